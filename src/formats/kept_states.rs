//! Which states of a file stay in memory while it is read: those of an interval and what interpolation needs around it, or
//! none, so that memory follows what is used and not the size of the file.

/// States kept on each side of an interval: twice the most that a polynomial passes through, since the error of
/// interpolation is estimated with every other state omitted.
const MARGIN: usize = 48;

/// Which states of a satellite are kept; instants are those of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeptStates<I> {
    /// All.
    #[default]
    All,
    /// None: the file is only checked.
    None,
    /// Those between two instants, both included, and the nearest before and after.
    Around(I, I),
}

impl<I> KeptStates<I> {
    /// The same with instants of another kind.
    #[must_use]
    pub fn map<J>(self, convert: impl Fn(I) -> J) -> KeptStates<J> {
        match self {
            Self::All => KeptStates::All,
            Self::None => KeptStates::None,
            Self::Around(first, last) => KeptStates::Around(convert(first), convert(last)),
        }
    }
}

impl<I: PartialOrd + Copy> KeptStates<I> {
    /// Keeps of states in the order of time those of the interval, and the nearest before and after.
    pub(crate) fn cut<T>(self, states: &mut Vec<T>, at: impl Fn(&T) -> I) {
        match self {
            Self::All => {}
            Self::None => states.clear(),
            Self::Around(first, last) => {
                let after = states.partition_point(|state| at(state) <= last);
                states.truncate(after + MARGIN);
                let before = states.partition_point(|state| at(state) < first);
                states.drain(..before.saturating_sub(MARGIN));
            }
        }
    }
}

/// Takes the states of a satellite in the order of time, and keeps some.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StateKeeper<I> {
    kept: KeptStates<I>,
    /// Number of states kept after the interval.
    after: usize,
}

impl<I: PartialOrd + Copy> StateKeeper<I> {
    pub(crate) fn new(kept: KeptStates<I>) -> Self {
        Self { kept, after: 0 }
    }

    /// Adds the state at an instant to those kept, if it is to be kept.
    pub(crate) fn push<T>(&mut self, states: &mut Vec<T>, at: I, state: T) {
        match self.kept {
            KeptStates::All => states.push(state),
            KeptStates::None => {}
            KeptStates::Around(first, _) if at < first => {
                // Twice as many are held, so that moving them costs little.
                if states.len() == 2 * MARGIN {
                    states.drain(..MARGIN);
                }
                states.push(state);
            }
            KeptStates::Around(_, last) => {
                self.after += usize::from(at > last);
                if self.after <= MARGIN {
                    states.push(state);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exactly the margin on each side: what was kept of the parts of a track has holes farther away.
    #[test]
    fn states_are_cut_to_an_interval_and_its_neighbours() {
        let margin = MARGIN as u32;
        for (kept, expected) in [
            (KeptStates::All, 0..1000),
            (KeptStates::None, 0..0),
            (KeptStates::Around(500, 600), 500 - margin..601 + margin),
            (KeptStates::Around(0, 2000), 0..1000),
            (KeptStates::Around(2000, 3000), 1000 - margin..1000),
        ] {
            let mut states: Vec<u32> = (0..1000).collect();
            kept.cut(&mut states, |at| *at);
            assert_eq!(states, Vec::from_iter(expected), "{kept:?}");
        }
    }

    fn kept(kept: KeptStates<u32>) -> Vec<u32> {
        let mut keeper = StateKeeper::new(kept);
        let mut states = Vec::new();
        (0..1000).for_each(|at| keeper.push(&mut states, at, at));
        states
    }

    /// Whole inside, and at least the margin on each side: the nodes of every polynomial are the same.
    #[test]
    fn states_of_an_interval_are_kept_with_their_neighbours() {
        let margin = MARGIN as u32;
        let some = kept(KeptStates::Around(500, 600));
        assert!(some.is_sorted() && some.windows(2).all(|pair| pair[0] + 1 == pair[1]));
        assert!((500 - 2 * margin..=500 - margin).contains(&some[0]));
        assert_eq!(some.last(), Some(&(600 + margin)));
        assert_eq!(kept(KeptStates::Around(0, 2000)).len(), 1000);
        assert_eq!(kept(KeptStates::All).len(), 1000);
        assert!(kept(KeptStates::None).is_empty());
        // An interval before or after all states.
        let before = kept(KeptStates::Around(2000, 3000));
        assert!(before.len() >= MARGIN && before.len() <= 2 * MARGIN);
        assert_eq!(before.last(), Some(&999));
    }
}
