//! Differences of two trajectories of the same satellites in radial, in-track, cross-track axes.

use super::distribution::{Distribution, Residual};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::ric_basis;
use crate::stats::line_fit;
use crate::units::SECONDS_PER_DAY;
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A number for each axis of the RIC basis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ric {
    /// Along the position vector.
    pub radial: f64,
    /// Along C × R, forwards.
    pub in_track: f64,
    /// Along the orbit normal.
    pub cross_track: f64,
}

impl Ric {
    /// Radial, in-track, cross-track.
    #[must_use]
    pub fn axes(&self) -> [f64; 3] {
        [self.radial, self.in_track, self.cross_track]
    }

    fn vector(&self) -> Vector3<f64> {
        Vector3::new(self.radial, self.in_track, self.cross_track)
    }

    pub(super) fn from_vector(v: Vector3<f64>) -> Self {
        Self {
            radial: v.x,
            in_track: v.y,
            cross_track: v.z,
        }
    }
}

/// Where the largest difference occurs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Name of the satellite.
    pub satellite: String,
    /// Seconds since the epoch of the grid.
    pub elapsed_s: f64,
    /// Size of the difference, km.
    pub distance_km: f64,
}

/// One line of an error budget: second trajectory minus first, over every satellite and sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BudgetLine {
    /// What is compared: `first/second`.
    pub case: String,
    /// What causes the difference.
    pub cause: String,
    /// Root mean square, km.
    pub rms_km: Ric,
    /// Largest size, km.
    pub max_km: Ric,
    /// Mean, km.
    pub mean_km: Ric,
    /// Slope of the straight line through the mean of the constellation, km/day.
    pub growth_km_per_day: Ric,
    /// Where the largest difference occurs.
    pub worst: Worst,
    /// How the distances are distributed.
    pub distance: Option<Distribution>,
}

impl BudgetLine {
    /// The lines of one case for several shells of a design, with their numbers of satellites, as one line for
    /// all: the sums behind each line are over the same instants, so they add. `None` without a line.
    #[must_use]
    pub fn pooled(shells: &[(usize, &Self)]) -> Option<Self> {
        let (_, first) = shells.first()?;
        let satellites: usize = shells.iter().map(|(count, _)| count).sum();
        let mean = |of: fn(&Self) -> Vector3<f64>| {
            let parts = shells.iter().map(|(count, line)| of(line) * *count as f64);
            parts.sum::<Vector3<f64>>() / satellites as f64
        };
        let squares = mean(|line| line.rms_km.vector().map(|x| x * x));
        let largest =
            |one: Vector3<f64>, (_, line): &(usize, &Self)| one.sup(&line.max_km.vector());
        let worst = shells.iter().map(|(_, line)| &line.worst);
        let worst = worst.max_by(|a, b| a.distance_km.total_cmp(&b.distance_km))?;
        Some(Self {
            rms_km: Ric::from_vector(squares.map(f64::sqrt)),
            max_km: Ric::from_vector(shells.iter().fold(Vector3::zeros(), largest)),
            mean_km: Ric::from_vector(mean(|line| line.mean_km.vector())),
            growth_km_per_day: Ric::from_vector(mean(|line| line.growth_km_per_day.vector())),
            worst: worst.clone(),
            // Quantiles do not add.
            distance: None,
            ..(*first).clone()
        })
    }
}

/// Maximum number of distances in a distribution; beyond this, instants are thinned out.
const KEPT: usize = 1_000_000;

/// The sums of one instant, over the satellites.
struct InstantSums {
    elapsed_s: f64,
    sum: Vector3<f64>,
    squares: Vector3<f64>,
    largest: Vector3<f64>,
    worst: (f64, usize),
    distances: Vec<f64>,
}

