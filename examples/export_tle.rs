//! Writes a design as two-line element sets to stdout, ready for any SGP4.
//!
//! `cargo run --release --example export_tle -- delta:55:60/6/1@1000 >design.tle`

use navwalker::constellation::Design;
use navwalker::ephemeris::object_name;
use navwalker::formats::{element_set, metadata::Object, tle};
use navwalker::orbit::sgp4::MeanMotionSlot;
use navwalker::time::Epoch;
use std::error::Error;
use std::io;

fn main() -> Result<(), Box<dyn Error>> {
    let notation = std::env::args().nth(1);
    let notation = notation.as_deref().unwrap_or("delta:55:60/6/1@1000");
    let design: Design = notation.parse()?;
    let epoch = Epoch::from_utc("2025-06-01T00:00:00Z".parse()?);
    let mut out = io::stdout().lock();
    for (index, satellite) in design.satellites().iter().enumerate() {
        let object = Object::numbered(&object_name(satellite.slot), index, epoch)?;
        let slot = MeanMotionSlot::Kozai;
        let set = element_set(&satellite.elements, &object, epoch, slot);
        tle::write(&mut out, &set)?;
    }
    Ok(())
}
