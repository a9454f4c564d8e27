//! The range errors of the systems, from which the accuracy in metres follows, and the window of the information.

use super::{Objectives, Reliability, Scenario, TimeSpan};
use crate::evaluate::{Accuracy, RangeError};
use crate::scenario::keys::{KeyPath, key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Number, Optional, TwoNumbers};
use crate::scenario::{GnssSetup, Keyword, Preset, Quantity};

/// Limits of a range error, metres. Its ratio between two systems enters the normal matrix squared: beyond 1e6 the
/// more accurate one leaves no digits for the other.
const SIGMA: Number = Number::from_to(0.001, 1000.0);

/// Limits of the parts a and b of a range error.
const PART: Number = Number::from_to(0.0, 100.0);

section! {
    /// Range errors, 1 sigma: the accuracy in metres is computed if the study gives one of every system in use.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct RangeErrors in "accuracy", finish check_systems {
        /// Range error of the LEO satellites, 1 sigma.
        pub leo_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of the LEO satellites, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub leo_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of BeiDou-3, 1 sigma.
        pub beidou_3_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of BeiDou-3, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub beidou_3_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of GPS, 1 sigma.
        pub gps_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of GPS, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub gps_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of Galileo, 1 sigma.
        pub galileo_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of Galileo, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub galileo_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of GLONASS, 1 sigma.
        pub glonass_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of GLONASS, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub glonass_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of QZSS, 1 sigma.
        pub qzss_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of QZSS, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub qzss_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of NavIC, 1 sigma.
        pub navic_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of NavIC, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub navic_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
        /// Range error of GNSS satellites from `gnss.files`, 1 sigma.
        pub files_m: Option<f64> = Optional(SIGMA), unit "m", follows "none: no accuracy in metres", example Some(0.5);
        /// [a, b] of the range error of GNSS satellites from `gnss.files`, sigma sqrt(a^2 + b^2/sin^2 E) at elevation E.
        pub files_elevation: Option<[f64; 2]> = Optional(TwoNumbers(PART)), follows "[1, 0]", example Some([1.0, 0.0]);
    }
}

section! {
    /// Metrics that are computed where they are asked for.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct FurtherMetrics in "metrics", finish clear_window {
        /// Length of the windows whose PDOP is computed: all observations in a window with one position and clocks at each instant.
        pub window_min: Option<f64> = Optional(Number::above(0.0)), unit "min", follows "none", example Some(10.0);
    }
}

fn clear_window(metrics: &mut FurtherMetrics, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(FurtherMetrics.window_min)) {
        metrics.window_min = None;
    }
}

/// The keys of a system and their values.
struct SystemKeys<'a> {
    sigma: KeyPath,
    sigma_m: &'a mut Option<f64>,
    elevation: KeyPath,
    parts: &'a mut Option<[f64; 2]>,
}

impl RangeErrors {
    fn systems(&mut self) -> [SystemKeys<'_>; 8] {
        [
            SystemKeys {
                sigma: key!(RangeErrors.leo_m),
                sigma_m: &mut self.leo_m,
                elevation: key!(RangeErrors.leo_elevation),
                parts: &mut self.leo_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.beidou_3_m),
                sigma_m: &mut self.beidou_3_m,
                elevation: key!(RangeErrors.beidou_3_elevation),
                parts: &mut self.beidou_3_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.gps_m),
                sigma_m: &mut self.gps_m,
                elevation: key!(RangeErrors.gps_elevation),
                parts: &mut self.gps_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.galileo_m),
                sigma_m: &mut self.galileo_m,
                elevation: key!(RangeErrors.galileo_elevation),
                parts: &mut self.galileo_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.glonass_m),
                sigma_m: &mut self.glonass_m,
                elevation: key!(RangeErrors.glonass_elevation),
                parts: &mut self.glonass_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.qzss_m),
                sigma_m: &mut self.qzss_m,
                elevation: key!(RangeErrors.qzss_elevation),
                parts: &mut self.qzss_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.navic_m),
                sigma_m: &mut self.navic_m,
                elevation: key!(RangeErrors.navic_elevation),
                parts: &mut self.navic_elevation,
            },
            SystemKeys {
                sigma: key!(RangeErrors.files_m),
                sigma_m: &mut self.files_m,
                elevation: key!(RangeErrors.files_elevation),
                parts: &mut self.files_elevation,
            },
        ]
    }

    /// The error of a system of the presets.
    fn of_preset(&self, preset: Preset) -> Option<RangeError> {
        match preset {
            Preset::Beidou3 => error(self.beidou_3_m, self.beidou_3_elevation),
            Preset::Gps => error(self.gps_m, self.gps_elevation),
            Preset::Galileo => error(self.galileo_m, self.galileo_elevation),
            Preset::Glonass => error(self.glonass_m, self.glonass_elevation),
            Preset::Qzss => error(self.qzss_m, self.qzss_elevation),
            Preset::Navic => error(self.navic_m, self.navic_elevation),
        }
    }

    /// The range errors of the presets in their order and of `from_files` systems behind them; `None` if the study
    /// gives none.
    pub(in crate::scenario) fn accuracy(
        &self,
        presets: &[Preset],
        from_files: usize,
    ) -> Option<Accuracy> {
        let leo = error(self.leo_m, self.leo_elevation)?;
        let presets = presets.iter().map(|preset| self.of_preset(*preset));
        let files = std::iter::repeat_n(error(self.files_m, self.files_elevation), from_files);
        let gnss = presets.chain(files).collect::<Option<_>>()?;
        Some(Accuracy { leo, gnss })
    }
}

