//! Where the lanes may decide, and where the plain path does.

use super::super::sample::Limits;
use super::Threshold;

/// The band about a threshold is a relative 1e-6, and what one pivot floor changes: 8 ε n PDOP², for 100 satellites and
/// a cap of 10⁵ a relative 1.78e-3.
#[test]
fn lanes_decide_outside_the_band_of_each_threshold() {
    let limits = Limits {
        single_below: 2.0,
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
