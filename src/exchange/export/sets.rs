//! The element sets of an export: made from mean elements, those of a file, or fitted; and what they lose.

use super::source::{ExportSource, failed};
use super::{Choices, Product};
use crate::earth::MU_KM3_S2;
use crate::ephemeris::{EphemerisError, EphemerisSatellite};
use crate::exchange::element_sets::ElementSetRule;
use crate::exchange::manifest::Loss;
use crate::exchange::members::{ConstellationMember, Origin};
use crate::formats::ccsds::opm::Keplerian;
use crate::formats::metadata::{ElementChoice, Object, Theory};
use crate::formats::{WriteError, element_set, tle};
use crate::frames::{Position, Teme};
use crate::keyword::Keyword;
use crate::orbit::fit::fit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::orbit::{MeanElements, PropagatorDistance};
use crate::time::{Epoch, TimeGrid};
use std::f64::consts::TAU;

/// Samples of a trajectory that a fit uses at most.
const FITTED: usize = 200;

/// Revolutions of the first arc of a fit that starts from an osculating state, whose mean motion is off by what
/// J2 does to it; each further arc is so many times longer.
const FIRST_ARC: f64 = 2.0;
const LONGER: f64 = 6.0;

impl ExportSource<'_> {
    /// The theory of a file with the element sets of all satellites.
    pub(super) fn theory_of_sets(&self) -> Theory {
        Theory::of_all(self.members.iter().map(|member| self.theory_of_set(member)))
    }

    pub(super) fn theory_of_set(&self, member: &ConstellationMember<'_>) -> Theory {
        match member.origin {
            Origin::Set(_) => Theory::SourceSets,
            _ => Theory::Sgp4Elements(self.choices.elements),
        }
    }

    /// Refuses a product that cannot express the constellation.
    ///
    /// # Errors
    /// Names the product, what it cannot express, and what to do.
    pub(super) fn require_expressible(&self, product: Product) -> Result<(), WriteError> {
        let names = self.subject.constellation.files.as_ref();
        let names = names.map_or_else(String::new, |files| files.names.join(", "));
        let cannot = |what: String, instead| WriteError::CannotSay {
            product: product.keyword(),
            what,
            instead,
        };
        let any = |is: fn(&Origin<'_>) -> bool| self.members.iter().any(|one| is(&one.origin));
        match product {
            Product::Tle | Product::Omm | Product::TleStates => {
                let Choices { elements, .. } = self.choices;
                if elements == ElementChoice::Kepler && any(|one| matches!(one, Origin::Set(_))) {
                    return Err(cannot(
                        format!(
                            "the element sets of {names} with a Keplerian mean motion: they are written as they are"
                        ),
                        "omit --tle-theory kepler, which is for mean elements of J2",
                    ));
                }
                let without = |one: &Origin<'_>| matches!(one, Origin::Sampled | Origin::Almanac);
                if elements != ElementChoice::Fit && any(without) {
                    return Err(cannot(
                        format!(
                            "the satellites of {names}: their files have no mean elements of SGP4 or J2"
                        ),
                        "use --tle-theory fit, which fits SGP4 to the trajectory, or --as oem, sp3 or stk",
                    ));
                }
            }
            Product::Yuma if self.has_files() => {
                return Err(cannot(
                    format!(
                        "the satellites of {names}: it holds the nominal GNSS of a scenario around a design"
                    ),
                    "use --as sp3, oem or tle for satellites from files",
                ));
            }
            _ => {}
        }
        Ok(())
    }

    fn rule(&self, rounding: fn(Epoch) -> Epoch) -> ElementSetRule {
        ElementSetRule {
            model: self.subject.model,
            epoch: self.subject.grid.epoch(),
            slot: match self.choices.elements {
                ElementChoice::Kepler => MeanMotionSlot::Kepler,
                ElementChoice::Kozai | ElementChoice::Fit => MeanMotionSlot::Kozai,
            },
            rounding,
        }
    }

    /// The element sets at epochs that a format can write, with all digits.
    pub(super) fn element_sets(
        &self,
        rounding: fn(Epoch) -> Epoch,
    ) -> Result<Vec<sgp4::Elements>, WriteError> {
        let rule = self.rule(rounding);
        let satellites = self.satellites().zip(&self.objects);
        let set = |((satellite, member), object): (
            (&EphemerisSatellite, &ConstellationMember<'_>),
            &Object,
        )| {
            let unfitted = rule.set(member, object);
            let fits = self.choices.elements == ElementChoice::Fit;
            Ok(match (unfitted, member.origin) {
                (Some(set), Origin::Set(_)) => set,
                (Some(set), _) if !fits => set,
                (Some(set), _) => self.fit(&set, satellite)?,
                (None, _) => self.fit_to_states(satellite, object, rounding)?,
            })
        };
        satellites.map(set).collect()
    }

    /// A set fitted to samples of the whole trajectory.
    fn fit(
        &self,
        start: &sgp4::Elements,
        satellite: &EphemerisSatellite,
    ) -> Result<sgp4::Elements, EphemerisError> {
        let samples = self.subject.grid.len();
        self.fit_arc(start, satellite, samples)
    }

    /// A set fitted to at most [`FITTED`] of the first samples of the trajectory.
    fn fit_arc(
        &self,
        start: &sgp4::Elements,
        satellite: &EphemerisSatellite,
        samples: usize,
    ) -> Result<sgp4::Elements, EphemerisError> {
        let grid = self.subject.grid;
        let stride = samples.div_ceil(FITTED);
        let mut positions: Vec<(f64, Position<Teme>)> = Vec::new();
        for k in (0..samples).step_by(stride) {
            let elapsed_s = grid.elapsed_s(k);
            let state = self.ephemeris.state(satellite, elapsed_s)?;
            positions.push((elapsed_s, state.position_km));
        }
        let fitted = fit(start, &positions, grid.epoch());
        Ok(fitted.map_err(|source| failed(satellite, source))?.set)
    }

    /// A set fitted to states of which nothing else is known, from the osculating orbit of the first, over
    /// arcs that grow to the whole span.
    fn fit_to_states(
        &self,
        satellite: &EphemerisSatellite,
        object: &Object,
        rounding: fn(Epoch) -> Epoch,
    ) -> Result<sgp4::Elements, WriteError> {
        let grid = self.subject.grid;
        let at = rounding(grid.epoch());
        let elements = self.osculating(satellite)?;
        let synthetic = Object::synthetic(&object.name, object.catalog_number, grid.epoch());
        let object = if tle::holds_designator(&object.id) {
            object
        } else {
            &synthetic
        };
        let mut set = element_set(&elements, object, at, MeanMotionSlot::Kozai);
        let mut arc_s = FIRST_ARC * TAU / elements.kepler_mean_motion_rad_s();
        loop {
            let samples = (arc_s / grid.step_s()).ceil().max(8.0) as usize;
            set = self.fit_arc(&set, satellite, samples.min(grid.len()))?;
            if samples >= grid.len() {
                return Ok(set);
            }
            arc_s *= LONGER;
        }
    }

    /// The osculating elements of a satellite at the epoch of the study.
    fn osculating(&self, satellite: &EphemerisSatellite) -> Result<MeanElements, WriteError> {
        let state = self.ephemeris.state(satellite, 0.0)?;
        let unbound = || WriteError::CannotSay {
            product: "an element set",
            what: format!("the orbit of {}, which is not closed", satellite.name),
            instead: "leave it out with --exclude",
        };
        let found = Keplerian::of_state(&state, MU_KM3_S2).ok_or_else(unbound)?;
        let e = found.eccentricity;
        let (sin, cos) = found.true_anomaly_deg.to_radians().sin_cos();
        let eccentric = ((1.0 - e * e).max(0.0).sqrt() * sin).atan2(e + cos);
        let elements = MeanElements {
            semi_major_axis_km: found.semi_major_axis_km,
            eccentricity: e,
            inclination_rad: found.inclination_deg.to_radians(),
            raan_rad: found.raan_deg.to_radians(),
            arg_perigee_rad: found.arg_perigee_deg.to_radians(),
            mean_anomaly_rad: eccentric - e * eccentric.sin(),
        };
        elements.checked().map_err(|_| unbound())
    }

    /// The sets at epochs that a TLE can write, with all digits.
    pub(super) fn tle_sets(&self) -> Result<Vec<sgp4::Elements>, WriteError> {
        self.element_sets(tle::rounded_epoch)
    }

    /// The loss of the sets, sampled about once an hour, for the satellite that loses most: from their
    /// digits in a TLE, and from SGP4 relative to the trajectory; sets of a file are their trajectory.
    pub(super) fn loss_of_sets(
        &self,
        sets: &[sgp4::Elements],
        tle: bool,
    ) -> Result<Loss, WriteError> {
        let grid = self.subject.grid;
        let span_s = grid.elapsed_s(grid.len() - 1) + 1.0;
        let hourly = TimeGrid::new(grid.epoch(), span_s, 3_577.0).unwrap_or(grid);
        let mut digits = PropagatorDistance::default();
        let mut theory: Option<PropagatorDistance> = None;
        for (set, (satellite, member)) in sets.iter().zip(self.satellites()) {
            let of_set = |set: &sgp4::Elements| {
                Sgp4Orbit::from_element_set(set, grid.epoch()).map_err(|e| failed(satellite, e))
            };
            let apart = |one: &dyn crate::orbit::Propagator,
                         other: &dyn crate::orbit::Propagator| {
                let distance = PropagatorDistance::between(one, other, hourly);
                distance.map_err(|source| failed(satellite, source))
            };
            let exact = of_set(set)?;
            if !matches!(member.origin, Origin::Set(_)) {
                let found = apart(&exact, satellite.propagator.as_ref())?;
                theory.get_or_insert_default().widen(&found);
            }
            if tle {
                digits.widen(&apart(&exact, &of_set(&tle::as_written(set)?)?)?);
            }
        }
        Ok(Loss {
            quantisation_max_km: tle.then_some(digits.max_km),
            quantisation_rms_km: tle.then_some(digits.rms_km),
            theory_max_km: theory.map(|theory| theory.max_km),
            theory_rms_km: theory.map(|theory| theory.rms_km),
            ..Loss::default()
        })
    }
}