impl RangeErrors {
    /// The keys of range errors that are given and of systems that are not in use.
    pub(in crate::scenario) fn unused(&self, gnss: &GnssSetup) -> Vec<KeyPath> {
        let has = |preset: Preset| gnss.constellations.contains(&preset);
        // In the order of the keys.
        let in_use = [
            true,
            has(Preset::Beidou3),
            has(Preset::Gps),
            has(Preset::Galileo),
            has(Preset::Glonass),
            has(Preset::Qzss),
            has(Preset::Navic),
            !gnss.files.is_empty(),
        ];
        let mut given = *self;
        let systems = given.systems().into_iter().zip(in_use);
        let unused = systems.filter(|(system, in_use)| !in_use && system.sigma_m.is_some());
        unused.map(|(system, _)| system.sigma).collect()
    }

    /// The name and the range error of each system in use that has one, the LEO satellites first.
    #[must_use]
    pub fn in_use(&self, gnss: &GnssSetup) -> Vec<(&'static str, RangeError)> {
        let leo = Some("LEO").zip(error(self.leo_m, self.leo_elevation));
        let presets = gnss.constellations.iter();
        let presets = presets.filter_map(|one| Some(one.keyword()).zip(self.of_preset(*one)));
        let files = error(self.files_m, self.files_elevation);
        let files = files.filter(|_| !gnss.files.is_empty());
        let files = files.map(|error| ("GNSS from files", error));
        leo.into_iter().chain(presets).chain(files).collect()
    }
}

fn error(sigma_m: Option<f64>, elevation: Option<[f64; 2]>) -> Option<RangeError> {
    let [constant, by_elevation] = elevation.unwrap_or([1.0, 0.0]);
    Some(RangeError {
        sigma_m: sigma_m?,
        constant,
        by_elevation,
    })
}

/// Clears what is not given, and refuses an elevation part without an error, or that leaves none.
fn check_systems(errors: &mut RangeErrors, reader: &mut Reader<'_>) {
    for system in errors.systems() {
        if !reader.is_given(system.sigma) {
            *system.sigma_m = None;
        }
        if !reader.is_given(system.elevation) {
            *system.parts = None;
        }
        if system.parts.is_some() && system.sigma_m.is_none() {
            let other = system.sigma.to_string();
            let keys = [system.elevation, system.sigma];
            reader.refuse(&keys, Fault::NoRangeError { other });
        }
        if *system.parts == Some([0.0, 0.0]) {
            reader.refuse(&[system.elevation], Fault::NoError);
        }
    }
}

