//! Warnings about sampled states in a study: gaps, and the error of interpolation.

use super::Fleet;
use crate::ephemeris::arc::{Arc, Interpolation};
use crate::formats::trajectory::Trajectory;
use crate::time::{Epoch, TimeGrid};
use crate::units::counted;
use std::fmt;

/// Maximum number of satellites, the first ones, whose interpolation error is estimated.
const ESTIMATED: usize = 100;

/// A note on sampled satellites on a grid.
#[derive(Debug, Clone, PartialEq)]
pub enum SamplingNote {
    /// Instants at which a satellite has no state and counts as not visible.
    Gaps {
        /// The satellite.
        name: String,
        /// Number of instants without a state.
        missing: usize,
        /// Number of instants of the grid.
        of: usize,
        /// The first instant without a state.
        first: Epoch,
        /// The last instant without a state.
        last: Epoch,
    },
    /// States that are interpolated.
    Interpolated {
        /// Number of satellites with interpolated states.
        satellites: usize,
        /// The interpolation of the satellite with the largest error.
        interpolation: Interpolation,
        /// That satellite.
        worst: String,
        /// Its largest error with every other state omitted, km; `None` if there are too few states.
        left_out_error_km: Option<f64>,
    },
    /// Arcs that end and begin at one instant with different positions, as the files of two days may.
    Seams {
        /// Number of satellites with such arcs.
        satellites: usize,
        /// The satellite with the largest difference.
        worst: String,
        /// The instant of that difference.
        at: Epoch,
        /// That difference, km.
        apart_km: f64,
    },
}

impl fmt::Display for SamplingNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gaps {
                name,
                missing,
                of,
                first,
                last,
            } => write!(
                f,
                "{name} has no state at {missing} of {of} instants, from {first} to {last}: it counts as not visible then"
            ),
            Self::Interpolated {
                satellites,
                interpolation,
                worst,
                left_out_error_km,
            } => {
                let how = interpolation.describe();
                write!(
                    f,
                    "states of {} are interpolated ({how}); ",
                    counted(*satellites, "satellite")
                )?;
                let among = match *satellites > ESTIMATED {
                    true => format!(", among the first {ESTIMATED} satellites"),
                    false => String::new(),
                };
                match left_out_error_km {
                    Some(km) => write!(
                        f,
                        "largest error with every other state omitted: {} ({worst}{among}); with all \
                         states about {} times less",
                        length(*km),
                        2_u64.saturating_pow(interpolation.order())
                    ),
                    None => write!(f, "{worst} has too few states to estimate the error"),
                }
            }
            Self::Seams {
                satellites,
                worst,
                at,
                apart_km,
            } => write!(
                f,
                "the positions of {} differ at the instant that two files share, most by {} ({worst} at {at}): \
                 states are not interpolated across it",
                counted(*satellites, "satellite"),
                length(*apart_km)
            ),
        }
    }
}

/// A length in a suitable unit, to two digits.
fn length(km: f64) -> String {
    match km {
        km if km >= 10.0 => format!("{km:.0} km"),
        km if km >= 1.0 => format!("{km:.1} km"),
        km if km >= 1e-2 => format!("{:.0} m", km * 1e3),
        km if km >= 1e-3 => format!("{:.1} m", km * 1e3),
        km if km >= 1e-5 => format!("{:.0} mm", km * 1e6),
        _ => "under 10 mm".to_owned(),
    }
}

impl Fleet {
    /// Notes on sampled satellites on a grid: files that do not continue each other, gaps, once per satellite, and the
    /// interpolation.
    #[must_use]
    pub fn sampling_notes(&self, grid: TimeGrid) -> Vec<SamplingNote> {
        let labels = self.labels();
        let mut sampled = Vec::new();
        self.collect_sampled(&mut labels.iter(), &mut sampled);
        let mut notes = Vec::from_iter(seams(&sampled, grid));
        let mut interpolated: Vec<(&Trajectory, &String)> = Vec::new();
        for (trajectory, label) in sampled {
            let look = SampleCoverage::of(trajectory, grid);
            notes.extend(look.gaps(label, grid.len()));
            if look.interpolates {
                interpolated.push((trajectory, label));
            }
        }
        notes.extend(worst(&interpolated));
        notes
    }

