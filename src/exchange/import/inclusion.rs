//! Whether the satellites of one fleet are in another.

use super::Fleet;

impl Fleet {
    /// Whether all satellites of another fleet are among these, with the same data.
    #[must_use]
    pub fn includes(&self, other: &Self) -> bool {
        fn all_in<T: PartialEq>(some: &[T], all: &[T]) -> bool {
            some.iter().all(|one| all.contains(one))
        }
        match (self, other) {
            (_, Self::Mixed(parts)) => parts.iter().all(|part| self.includes(part)),
            (Self::Sets(all), Self::Sets(some)) => all_in(some, all),
            (Self::Elements(all), Self::Elements(some)) => all_in(some, all),
            (Self::Sampled(all), Self::Sampled(some)) => all_in(some, all),
            (Self::Almanacs(all), Self::Almanacs(some)) => all_in(some, all),
            (Self::Mixed(parts), _) => parts.iter().any(|part| part.includes(other)),
            _ => false,
        }
    }
}
