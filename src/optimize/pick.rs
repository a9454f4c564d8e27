//! Which member of a front to take, and why.

use super::decision::{best, fuzzy, knee, topsis};
use thiserror::Error;

/// A method that picks, or the member itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pick {
    /// The fuzzy pick: the best worst-case membership.
    Fuzzy,
    /// The largest normalised sum of memberships.
    Sum,
    /// TOPSIS with equal weights.
    Topsis,
    /// The member that bulges farthest towards the ideal point.
    Knee,
    /// A member by its index, from 1.
    Index(usize),
}

/// A member that was picked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picked {
    /// Its position in the front, from 0.
    pub place: usize,
    /// Why, in words.
    pub reason: String,
}

/// A text that is not a pick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("expected fuzzy, sum, topsis, knee, or the index of a front member from 1")]
pub struct UnknownPick;

impl std::str::FromStr for Pick {
    type Err = UnknownPick;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "fuzzy" => Ok(Self::Fuzzy),
            "sum" => Ok(Self::Sum),
            "topsis" => Ok(Self::Topsis),
            "knee" => Ok(Self::Knee),
            _ => match text.parse() {
                Ok(index) if index > 0 => Ok(Self::Index(index)),
                _ => Err(UnknownPick),
            },
        }
    }
}

impl Pick {
    /// The methods, for tables of their picks.
    pub const METHODS: [Self; 4] = [Self::Fuzzy, Self::Sum, Self::Topsis, Self::Knee];

    /// The keyword of the pick.
    #[must_use]
    pub fn keyword(self) -> String {
        match self {
            Self::Fuzzy => "fuzzy".to_owned(),
            Self::Sum => "sum".to_owned(),
            Self::Topsis => "topsis".to_owned(),
            Self::Knee => "knee".to_owned(),
            Self::Index(index) => index.to_string(),
        }
    }

    /// The meaning of a pick's score.
    fn reason(self) -> &'static str {
        match self {
            Self::Fuzzy => {
                "the fuzzy pick, with the best worst-case membership over the objectives"
            }
            Self::Sum => "the largest normalised sum of memberships over the objectives",
            Self::Topsis => {
                "TOPSIS, equal weights: nearest to the best and farthest from the worst of every objective"
            }
            Self::Knee => "the knee: farthest from the line between the ends of the front",
            Self::Index(_) => "the design with this index",
        }
    }

    /// Picks among members whose objectives are all minimised; `None` if there is no such member or
    /// the members cannot be scored.
    #[must_use]
    pub fn apply(self, members: &[Vec<f64>]) -> Option<Picked> {
        let scores = match self {
            Self::Index(index) => {
                let place = index
                    .checked_sub(1)
                    .filter(|place| *place < members.len())?;
                let reason = self.reason().to_owned();
                return Some(Picked { place, reason });
            }
            Self::Fuzzy => fuzzy(members).map(|memberships| memberships.minimum),
            Self::Sum => fuzzy(members).map(|memberships| memberships.share),
            Self::Topsis => topsis(members, &vec![1.0; members.first().map_or(0, Vec::len)]),
            Self::Knee => knee(members),
        };
        let scores = scores.ok()?;
        let place = best(&scores)?;
        let reason = format!("{} ({:.3})", self.reason(), scores[place]);
        Some(Picked { place, reason })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand on a convex front; TOPSIS divides by the norms, which the other methods do not.
    #[test]
    fn each_method_has_its_own_pick() {
        let front = [
            vec![1.0, 100.0],
            vec![1.2, 60.0],
            vec![2.0, 42.0],
            vec![4.0, 40.0],
        ];
        let place = |pick: Pick| pick.apply(&front).map(|picked| picked.place);
        // Memberships: (1, 0), (0.933, 0.667), (0.667, 0.967), (0, 1); the sums of the middle ones
        // are 1.6 and 1.633.
        assert_eq!(place(Pick::Fuzzy), Some(1));
        assert_eq!(place(Pick::Sum), Some(2));
        assert_eq!(place(Pick::Knee), Some(2));
        // Norms 4.737 and 130.2: closeness 0.807 of the second and 0.744 of the third.
        assert_eq!(place(Pick::Topsis), Some(1));
        assert_eq!(place(Pick::Index(4)), Some(3));
        assert_eq!(place(Pick::Index(5)), None);
        assert_eq!(Pick::Knee.apply(&[]), None);
    }

    #[test]
    fn words_are_read_back() {
        for pick in Pick::METHODS.into_iter().chain([Pick::Index(7)]) {
            assert_eq!(pick.keyword().parse(), Ok(pick));
        }
        assert!("0".parse::<Pick>().is_err() && "best".parse::<Pick>().is_err());
    }
}
