//! The effect of a trajectory difference on visibility decisions, passes and metrics.

use super::distribution::{Distribution, Residual};
use super::{Check, CheckedQuantity, Findings};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::{Evaluator, Metrics};
use crate::frames::{EarthFixed, EarthRotation, Position};
use crate::ground::Site;
use crate::units::wrap_pi;
use rayon::prelude::*;

/// Number of sites at which passes are timed; more would not change the result noticeably.
const PASS_SITES: usize = 6;

/// Maximum number of satellites whose passes are timed.
const PASS_SATELLITES: usize = 60;

/// The reason given if there is no bound.
const UNBOUNDED: &str = "reported only: effect of the state difference on the result";

/// Two propagations of the same satellites, seen from the points of a study.
pub(super) struct TrajectoryPair<'a> {
    pub(super) evaluator: &'a Evaluator,
    pub(super) first: &'a Ephemeris,
    pub(super) second: &'a Ephemeris,
}

/// Number of decisions, and of those that flip.
#[derive(Debug, Clone, Copy, Default)]
struct FlipCounts {
    decisions: u64,
    flips: u64,
}

impl TrajectoryPair<'_> {
    /// Compares decisions, passes and metrics. `name` is the beginning of the names of the checks, and
    /// `flip_gate` bounds the fraction of decisions that flip. Metrics have no gate: a bound derived from
    /// the flips is tens of times their actual change, as flips of opposite sign cancel.
    pub(super) fn compare(
        &self,
        name: &str,
        flip_gate: Option<f64>,
    ) -> Result<Findings, EphemerisError> {
        let counts = self.count()?;
        let flips = counts.flips as f64 / counts.decisions.max(1) as f64;
        let mut findings = Findings::default();
        findings.checks.push(Check::new(
            &format!("{name}/flipped-decisions"),
            CheckedQuantity {
                quantity: "visibility decisions that flip",
                unit: "1",
                statistic: "share",
            },
            flips,
            flip_gate,
            flip_gate.map_or(UNBOUNDED, |_| "area swept by the displaced footprint edge, times three because satellites crowd near their highest latitude"),
        ));
        let metrics = [
            self.evaluator.evaluate_ephemeris(self.first)?,
            self.evaluator.evaluate_ephemeris(self.second)?,
        ];
        findings.checks.extend(metric_checks(name, &metrics));
        self.passes(name, &mut findings)?;
        Ok(findings)
    }

    fn rotation(&self, elapsed_s: f64) -> EarthRotation {
        let epoch = self.evaluator.setup().grid.epoch();
        EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s))
    }

    fn count(&self) -> Result<FlipCounts, EphemerisError> {
        let setup = self.evaluator.setup();
        let times: Vec<f64> = setup.grid.iter().collect();
        let one = |&elapsed_s: &f64| {
            let rotation = self.rotation(elapsed_s);
            let mut counts = FlipCounts::default();
            let pairs = self.first.satellites().iter().zip(self.second.satellites());
            for (a, b) in pairs {
                let a = rotation.to_earth_fixed(self.first.state(a, elapsed_s)?.position_km);
                let b = rotation.to_earth_fixed(self.second.state(b, elapsed_s)?.position_km);
                for site in &setup.sites {
                    let seen = |target| site.line_of_sight(setup.mask, target).is_some();
                    counts.flips += u64::from(seen(a) != seen(b));
                }
                counts.decisions += setup.sites.len() as u64;
            }
            Ok(counts)
        };
        let instants: Vec<FlipCounts> = times.par_iter().map(one).collect::<Result<_, _>>()?;
        Ok(instants
            .iter()
            .fold(FlipCounts::default(), |sum, at| FlipCounts {
                decisions: sum.decisions + at.decisions,
                flips: sum.flips + at.flips,
            }))
    }

    /// Whether satellites have states between the samples too, as those of a table do not.
    fn is_continuous(&self) -> Result<bool, EphemerisError> {
        let between_s = 0.5 * self.first.grid().step_s();
        for ephemeris in [self.first, self.second] {
            for satellite in ephemeris.satellites() {
                if ephemeris.state_or_gap(satellite, between_s)?.is_none() {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Shifts of rise and set and of the duration of passes.
    fn passes(&self, name: &str, findings: &mut Findings) -> Result<(), EphemerisError> {
        if !self.is_continuous()? {
            let note = format!("{name}: passes are not timed, for lack of states between samples");
            findings.notes.push(note);
            return Ok(());
        }
        let sites = thinned(&self.evaluator.setup().sites, PASS_SITES);
        let pairs: Vec<(&EphemerisSatellite, &EphemerisSatellite)> = self
            .first
            .satellites()
            .iter()
            .zip(self.second.satellites())
            .collect();
        let pairs = thinned(&pairs, PASS_SATELLITES);
        let shifts: Vec<Vec<Shift>> = pairs
            .par_iter()
            .map(|(a, b)| self.pass_shifts(&sites, a, b))
            .collect::<Result<_, _>>()?;
        let shifts: Vec<Shift> = shifts.into_iter().flatten().collect();
        let kinds: [(&str, &str, ShiftMeasure); 3] = [
            ("rise", "shift of the rise time", |shift| shift.rise_s),
            ("set", "shift of the set time", |shift| shift.set_s),
            ("duration", "change in pass duration", |shift| {
                shift.set_s - shift.rise_s
            }),
        ];
        for (kind, quantity, value) in kinds {
            let residuals: Vec<_> = shifts
                .iter()
                .map(|shift| Residual {
                    value: value(shift),
                    input: shift,
                })
                .collect();
            findings.distributions.extend(Distribution::of(
                &format!("{name}/{kind}"),
                [quantity, "s"],
                &residuals,
                |shift| shift.to_string(),
            ));
        }
        Ok(())
    }

    fn pass_shifts(
        &self,
        sites: &[Site],
        a: &EphemerisSatellite,
        b: &EphemerisSatellite,
    ) -> Result<Vec<Shift>, EphemerisError> {
        let mut shifts = Vec::new();
        let propagations = [
            SampledSatellite::new(self, self.first, a)?,
            SampledSatellite::new(self, self.second, b)?,
        ];
        for site in sites {
            let [first, second] = [propagations[0].passes(site)?, propagations[1].passes(site)?];
            for pass in &first {
                // Two passes count as the same if one is in progress at the middle of the other.
                let middle = 0.5 * (pass.0 + pass.1);
                let Some(other) = second.iter().find(|p| p.0 <= middle && middle <= p.1) else {
                    continue;
                };
                shifts.push(Shift {
                    satellite: a.name.clone(),
                    latitude_deg: site.latitude_deg,
                    longitude_deg: site.longitude_deg,
                    at_s: pass.0,
                    rise_s: other.0 - pass.0,
                    set_s: other.1 - pass.1,
                });
            }
        }
        Ok(shifts)
    }
}

/// At most `most` of `all`, evenly spaced and including both ends.
fn thinned<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    if all.len() <= most {
        return all.to_vec();
    }
    let place = |k: usize| k * (all.len() - 1) / (most - 1).max(1);
    (0..most).map(|k| all[place(k)].clone()).collect()
}

/// The quantity taken from a shift.
type ShiftMeasure = fn(&Shift) -> f64;

/// How a pass moved.
struct Shift {
    satellite: String,
    latitude_deg: f64,
    longitude_deg: f64,
    at_s: f64,
    rise_s: f64,
    set_s: f64,
}

impl std::fmt::Display for Shift {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "{} seen from {}, {} deg at {:.0} s",
            self.satellite, self.latitude_deg, self.longitude_deg, self.at_s
        )
    }
}

