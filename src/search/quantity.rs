//! The quantities that a search can optimise or bound, by name.

use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::keyword::keywords;

keywords! {
    /// A quantity of a design.
    Quantity {
        /// Mean PDOP + λ CVaR; dimensionless, minimised (equation 8 of the paper).
        JPos = "j-pos",
        /// Satellites / mean visible; dimensionless, minimised (equation 9).
        JCost = "j-cost",
        /// Mean PDOP; dimensionless, minimised.
        MeanPdop = "mean-pdop",
        /// CVaR of PDOP; dimensionless, minimised.
        CvarPdop = "cvar-pdop",
        /// 95 % quantile of PDOP; dimensionless, minimised.
        P95Pdop = "p95-pdop",
        /// 99 % quantile of PDOP; dimensionless, minimised.
        P99Pdop = "p99-pdop",
        /// Maximum PDOP; dimensionless, minimised.
        MaxPdop = "max-pdop",
        /// Satellites T; minimised.
        Satellites = "satellites",
        /// Planes P; minimised.
        Planes = "planes",
        /// Mean visible LEO satellites; maximised.
        MeanVisible = "mean-visible",
        /// Fraction of samples whose PDOP is at most the availability threshold; maximised.
        Availability = "availability",
        /// Mean PDOP of all observations in a window of `metrics.window-min`; dimensionless, minimised.
        InformationPdop = "information-pdop",
        /// Mean standard deviation of the position, metres; minimised.
        Sigma3dM = "sigma-3d-m",
        /// Mean standard deviation of the horizontal position (DRMS), metres; minimised.
        SigmaHM = "sigma-h-m",
        /// Mean standard deviation of the height, metres; minimised.
        SigmaVM = "sigma-v-m",
        /// 95 % error of the position, metres; minimised.
        Error953dM = "error95-3d-m",
        /// 95 % error of the horizontal position, metres; minimised.
        Error95HM = "error95-h-m",
        /// 95 % error of the height, metres; minimised.
        Error95VM = "error95-v-m",
        /// Cost of launching the satellites, in the unit of its parameters; minimised.
        LaunchCost = "launch-cost",
    }
}

/// Parameters of the launch cost c_T T (1 + c_h h/1000 km) + c_P P ([M-32](crate::models#m-32)), in
/// a currency or unit of the user's choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaunchCost {
    /// c_T, cost of launching one satellite to zero altitude.
    pub per_satellite: f64,
    /// c_P, cost of opening one plane.
    pub per_plane: f64,
    /// c_h, fraction by which a satellite costs more for each 1000 km of altitude.
    pub per_1000_km: f64,
}

impl Quantity {
    /// Whether larger is better.
    #[must_use]
    pub fn is_maximised(self) -> bool {
        matches!(self, Self::MeanVisible | Self::Availability)
    }

    /// Whether it is an accuracy in metres, which needs range errors.
    #[must_use]
    pub fn is_in_metres(self) -> bool {
        matches!(
            self,
            Self::Sigma3dM
                | Self::SigmaHM
                | Self::SigmaVM
                | Self::Error953dM
                | Self::Error95HM
                | Self::Error95VM
        )
    }

    /// Whether it is computed only where the scenario asks for it.
    #[must_use]
    pub fn is_on_demand(self) -> bool {
        self.is_in_metres() || self == Self::InformationPdop
    }

    /// Fraction of its samples that are solved: of the windows for a statistic over windows, else of points and
    /// instants.
    #[must_use]
    pub fn solved_fraction(self, metrics: &Metrics) -> f64 {
        match (self, metrics.information_pdop) {
            (Self::InformationPdop, Some(of)) => of.solved_fraction,
            _ => metrics.solved_fraction,
        }
    }

    /// The default coordinate of the hypervolume's reference point.
    #[must_use]
    pub fn default_reference(self) -> Option<f64> {
        match self {
            Self::JPos => Some(2.0),
            Self::JCost => Some(22.0),
            _ => None,
        }
    }

