//! Which member of a run: by a method, by its index or by its name.

use crate::optimize::{Pick, Picked};
use crate::run::FrontMember;
use anyhow::{Result, bail};

/// A member of a front, as `--pick` selects it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum MemberPick {
    /// By a method or an index.
    Pick(Pick),
    /// By its name, in a run of given constellations.
    Name(String),
}

impl std::str::FromStr for MemberPick {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text.parse() {
            Ok(pick) => Self::Pick(pick),
            Err(_) => Self::Name(text.to_owned()),
        })
    }
}

impl MemberPick {
    /// The member, and why.
    ///
    /// # Errors
    /// If there is no such member.
    pub(crate) fn apply(&self, front: &[FrontMember]) -> Result<Picked> {
        match self {
            Self::Pick(pick) => {
                let points: Vec<Vec<f64>> = front.iter().map(FrontMember::minimised).collect();
                match pick.apply(&points) {
                    Some(picked) => Ok(picked),
                    None => bail!(
                        "cannot pick {}: the front has {} designs",
                        pick.keyword(),
                        front.len()
                    ),
                }
            }
            Self::Name(name) => {
                let is_it = |member: &FrontMember| member.name.as_ref() == Some(name);
                let Some(place) = front.iter().position(is_it) else {
                    bail!("cannot pick {name}: expected {}", expected(front));
                };
                let reason = "the constellation with this name".to_owned();
                Ok(Picked { place, reason })
            }
        }
    }
}

/// What can be picked from a front.
fn expected(front: &[FrontMember]) -> String {
    let names: Vec<&str> = front
        .iter()
        .filter_map(|member| member.name.as_deref())
        .collect();
    let names = match names.as_slice() {
        [] => String::new(),
        names => format!("; or a name: {}", names.join(", ")),
    };
    format!("fuzzy, sum, topsis, knee, or the index of a front member from 1{names}")
}