/// One satellite along one ephemeris, Earth-fixed.
struct SampledSatellite<'a> {
    seen: &'a TrajectoryPair<'a>,
    ephemeris: &'a Ephemeris,
    satellite: &'a EphemerisSatellite,
    sampled_km: Vec<Position<EarthFixed>>,
}

impl<'a> SampledSatellite<'a> {
    fn new(
        seen: &'a TrajectoryPair<'a>,
        ephemeris: &'a Ephemeris,
        satellite: &'a EphemerisSatellite,
    ) -> Result<Self, EphemerisError> {
        let mut propagation = Self {
            seen,
            ephemeris,
            satellite,
            sampled_km: Vec::new(),
        };
        let grid = seen.evaluator.setup().grid;
        propagation.sampled_km = grid
            .iter()
            .map(|elapsed_s| propagation.position_km(elapsed_s))
            .collect::<Result<_, _>>()?;
        Ok(propagation)
    }

    fn position_km(&self, elapsed_s: f64) -> Result<Position<EarthFixed>, EphemerisError> {
        let state = self.ephemeris.state(self.satellite, elapsed_s)?;
        Ok(self
            .seen
            .rotation(elapsed_s)
            .to_earth_fixed(state.position_km))
    }

    /// Sine of the elevation minus that of the mask.
    fn height(&self, site: &Site, target_km: Position<EarthFixed>) -> f64 {
        let line = target_km - site.local.origin_km;
        let mask_rad = self.seen.evaluator.setup().mask.degrees().to_radians();
        site.local.up.dot(&line) / line.norm() - mask_rad.sin()
    }