    /// The fraction of unsolved samples if, counted as infinite, they make the quantity infinite;
    /// otherwise 0. Ignoring them would make a statistic of the solved samples look better.
    #[must_use]
    pub fn unsolved_share(self, solved_fraction: f64) -> f64 {
        /// Rounding error of a fraction that is a sum of weights.
        const ROUNDING: f64 = 1e-12;
        match self.solved_share_needed() {
            Some(needed) if solved_fraction < needed - ROUNDING => 1.0 - solved_fraction,
            _ => 0.0,
        }
    }

    /// Fraction of the samples that must be solved: all for a mean, a tail or a maximum, q for
    /// a quantile of level q. `None` for a quantity that is not a statistic of the solved samples.
    fn solved_share_needed(self) -> Option<f64> {
        match self {
            Self::JPos | Self::MeanPdop | Self::CvarPdop | Self::MaxPdop => Some(1.0),
            Self::InformationPdop | Self::Sigma3dM | Self::SigmaHM | Self::SigmaVM => Some(1.0),
            Self::P95Pdop | Self::Error953dM | Self::Error95HM | Self::Error95VM => Some(0.95),
            Self::P99Pdop => Some(0.99),
            Self::JCost
            | Self::Satellites
            | Self::Planes
            | Self::MeanVisible
            | Self::Availability
            | Self::LaunchCost => None,
        }
    }

    /// The value as an optimiser minimises it; applying it twice gives the value back.
    #[must_use]
    pub fn minimised(self, value: f64) -> f64 {
        if self.is_maximised() { -value } else { value }
    }

    /// The value of a design; `None` if there is none, as for PDOP without solved samples.
    #[must_use]
    pub fn value(self, design: &Design, metrics: &Metrics, cost: &LaunchCost) -> Option<f64> {
        self.value_of(design.satellite_count(), Some(design), metrics, cost)
    }

    /// Whether only the satellites of a design have it: others are in no planes.
    #[must_use]
    pub fn needs_design(self) -> bool {
        matches!(self, Self::Planes | Self::LaunchCost)
    }

    /// The value of any satellites, which are those of a design if there is one; `None` if there is none.
    #[must_use]
    pub fn value_of(
        self,
        satellites: usize,
        design: Option<&Design>,
        metrics: &Metrics,
        cost: &LaunchCost,
    ) -> Option<f64> {
        let satellites = satellites as f64;
        match self {
            Self::JPos => metrics.j_pos,
            Self::JCost => metrics.j_cost,
            Self::MeanPdop => metrics.mean_pdop,
            Self::CvarPdop => metrics.cvar_pdop,
            Self::P95Pdop => metrics.p95_pdop,
            Self::P99Pdop => metrics.p99_pdop,
            Self::MaxPdop => metrics.max_pdop,
            Self::Satellites => Some(satellites),
            Self::Planes => Some(design?.planes() as f64),
            Self::MeanVisible => Some(metrics.mean_visible),
            Self::Availability => Some(metrics.availability),
            Self::InformationPdop => metrics.information_pdop?.mean,
            Self::Sigma3dM => metrics.sigma_3d_m?.map(|of| of.mean),
            Self::SigmaHM => metrics.sigma_h_m?.map(|of| of.mean),
            Self::SigmaVM => metrics.sigma_v_m?.map(|of| of.mean),
            Self::Error953dM => metrics.error95_3d_m?,
            Self::Error95HM => metrics.error95_h_m?,
            Self::Error95VM => metrics.error95_v_m?,
            Self::LaunchCost => {
                let design = design?;
                let lift = 1.0 + cost.per_1000_km * design.highest_altitude_km() / 1000.0;
                Some(
                    cost.per_satellite * satellites * lift
                        + cost.per_plane * design.planes() as f64,
                )
            }
        }
    }
}