fn instant(
    first: &Ephemeris,
    second: &Ephemeris,
    elapsed_s: f64,
) -> Result<InstantSums, EphemerisError> {
    let mut sums = InstantSums {
        elapsed_s,
        sum: Vector3::zeros(),
        squares: Vector3::zeros(),
        largest: Vector3::zeros(),
        worst: (-1.0, 0),
        distances: Vec::with_capacity(first.satellites().len()),
    };
    for (n, (a, b)) in first
        .satellites()
        .iter()
        .zip(second.satellites())
        .enumerate()
    {
        let (a, b) = (first.state(a, elapsed_s)?, second.state(b, elapsed_s)?);
        // A closed orbit above the ground never moves along its position vector.
        let Some(basis) = ric_basis(&a) else { continue };
        let apart = basis * (b.position_km - a.position_km);
        sums.sum += apart;
        sums.squares += apart.component_mul(&apart);
        sums.largest = sums.largest.sup(&apart.abs());
        sums.distances.push(apart.norm());
        if apart.norm() > sums.worst.0 {
            sums.worst = (apart.norm(), n);
        }
    }
    Ok(sums)
}

/// The differences of `second` from `first` in the RIC basis of `first`, satellite by satellite in
/// the order of both, over the grid of `first`.
///
/// # Errors
/// If a satellite of either cannot be propagated.
pub fn compare(
    case: &str,
    cause: &str,
    first: &Ephemeris,
    second: &Ephemeris,
) -> Result<BudgetLine, EphemerisError> {
    let times: Vec<f64> = first.grid().iter().collect();
    // Collected in time order, so the sums below do not depend on the number of threads.
    let instants = times
        .par_iter()
        .map(|&elapsed_s| instant(first, second, elapsed_s))
        .collect::<Result<Vec<_>, _>>()?;
    let satellites = first.satellites().len().min(second.satellites().len()) as f64;
    let samples = satellites * instants.len() as f64;
    let total = |add: fn(Vector3<f64>, &InstantSums) -> Vector3<f64>| {
        instants.iter().fold(Vector3::zeros(), add)
    };
    let mean = total(|sum, at| sum + at.sum) / samples;
    let squares = total(|sum, at| sum + at.squares);
    let largest = total(|most, at| most.sup(&at.largest));
    let days: Vec<f64> = times.iter().map(|t| t / SECONDS_PER_DAY).collect();
    let slope = |axis: usize| {
        let means: Vec<f64> = instants
            .iter()
            .map(|at| at.sum[axis] / satellites)
            .collect();
        line_fit(&days, &means).map_or(0.0, |(_, slope)| slope)
    };
    Ok(BudgetLine {
        case: case.to_owned(),
        cause: cause.to_owned(),
        rms_km: Ric::from_vector((squares / samples).map(f64::sqrt)),
        max_km: Ric::from_vector(largest),
        mean_km: Ric::from_vector(mean),
        growth_km_per_day: Ric {
            radial: slope(0),
            in_track: slope(1),
            cross_track: slope(2),
        },
        worst: worst(first, &instants),
        distance: distances(case, first, &instants),
    })
}

fn worst(first: &Ephemeris, instants: &[InstantSums]) -> Worst {
    let (mut distance_km, mut satellite, mut elapsed_s) = (-1.0, 0, 0.0);
    for at in instants {
        if at.worst.0 > distance_km {
            (distance_km, satellite) = at.worst;
            elapsed_s = at.elapsed_s;
        }
    }
    Worst {
        satellite: first.satellites()[satellite].name.clone(),
        elapsed_s,
        distance_km,
    }
}

