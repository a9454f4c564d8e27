//! Hermite interpolation between the samples of a file, and its error.
//!
//! A polynomial interpolates between the lines of a table of positions and velocities. The file
//! names its degree; this module measures which degree the step of the study needs.

use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{EphemerisError, EphemerisSatellite};
use crate::frames::{Position, ReferenceFrame, State};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Error that the chosen degree keeps to where it can, km: the centimetre to which files are
/// compared.
const TARGET_KM: f64 = 1e-5;

/// Fewest and most nodes; n nodes make a polynomial of degree 2n - 1.
const NODES: std::ops::RangeInclusive<usize> = 4..=8;

/// Maximum number of intervals between samples that are checked.
const INTERVALS: usize = 200;

/// Hermite interpolation of a degree, with its largest error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hermite {
    /// Degree of the polynomial: 2n - 1 for n samples.
    pub degree: usize,
    /// Largest distance from the model at the middle of an interval, km.
    pub max_error_km: f64,
}

impl Hermite {
    /// The interpolation for each satellite. Those of a shell are propagated in the same way, so the first
    /// represents all; others are measured one by one.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn of_each<F: ReferenceFrame>(
        sampled: &Sampled<'_, F>,
    ) -> Result<Vec<Option<Self>>, EphemerisError> {
        let ephemeris = sampled.ephemeris();
        let measured = |place: usize| Self::measured(sampled, &ephemeris.satellites()[place]);
        let mut hermites = vec![None; ephemeris.satellites().len()];
        for span in ephemeris.shells() {
            hermites[span.places()].fill(measured(span.first)?);
        }
        let others = ephemeris.outside_shells();
        let found = others.par_iter().map(|place| measured(*place));
        let found: Vec<Option<Self>> = found.collect::<Result<_, _>>()?;
        for (place, hermite) in others.into_iter().zip(found) {
            hermites[place] = hermite;
        }
        Ok(hermites)
    }

    /// The lowest degree from 7 whose error is below a centimetre, or the best up to 15,
    /// measured on the states of one satellite. None if there is only one sample, or no state halfway between two.
    ///
    /// # Errors
    /// If the satellite cannot be propagated.
    pub fn measured<F: ReferenceFrame>(
        sampled: &Sampled<'_, F>,
        satellite: &EphemerisSatellite,
    ) -> Result<Option<Self>, EphemerisError> {
        let samples = sampled.grid().len();
        if samples < 2 {
            return Ok(None);
        }
        let mut best: Option<Self> = None;
        for nodes in NODES.map(|nodes| nodes.min(samples)) {
            let Some(max_error_km) = max_error_km(sampled, satellite, nodes)? else {
                return Ok(None);
            };
            let found = Self {
                degree: 2 * nodes - 1,
                max_error_km,
            };
            if best.is_none_or(|best| found.max_error_km < best.max_error_km) {
                best = Some(found);
            }
            if found.max_error_km <= TARGET_KM || nodes == samples {
                break;
            }
        }
        Ok(best)
    }
}

/// Largest distance between the interpolated and the true position, halfway between samples. A satellite may have no
/// state there, between two arcs of its file; `None` if that is so everywhere.
fn max_error_km<F: ReferenceFrame>(
    sampled: &Sampled<'_, F>,
    satellite: &EphemerisSatellite,
    nodes: usize,
) -> Result<Option<f64>, EphemerisError> {
    let grid = sampled.grid();
    let state = |elapsed_s: f64| sampled.state(satellite, elapsed_s);
    let last = grid.len() - 1;
    let count = last.min(INTERVALS);
    let mut max_km: Option<f64> = None;
    for k in 0..count {
        // The first and the last interval are among them, where the nodes lie to one side.
        let interval = if count == 1 {
            0
        } else {
            k * (last - 1) / (count - 1)
        };
        let middle_s = grid.elapsed_s(interval) + 0.5 * grid.step_s();
        let Some(exact) = sampled.state_or_gap(satellite, middle_s)? else {
            continue;
        };
        let start = (interval + 1)
            .saturating_sub(nodes / 2)
            .min(grid.len() - nodes);
        let table = (start..start + nodes)
            .map(|sample| Ok((grid.elapsed_s(sample), state(grid.elapsed_s(sample))?)))
            .collect::<Result<Vec<_>, EphemerisError>>()?;
        let apart = hermite_position(&table, middle_s) - exact.position_km;
        max_km = Some(max_km.unwrap_or(0.0).max(apart.norm()));
    }
    Ok(max_km)
}

/// Position at `at_s` of the polynomial through positions and velocities.
#[must_use]
pub fn hermite_position<F>(table: &[(f64, State<F>)], at_s: f64) -> Position<F> {
    hermite_state(table, at_s).position_km
}