    fn collect_sampled<'a>(
        &'a self,
        labels: &mut std::slice::Iter<'a, String>,
        sampled: &mut Vec<(&'a Trajectory, &'a String)>,
    ) {
        match self {
            Self::Sampled(trajectories) => sampled.extend(trajectories.iter().zip(labels)),
            Self::Mixed(parts) => {
                for part in parts {
                    part.collect_sampled(labels, sampled);
                }
            }
            Self::Sets(_) | Self::Elements(_) | Self::Almanacs(_) => {
                labels.by_ref().take(self.len()).for_each(drop);
            }
        }
    }
}

/// The instants of a grid at which a satellite has states.
struct SampleCoverage {
    missing: usize,
    ends: Option<(Epoch, Epoch)>,
    interpolates: bool,
}

impl SampleCoverage {
    fn of(trajectory: &Trajectory, grid: TimeGrid) -> Self {
        let mut found = Self {
            missing: 0,
            ends: None,
            interpolates: false,
        };
        for elapsed_s in grid.iter() {
            let at = grid.epoch().plus_seconds(elapsed_s);
            match trajectory
                .arc_at(at)
                .and_then(|arc| arc.is_interpolated(at))
            {
                Some(interpolated) => found.interpolates |= interpolated,
                None => {
                    found.missing += 1;
                    found.ends = Some((found.ends.map_or(at, |(first, _)| first), at));
                }
            }
        }
        found
    }

    fn gaps(&self, name: &str, of: usize) -> Option<SamplingNote> {
        let (first, last) = self.ends?;
        Some(SamplingNote::Gaps {
            name: name.to_owned(),
            missing: self.missing,
            of,
            first,
            last,
        })
    }
}

/// The arcs that would be one if they had the same position at the instant that they share.
fn seams(sampled: &[(&Trajectory, &String)], grid: TimeGrid) -> Option<SamplingNote> {
    let last = grid.epoch().plus_seconds(grid.elapsed_s(grid.len() - 1));
    let largest = |trajectory: &Trajectory| {
        let pairs = trajectory.arcs.windows(2);
        let found = pairs.filter_map(|pair| {
            let at = pair[0].useable.1;
            let apart_km = pair[0].seam_km(&pair[1])?.norm();
            (grid.epoch() <= at && at <= last).then_some((at, apart_km))
        });
        found.reduce(|one, other| if other.1 > one.1 { other } else { one })
    };
    let found = sampled.iter().filter_map(|(trajectory, label)| {
        let (at, apart_km) = largest(trajectory)?;
        Some((1, *label, at, apart_km))
    });
    let (satellites, worst, at, apart_km) = found.reduce(|one, other| {
        let count = one.0 + other.0;
        let (_, label, at, apart_km) = if other.3 > one.3 { other } else { one };
        (count, label, at, apart_km)
    })?;
    Some(SamplingNote::Seams {
        satellites,
        worst: worst.clone(),
        at,
        apart_km,
    })
}

fn worst(interpolated: &[(&Trajectory, &String)]) -> Option<SamplingNote> {
    let error_of = |trajectory: &Trajectory| {
        let errors = trajectory.arcs.iter().filter_map(Arc::left_out_error_km);
        errors.reduce(f64::max)
    };
    let estimated = interpolated.iter().take(ESTIMATED);
    let estimated =
        estimated.map(|(trajectory, label)| (error_of(trajectory), *trajectory, *label));
    let (left_out_error_km, trajectory, label) =
        estimated.reduce(|one, other| if other.0 > one.0 { other } else { one })?;
    Some(SamplingNote::Interpolated {
        satellites: interpolated.len(),
        interpolation: trajectory.arcs.first()?.interpolation,
        worst: label.clone(),
        left_out_error_km,
    })
}

#[cfg(test)]
mod tests;
