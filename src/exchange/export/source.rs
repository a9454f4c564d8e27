//! The data from which the products of an export are made.

use super::{Choices, ExportSubject};
use crate::constellation::Satellite;
use crate::earth::RADIUS_KM;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::exchange::manifest::{Conventions, FileEntry, Loss, Manifest};
use crate::formats::metadata::{ElementChoice, Metadata, Object, Theory, distance_from_itrf};
use crate::formats::text::timestamp::TimeSystem;
use crate::formats::{WriteError, element_set, tle};
use crate::frames::Frame;
use crate::orbit::PropagatorDistance;
use crate::orbit::fit::{Fit, fit};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::orbit::{PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};

/// The data of an export.
pub(super) struct ExportSource<'a> {
    pub(super) subject: &'a ExportSubject,
    pub(super) choices: Choices,
    pub(super) satellites: Vec<Satellite>,
    pub(super) objects: Vec<Object>,
    pub(super) ephemeris: Ephemeris,
}

impl<'a> ExportSource<'a> {
    pub(super) fn new(subject: &'a ExportSubject, choices: Choices) -> Result<Self, WriteError> {
        let ephemeris = Ephemeris::of_design(&subject.design, subject.model, subject.grid)?;
        Ok(Self {
            subject,
            choices,
            satellites: subject.design.satellites(),
            objects: Object::all(ephemeris.satellites(), subject.grid.epoch())?,
            ephemeris,
        })
    }

    pub(super) fn metadata(&self, frame: Frame, theory: Theory) -> Metadata {
        let study = &self.subject.study;
        Metadata {
            originator: self.subject.originator.clone(),
            creation: self.subject.creation,
            frame,
            time_system: TimeSystem::Utc,
            theory,
            subject: vec![
                format!("Design: {}", self.subject.design),
                format!("Scenario: {}, hash {}", study.name, study.hash),
            ],
            frame_note: (frame == Frame::EarthFixed).then(|| self.distance_from_itrf()),
        }
    }

    /// The distance of the design's satellites from their positions in an ITRF.
    fn distance_from_itrf(&self) -> String {
        let radius_km = RADIUS_KM + self.subject.design.highest_altitude_km();
        distance_from_itrf(self.subject.grid.epoch(), radius_km)
    }

    /// The unrounded element sets at an epoch, with their satellites.
    pub(super) fn element_sets(&self, epoch: Epoch) -> Result<Vec<sgp4::Elements>, WriteError> {
        let since_s = epoch.seconds_since(self.subject.grid.epoch());
        let slot = match self.choices.elements {
            ElementChoice::Kepler => MeanMotionSlot::Kepler,
            ElementChoice::Kozai | ElementChoice::Fit => MeanMotionSlot::Kozai,
        };
        let set = |(satellite, object): (&Satellite, &Object)| {
            let elements = SecularOrbit::j2(&satellite.elements).elements_at(since_s);
            element_set(&elements, object, epoch, slot)
        };
        let sets = self.satellites.iter().zip(&self.objects).map(set);
        if self.choices.elements != ElementChoice::Fit {
            return Ok(sets.collect());
        }
        let fitted = |(set, propagated): (sgp4::Elements, &EphemerisSatellite)| {
            Ok(self.fit(&set, propagated)?.set)
        };
        sets.zip(self.ephemeris.satellites()).map(fitted).collect()
    }

    /// A set fitted to at most 200 samples of the trajectory.
    fn fit(
        &self,
        start: &sgp4::Elements,
        propagated: &EphemerisSatellite,
    ) -> Result<Fit, EphemerisError> {
        let grid = self.subject.grid;
        let stride = grid.len().div_ceil(200);
        let mut positions = Vec::new();
        for k in (0..grid.len()).step_by(stride) {
            let elapsed_s = grid.elapsed_s(k);
            let state = self.ephemeris.state(propagated, elapsed_s)?;
            positions.push((elapsed_s, state.position_km));
        }
        fit(start, &positions, grid.epoch()).map_err(|source| failed(propagated, source))
    }

    /// The sets as rounded in a TLE, and unrounded, at the TLE epoch nearest to that of the study.
    pub(super) fn tle_sets(&self) -> Result<Vec<sgp4::Elements>, WriteError> {
        self.element_sets(tle::rounded_epoch(self.subject.grid.epoch()))
    }

    /// The loss of the sets, sampled about once an hour, for the satellite that loses most: from their
    /// digits in a TLE, and from SGP4 relative to the propagated model.
    pub(super) fn loss_of_sets(
        &self,
        sets: &[sgp4::Elements],
        tle: bool,
    ) -> Result<Loss, WriteError> {
        let grid = self.subject.grid;
        let span_s = grid.elapsed_s(grid.len() - 1) + 1.0;
        let hourly = TimeGrid::new(grid.epoch(), span_s, 3_577.0).unwrap_or(grid);
        let (mut digits, mut theory) =
            (PropagatorDistance::default(), PropagatorDistance::default());
        for (set, propagated) in sets.iter().zip(self.ephemeris.satellites()) {
            let of_set = |set: &sgp4::Elements| {
                Sgp4Orbit::from_element_set(set, grid.epoch()).map_err(|e| failed(propagated, e))
            };
            let exact = of_set(set)?;
            theory.widen(&self.apart(
                propagated,
                &exact,
                propagated.propagator.as_ref(),
                hourly,
            )?);
            if tle {
                let rounded = of_set(&tle::as_written(set)?)?;
                digits.widen(&self.apart(propagated, &exact, &rounded, hourly)?);
            }
        }
        Ok(Loss {
            quantisation_max_km: tle.then_some(digits.max_km),
            quantisation_rms_km: tle.then_some(digits.rms_km),
            theory_max_km: Some(theory.max_km),
            theory_rms_km: Some(theory.rms_km),
            ..Loss::default()
        })
    }

    fn apart(
        &self,
        propagated: &EphemerisSatellite,
        one: &dyn Propagator,
        other: &dyn Propagator,
        grid: TimeGrid,
    ) -> Result<PropagatorDistance, EphemerisError> {
        PropagatorDistance::between(one, other, grid).map_err(|source| failed(propagated, source))
    }

    pub(super) fn manifest(&self, files: Vec<FileEntry>) -> Manifest {
        let ExportSubject { grid, study, .. } = self.subject;
        Manifest {
            program: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: study.clone(),
            design: self.subject.design.to_string(),
            epoch: grid.epoch().to_string(),
            step_s: grid.step_s(),
            samples: grid.len(),
            conventions: Conventions::new(self.distance_from_itrf()),
            files,
        }
    }
}

pub(super) fn failed(satellite: &EphemerisSatellite, source: PropagationError) -> EphemerisError {
    EphemerisError {
        name: satellite.name.clone(),
        source,
    }
}
