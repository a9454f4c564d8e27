//! Samples that the lanes leave undecided, because a satellite is too close to the mask or the
//! geometry too close to a limit: recomputed by the definitions.

use super::super::fixed::{self, PlainGnssSample, PlainPositions};
use super::super::{Setup, leo, plain};
use super::fixed::{FixedSample, SampleInstant};
use super::normal::{FixedTile, clear_pivot};
use super::sample::{Doubt, POSITION_STATES, SampleContext, SampleOutcome, UNSOLVED, Undecided};
use crate::dop::{Factor, Geometry, ObservationWeights, Symmetric3};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, Position};
use crate::ground::Site;
use nalgebra::Vector3;
use std::cell::OnceCell;

/// The data needed to settle the doubtful samples of one instant.
pub(super) struct Settling<'a> {
    setup: &'a Setup,
    scene: &'a SampleContext,
    instant: SampleInstant,
    fixed: FixedSample<'a>,
    /// The GNSS, if needed.
    gnss: OnceCell<Vec<PlainPositions>>,
}

/// The final result of a sample.
struct Settled {
    visible: u32,
    pdop: Option<f64>,
}

impl<'a> Settling<'a> {
    pub(super) fn new(
        setup: &'a Setup,
        scene: &'a SampleContext,
        instant: SampleInstant,
        fixed: FixedSample<'a>,
    ) -> Self {
        Self {
            setup,
            scene,
            instant,
            fixed,
            gnss: OnceCell::new(),
        }
    }

    /// Settles all doubtful samples of an outcome, which stay listed.
    pub(super) fn settle(
        &self,
        leo: &Ephemeris,
        systems: &[Ephemeris],
        outcome: &mut SampleOutcome,
    ) -> Result<(), EphemerisError> {
        let doubts = std::mem::take(&mut outcome.doubts);
        for undecided in &doubts {
            let Undecided { tile, lane, .. } = *undecided;
            let site = self.site(undecided);
            let clocks = self.candidates(leo, undecided)?;
            let is_unit = self.scene.weights == ObservationWeights::Unit;
            let by_lanes = match (undecided.doubt, clocks.as_slice()) {
                (Doubt::Mask, [positions]) if is_unit => {
                    self.with_gnss_of_lanes(site, positions, undecided)
                }
                (Doubt::Mask | Doubt::Geometry, _) => None,
            };
            let settled = match by_lanes {
                Some(settled) => settled,
                None => self.by_plain_sums(site, &clocks, systems)?,
            };
            let stored = |pdop: f64| self.scene.limits.available.stored(pdop);
            outcome.pdop[tile].0[lane] = settled.pdop.map_or(UNSOLVED, stored);
            outcome.visible[tile].0[lane] = settled.visible;
        }
        outcome.doubts = doubts;
        Ok(())
    }

    /// The positions, by the plain path and clock by clock, of the satellites that a point may see.
    fn candidates(
        &self,
        leo: &Ephemeris,
        undecided: &Undecided,
    ) -> Result<Vec<PlainPositions>, EphemerisError> {
        let mut clocks = leo::no_positions(self.setup, leo);
        for n in undecided.satellites.iter().map(|&n| n as usize) {
            let satellite = &leo.satellites()[n];
            if let Some(state) = leo.state_or_gap(satellite, self.instant.elapsed_s)? {
                let clock = if clocks.len() > 1 { leo.parts()[n] } else { 0 };
                clocks[clock].push(self.instant.rotation.to_earth_fixed(state.position_km));
            }
        }
        Ok(clocks)
    }

    /// The sums of the plain path of an undecided sample.
    pub(super) fn geometry(
        &self,
        leo: &Ephemeris,
        systems: &[Ephemeris],
        undecided: &Undecided,
    ) -> Result<Geometry, EphemerisError> {
        let clocks = self.candidates(leo, undecided)?;
        Ok(self.plain_sums(self.site(undecided), &clocks, systems)?.1)
    }

    fn site(&self, undecided: &Undecided) -> &Site {
        let members = &self.scene.tiles.tiles[undecided.tile].members;
        &self.setup.sites[members[undecided.lane] as usize]
    }

    /// The sample by the plain path, bit for bit.
    fn by_plain_sums(
        &self,
        site: &Site,
        clocks: &[PlainPositions],
        systems: &[Ephemeris],
    ) -> Result<Settled, EphemerisError> {
        let (visible, geometry) = self.plain_sums(site, clocks, systems)?;
        let pdop = geometry.pdop(self.setup.pdop_cap);
        Ok(Settled { visible, pdop })
    }

    fn plain_sums(
        &self,
        site: &Site,
        clocks: &[PlainPositions],
        systems: &[Ephemeris],
    ) -> Result<(u32, Geometry), EphemerisError> {
        let gnss = match self.gnss.get() {
            Some(gnss) => gnss,
            None => {
                let SampleInstant {
                    elapsed_s,
                    rotation,
                    ..
                } = self.instant;
                let made = fixed::positions(systems, elapsed_s, rotation)?;
                self.gnss.get_or_init(|| made)
            }
        };
        let gnss = PlainGnssSample::new(self.setup, site, gnss);
        Ok(plain::geometry(self.setup, site, clocks, &gnss))
    }

    /// The sample with the mask decided by the plain path and the GNSS part from the lanes; `None` if
    /// that leaves open whether it is solved. For unit weights.
    fn with_gnss_of_lanes(
        &self,
        site: &Site,
        positions: &[Position<EarthFixed>],
        undecided: &Undecided,
    ) -> Option<Settled> {
        let limits = &self.scene.limits;
        let fixed = self.fixed.tile(undecided.tile);
        let (mut normal, mut sum, mut in_group) = gnss_part(&fixed, undecided.lane);
        let mut visible = 0;
        for &position in positions {
            if let Some(unit) = site.line_of_sight(self.setup.mask, position) {
                normal += Symmetric3::outer(unit, 1.0);
                sum += unit;
                visible += 1;
            }
        }
        in_group += visible;
        let mut surplus = u32::from(fixed.surplus[undecided.lane]);
        if in_group > 0 {
            normal += Symmetric3::outer(sum, -1.0 / f64::from(in_group));
            surplus += in_group - 1;
        }
        if surplus < POSITION_STATES {
            return Some(Settled {
                visible,
                pdop: None,
            });
        }
        let satellites = surplus + limits.clocks;
        let factor = Factor::new(&normal);
        let pdop = factor.trace_of_inverse().sqrt();
        let decided =
            factor.exceeds(clear_pivot(f64::from(satellites))) && limits.decides(pdop, satellites);
        decided.then(|| Settled {
            visible,
            pdop: (pdop <= limits.cap).then_some(pdop),
        })
    }
}

/// Normal matrix of the GNSS at a point of a tile, and Σ v and the number of satellites that share
/// their clock with the design. The elimination of that clock is undone, since the design shares it.
fn gnss_part(fixed: &FixedTile<'_>, lane: usize) -> (Symmetric3, Vector3<f64>, u32) {
    let elements = std::array::from_fn(|element| fixed.normal::<f64>(element, lane));
    let mut normal = Symmetric3::from(elements);
    let Some(shared) = fixed.shared else {
        return (normal, Vector3::zeros(), 0);
    };
    let count = shared.count.0[lane];
    let mean = Vector3::from_fn(|axis, _| shared.mean::<f64>(axis, lane));
    normal += Symmetric3::outer(mean, f64::from(count));
    (normal, mean * f64::from(count), count)
}
