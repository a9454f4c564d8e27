//! The setting of a study: time, Earth, visibility and GNSS.

use chrono::{DateTime, Utc};

use super::{JANUARY_2025, STEP_SLACK};
use crate::dop::MOST_PDOP_CAP;
use crate::scenario::keys::{key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Number, OneOf, Skyline, SomeOf, Texts, UtcInstant};
use crate::scenario::{Clocks, LeoClocks, Model, ObservationWeights, Preset, Surface};

/// Maximum number of instants: 366 days at every 3.2 seconds.
const MAX_SAMPLES: u64 = 10_000_000;

section! {
    /// Samples at `epoch + k step_s` for every k from 0 with `k step_s < duration_h`.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct TimeSpan in "time", finish check_samples {
        /// First instant, UTC; the epoch of the elements of every design.
        pub epoch: DateTime<Utc> = UtcInstant, default JANUARY_2025;
        /// Length of the study; the end instant is excluded.
        pub duration_h: f64 = Number::above_to(0.0, 366.0 * 24.0), unit "h", default 24.0;
        /// Interval between samples.
        pub step_s: f64 = Number::above(0.0), unit "s", default 60.0;
    }
}

impl TimeSpan {
    /// Number of samples, at least 1.
    #[must_use]
    pub fn samples(&self) -> usize {
        // Both are bounded on validation; a cast from a float saturates.
        (self.steps() - STEP_SLACK).ceil().max(1.0) as usize
    }

    pub(super) fn steps(&self) -> f64 {
        self.duration_h * 3600.0 / self.step_s
    }
}

fn check_samples(span: &mut TimeSpan, reader: &mut Reader<'_>) {
    let keys = [key!(TimeSpan.step_s), key!(TimeSpan.duration_h)];
    reader.at_most(MAX_SAMPLES, span.steps(), "samples in time", &keys);
}

section! {
    /// The Earth.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Earth in "earth" {
        /// Surface of the ground points and their verticals.
        pub surface: Surface = OneOf::new(), default Surface::Wgs84;
    }
}

section! {
    /// The motion of the LEO design.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Propagation in "propagation" {
        /// Propagation model of the LEO design; GNSS constellations always use their own.
        pub model: Model = OneOf::new(), default Model::J2;
    }
}

section! {
    /// Visibility, and when a sample is solved.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Visibility in "visibility", finish share_mask {
        /// Lowest elevation of a visible LEO satellite.
        pub mask_deg: f64 = Number::from_below(0.0, 90.0), unit "deg", default 7.0;
        /// Lowest elevation of a visible GNSS satellite.
        pub gnss_mask_deg: f64 = Number::from_below(0.0, 90.0), unit "deg",
            follows "mask-deg", example 7.0;
        /// Mask by azimuth [[azimuth, mask], ...] from 0 to 360 deg, linear between its points; applies
        /// where it is higher than a mask.
        pub mask_table: Vec<MaskPoint> = Skyline, unit "deg", default Vec::new();
        /// Weight of an observation in the least-squares solution.
        pub weighting: ObservationWeights = OneOf::new(), default ObservationWeights::Unit;
        /// PDOP above which a sample is unsolved.
        pub pdop_cap: f64 = Number::above_to(1.0, MOST_PDOP_CAP), default 100.0;
    }
}

/// One point of a mask by azimuth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaskPoint {
    /// Azimuth from north over east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Lowest elevation of a visible satellite there, degrees.
    pub mask_deg: f64,
}

fn share_mask(visibility: &mut Visibility, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(Visibility.gnss_mask_deg)) {
        visibility.gnss_mask_deg = visibility.mask_deg;
    }
}

section! {
    /// The GNSS that is augmented.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub struct GnssSetup in "gnss", finish check_clocks {
        /// Built-in GNSS constellations that the design augments.
        pub constellations: Vec<Preset> = SomeOf::at_least(0), default vec![Preset::Beidou3];
        /// TLE, OMM, SP3, OEM or almanacs of GNSS satellites, paths relative to this file.
        pub files: Vec<String> = Texts::any("paths"), default Vec::new();
        /// Receiver clocks solved for in addition to the position.
        pub clocks: Clocks = OneOf::new(), default Clocks::PerSystem;
        /// Clocks of the LEO satellites: one for all of a constellation, or one for each of its shells and files.
        pub leo_clocks: LeoClocks = OneOf::new(), default LeoClocks::Shared;
    }
}

/// One clock for all systems leaves none for the parts of a constellation.
fn check_clocks(gnss: &mut GnssSetup, reader: &mut Reader<'_>) {
    if gnss.clocks == Clocks::Shared && gnss.leo_clocks == LeoClocks::PerPart {
        let other = key!(GnssSetup.clocks).to_string();
        reader.refuse(&[key!(GnssSetup.leo_clocks)], Fault::OneClock { other });
    }
}
