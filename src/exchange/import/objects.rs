//! The satellites of a fleet: their identities, the joining of their states, and their selection.

use super::Fleet;
use crate::constellation::identity::{ObjectIdentity, unique_labels};
use crate::formats::trajectory::Trajectory;
use crate::keyword::nearest;
use thiserror::Error;

/// The identity of a satellite with states.
pub(super) fn identity(trajectory: &Trajectory) -> ObjectIdentity {
    identity_of(&trajectory.name, &trajectory.id)
}

/// The identity of a satellite with this name and id; an id that differs from its name is valid outside its file.
pub(super) fn identity_of(name: &str, id: &str) -> ObjectIdentity {
    let designator = if id == name { "" } else { id };
    ObjectIdentity::new(0, designator, name)
}

/// Whether the arcs of two satellites overlap by more than an instant.
pub(super) fn overlap(one: &Trajectory, other: &Trajectory) -> bool {
    let mut arcs = one.arcs.iter();
    arcs.any(|arc| other.arcs.iter().any(|next| arc.overlaps(next)))
}

/// Merges arcs into those of the same satellite; at an instant that two share, the earlier arc's state is used.
pub(super) fn join(before: &mut Trajectory, next: Trajectory) {
    let mut arcs = std::mem::take(&mut before.arcs);
    arcs.extend(next.arcs);
    // The sort is stable.
    arcs.sort_by_key(|arc| arc.useable.0);
    for arc in arcs {
        let rest = match before.arcs.last_mut() {
            Some(last) => last.continued_by(arc).err(),
            None => Some(arc),
        };
        before.arcs.extend(rest);
    }
}

impl Fleet {
    /// The identities of the satellites, in order.
    #[must_use]
    pub fn identities(&self) -> Vec<ObjectIdentity> {
        let named = |name: &String| ObjectIdentity::new(0, "", name);
        match self {
            Self::Sets(sets) => sets.iter().map(ObjectIdentity::of_set).collect(),
            Self::Elements(rows) => rows.iter().map(|row| named(&row.name)).collect(),
            Self::Sampled(trajectories) => trajectories.iter().map(identity).collect(),
            Self::Almanacs(almanacs) => almanacs.iter().map(|one| named(&one.name())).collect(),
            Self::Mixed(parts) => parts.iter().flat_map(Self::identities).collect(),
        }
    }

    /// The unique names of the satellites, in order.
    #[must_use]
    pub fn labels(&self) -> Vec<String> {
        unique_labels(&self.identities())
    }

    /// Keeps the satellites that `filter` selects, and says of each whether it is kept.
    ///
    /// # Errors
    /// If a pattern matches none, or no satellite is left.
    pub fn choose(&mut self, filter: &SatelliteFilter) -> Result<Vec<bool>, NoSuchSatellite> {
        filter.keep(&mut [self])
    }

    /// Whether a satellite that `filter` selects lacks states that were not kept: its label selects it, which is known only
    /// with all satellites, or it shares an identity with another. All must then be kept.
    #[must_use]
    pub fn lacks_states(&self, filter: &SatelliteFilter) -> bool {
        if filter.is_empty() {
            return false;
        }
        let identities = self.identities();
        let Ok(kept) = filter.choose(&identities, &unique_labels(&identities)) else {
            return false;
        };
        let lacks =
            |trajectory: &Trajectory| trajectory.arcs.iter().any(|arc| arc.nodes.is_empty());
        let mut each = self.trajectories().into_iter().zip(kept);
        each.any(|(trajectory, kept)| kept && trajectory.is_some_and(lacks))
    }

    fn retain(&mut self, keep: &mut dyn FnMut() -> bool) {
        match self {
            Self::Sets(sets) => sets.retain(|_| keep()),
            Self::Elements(rows) => rows.retain(|_| keep()),
            Self::Sampled(trajectories) => trajectories.retain(|_| keep()),
            Self::Almanacs(almanacs) => almanacs.retain(|_| keep()),
            Self::Mixed(parts) => {
                parts.iter_mut().for_each(|part| part.retain(keep));
                parts.retain(|part| !part.is_empty());
            }
        }
    }
}

/// A selection of satellites by patterns: names, designators or catalogue numbers, in which `*` stands for any characters
/// and `?` for one; case does not matter.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SatelliteFilter {
    /// Patterns of the satellites to keep; none keeps all.
    pub only: Vec<String>,
    /// Patterns of the satellites to exclude.
    pub exclude: Vec<String>,
}

