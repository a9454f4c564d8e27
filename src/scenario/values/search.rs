//! The search space.

use super::shell::{INTERVALS, MAX_SATELLITES};
use crate::scenario::keys::{KeyPath, Section, Walk, key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{ListOf, Optional, SectionTable, Text};
use crate::search::{ShellSpace, SweepSteps};

section! {
    /// The search space.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SearchSpace in "search", finish finish_search {
        /// The shells of the designs; every interval includes its limits.
        pub shells: SearchShells;
        /// Constellation that every design of the search has beside its own shells: a design in Walker notation, or
        /// a name in `constellations`, also of satellites from files.
        pub fixed: Option<String> = Optional(Text::Any), follows "nothing",
            example Some("star:86.4:66/6/3@780,node-step=31.6".to_owned());
    }
}

/// The key that lists several shells.
pub(in crate::scenario) const SHELLS: KeyPath = key!(ShellList.shells);

/// The shells of a search.
#[derive(Debug, Clone, PartialEq)]
pub enum SearchShells {
    /// One, by the keys of `[search]`.
    One(Box<ShellSpace>),
    /// Those listed as `[[search.shells]]`.
    Listed(Vec<ShellSpace>),
}

section! {
    /// The key of several shells.
    struct ShellList in "search" {
        /// Shells, each with the keys of `[search]` from `pattern` to the steps, also written as `[[search.shells]]`, in
        /// place of those intervals; steps that are not given are those of `[search]`. A shell whose
        /// `satellites-per-plane` start at 0 may be empty.
        pub shells: Vec<ShellSpace> = ListOf(SectionTable::new()),
            follows "one shell, by the keys above", example ShellSpace::examples();
    }
}

impl SearchShells {
    /// The shells in their order.
    #[must_use]
    pub fn as_slice(&self) -> &[ShellSpace] {
        match self {
            Self::One(shell) => std::slice::from_ref(shell.as_ref()),
            Self::Listed(shells) => shells,
        }
    }
}

impl Section for SearchShells {
    const SECTION: &'static str = ShellSpace::SECTION;

    fn walk(walk: &mut impl Walk, values: Option<&Self>) -> Self {
        let (one, listed) = match values {
            None => (None, None),
            Some(Self::One(shell)) => (Some(shell.as_ref()), None),
            Some(Self::Listed(shells)) => {
                let shells = shells.clone();
                (None, Some(ShellList { shells }))
            }
        };
        let one = ShellSpace::walk(walk, one);
        let listed = ShellList::walk(walk, listed.as_ref()).shells;
        walk.finish(Self::One(Box::new(one)), |gathered, reader| {
            if !reader.is_given(SHELLS) {
                return;
            }
            if let Self::One(one) = &*gathered {
                refuse_intervals(reader);
                let listed = inherit_steps(listed, one, reader);
                check_listed(&listed, reader);
                *gathered = Self::Listed(listed);
            }
        })
    }
}

/// Rejects the intervals of one shell beside a list of shells.
fn refuse_intervals(reader: &mut Reader<'_>) {
    for interval in INTERVALS {
        if reader.is_given(interval) {
            reader.refuse(&[interval], Fault::OfOneShell);
        }
    }
}

/// The shells with the steps of `[search]` where their own tables give none.
fn inherit_steps(
    mut shells: Vec<ShellSpace>,
    one: &ShellSpace,
    reader: &Reader<'_>,
) -> Vec<ShellSpace> {
    macro_rules! inherit {
        ($steps:ident, $place:ident: $($field:ident),+) => {
            $(if reader.is_absent_in(SHELLS, $place, key!(SweepSteps.$field))
                && reader.is_given(key!(SweepSteps.$field))
            {
                $steps.$field = one.steps.$field;
            })+
        };
    }
    for (place, shell) in shells.iter_mut().enumerate() {
        let steps = &mut shell.steps;
        inherit!(
            steps, place: inclination_step_deg, altitude_step_km, eccentricity_step, arg_perigee_step_deg,
            raan_step_deg, arg_latitude_step_deg, node_step_step_deg
        );
    }
    shells
}

fn check_listed(shells: &[ShellSpace], reader: &mut Reader<'_>) {
    let key = SHELLS;
    if shells.is_empty() {
        reader.refuse(&[key], Fault::NoShells);
    }
    let most =
        |shell: &ShellSpace| f64::from(shell.planes[1]) * f64::from(shell.satellites_per_plane[1]);
    let most = shells.iter().map(most).sum();
    let limit = MAX_SATELLITES.into();
    reader.at_most(limit, most, "satellites in a design", &[key]);
}

fn finish_search(search: &mut SearchSpace, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(SearchSpace.fixed)) {
        search.fixed = None;
    }
    let shells = search.shells.as_slice();
    if search.fixed.is_none() && !shells.is_empty() && shells.iter().all(ShellSpace::may_be_empty) {
        let keys = [SHELLS, key!(ShellSpace.satellites_per_plane)];
        reader.refuse(&keys, Fault::AllEmpty);
    }
}

impl SearchSpace {
    /// Upper bound on the number of designs of an exhaustive search.
    pub(super) fn design_count(&self) -> f64 {
        let shells = self.shells.as_slice().iter();
        shells.map(ShellSpace::grid_points).product()
    }
}