/// Position at `at_s` of the polynomial through positions and velocities, and its derivative.
///
/// Newton's form with every node taken twice; Stoer and Bulirsch, *Introduction to Numerical
/// Analysis* (3rd ed.), section 2.1.5. The instants must differ.
#[must_use]
pub fn hermite_state<F>(table: &[(f64, State<F>)], at_s: f64) -> State<F> {
    let instants: Vec<f64> = table.iter().flat_map(|(t, _)| [*t, *t]).collect();
    let mut column: Vec<Vector3<f64>> = table
        .iter()
        .flat_map(|(_, state)| [state.position_km.km(); 2])
        .collect();
    let mut coefficients: Vec<Vector3<f64>> = column.iter().take(1).copied().collect();
    for order in 1..instants.len() {
        for i in 0..instants.len() - order {
            let span = instants[i + order] - instants[i];
            column[i] = if order == 1 && i % 2 == 0 {
                table[i / 2].1.velocity_km_s
            } else {
                (column[i + 1] - column[i]) / span
            };
        }
        coefficients.push(column[0]);
    }
    let (mut value, mut slope) = (Vector3::zeros(), Vector3::zeros());
    for (t, coefficient) in instants.iter().zip(&coefficients).rev() {
        slope = slope * (at_s - t) + value;
        value = value * (at_s - t) + coefficient;
    }
    State::new(value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::ephemeris::Ephemeris;
    use crate::ephemeris::testing::files_between_shells;
    use crate::frames::{Frame, Teme};
    use crate::orbit::Model;
    use crate::time::{Epoch, TimeGrid};

    /// A polynomial of degree 7 is met exactly by four nodes.
    #[test]
    fn validate_a_polynomial_is_its_own_interpolation() {
        let at = |t: f64| {
            State::<Teme>::new(
                Vector3::new(t.powi(7) - 3.0 * t, 2.0 * t * t, 5.0),
                Vector3::new(7.0 * t.powi(6) - 3.0, 4.0 * t, 0.0),
            )
        };
        let table: Vec<_> = [-1.0, -0.25, 0.5, 1.5].map(|t| (t, at(t))).into();
        for t in [-0.8, 0.0, 0.3, 1.2] {
            let apart = hermite_position(&table, t) - at(t).position_km;
            // Rounding of sums of terms up to 20.
            assert!(apart.norm() < 1e-13, "{t}: {}", apart.norm());
            let apart = hermite_state(&table, t).velocity_km_s - at(t).velocity_km_s;
            assert!(apart.norm() < 1e-12, "{t}: {}", apart.norm());
        }
    }

    fn measured(step_s: f64, frame: Frame) -> Hermite {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 86_400.0, step_s).unwrap();
        let design: Design = "delta:55:6/3/1@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let sampled = Sampled::new(&ephemeris, frame);
        Hermite::measured(&sampled, &ephemeris.satellites()[0])
            .unwrap()
            .unwrap()
    }

    /// The truncation of degree 7 at 60 s is far below a millimetre (1e-11 km in TEME). In
    /// EME2000 the rotation's own rate, 7.7e-12 rad/s by precession, is left out of the velocity:
    /// 5.6e-8 km/s over part of a minute.
    #[test]
    fn a_minute_needs_degree_7_and_ten_minutes_more() {
        for (frame, most_km) in [
            (Frame::Teme, 1e-9),
            (Frame::EarthFixed, 1e-9),
            (Frame::Eme2000, 4e-6),
        ] {
            let minute = measured(60.0, frame);
            assert_eq!(minute.degree, 7);
            assert!(minute.max_error_km < most_km, "{frame}: {minute:?}");
        }
        let coarse = measured(600.0, Frame::Teme);
        assert!(
            coarse.degree > 7 && coarse.max_error_km < TARGET_KM,
            "{coarse:?}"
        );
    }

    /// Each satellite has the error of its own orbit, whatever is before it.
    #[test]
    fn satellites_are_represented_by_their_own_shell() {
        let mixed = files_between_shells();
        let sampled = Sampled::new(&mixed, Frame::Teme);
        let found = Hermite::of_each(&sampled).unwrap();
        let own = |place: usize| Hermite::measured(&sampled, &mixed.satellites()[place]).unwrap();
        for (place, first) in [0, 0, 2, 3, 4, 4, 4, 4].into_iter().enumerate() {
            assert_eq!(found[place], own(first), "{place}");
        }
        assert_ne!(own(0), own(4));
    }

    #[test]
    fn short_tables_use_what_they_have() {
        assert_eq!(measured(43_200.0, Frame::Teme).degree, 3);
        assert!(measured(30_000.0, Frame::Teme).degree == 5);
    }
}