/// An invalid selection.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoSuchSatellite {
    /// A pattern that matches nothing.
    #[error("no satellite matches '{pattern}'{}", did_you_mean(nearest.as_deref()))]
    Pattern {
        /// The pattern.
        pattern: String,
        /// The most similar satellite name.
        nearest: Option<String>,
    },
    /// Nothing is selected.
    #[error("the selection excludes all {0} satellites")]
    Nothing(usize),
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean '{name}'?"))
}

impl SatelliteFilter {
    /// Whether it selects everything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.only.is_empty() && self.exclude.is_empty()
    }

    /// Whether a satellite may be selected by what is known of it alone: by its identity, not its label among others.
    pub(super) fn may_select(&self, identity: &ObjectIdentity) -> bool {
        let texts: Vec<String> = identity.texts().collect();
        let is_met = |pattern: &String| texts.iter().any(|text| matches(pattern, text));
        (self.only.is_empty() || self.only.iter().any(is_met)) && !self.exclude.iter().any(is_met)
    }

    /// Keeps the satellites of several fleets that are selected, and says of each whether it is; each pattern must match in
    /// one of them.
    ///
    /// # Errors
    /// If a pattern matches none, or no satellite is left.
    pub fn keep(&self, fleets: &mut [&mut Fleet]) -> Result<Vec<bool>, NoSuchSatellite> {
        if self.is_empty() {
            let count = fleets.iter().map(|fleet| fleet.len()).sum();
            return Ok(vec![true; count]);
        }
        let identities: Vec<_> = fleets.iter().flat_map(|fleet| fleet.identities()).collect();
        let labels = unique_labels(&identities);
        let kept = self.choose(&identities, &labels)?;
        let mut each = kept.iter();
        for fleet in fleets {
            fleet.retain(&mut || each.next().copied().unwrap_or(false));
        }
        Ok(kept)
    }

    /// Whether each satellite is selected.
    ///
    /// # Errors
    /// If a pattern matches none, or none is left.
    fn choose(
        &self,
        identities: &[ObjectIdentity],
        labels: &[String],
    ) -> Result<Vec<bool>, NoSuchSatellite> {
        let texts = |(identity, label): (&ObjectIdentity, &String)| {
            let mut texts: Vec<String> = identity.texts().collect();
            texts.push(label.clone());
            texts
        };
        let texts: Vec<Vec<String>> = identities.iter().zip(labels).map(texts).collect();
        let mut kept = vec![self.only.is_empty(); texts.len()];
        for (patterns, keep) in [(&self.only, true), (&self.exclude, false)] {
            for pattern in patterns {
                let is_met = |texts: &Vec<String>| texts.iter().any(|text| matches(pattern, text));
                let met: Vec<bool> = texts.iter().map(is_met).collect();
                if !met.contains(&true) {
                    let texts: Vec<&str> = texts.iter().flatten().map(String::as_str).collect();
                    return Err(NoSuchSatellite::Pattern {
                        pattern: pattern.clone(),
                        nearest: nearest_text(pattern, &texts),
                    });
                }
                for (kept, met) in kept.iter_mut().zip(met) {
                    *kept = if met { keep } else { *kept };
                }
            }
        }
        if kept.contains(&true) {
            Ok(kept)
        } else {
            Err(NoSuchSatellite::Nothing(kept.len()))
        }
    }
}

/// The text most similar to a pattern.
fn nearest_text(pattern: &str, texts: &[&str]) -> Option<String> {
    let lower: Vec<String> = texts
        .iter()
        .map(|text| text.to_lowercase().replace('_', "-"))
        .collect();
    let lower: Vec<&str> = lower.iter().map(String::as_str).collect();
    let found = nearest(pattern, &lower)?;
    let at = lower.iter().position(|text| *text == found)?;
    Some(texts[at].to_owned())
}

/// Whether a text matches a pattern with `*` and `?`, ignoring case.
fn matches(pattern: &str, text: &str) -> bool {
    let lower = |text: &str| text.to_lowercase().chars().collect::<Vec<char>>();
    let (pattern, text) = (lower(pattern), lower(text));
    let (mut p, mut t) = (0, 0);
    // The last star, and how much of the text it has matched.
    let mut star: Option<(usize, usize)> = None;
    while t < text.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, t));
                p += 1;
            }
            Some(c) if *c == '?' || *c == text[t] => {
                p += 1;
                t += 1;
            }
            _ => match star {
                Some((at, taken)) => {
                    star = Some((at, taken + 1));
                    p = at + 1;
                    t = taken + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

#[cfg(test)]
mod tests;