/// Refuses a study with range errors of some systems in use but not of all, a window that is longer than the span, and
/// quantities that need what is not given.
pub(super) fn check(scenario: &mut Scenario, reader: &mut Reader<'_>) {
    let systems = scenario.accuracy.systems().into_iter();
    let given = systems.filter(|system| system.sigma_m.is_some());
    let given: Vec<KeyPath> = given.map(|system| system.sigma).collect();
    if !given.is_empty() {
        for missing in missing(scenario) {
            let fault = Fault::MissingRangeError {
                key: missing.to_string(),
            };
            // The systems may be given by `--set` after the range errors.
            let systems = [key!(GnssSetup.constellations), key!(GnssSetup.files)];
            let keys = [given.as_slice(), &systems, &[missing]].concat();
            reader.refuse(&keys, fault);
        }
    }
    check_window(scenario, reader);
    check_quantities(scenario, reader, !given.is_empty());
}

/// The keys of the systems in use whose range errors are missing.
fn missing(scenario: &Scenario) -> Vec<KeyPath> {
    let errors = &scenario.accuracy;
    let mut missing = Vec::new();
    if errors.leo_m.is_none() {
        missing.push(key!(RangeErrors.leo_m));
    }
    for preset in &scenario.gnss.constellations {
        if errors.of_preset(*preset).is_none() {
            missing.push(match preset {
                Preset::Beidou3 => key!(RangeErrors.beidou_3_m),
                Preset::Gps => key!(RangeErrors.gps_m),
                Preset::Galileo => key!(RangeErrors.galileo_m),
                Preset::Glonass => key!(RangeErrors.glonass_m),
                Preset::Qzss => key!(RangeErrors.qzss_m),
                Preset::Navic => key!(RangeErrors.navic_m),
            });
        }
    }
    if !scenario.gnss.files.is_empty() && errors.files_m.is_none() {
        missing.push(key!(RangeErrors.files_m));
    }
    missing
}

fn check_window(scenario: &Scenario, reader: &mut Reader<'_>) {
    let Some(window_min) = scenario.metrics.window_min else {
        return;
    };
    let span_min = scenario.time.duration_h * 60.0;
    if window_min > span_min {
        let keys = [key!(FurtherMetrics.window_min), key!(TimeSpan.duration_h)];
        let fault = Fault::WindowTooLong {
            window_min,
            span_min,
        };
        reader.refuse(&keys, fault);
    }
    let step_min = scenario.time.step_s / 60.0;
    if window_min <= step_min {
        let keys = [key!(FurtherMetrics.window_min), key!(TimeSpan.step_s)];
        let fault = Fault::WindowTooShort {
            window_min,
            step_min,
        };
        reader.refuse(&keys, fault);
    }
}

fn check_quantities(scenario: &Scenario, reader: &mut Reader<'_>, has_errors: bool) {
    let lacks = |quantity: Quantity| {
        if quantity.is_in_metres() && !has_errors {
            return Some("the range errors of [accuracy]".to_owned());
        }
        let up = scenario.reliability.satellite_availability();
        if quantity == Quantity::ExpectedAvailability && up.is_none() {
            return Some(format!("`{}`", key!(Reliability.availability)));
        }
        if quantity == Quantity::ExpectedAvailability
            && scenario.reliability.spares_per_plane.is_some()
        {
            let spares = key!(Reliability.spares_per_plane);
            return Some(format!(
                "a study without `{spares}`, whose draws are of `evaluate` alone"
            ));
        }
        let gnss = &scenario.gnss;
        let has_gnss = !gnss.constellations.is_empty() || !gnss.files.is_empty();
        if quantity.gain_in().is_some() && !has_gnss {
            let (built_in, files) = (key!(GnssSetup.constellations), key!(GnssSetup.files));
            return Some(format!(
                "a GNSS to gain over, from `{built_in}` or `{files}`"
            ));
        }
        let window = key!(FurtherMetrics.window_min);
        let lacks_window = quantity.is_of_windows() && scenario.metrics.window_min.is_none();
        lacks_window.then(|| format!("`{window}`"))
    };
    let objectives = scenario.objectives.minimize.iter().copied();
    let constraints = scenario.objectives.constraints.iter();
    let lists: [(KeyPath, Vec<Quantity>); 2] = [
        (key!(Objectives.minimize), objectives.collect()),
        (
            key!(Objectives.constraints),
            constraints.map(|one| one.quantity).collect(),
        ),
    ];
    for (key, quantities) in lists {
        for (place, quantity) in quantities.into_iter().enumerate() {
            if let Some(needs) = lacks(quantity) {
                let quantity = quantity.to_string();
                reader.refuse_element(key, place, Fault::Needs { quantity, needs });
            }
        }
    }
}
