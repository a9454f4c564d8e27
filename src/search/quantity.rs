//! The quantities that a search can optimise or bound, by name.

use super::counted::{CountedSatellites, NewSatellites};
use crate::constellation::separation::least_separation_km;
use crate::constellation::{Design, Shell};
use crate::evaluate::{Gain, Metrics};
use crate::keyword::{Keyword, keywords};

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
        /// Satellites that are not fixed; minimised.
        NewSatellites = "new-satellites",
        /// Planes that are not fixed; minimised.
        NewPlanes = "new-planes",
        /// Mean visible LEO satellites; maximised.
        MeanVisible = "mean-visible",
        /// Fraction of samples whose PDOP is at most the availability threshold; maximised.
        Availability = "availability",
        /// Least number of visible LEO satellites in any sample; maximised.
        LeastVisible = "least-visible",
        /// Mean visible satellites, LEO and GNSS; maximised.
        MeanTotalVisible = "mean-total-visible",
        /// Longest outage of any point, seconds; minimised.
        LongestOutageS = "longest-outage-s",
        /// 95 % quantile of HDOP; dimensionless, minimised.
        P95Hdop = "p95-hdop",
        /// 95 % quantile of VDOP; dimensionless, minimised.
        P95Vdop = "p95-vdop",
        /// Fraction of samples with at least 1 visible LEO satellite; maximised.
        Coverage1 = "coverage-1",
        /// Fraction of samples with at least 2 visible LEO satellites; maximised.
        Coverage2 = "coverage-2",
        /// Fraction of samples with at least 3 visible LEO satellites; maximised.
        Coverage3 = "coverage-3",
        /// Fraction of samples with at least 4 visible LEO satellites; maximised.
        Coverage4 = "coverage-4",
        /// Fraction of samples with at least 5 visible LEO satellites; maximised.
        Coverage5 = "coverage-5",
        /// Fraction of samples with at least 6 visible LEO satellites; maximised.
        Coverage6 = "coverage-6",
        /// Fraction of samples with at least 7 visible LEO satellites; maximised.
        Coverage7 = "coverage-7",
        /// Fraction of samples with at least 8 visible LEO satellites; maximised.
        Coverage8 = "coverage-8",
        /// Fraction of samples with at least 9 visible LEO satellites; maximised.
        Coverage9 = "coverage-9",
        /// Fraction of samples with at least 10 visible LEO satellites; maximised.
        Coverage10 = "coverage-10",
        /// Fraction of samples with at least 11 visible LEO satellites; maximised.
        Coverage11 = "coverage-11",
        /// Fraction of samples with at least 12 visible LEO satellites; maximised.
        Coverage12 = "coverage-12",
        /// Fraction of samples with at least 1 visible satellite, LEO and GNSS; maximised.
        CoverageTotal1 = "coverage-total-1",
        /// Fraction of samples with at least 2 visible satellites, LEO and GNSS; maximised.
        CoverageTotal2 = "coverage-total-2",
        /// Fraction of samples with at least 3 visible satellites, LEO and GNSS; maximised.
        CoverageTotal3 = "coverage-total-3",
        /// Fraction of samples with at least 4 visible satellites, LEO and GNSS; maximised.
        CoverageTotal4 = "coverage-total-4",
        /// Fraction of samples with at least 5 visible satellites, LEO and GNSS; maximised.
        CoverageTotal5 = "coverage-total-5",
        /// Fraction of samples with at least 6 visible satellites, LEO and GNSS; maximised.
        CoverageTotal6 = "coverage-total-6",
        /// Fraction of samples with at least 7 visible satellites, LEO and GNSS; maximised.
        CoverageTotal7 = "coverage-total-7",
        /// Fraction of samples with at least 8 visible satellites, LEO and GNSS; maximised.
        CoverageTotal8 = "coverage-total-8",
        /// Fraction of samples with at least 9 visible satellites, LEO and GNSS; maximised.
        CoverageTotal9 = "coverage-total-9",
        /// Fraction of samples with at least 10 visible satellites, LEO and GNSS; maximised.
        CoverageTotal10 = "coverage-total-10",
        /// Fraction of samples with at least 11 visible satellites, LEO and GNSS; maximised.
        CoverageTotal11 = "coverage-total-11",
        /// Fraction of samples with at least 12 visible satellites, LEO and GNSS; maximised.
        CoverageTotal12 = "coverage-total-12",
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
        /// Largest maximum PDOP without any one satellite; dimensionless, minimised.
        N1MaxPdop = "n1-max-pdop",
        /// Largest CVaR of PDOP without any one satellite; dimensionless, minimised.
        N1CvarPdop = "n1-cvar-pdop",
        /// Least availability without any one satellite; maximised.
        N1Availability = "n1-availability",
        /// Availability as expected over failures of the satellites by `[reliability]`; maximised.
        ExpectedAvailability = "expected-availability",
        /// Least distance of any two satellites over all time by mean elements, km; maximised.
        LeastSeparationKm = "least-separation-km",
        /// Cost of launching the satellites that are not fixed, in the unit of its parameters; minimised.
        LaunchCost = "launch-cost",
        /// Gain over the GNSS alone in mean PDOP; dimensionless; maximised.
        GainMeanPdop = "gain-mean-pdop",
        /// Gain over the GNSS alone in CVaR of PDOP; dimensionless; maximised.
        GainCvarPdop = "gain-cvar-pdop",
        /// Gain over the GNSS alone in 95 % quantile of PDOP; dimensionless; maximised.
        GainP95Pdop = "gain-p95-pdop",
        /// Gain over the GNSS alone in 99 % quantile of PDOP; dimensionless; maximised.
        GainP99Pdop = "gain-p99-pdop",
        /// Gain over the GNSS alone in maximum PDOP; dimensionless; maximised.
        GainMaxPdop = "gain-max-pdop",
        /// Gain over the GNSS alone in 95 % quantile of HDOP; dimensionless; maximised.
        GainP95Hdop = "gain-p95-hdop",
        /// Gain over the GNSS alone in 95 % quantile of VDOP; dimensionless; maximised.
        GainP95Vdop = "gain-p95-vdop",
        /// Gain over the GNSS alone in longest outage of any point, seconds; maximised.
        GainLongestOutageS = "gain-longest-outage-s",
        /// Gain over the GNSS alone in mean PDOP of a window; dimensionless; maximised.
        GainInformationPdop = "gain-information-pdop",
        /// Gain over the GNSS alone in mean standard deviation of the position, metres; maximised.
        GainSigma3dM = "gain-sigma-3d-m",
        /// Gain over the GNSS alone in mean standard deviation of the horizontal position, metres; maximised.
        GainSigmaHM = "gain-sigma-h-m",
        /// Gain over the GNSS alone in mean standard deviation of the height, metres; maximised.
        GainSigmaVM = "gain-sigma-v-m",
        /// Gain over the GNSS alone in 95 % error of the position, metres; maximised.
        GainError953dM = "gain-error95-3d-m",
        /// Gain over the GNSS alone in 95 % error of the horizontal position, metres; maximised.
        GainError95HM = "gain-error95-h-m",
        /// Gain over the GNSS alone in 95 % error of the height, metres; maximised.
        GainError95VM = "gain-error95-v-m",
    }
}

