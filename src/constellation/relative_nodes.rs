//! How the nodes of a design's shells turn against each other.

use super::{Design, DesignError, Orientation, Pattern, Shell, Slot};
use crate::orbit::j2::SecularRates;
use crate::units::{DAYS_PER_YEAR, SECONDS_PER_DAY};
use thiserror::Error;

/// Shells that turn against each other by less than this stay as they are for all purposes of a design, degrees a year.
const SLOWEST_DEG_PER_YEAR: f64 = 1.0;

/// The nodes of two shells with respect to each other, under secular J2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeNode {
    /// The places of the shells in the design, the lower first.
    pub shells: [usize; 2],
    /// How fast the nodes of the second move to the east of those of the first, degrees a day.
    pub rate_deg_per_day: f64,
    /// After how long they have turned by 360°, days; `None` if by less than a degree a year.
    pub period_days: Option<f64>,
    /// After how long planes stand to planes as before, days: 360° over the least common multiple of the numbers of planes of
    /// delta patterns and lattices.
    pub planes_period_days: Option<f64>,
}

/// Why a design has no relative nodes to go through.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RelativeNodeError {
    /// One shell.
    #[error("{0} has one shell, whose nodes keep their places with respect to each other")]
    OneShell(String),
    /// Two shells that stay as they are.
    #[error(
        "shells {letters} turn against each other by {deg_per_year:.3}° a year, less than a degree: their relative nodes stay as they are"
    )]
    TooSlow {
        /// Their letters.
        letters: String,
        /// The rate, degrees a year.
        deg_per_year: f64,
    },
    /// A node that cannot be.
    #[error(transparent)]
    Design(#[from] DesignError),
}

impl RelativeNode {
    /// The relative nodes of each two shells.
    #[must_use]
    pub fn all_of(design: &Design) -> Vec<Self> {
        let count = design.shells().len();
        let pairs = (0..count).flat_map(|n| (n + 1..count).map(move |m| [n, m]));
        pairs.map(|shells| Self::of(design, shells)).collect()
    }

    fn of(design: &Design, shells: [usize; 2]) -> Self {
        let [one, other] = shells.map(|n| &design.shells()[n]);
        let rate_deg_per_day = node_rate_deg_per_day(other) - node_rate_deg_per_day(one);
        let turns = (rate_deg_per_day * DAYS_PER_YEAR).abs() >= SLOWEST_DEG_PER_YEAR;
        let period_days = turns.then(|| 360.0 / rate_deg_per_day.abs());
        let fold = least_common_multiple(fold(one), fold(other));
        Self {
            shells,
            rate_deg_per_day,
            period_days,
            planes_period_days: period_days.map(|days| days / fold as f64),
        }
    }

    fn deg_per_year(&self) -> f64 {
        (self.rate_deg_per_day * DAYS_PER_YEAR).abs()
    }
}

/// The longest of the periods after which the shells of a design have turned by 360° against each other, days.
///
/// # Errors
/// For one shell, and for shells that turn by less than a degree a year.
pub fn longest_period_days(design: &Design) -> Result<f64, RelativeNodeError> {
    let mut longest: Option<f64> = None;
    for one in RelativeNode::all_of(design) {
        let Some(days) = one.period_days else {
            let letters = one.shells.map(super::shell_letters).join(" and ");
            return Err(RelativeNodeError::TooSlow {
                letters,
                deg_per_year: one.deg_per_year(),
            });
        };
        longest = Some(longest.map_or(days, |longest| longest.max(days)));
    }
    longest.ok_or_else(|| RelativeNodeError::OneShell(design.to_string()))
}

/// The design with its nodes as they stand to each other after some days; those of the first shell, all phases and the
/// Earth stay where they are.
///
/// # Errors
/// If a node has no digits left.
pub fn after_days(design: &Design, days: f64) -> Result<Design, RelativeNodeError> {
    let first = node_rate_deg_per_day(&design.shells()[0]);
    let turned = |shell: &Shell| {
        let orientation = shell.orientation();
        let ahead_deg = (node_rate_deg_per_day(shell) - first) * days;
        shell.with_orientation(Orientation {
            raan_deg: orientation.raan_deg + ahead_deg,
            ..orientation
        })
    };
    let shells: Result<_, DesignError> = design.shells().iter().map(turned).collect();
    Ok(Design::new(shells?)?)
}

fn node_rate_deg_per_day(shell: &Shell) -> f64 {
    let rates = SecularRates::j2(&shell.elements(Slot::FIRST));
    rates.raan_rad_s.to_degrees() * SECONDS_PER_DAY
}

/// Turns of the nodes, as parts of a whole one, that put planes in the places of planes.
fn fold(shell: &Shell) -> u64 {
    match (shell.pattern(), shell.orientation().node_step_deg) {
        (Pattern::Delta | Pattern::Lattice, None) => shell.planes() as u64,
        _ => 1,
    }
}

fn least_common_multiple(a: u64, b: u64) -> u64 {
    let (mut high, mut low) = (a, b);
    while low > 0 {
        (high, low) = (low, high % low);
    }
    a / high * b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(text: &str) -> Design {
        text.parse().unwrap()
    }

    /// -3/2 J2 (R/a)² n cos i for 53° at 1100 km, by hand; a polar node stands still.
    #[test]
    fn validate_the_period_of_a_hybrid() {
        let hybrid = design("delta:53:160/10/1@1100+star:90:40/5/1@1100");
        let [found] = RelativeNode::all_of(&hybrid)[..] else {
            panic!();
        };
        assert!((found.rate_deg_per_day - 3.436).abs() < 5e-4, "{found:?}");
        let period_days = found.period_days.unwrap();
        assert!((period_days - 104.8).abs() < 0.05, "{found:?}");
        assert_eq!(found.planes_period_days, Some(period_days / 10.0));
        let both = design("delta:53:160/10/1@1100+delta:90:60/4/1@1100");
        let found = RelativeNode::all_of(&both)[0];
        assert_eq!(found.planes_period_days, Some(period_days / 20.0));
    }

    /// After a period the nodes are where they were; half-way they are opposite.
    #[test]
    fn nodes_turn_once_in_a_period() {
        let hybrid = design("delta:53:160/10/1@1100,raan=10+star:90:40/5/1@1100,raan=20");
        let days = longest_period_days(&hybrid).unwrap();
        for (share, expected) in [(0.0, 20.0), (0.5, 200.0), (0.75, 290.0), (1.0, 20.0)] {
            let turned = after_days(&hybrid, share * days).unwrap();
            let nodes = [0, 1].map(|n: usize| turned.shells()[n].orientation().raan_deg);
            assert_eq!(nodes[0], 10.0);
            assert!((nodes[1] - expected).abs() < 1e-9, "{share}: {nodes:?}");
        }
    }

    #[test]
    fn shells_that_stay_are_refused_with_their_rate() {
        let slow = design("delta:53:160/10/1@1100+delta:53.0001:40/5/1@1100");
        let told = longest_period_days(&slow).unwrap_err().to_string();
        assert!(
            told.starts_with("shells A and B turn against each other by 0.00"),
            "{told}"
        );
        let one = longest_period_days(&design("delta:53:160/10/1@1100"));
        assert!(matches!(one, Err(RelativeNodeError::OneShell(_))));
    }
}
