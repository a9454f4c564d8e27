//! Every sample by itself.

use super::Instant;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;

/// All samples of an evaluation, instant by instant and in it point by point.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleGrid {
    /// Visible LEO satellites.
    pub visible: Vec<u32>,
    /// Visible GNSS satellites.
    pub gnss_visible: Vec<u32>,
    /// PDOP in single precision; `None` if unsolved.
    pub pdop: Vec<Option<f32>>,
}

impl SampleGrid {
    fn with_capacity(samples: usize) -> Self {
        Self {
            visible: Vec::with_capacity(samples),
            gnss_visible: Vec::with_capacity(samples),
            pdop: Vec::with_capacity(samples),
        }
    }

    fn add(&mut self, instant: &Instant) {
        let points = &instant.points;
        self.visible.extend(points.iter().map(|one| one.visible));
        let gnss = points.iter().map(|one| one.gnss_visible);
        self.gnss_visible.extend(gnss);
        self.pdop.extend(points.iter().map(|one| one.pdop));
    }
}

impl Evaluator {
    /// What every point has in view at every instant, and its PDOP.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn samples(&self, ephemeris: &Ephemeris) -> Result<SampleGrid, EphemerisError> {
        let mut samples = SampleGrid::with_capacity(self.setup().sample_count());
        self.visit(ephemeris, |instant| samples.add(instant))?;
        Ok(samples)
    }

    /// The same at some instants alone, by their numbers in the grid.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn samples_at(
        &self,
        ephemeris: &Ephemeris,
        is_kept: impl Fn(usize) -> bool,
    ) -> Result<SampleGrid, EphemerisError> {
        let mut samples = SampleGrid::with_capacity(0);
        self.visit(ephemeris, |instant| {
            if is_kept(instant.number) {
                samples.add(instant);
            }
        })?;
        Ok(samples)
    }
}

#[cfg(test)]
mod tests {
    use crate::earth::Surface;
    use crate::ephemeris::Ephemeris;
    use crate::evaluate::{Evaluator, testing};
    use crate::ground::Site;
    use crate::time::{Epoch, TimeGrid};

    /// The means of the samples are those of the series.
    #[test]
    fn samples_add_up_to_the_series() {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 7200.0, 600.0).unwrap();
        let site = |latitude| Site::new(Surface::Sphere, latitude, 110.0, 1.0).unwrap();
        let evaluator =
            Evaluator::new(testing::setup(grid, vec![site(5.0), site(40.0)], 7.0)).unwrap();
        let setup = evaluator.setup();
        let design = "delta:55:24/6/1@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let samples = evaluator.samples(&ephemeris).unwrap();
        let series = evaluator.series(&ephemeris).unwrap();
        let points = setup.sites.len();
        assert_eq!(samples.visible.len(), setup.sample_count());
        let some = evaluator
            .samples_at(&ephemeris, |number| number % 5 == 0)
            .unwrap();
        assert_eq!(some.pdop.len(), points * setup.grid.len().div_ceil(5));
        assert_eq!(
            some.pdop[points..2 * points],
            samples.pdop[5 * points..6 * points]
        );
        assert_eq!(
            some.visible[points..2 * points],
            samples.visible[5 * points..6 * points]
        );
        for (number, point) in series.points.iter().enumerate() {
            let own = samples.pdop.iter().skip(number).step_by(points);
            let solved: Vec<f64> = own.flatten().map(|pdop| f64::from(*pdop)).collect();
            let mean = solved.iter().sum::<f64>() / solved.len() as f64;
            assert!((mean - point.mean_pdop.unwrap()).abs() < 1e-9, "{number}");
            let seen = samples.visible.iter().skip(number).step_by(points);
            let seen: f64 = seen.map(|one| f64::from(*one)).sum();
            let mean = seen / setup.grid.len() as f64;
            assert!((mean - point.mean_visible).abs() < 1e-12, "{number}");
        }
    }
}