/// Parameters of the launch cost Σ c_T T (1 + c_h h/1000 km) + c_P P over the shells ([M-32](crate::models#m-32)),
/// in a currency or unit of the user's choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaunchCost {
    /// c_T, cost of launching one satellite to zero altitude.
    pub per_satellite: f64,
    /// c_P, cost of opening one plane.
    pub per_plane: f64,
    /// c_h, fraction by which a satellite costs more for each 1000 km of altitude.
    pub per_1000_km: f64,
}

impl LaunchCost {
    /// The cost of launching a shell.
    fn of_shell(&self, shell: &Shell) -> f64 {
        let lift = 1.0 + self.per_1000_km * shell.altitude_km() / 1000.0;
        let satellites = self.per_satellite * shell.satellite_count() as f64 * lift;
        satellites + self.per_plane * shell.planes() as f64
    }
}

impl Quantity {
    /// Whether larger is better.
    #[must_use]
    pub fn is_maximised(self) -> bool {
        self.coverage_levels().is_some()
            || self.gain_in().is_some()
            || matches!(
                self,
                Self::MeanVisible
                    | Self::Availability
                    | Self::LeastVisible
                    | Self::MeanTotalVisible
                    | Self::N1Availability
                    | Self::ExpectedAvailability
                    | Self::LeastSeparationKm
            )
    }

