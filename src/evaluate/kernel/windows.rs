//! The PDOP of windows of time in f64 lanes: the normal matrices of the instants of a window added up.
//!
//! Where a satellite is close to the mask, the sums of the plain path stand for those of the lanes. A window whose verdict
//! rounding could turn is left open.

use super::super::counts::Threshold;
use super::super::window::SlidingSum;
use super::Kernel;
use super::fixed::FixedSample;
use super::instructions::Work;
use super::lanes::LANES;
use super::limits::Limits;
use super::normal::NormalLanes;
use super::sample::{POSITION_STATES, SampleContext};
use super::settle::Settling;
use super::weighting::{SeveralClocks, SineWeights, UnitWeights, Weighting};
use super::workspace::Workspace;
use crate::dop::ObservationWeights;
use crate::ephemeris::{Ephemeris, EphemerisError};

/// The PDOP of a window at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) enum WindowPdop {
    Unsolved,
    Solved(f64),
    /// To be decided by the sums of the plain path.
    Open,
}

impl Kernel {
    /// Passes the windows of so many instants to `see`, one after the other, each with its PDOP at all points.
    pub(in super::super) fn windows(
        &self,
        ephemeris: &Ephemeris,
        count: usize,
        mut see: impl FnMut(&[WindowPdop]),
    ) -> Result<(), EphemerisError> {
        let propagation = &self.propagation(ephemeris);
        let (tiles, systems) = (&self.scene.tiles.tiles, &self.fixed.systems);
        let mut instant = vec![NormalLanes::nothing(); tiles.len()];
        let mut sliding = vec![SlidingSum::default(); tiles.len()];
        let mut verdicts = vec![[WindowPdop::Open; LANES]; tiles.len()];
        let mut points = vec![WindowPdop::Open; self.setup.sites.len()];
        let samples = 0..self.setup.grid.len();
        self.run(propagation, samples, self.scene.limits, |evaluating| {
            let clocks = self.scene.limits.clocks + evaluating.work.clock_count() - 1;
            self.instructions.run(SumInstant {
                scene: &self.scene,
                fixed: evaluating.fixed,
                work: evaluating.work,
                to: &mut instant,
            });
            let settling = Settling::new(
                &self.setup,
                &self.scene,
                evaluating.instant,
                evaluating.fixed,
            );
            for undecided in &evaluating.outcome.doubts {
                let geometry = settling.geometry(ephemeris, systems, undecided)?;
                instant[undecided.tile].set(undecided.lane, &geometry);
            }
            let span = WindowSpan {
                limits: Limits {
                    // The only threshold of a window is the cap.
                    available: Threshold(self.scene.limits.cap),
                    ..self.scene.limits
                },
                count,
                clocks: (clocks as usize).saturating_mul(count) as u32,
            };
            let is_whole = self.instructions.run(Slide {
                span,
                instant: &instant,
                sliding: &mut sliding,
                to: &mut verdicts,
            });
            if is_whole {
                for (tile, verdicts) in tiles.iter().zip(&verdicts) {
                    for (&site, &verdict) in tile.members.iter().zip(verdicts) {
                        points[site as usize] = verdict;
                    }
                }
                see(&points);
            }
            Ok(())
        })?;
        Ok(())
    }
}

/// The normal matrices of one instant, after its evaluation.
struct SumInstant<'a> {
    scene: &'a SampleContext,
    fixed: FixedSample<'a>,
    work: &'a mut Workspace,
    to: &'a mut [NormalLanes<f64>],
}

impl Work for SumInstant<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match (self.scene.weights, self.work.has_several_clocks()) {
            (ObservationWeights::Unit, false) => self.sum::<UnitWeights>(),
            (ObservationWeights::SineElevation, false) => self.sum::<SineWeights>(),
            (ObservationWeights::Unit, true) => self.sum::<SeveralClocks<UnitWeights>>(),
            (ObservationWeights::SineElevation, true) => self.sum::<SeveralClocks<SineWeights>>(),
        }
    }
}

impl SumInstant<'_> {
    #[inline(always)]
    fn sum<W: Weighting>(self) {
        for group in &self.scene.tiles.groups {
            self.work.select(self.scene, group);
            for number in group.tiles.clone() {
                let candidates = self.work.candidates(number, group);
                let place = (number, &self.work.positions);
                let fixed = self.fixed.tile(number);
                self.to[number] = candidates.double_normal::<W>(self.scene, place, &fixed);
            }
        }
    }
}

/// What decides about windows.
#[derive(Clone, Copy)]
struct WindowSpan {
    limits: Limits,
    /// Instants of a window.
    count: usize,
    /// Maximum number of clock states of all of them.
    clocks: u32,
}

impl WindowSpan {
    /// The verdicts on a window at the points of a tile.
    #[inline(always)]
    fn verdicts(&self, sum: &NormalLanes<f64>) -> [WindowPdop; LANES] {
        let pdop = sum.pdop_of_sum(self.clocks, self.count);
        let mut verdicts = [WindowPdop::Open; LANES];
        for (l, verdict) in verdicts.iter_mut().enumerate() {
            let (pdop, surplus) = (pdop.0[l], sum.surplus.0[l]);
            let satellites = surplus.saturating_add(self.clocks);
            if surplus < POSITION_STATES {
                *verdict = WindowPdop::Unsolved;
            } else if pdop < f64::INFINITY && self.limits.decides(pdop, satellites) {
                *verdict = if pdop <= self.limits.cap {
                    WindowPdop::Solved(pdop)
                } else {
                    WindowPdop::Unsolved
                };
            }
        }
        verdicts
    }
}

/// Moves the windows on by an instant; its output is whether they are whole.
struct Slide<'a> {
    span: WindowSpan,
    instant: &'a [NormalLanes<f64>],
    sliding: &'a mut [SlidingSum<NormalLanes<f64>>],
    to: &'a mut [[WindowPdop; LANES]],
}

impl Work for Slide<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let mut is_whole = false;
        let tiles = self.instant.iter().zip(self.sliding).zip(self.to);
        for ((instant, sliding), to) in tiles {
            if let Some(sum) = sliding.push(instant.clone(), self.span.count) {
                *to = self.span.verdicts(&sum);
                is_whole = true;
            }
        }
        is_whole
    }
}