fn distances(case: &str, first: &Ephemeris, instants: &[InstantSums]) -> Option<Distribution> {
    let total = instants.len() * first.satellites().len();
    let stride = total.div_ceil(KEPT).max(1);
    let kept = instants.iter().step_by(stride);
    let residuals: Vec<_> = kept
        .flat_map(|at| {
            let distances = at.distances.iter().enumerate();
            distances.map(|(n, &value)| Residual {
                value,
                input: (n, at.elapsed_s),
            })
        })
        .collect();
    let describe =
        |&(n, elapsed_s): &(usize, f64)| format!("{} at {elapsed_s} s", first.satellites()[n].name);
    Distribution::of(case, ["distance", "km"], &residuals, describe)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Shell;
    use crate::ephemeris::EphemerisSatellite;
    use crate::orbit::Model;
    use crate::orbit::j2::{SecularOrbit, SecularRates};
    use crate::time::{Epoch, TimeGrid};

    fn grid() -> TimeGrid {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        TimeGrid::new(epoch, SECONDS_PER_DAY, 600.0).unwrap()
    }

    /// Lines of two shells, pooled, are the line of all their satellites.
    #[test]
    fn pooled_lines_are_those_of_all_satellites() {
        let propagate = |text: &str, model: Model| {
            let design = text.parse().unwrap();
            Ephemeris::of_design(&design, model, grid()).unwrap()
        };
        let shells = ["delta:55:6/3/1@925", "star:87:10/5/1@1200"];
        let pair = |text: &str| [Model::J2, Model::J2Osculating].map(|m| propagate(text, m));
        let lines = shells.map(|text| {
            let [first, second] = pair(text);
            compare("case", "cause", &first, &second).unwrap()
        });
        let pooled = BudgetLine::pooled(&[(6, &lines[0]), (10, &lines[1])]).unwrap();
        let ([a, b], [c, d]) = (pair(shells[0]), pair(shells[1]));
        let all = compare("case", "cause", &a.joined(c), &b.joined(d)).unwrap();
        let rics = [
            (&pooled.rms_km, &all.rms_km),
            (&pooled.max_km, &all.max_km),
            (&pooled.mean_km, &all.mean_km),
            (&pooled.growth_km_per_day, &all.growth_km_per_day),
        ];
        for (ours, whole) in rics {
            // Rounding of sums in another order, on kilometres.
            assert!(
                (ours.vector() - whole.vector()).norm() < 1e-9,
                "{ours:?} {whole:?}"
            );
        }
        assert_eq!(pooled.worst.distance_km, all.worst.distance_km);
    }

    /// A mean motion that is off by δ drifts by a δ t: growth, maximum and RMS are those of a ramp.
    #[test]
    fn validate_a_known_drift() {
        let shell: Shell = "delta:55:6/3/1@925".parse().unwrap();
        let drift_km_per_day = 2.0;
        let propagate = |extra_rad_s: f64| {
            let satellites = shell.satellites().into_iter().map(|satellite| {
                let mut rates = SecularRates::j2(&satellite.elements);
                rates.mean_anomaly_rad_s += extra_rad_s;
                EphemerisSatellite {
                    name: satellite.slot.to_string(),
                    slot: Some(satellite.slot),
                    propagator: Box::new(SecularOrbit::new(&satellite.elements, rates)),
                }
            });
            Ephemeris::new(grid(), satellites.collect())
        };
        let extra = drift_km_per_day / SECONDS_PER_DAY / (crate::earth::RADIUS_KM + 925.0);
        let line = compare("a/b", "ramp", &propagate(0.0), &propagate(extra)).unwrap();
        // The chord is shorter than the arc by 2³/(24 a²) = 6e-9 km.
        assert!((line.growth_km_per_day.in_track - drift_km_per_day).abs() < 1e-6);
        let last_day = 143.0 / 144.0;
        assert!((line.max_km.in_track - drift_km_per_day * last_day).abs() < 1e-6);
        // RMS of a ramp of 144 samples: sqrt(Σ k²/n) with Σ_{k<n} k² = (n-1) n (2n-1) / 6
        let rms = drift_km_per_day / 144.0 * (143.0_f64 * 287.0 / 6.0).sqrt();
        assert!((line.rms_km.in_track - rms).abs() < 1e-6);
        // r × v is tilted from the plane normal by Ω' sin i / n = 6e-4 rad because the plane itself rotates.
        assert!(line.max_km.cross_track < 2.0 * 1e-3);
        assert_eq!(line.worst.elapsed_s, 85_800.0);
    }
}