    /// Whether it is a fraction of the samples, from 0 to 1.
    #[must_use]
    pub fn is_fraction(self) -> bool {
        self == Self::Availability || self.coverage_levels().is_some()
    }

    /// For a coverage: the number of satellites, and whether they are of LEO and GNSS.
    #[must_use]
    pub fn coverage_levels(self) -> Option<(usize, bool)> {
        let level = self.keyword().strip_prefix("coverage-")?;
        let (level, is_total) = match level.strip_prefix("total-") {
            Some(level) => (level, true),
            None => (level, false),
        };
        Some((level.parse().ok()?, is_total))
    }

    /// For a gain over the GNSS alone: the quantity that gains.
    #[must_use]
    pub fn gain_in(self) -> Option<Self> {
        let name = self.keyword().strip_prefix("gain-")?;
        Self::from_keyword(name).ok()
    }

    /// The quantity that the samples of this one are of: that which gains, for a gain.
    fn of_samples(self) -> Self {
        self.gain_in().unwrap_or(self)
    }

    /// Whether it is an accuracy in metres, which needs range errors.
    #[must_use]
    pub fn is_in_metres(self) -> bool {
        matches!(
            self.of_samples(),
            Self::Sigma3dM
                | Self::SigmaHM
                | Self::SigmaVM
                | Self::Error953dM
                | Self::Error95HM
                | Self::Error95VM
        )
    }

    /// Whether it is the worst without any one satellite.
    #[must_use]
    pub fn is_of_one_lost(self) -> bool {
        matches!(
            self,
            Self::N1MaxPdop | Self::N1CvarPdop | Self::N1Availability
        )
    }

    /// Whether it is of windows, which need a length.
    #[must_use]
    pub fn is_of_windows(self) -> bool {
        self.of_samples() == Self::InformationPdop
    }

    /// Whether it is a quantile of HDOP or VDOP, which take several times as long as PDOP.
    #[must_use]
    pub fn is_of_dops(self) -> bool {
        matches!(self.of_samples(), Self::P95Hdop | Self::P95Vdop)
    }

    /// Whether it is computed only where the scenario has what it needs: range errors, windows, or a GNSS to gain over.
    #[must_use]
    pub fn is_on_demand(self) -> bool {
        self.is_in_metres() || self.is_of_windows() || self.gain_in().is_some()
    }

    /// Fraction of its samples that are solved: of the windows for a statistic over windows, those that have an accuracy for
    /// metres, else of points and instants.
    #[must_use]
    pub fn solved_fraction(self, metrics: &Metrics) -> f64 {
        let of_window = metrics.information_pdop.map(|of| of.solved_fraction);
        let of_failures = metrics.n1.map(|of| of.solved_fraction);
        let own = match self.of_samples() {
            Self::InformationPdop => of_window,
            one if one.is_of_one_lost() => of_failures,
            one if one.is_in_metres() => metrics.accuracy_solved_fraction,
            _ => None,
        };
        own.unwrap_or(metrics.solved_fraction)
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
        match self.of_samples() {
            Self::JPos | Self::MeanPdop | Self::CvarPdop | Self::MaxPdop => Some(1.0),
            Self::N1MaxPdop | Self::N1CvarPdop => Some(1.0),
            Self::InformationPdop | Self::Sigma3dM | Self::SigmaHM | Self::SigmaVM => Some(1.0),
            Self::P95Pdop | Self::P95Hdop | Self::P95Vdop => Some(0.95),
            Self::Error953dM | Self::Error95HM | Self::Error95VM => Some(0.95),
            Self::P99Pdop => Some(0.99),
            _ => None,
        }
    }

    /// The value as an optimiser minimises it; applying it twice gives the value back.
    #[must_use]
    pub fn minimised(self, value: f64) -> f64 {
        if self.is_maximised() { -value } else { value }
    }

    /// Whether satellites from files have none, those that are fixed apart: their planes are not known.
    #[must_use]
    pub fn needs_planes(self) -> bool {
        matches!(
            self,
            Self::Planes | Self::NewPlanes | Self::LaunchCost | Self::LeastSeparationKm
        )
    }

