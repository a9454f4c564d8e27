//! Where the lanes may decide, and where the plain path does.

use super::super::limits::{Limits, SingleLimits};
use super::super::weighting::UnitWeights;
use super::decisions::street;
use super::{Surface, Threshold, setup};
use std::sync::Arc;

/// The band about a threshold is a relative 1e-6, and what one pivot floor changes: 8 ε n PDOP², for 100 satellites and
/// a cap of 10⁵ a relative 1.78e-3.
#[test]
fn lanes_decide_outside_the_band_of_each_threshold() {
    let limits = Limits {
        single: SingleLimits::new::<UnitWeights>(1e5),
        cap: 1e5,
        available: Threshold(6.0),
        clocks: 1,
    };
    for (threshold, within, beyond) in [(1e5, 1.7e-3, 1.9e-3), (6.0, 0.9e-6, 1.1e-6)] {
        for side in [-1.0, 1.0] {
            let decides = |by: f64| limits.decides(threshold * (1.0 + side * by), 100);
            assert!(!decides(within), "{threshold}: {within} on side {side}");
            assert!(decides(beyond), "{threshold}: {beyond} on side {side}");
        }
    }
}

/// Dilutions asked for by a search count on every thread, those of `--dops` once, and skylines by their tables.
#[test]
fn memory_of_what_is_asked_for_is_counted() {
    let setup = setup([3.0, 54.0], Surface::Sphere);
    // GDOP, HDOP, VDOP and two clocks, on nine tiles; and of the clock of the GNSS eight numbers and how many satellites.
    let rows = (5 * 9 * 16 * 1440 * size_of::<f32>()) as u64 + (9 * 9 * 16 * 1440 * 4) as u64;
    let dops = setup.dops_bytes(1);
    assert!((rows..rows + (8 << 20)).contains(&dops), "{dops}");
    let mut asking = setup.clone();
    asking.metrics.asks_for_hdop = true;
    assert_eq!(
        asking.memory_bytes(2, 2),
        setup.memory_bytes(2, 2) + 2 * dops
    );
    assert!(setup.series_bytes() >= (143 * 1440 * size_of::<f32>()) as u64);
    let under_skyline = setup.clone().with_skyline(street());
    let table = (2048 * size_of::<u32>()) as u64;
    let more = under_skyline.memory_bytes(1, 1) - setup.memory_bytes(1, 1);
    assert!((table..table + 143 * 1024).contains(&more), "{more}");
    // A second skyline has a table of its own.
    let mut under_two = under_skyline.clone();
    under_two.sites[7].skyline = Some(Arc::new(street()));
    assert_eq!(
        under_two.memory_bytes(1, 1) - under_skyline.memory_bytes(1, 1),
        table
    );
}
