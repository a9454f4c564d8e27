//! Evaluates one design over a region and with a GNSS defined in code, without a scenario file.
//!
//! `cargo run --release --example evaluate_design`

use navwalker::constellation::Design;
use navwalker::constellation::gnss::{Preset, System};
use navwalker::earth::Surface;
use navwalker::evaluate::{Evaluator, MetricOptions, Setup};
use navwalker::ground::{Grid, PointWeights};
use navwalker::time::{Epoch, TimeGrid};
use navwalker::visibility::Mask;
use std::error::Error;
use std::io::{self, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let iberia = Grid {
        latitude_deg: [36.0, 44.0],
        longitude_deg: [-10.0, 4.0],
        step_deg: [2.0, 2.0],
        weights: PointWeights::CosLatitude,
    };
    let epoch = Epoch::from_utc("2025-06-01T00:00:00Z".parse()?);
    let grid = TimeGrid::new(epoch, 86_400.0, 60.0)?;
    let setup = Setup::new(grid, iberia.sites(Surface::Wgs84)?)
        .with_mask(Mask::from_degrees(10.0)?)
        .with_gnss_mask(Mask::from_degrees(5.0)?)
        .with_gnss(vec![
            System::from(Preset::Gps),
            System::from(Preset::Galileo),
        ])
        .with_metrics(MetricOptions {
            availability_pdop: 2.0,
            ..MetricOptions::default()
        });
    let evaluator = Evaluator::new(setup)?;
    let design: Design = "delta:55:60/6/1@1000".parse()?;
    let metrics = evaluator.evaluate(&design)?;

    let mut out = io::stdout().lock();
    writeln!(out, "{design}")?;
    writeln!(out, "mean visible  {:.3}", metrics.mean_visible)?;
    // Statistics of PDOP have no value when no sample is solved.
    if let (Some(mean), Some(max)) = (metrics.mean_pdop, metrics.max_pdop) {
        writeln!(out, "mean PDOP     {mean:.3}")?;
        writeln!(out, "maximum PDOP  {max:.3}")?;
    }
    writeln!(out, "availability  {:.4}", metrics.availability)?;
    Ok(())
}