    /// The value for the satellites of a constellation, of which some are new; `None` if there is none, as for PDOP
    /// without solved samples, and for planes where files have satellites that are not fixed.
    pub(super) fn value(
        self,
        satellites: CountedSatellites<'_>,
        new: &NewSatellites<'_>,
        metrics: &Metrics,
        cost: &LaunchCost,
    ) -> Option<f64> {
        if self.is_of_shells() {
            return self.of_shells(satellites, new, cost);
        }
        self.of_metrics(metrics)
    }

    /// The value of a quantity that the metrics alone have; `None` for others too, such as planes.
    #[must_use]
    pub fn of_metrics(self, metrics: &Metrics) -> Option<f64> {
        match self {
            Self::JPos => metrics.j_pos,
            Self::JCost => metrics.j_cost,
            Self::MeanPdop => metrics.mean_pdop,
            Self::CvarPdop => metrics.cvar_pdop,
            Self::P95Pdop => metrics.p95_pdop,
            Self::P99Pdop => metrics.p99_pdop,
            Self::MaxPdop => metrics.max_pdop,
            Self::MeanVisible => Some(metrics.mean_visible),
            Self::Availability => Some(metrics.availability),
            Self::LeastVisible => Some(metrics.least_visible.into()),
            Self::MeanTotalVisible => Some(metrics.mean_total_visible),
            Self::LongestOutageS => Some(metrics.longest_outage_s),
            Self::P95Hdop => metrics.p95_hdop,
            Self::P95Vdop => metrics.p95_vdop,
            Self::InformationPdop => metrics.information_pdop?.mean,
            Self::N1MaxPdop => metrics.n1?.max_pdop,
            Self::N1CvarPdop => metrics.n1?.cvar_pdop?,
            Self::N1Availability => Some(metrics.n1?.availability),
            Self::ExpectedAvailability => metrics.expected_availability,
            Self::Sigma3dM => metrics.sigma_3d_m?.map(|of| of.mean),
            Self::SigmaHM => metrics.sigma_h_m?.map(|of| of.mean),
            Self::SigmaVM => metrics.sigma_v_m?.map(|of| of.mean),
            Self::Error953dM => metrics.error95_3d_m?,
            Self::Error95HM => metrics.error95_h_m?,
            Self::Error95VM => metrics.error95_v_m?,
            gain if gain.gain_in().is_some() => gain.of_gain(metrics.gain.as_ref()?),
            _ => {
                let (satellites, is_total) = self.coverage_levels()?;
                let coverage = if is_total {
                    metrics.coverage_total
                } else {
                    metrics.coverage
                };
                coverage.of(satellites)
            }
        }
    }

    /// The value of a gain.
    fn of_gain(self, gain: &Gain) -> Option<f64> {
        let metric = self.gain_in()?.keyword().replace('-', "_");
        let gains = gain.named();
        gains.into_iter().find(|(name, _)| *name == metric)?.1
    }

    /// Whether it follows from the shells alone, without an evaluation.
    #[must_use]
    pub fn is_of_shells(self) -> bool {
        self.needs_planes() || matches!(self, Self::Satellites | Self::NewSatellites)
    }

    /// The value of a quantity of the shells, as in [`Quantity::value`]; `None` for any other.
    pub(super) fn of_shells(
        self,
        satellites: CountedSatellites<'_>,
        new: &NewSatellites<'_>,
        cost: &LaunchCost,
    ) -> Option<f64> {
        let new_sum = |of: fn(&Shell) -> usize| new.shells.iter().map(|shell| of(shell)).sum();
        let has_planes = satellites.count() > 0 && new.from_files == 0;
        let of_planes = |value: usize| has_planes.then_some(value as f64);
        match self {
            Self::Satellites => Some(satellites.count() as f64),
            Self::Planes => of_planes(satellites.shells.map_or(0, Design::planes)),
            Self::NewSatellites => {
                let of_shells: usize = new_sum(Shell::satellite_count);
                Some((of_shells + new.from_files) as f64)
            }
            Self::NewPlanes => of_planes(new_sum(Shell::planes)),
            Self::LeastSeparationKm => {
                let of_shells = satellites.shells.filter(|_| satellites.from_files == 0);
                least_separation_km(of_shells?)
            }
            // 0 and not -0 for no shell.
            Self::LaunchCost => has_planes.then(|| {
                let costs = new.shells.iter().map(|shell| cost.of_shell(shell));
                costs.fold(0.0, |sum, cost| sum + cost)
            }),
            _ => None,
        }
    }
}
