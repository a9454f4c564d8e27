//! The worst at each point without any one of the satellites.

use super::sight::SightTree;
use super::{Sets, pass};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;

/// The worst at a point without any one of the satellites.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointOneLost {
    /// Largest PDOP at any instant; `None` if some loss leaves an instant unsolved.
    pub max_pdop: Option<f64>,
    /// Least fraction of the instants that are available.
    pub availability: f64,
}

impl Evaluator {
    /// The worst at each point without any one of the satellites.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn one_lost_by_point(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Vec<PointOneLost>, EphemerisError> {
        let setup = self.setup();
        let sites = setup.sites.len();
        let available_up_to = setup.metrics.availability_pdop;
        let mut largest = vec![0.0_f64; sites];
        let mut available = vec![0_u32; sites];
        let mut most_lost = vec![0_u32; sites];
        let places = 0..ephemeris.satellites().len();
        let singles: Vec<Vec<usize>> = places.map(|place| vec![place]).collect();
        let tree = SightTree::new(setup);
        for (number, batch) in self.batches(ephemeris, &singles)?.into_iter().enumerate() {
            let pieces = pass::pass(self, &tree, &Sets::new(self, ephemeris, batch))?;
            let whole = pieces.iter().flat_map(|piece| &piece.whole);
            for one in whole.filter(|_| number == 0) {
                let site = one.site as usize;
                largest[site] = largest[site].max(one.pdop);
                available[site] += u32::from(one.pdop <= available_up_to);
            }
            for set in 0..batch.len() {
                let mut lost = vec![0_u32; sites];
                for piece in &pieces {
                    for one in &piece.changed[set] {
                        let before = &piece.whole[(one.sample - piece.first) as usize];
                        let site = before.site as usize;
                        largest[site] = largest[site].max(one.pdop);
                        let is_lost = before.pdop <= available_up_to && one.pdop > available_up_to;
                        lost[site] += u32::from(is_lost);
                    }
                }
                for (most, lost) in most_lost.iter_mut().zip(lost) {
                    *most = (*most).max(lost);
                }
            }
        }
        let instants = setup.grid.len() as f64;
        let of_site = |site: usize| PointOneLost {
            max_pdop: Some(largest[site]).filter(|pdop| pdop.is_finite()),
            availability: f64::from(available[site].saturating_sub(most_lost[site])) / instants,
        };
        Ok((0..sites).map(of_site).collect())
    }
}
