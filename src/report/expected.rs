//! What is expected over the life of a constellation, for reading.

use super::shown;
use super::{Align, Table};
use crate::evaluate::ExpectedMetrics;
use crate::units::counted;
use serde::Serialize;

/// The metrics as expected over failures, and the spares that they are with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExpectedService {
    /// The metrics.
    #[serde(flatten)]
    pub metrics: ExpectedMetrics,
    /// The spares, if the scenario has any; the metrics are then those of draws.
    #[serde(flatten)]
    pub spares: Option<SpareService>,
}

/// Spares in the orbits of the planes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpareService {
    /// Spares of each plane.
    pub spares_per_plane: u32,
    /// Number of planes.
    pub planes: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Number of vacant slots that is expected of the constellation.
    pub mean_vacancies: f64,
    /// Probability that no slot is vacant.
    pub all_filled: f64,
}

impl ExpectedService {
    /// A table for reading.
    #[must_use]
    pub fn to_text(&self) -> String {
        let of = &self.metrics;
        let mut table = Table::new(&[("", Align::Left), ("", Align::Right)]);
        let rows = [
            ("mean visible", shown::pdop(Some(of.mean_visible))),
            ("coverage, at least 4 LEO", shown::share(of.coverage.of(4))),
            ("mean PDOP", shown::pdop(of.mean_pdop)),
            ("95 % quantile of PDOP", shown::pdop(of.p95_pdop)),
            ("CVaR of PDOP", shown::pdop(of.cvar_pdop)),
            ("solved fraction", shown::share(Some(of.solved_fraction))),
            ("availability", shown::share(Some(of.availability))),
        ];
        for (name, value) in rows {
            table.row([name.to_owned(), value]);
        }
        if let Some(spares) = &self.spares {
            let rows = [
                (
                    "vacant slots, mean",
                    format!("{:.4}", spares.mean_vacancies),
                ),
                (
                    "probability of no vacant slot",
                    shown::share(Some(spares.all_filled)),
                ),
            ];
            for (name, value) in rows {
                table.row([name.to_owned(), value]);
            }
        }
        format!(
            "\nexpected with each satellite up with probability {}{}\n{}",
            crate::units::round_decimal(of.satellite_availability, 5),
            self.how(),
            table.to_text()
        )
    }

    /// The spares and how the states were found.
    fn how(&self) -> String {
        let (Some(spares), Some(draws)) = (&self.spares, &self.metrics.draws) else {
            let neglected = self.metrics.neglected;
            return format!(" (states left out: at most {neglected:.1e} of a sample)");
        };
        format!(
            " and {} in each of {} ({} draws, seed {}; availability within {:.1e}, one standard error)",
            counted(spares.spares_per_plane as usize, "spare"),
            counted(spares.planes, "plane"),
            draws.draws,
            spares.seed,
            draws.availability_standard_error
        )
    }
}
