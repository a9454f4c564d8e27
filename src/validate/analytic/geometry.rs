//! Visibility and PDOP of the study recomputed from angles and full matrices.

use crate::constellation::gnss::System;
use crate::dop::{Clocks, ObservationWeights};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Setup};
use crate::frames::EarthRotation;
use crate::ground::Site;
use crate::time::TimeGrid;
use crate::validate::{Check, CheckedQuantity, Subject, ValidateError};
use crate::visibility::Mask;
use nalgebra::{DMatrix, Vector3};

/// Instants that are recomputed.
const INSTANTS: usize = 12;

/// Points that are recomputed.
const POINTS: usize = 40;

/// The smallest singular value of a geometry with a PDOP of 1e7, ten times the largest cap; rounding
/// turns a zero into 1e-15.
const LEAST_SINGULAR_VALUE: f64 = 1e-7;

/// A study over some instants and points of another, with its systems propagated.
struct Again {
    setup: Setup,
    gnss: Vec<Ephemeris>,
}

impl Again {
    fn new(subject: &Subject<'_>) -> Option<Self> {
        let full = subject.setup();
        let span_s = full.grid.len() as f64 * full.grid.step_s();
        // A step that divides neither the day nor the period.
        let step_s = span_s / (INSTANTS as f64 - 0.37);
        let grid = TimeGrid::new(full.grid.epoch(), span_s, step_s).ok()?;
        let stride = full.sites.len().div_ceil(POINTS);
        let sites = full.sites.iter().step_by(stride);
        let setup = Setup {
            grid,
            sites: sites
                .map(|site| Site {
                    weight: 1.0,
                    ..site.clone()
                })
                .collect(),
            ..full.clone()
        };
        let propagate = |system: &System| Ephemeris::of_gnss(system.satellites(grid.epoch()), grid);
        let gnss = setup.gnss.iter().map(propagate).collect();
        Some(Self { setup, gnss })
    }

    /// Lines of sight of the visible satellites, by the angle between line and vertical.
    fn lines(
        &self,
        site: &Site,
        mask: Mask,
        ephemeris: &Ephemeris,
        elapsed_s: f64,
        gmst_rad: f64,
    ) -> Result<Vec<Vector3<f64>>, EphemerisError> {
        let rotation = EarthRotation::from_gmst(gmst_rad);
        let mut lines = Vec::new();
        for satellite in ephemeris.satellites() {
            let state = ephemeris.state(satellite, elapsed_s)?;
            let line = rotation.to_earth_fixed(state.position_km) - site.local.origin_km;
            let zenith_deg = line.angle(&site.local.up).to_degrees();
            let mut skyline = site.skyline.iter();
            let clears = skyline.all(|skyline| skyline.clears(&site.local, line.normalize()));
            if 90.0 - zenith_deg >= mask.degrees() && clears {
                lines.push(line.normalize());
            }
        }
        Ok(lines)
    }

    /// PDOP from the singular values of the full geometry matrix, none of which may be mere rounding;
    /// `groups` are the lines of sight of each clock.
    fn pdop(&self, groups: &[Vec<Vector3<f64>>]) -> Option<f64> {
        let groups: Vec<_> = groups.iter().filter(|group| !group.is_empty()).collect();
        let rows: usize = groups.iter().map(|group| group.len()).sum();
        let states = 3 + groups.len();
        if rows < states {
            return None;
        }
        let mut design = DMatrix::zeros(rows, states);
        let lines = groups
            .iter()
            .enumerate()
            .flat_map(|(clock, group)| group.iter().map(move |line| (clock, line)));
        for (row, (clock, line)) in lines.enumerate() {
            for axis in 0..3 {
                design[(row, axis)] = line[axis];
            }
            design[(row, 3 + clock)] = 1.0;
        }
        let svd = design.svd(false, true);
        let smallest = svd.singular_values.min();
        if smallest <= LEAST_SINGULAR_VALUE {
            return None;
        }
        // The inverse of the normal matrix is V S⁻² Vᵀ
        let right = svd.v_t?;
        let variance = |state: usize| -> f64 {
            let column = right.column(state);
            let terms = column.iter().zip(svd.singular_values.iter());
            terms.map(|(v, s)| (v / s).powi(2)).sum()
        };
        let pdop = (0..3).map(variance).sum::<f64>().sqrt();
        (pdop <= self.setup.pdop_cap).then_some(pdop)
    }
}

/// N̄, mean and maximum PDOP of the parts of a study by definition and by the evaluator.
pub(super) fn checks(subject: &Subject<'_>) -> Result<Vec<Check>, ValidateError> {
    let Some(again) = Again::new(subject) else {
        return Ok(Vec::new());
    };
    let full = subject.propagate_model()?;
    let setup = &again.setup;
    let (mut visible, mut sum, mut solved, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
    for elapsed_s in setup.grid.iter() {
        let gmst_rad = (subject.parts.gmst_rad)(setup.grid.epoch(), elapsed_s);
        for site in &setup.sites {
            let leo = again.lines(site, setup.mask, &full, elapsed_s, gmst_rad)?;
            visible += leo.len() as f64;
            let mut groups = vec![leo];
            for system in &again.gnss {
                let lines = again.lines(site, setup.gnss_mask, system, elapsed_s, gmst_rad)?;
                match setup.clocks {
                    Clocks::PerSystem => groups.push(lines),
                    Clocks::Shared => groups[0].extend(lines),
                }
            }
            if let Some(pdop) = again.pdop(&groups) {
                sum += pdop;
                solved += 1.0;
                largest = largest.max(pdop);
            }
        }
    }
    let solved_for = Setup {
        clocks: (subject.parts.clocks)(setup.clocks),
        ..setup.clone()
    };
    let propagated = subject.propagate_model()?.into_satellites();
    let metrics = (subject.parts.evaluate)(
        &Evaluator::new(solved_for)?,
        &Ephemeris::new(setup.grid, propagated),
    )?;
    let samples = setup.sample_count() as f64;
    let unit_weights = setup.observation_weights == ObservationWeights::Unit;
    let reason = "the same definitions by another route: angles instead of squared sines, full matrices instead of Schur complements";
    let mut checks = vec![Check::new(
        "analytic/geometry/mean-visible",
        CheckedQuantity {
            quantity: "mean visible over selected samples, from angles",
            unit: "1",
            statistic: "difference",
        },
        metrics.mean_visible - visible / samples,
        // A satellite within rounding of the mask may count on either side.
        Some(1.5 / samples),
        reason,
    )];
    let pdop = [
        // The fast path uses single precision where geometry is good: 1e-7 of a PDOP below 2.
        ("mean-pdop", metrics.mean_pdop, sum / solved, 2e-7),
        // Poor geometry costs both methods digits: the condition number grows as PDOP squared.
        (
            "max-pdop",
            metrics.max_pdop,
            largest,
            1e-12 * largest.powi(3) + 1e-6,
        ),
    ];
    for (name, found, expected, gate) in pdop {
        if let Some(found) = found.filter(|_| unit_weights) {
            checks.push(Check::new(
                &format!("analytic/geometry/{name}"),
                CheckedQuantity {
                    quantity: &format!("{name} of selected samples, from full matrices"),
                    unit: "1",
                    statistic: "difference",
                },
                found - expected,
                Some(gate),
                reason,
            ));
        }
    }
    Ok(checks)
}
