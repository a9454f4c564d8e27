//! Object identity: one rule within a file and across files, for every format.
//!
//! Two descriptions refer to the same object if they agree in the first of these that both give: the catalogue
//! number, the international designator, the name. Placeholders count as not given. The rule is described
//! for users in `docs/formats.md`.

use std::collections::{HashMap, HashSet};

/// Placeholders for a missing identifier (CCSDS 502.0-B-3 asks for `UNKNOWN`).
const PLACEHOLDERS: [&str; 9] = [
    "",
    "UNKNOWN",
    "UNKNOWN OBJECT",
    "UNASSIGNED",
    "N/A",
    "NA",
    "NONE",
    "TBD",
    "-",
];

/// The identifiers of an object in a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ObjectIdentity {
    /// Catalogue number; 0 if not given.
    catalogue_number: Option<u64>,
    /// International designator, or another identifier that is valid outside its file.
    designator: Option<String>,
    /// Name.
    name: Option<String>,
}

impl ObjectIdentity {
    /// The identity of an object with these identifiers; placeholders are dropped.
    #[must_use]
    pub fn new(catalogue_number: u64, designator: &str, name: &str) -> Self {
        Self {
            catalogue_number: Some(catalogue_number).filter(|number| *number != 0),
            designator: given(designator).filter(|text| !text.starts_with("0000-")),
            name: given(name),
        }
    }

    /// The identity in an element set.
    #[must_use]
    pub fn of_set(set: &::sgp4::Elements) -> Self {
        let text = |text: &Option<String>| text.clone().unwrap_or_default();
        Self::new(
            set.norad_id,
            &text(&set.international_designator),
            &text(&set.object_name),
        )
    }

    /// The catalogue number, if given.
    #[must_use]
    pub fn catalogue_number(&self) -> Option<u64> {
        self.catalogue_number
    }

    /// The international designator, if given.
    #[must_use]
    pub fn designator(&self) -> Option<&str> {
        self.designator.as_deref()
    }

    /// The name, if given.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Whether both refer to the same object.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        if let (Some(a), Some(b)) = (self.catalogue_number, other.catalogue_number) {
            return a == b;
        }
        let both = [
            (&self.designator, &other.designator),
            (&self.name, &other.name),
        ];
        let known = both
            .into_iter()
            .find_map(|(a, b)| Some((a.as_ref()?, b.as_ref()?)));
        known.is_some_and(|(a, b)| a.eq_ignore_ascii_case(b))
    }

    /// Whether both have names and the names differ.
    #[must_use]
    pub fn is_named_otherwise(&self, other: &Self) -> bool {
        let names = self.name.as_ref().zip(other.name.as_ref());
        names.is_some_and(|(a, b)| !a.eq_ignore_ascii_case(b))
    }

    /// The label of the object: its name, or else its number, or else its designator.
    #[must_use]
    pub fn label(&self) -> Option<String> {
        self.name.clone().or_else(|| self.identifier())
    }

    /// The catalogue number, or else the designator.
    fn identifier(&self) -> Option<String> {
        let number = self.catalogue_number.map(|number| number.to_string());
        number.or_else(|| self.designator.clone())
    }

    /// Every text that selects the object.
    pub fn texts(&self) -> impl Iterator<Item = String> {
        let number = self.catalogue_number.map(|number| number.to_string());
        let texts = [self.name.clone(), self.designator.clone(), number];
        texts.into_iter().flatten()
    }
}

/// The text, unless it is a placeholder.
fn given(text: &str) -> Option<String> {
    let text = text.trim();
    let is_placeholder = PLACEHOLDERS
        .iter()
        .any(|word| text.eq_ignore_ascii_case(word));
    (!is_placeholder).then(|| text.to_owned())
}

/// Unique labels of objects: objects that share a name have their number or designator appended, and
/// those without any identifier are numbered by position, from 1.
#[must_use]
pub fn unique_labels(identities: &[ObjectIdentity]) -> Vec<String> {
    let label = |(place, identity): (usize, &ObjectIdentity)| {
        let unnamed = || format!("satellite {}", place + 1);
        identity.label().unwrap_or_else(unnamed)
    };
    let labels: Vec<String> = identities.iter().enumerate().map(label).collect();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for label in &labels {
        *counts.entry(label).or_default() += 1;
    }
    let unique = |(label, identity): (&String, &ObjectIdentity)| match identity.identifier() {
        Some(identifier) if counts[label.as_str()] > 1 && identifier != *label => {
            format!("{label} ({identifier})")
        }
        _ => label.clone(),
    };
    // An object may be named as another is numbered.
    let mut texts = UniqueTexts::default();
    let labels = labels.iter().zip(identities).map(unique);
    labels.map(|label| texts.take(label, NUMBERED)).collect()
}

/// What stands between a name and the number that makes it unique.
pub const NUMBERED: &str = " #";

/// Texts that are given once each.
#[derive(Debug, Default)]
pub struct UniqueTexts {
    taken: HashSet<String>,
    /// The next number of a text that was taken.
    next: HashMap<String, usize>,
}

impl UniqueTexts {
    /// The text if it is free, or else with the first free number from 2 behind it and `between` them.
    pub fn take(&mut self, text: String, between: &str) -> String {
        self.take_by(text, between, str::to_owned)
    }