    /// Rise and set of the complete passes over a site, s.
    fn passes(&self, site: &Site) -> Result<Vec<(f64, f64)>, EphemerisError> {
        let grid = self.seen.evaluator.setup().grid;
        let heights: Vec<f64> = self
            .sampled_km
            .iter()
            .map(|&target| self.height(site, target))
            .collect();
        let mut passes = Vec::new();
        let mut rise = None;
        for k in 1..heights.len() {
            let [before, after] = [heights[k - 1], heights[k]];
            if (before < 0.0) == (after < 0.0) {
                continue;
            }
            let crossing = self.crossing_s(site, grid.elapsed_s(k - 1), grid.elapsed_s(k))?;
            if before < 0.0 {
                rise = Some(crossing);
            } else if let Some(rise) = rise.take() {
                passes.push((rise, crossing));
            }
        }
        Ok(passes)
    }

    /// The instant between two at which the satellite crosses the mask, by bisection to 1 ms.
    fn crossing_s(&self, site: &Site, low_s: f64, high_s: f64) -> Result<f64, EphemerisError> {
        let (mut low, mut high) = (low_s, high_s);
        let below = self.height(site, self.position_km(low)?) < 0.0;
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            if (self.height(site, self.position_km(middle)?) < 0.0) == below {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }
}

fn metric_checks(name: &str, [first, second]: &[Metrics; 2]) -> Vec<Check> {
    let metrics = [
        (
            "mean-visible",
            Some(first.mean_visible),
            Some(second.mean_visible),
        ),
        ("mean-pdop", first.mean_pdop, second.mean_pdop),
        ("cvar-pdop", first.cvar_pdop, second.cvar_pdop),
        ("max-pdop", first.max_pdop, second.max_pdop),
    ];
    let change = |(quantity, before, after): (&str, Option<f64>, Option<f64>)| {
        let measure = CheckedQuantity {
            quantity: &format!("change in {quantity}"),
            unit: "1",
            statistic: "difference",
        };
        let name = format!("{name}/{quantity}");
        Some(Check::new(
            &name,
            measure,
            after? - before?,
            None,
            UNBOUNDED,
        ))
    };
    metrics.into_iter().filter_map(change).collect()
}

/// Fraction of decisions that flip when satellites are displaced by `radial_km` and `along_km` (RMS).
///
/// The footprint has the half-angle ψ = acos(R cos ε/a) - ε; its edge moves by dψ/da per km of
/// radius and 1/a per km across it; a strip of width w covers w sin ψ/2 of the sphere.
pub(super) fn flip_gate(
    semi_major_axis_km: f64,
    mask_deg: f64,
    radial_km: f64,
    along_km: f64,
) -> f64 {
    let radius = crate::earth::RADIUS_KM;
    let (sin_mask, cos_mask) = mask_deg.to_radians().sin_cos();
    let reach = radius * cos_mask / semi_major_axis_km;
    let half_angle = wrap_pi(reach.acos() - sin_mask.atan2(cos_mask));
    let per_km = reach / (semi_major_axis_km * (1.0 - reach * reach).sqrt());
    let strip = (per_km * radial_km).hypot(along_km / semi_major_axis_km);
    3.0 * 0.5 * half_angle.sin() * strip
}
