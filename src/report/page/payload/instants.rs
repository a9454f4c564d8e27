//! Maps at single instants, of the constellations that a reader looks at first.

use super::Payload;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Evaluator;
use crate::report::page::Page;
use crate::report::page::pack::Packed;
use serde::Serialize;

/// Most bytes of a page for maps at instants.
const INSTANTS_BYTES: usize = 250_000;

/// Most instants that have maps.
const MOST_INSTANTS: usize = 97;

/// Fewest instants that are worth a slider.
const FEWEST_INSTANTS: usize = 6;

/// Most constellations that have them.
const MOST_CONSTELLATIONS: usize = 5;

/// The instants whose maps are in a page, and how many constellations have them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct InstantChoice {
    /// Every so many-th instant.
    stride: usize,
    /// Number of constellations, the first ones.
    pub(super) constellations: usize,
}

impl InstantChoice {
    /// As many instants as there is room for, at even steps; fewer constellations have them where there would be too few.
    /// `None` if a page has no room for any.
    pub(super) fn new(instants: usize, points: usize, constellations: usize) -> Option<Self> {
        // Two maps of two bytes a point, in base64.
        let each = (2 * 2 * points * 4).div_ceil(3).max(1);
        let fewest = FEWEST_INSTANTS.min(instants).max(1);
        let counts = (1..=constellations.min(MOST_CONSTELLATIONS)).rev();
        counts.into_iter().find_map(|constellations| {
            let most = (INSTANTS_BYTES / (each * constellations)).min(MOST_INSTANTS);
            (instants > 0 && most >= fewest).then(|| Self {
                stride: instants.div_ceil(most),
                constellations,
            })
        })
    }

    fn has(&self, number: usize) -> bool {
        number.is_multiple_of(self.stride)
    }

    /// The instants, seconds from the epoch.
    pub(super) fn elapsed_s(&self, evaluator: &Evaluator) -> Vec<f64> {
        let all = evaluator.setup().grid.iter();
        all.step_by(self.stride).collect()
    }
}

/// What every point has at the instants, instant by instant.
#[derive(Serialize)]
pub(super) struct InstantMaps {
    /// LEO satellites in view.
    visible: Packed,
    pdop: Packed,
}

impl InstantMaps {
    /// `None` if a satellite cannot be propagated.
    pub(super) fn new(
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        choice: &InstantChoice,
    ) -> Option<Self> {
        let samples = evaluator
            .samples_at(ephemeris, |number| choice.has(number))
            .ok()?;
        Some(Self {
            visible: Packed::of(samples.visible.into_iter().map(f64::from)),
            pdop: Packed::new(samples.pdop.into_iter().map(|pdop| pdop.map(f64::from))),
        })
    }
}

impl Payload {
    /// The page with maps at instants: of the chosen member, or else the first that has cuts, and of compared constellations.
    pub(super) fn with_instants(mut self, page: &Page<'_>) -> Self {
        let Some(evaluator) = page.evaluator else {
            return self;
        };
        let setup = evaluator.setup();
        let chosen = self.chosen.filter(|place| self.cuts.contains_key(place));
        let member = chosen.or(self.cuts.keys().next().copied());
        let compared = self.baselines.iter().filter(|one| one.cuts.is_some());
        let count = usize::from(member.is_some()) + compared.count();
        let choice = InstantChoice::new(setup.grid.len(), setup.sites.len(), count);
        let Some(choice) = choice else {
            return self;
        };
        let mut left = choice.constellations;
        if let Some(place) = member {
            let constellation = page.run.front[place].constellation(page.fixed);
            let ephemeris = constellation.and_then(|one| one.in_service(setup).ok());
            let maps = ephemeris.and_then(|one| InstantMaps::new(evaluator, &one, &choice));
            if let Some(cuts) = self.cuts.get_mut(&place) {
                cuts.instants = maps;
            }
            left -= 1;
        }
        let compared = self.baselines.iter_mut().zip(page.compared);
        let compared = compared.filter_map(|(one, of)| Some((one.cuts.as_mut()?, of)));
        for (cuts, of) in compared.take(left) {
            cuts.instants = InstantMaps::new(evaluator, &of.ephemeris, &choice);
        }
        self.instants_s = choice.elapsed_s(evaluator);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_evenly_spaced_and_fit() {
        // The paper's day by the minute on its 195 points, the fuzzy pick alone: every quarter of an hour.
        let paper = InstantChoice::new(1440, 195, 1).unwrap();
        assert_eq!((paper.stride, paper.constellations), (15, 1));
        assert!(paper.has(0) && paper.has(1425) && !paper.has(1439));
        for (instants, points, constellations) in
            [(1440, 195, 9), (1, 1, 1), (7, 1, 3), (1440, 7000, 4)]
        {
            let choice = InstantChoice::new(instants, points, constellations).unwrap();
            let count = (0..instants).filter(|number| choice.has(*number)).count();
            assert!(
                (FEWEST_INSTANTS.min(instants)..=MOST_INSTANTS).contains(&count),
                "{instants}"
            );
            assert!(choice.constellations <= constellations);
            let bytes = count * choice.constellations * points * 16 / 3;
            assert!(bytes <= INSTANTS_BYTES, "{bytes}");
        }
        assert_eq!(InstantChoice::new(1440, 195, 0), None);
        assert_eq!(InstantChoice::new(0, 195, 1), None);
        assert_eq!(InstantChoice::new(1440, 100_000, 1), None);
    }
}