    /// The same, where two texts are alike if they have the same key.
    pub fn take_by(&mut self, text: String, between: &str, key: fn(&str) -> String) -> String {
        let own = key(&text);
        if self.taken.insert(own.clone()) {
            return text;
        }
        let next = self.next.entry(own).or_insert(2);
        loop {
            let numbered = format!("{text}{between}{next}");
            *next += 1;
            if self.taken.insert(key(&numbered)) {
                return numbered;
            }
        }
    }
}

/// The objects found so far, indexed by identity.
#[derive(Debug, Default)]
pub struct KnownObjects {
    identities: Vec<ObjectIdentity>,
    by_number: HashMap<u64, Vec<usize>>,
    by_text: HashMap<String, Vec<usize>>,
}

impl KnownObjects {
    /// The position of the first object with this identity; records the object.
    pub fn meet(&mut self, identity: &ObjectIdentity) -> Option<usize> {
        let found = self.same(identity).first().copied();
        self.add(identity.clone());
        found
    }

    /// Records an object.
    pub fn add(&mut self, identity: ObjectIdentity) {
        let place = self.identities.len();
        if let Some(number) = identity.catalogue_number {
            self.by_number.entry(number).or_default().push(place);
        }
        for text in keys(&identity) {
            self.by_text.entry(text).or_default().push(place);
        }
        self.identities.push(identity);
    }

    /// The positions of the objects with this identity, in order.
    #[must_use]
    pub fn same(&self, identity: &ObjectIdentity) -> Vec<usize> {
        let by_number = identity
            .catalogue_number
            .and_then(|number| self.by_number.get(&number));
        let by_text = keys(identity).filter_map(|text| self.by_text.get(&text));
        let candidates = by_number.into_iter().chain(by_text).flatten().copied();
        let mut same: Vec<usize> = candidates
            .filter(|place| self.identities[*place].is_same(identity))
            .collect();
        same.sort_unstable();
        same.dedup();
        same
    }

    /// The identity of the object at a position.
    #[must_use]
    pub fn identity(&self, place: usize) -> &ObjectIdentity {
        &self.identities[place]
    }
}

/// The texts by which an object is found, in capitals.
fn keys(identity: &ObjectIdentity) -> impl Iterator<Item = String> {
    let texts = [&identity.designator, &identity.name];
    texts
        .into_iter()
        .flatten()
        .map(|text| text.to_ascii_uppercase())
}

/// The positions of the first two entries for the same object.
#[must_use]
pub fn first_repeated(identities: &[ObjectIdentity]) -> Option<(usize, usize)> {
    let mut known = KnownObjects::default();
    let mut places = identities.iter().enumerate();
    places.find_map(|(place, identity)| Some((known.meet(identity)?, place)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(number: u64, designator: &str, name: &str) -> ObjectIdentity {
        ObjectIdentity::new(number, designator, name)
    }

    /// Number before designator before name; what is not given on one side does not count.
    #[test]
    fn objects_are_told_apart_by_the_first_identifier_that_both_have() {
        for (one, other, is_same) in [
            (
                object(5, "1958-002B", "A"),
                object(5, "1958-002C", "B"),
                true,
            ),
            (
                object(5, "1958-002B", "A"),
                object(6, "1958-002B", "A"),
                false,
            ),
            (
                object(5, "1958-002B", "A"),
                object(0, "1958-002B", "B"),
                true,
            ),
            (
                object(0, "2025-900A", "UNKNOWN"),
                object(0, "2025-900B", "UNKNOWN"),
                false,
            ),
            (object(0, "", "UNKNOWN"), object(0, "", "unknown"), false),
            (
                object(0, "0000-000A", "A"),
                object(0, "0000-000A", "B"),
                false,
            ),
            (
                object(0, "0000-000A", "A"),
                object(0, "UNKNOWN", "a "),
                true,
            ),
            (
                object(0, "2025-900A", "A"),
                object(0, "2025-900a", "B"),
                true,
            ),
            (object(5, "", ""), object(0, "", "5"), false),
        ] {
            assert_eq!(one.is_same(&other), is_same, "{one:?} {other:?}");
            assert_eq!(other.is_same(&one), is_same);
            let expected = is_same.then_some((0, 1));
            assert_eq!(first_repeated(&[one, other]), expected);
        }
    }

    #[test]
    fn labels_are_unique() {
        let labels = unique_labels(&[
            object(0, "2025-900A", "UNKNOWN"),
            object(0, "2025-900B", "UNKNOWN"),
            object(7, "", "DEB"),
            object(8, "1999-025A", "DEB"),
            object(9, "", ""),
            object(0, "", ""),
            object(10, "", "SAT"),
            object(0, "", "9"),
            object(0, "", "9 #2"),
            object(0, "", "9"),
        ]);
        let expected = [
            "2025-900A",
            "2025-900B",
            "DEB (7)",
            "DEB (8)",
            "9",
            "satellite 6",
            "SAT",
            "9 #2",
            "9 #2 #2",
            "9 #3",
        ];
        assert_eq!(labels, expected);
    }
}
