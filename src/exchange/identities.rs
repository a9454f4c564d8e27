//! The identities under which the satellites of a constellation are exported.
//!
//! A satellite of a file keeps what identifies it there; what it lacks, and everything of a design's satellites, is
//! synthetic. Names, numbers and designators are unique, so that every reader tells the satellites apart.

use super::members::ConstellationMember;
use crate::constellation::identity::{NUMBERED, ObjectIdentity, UniqueTexts, unique_labels};
use crate::exchange::manifest::{ChangedIdentity, Identifier};
use crate::formats::gmat::script_name;
use crate::formats::metadata::{CatalogNumber, IdentityError, Object};
use crate::time::Epoch;
use std::collections::HashSet;

/// Longest name of a file without its extension.
const STEM: usize = 100;

/// How satellites are called that have no identity of their own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Naming {
    /// Beginning of the names of a design's satellites.
    pub prefix: String,
    /// The first catalogue number.
    pub first_catalog_number: u32,
}

impl Default for Naming {
    fn default() -> Self {
        Self {
            prefix: crate::ephemeris::NAME_PREFIX.to_owned(),
            first_catalog_number: CatalogNumber::FIRST_OF_DESIGNS,
        }
    }
}

impl Naming {
    /// The identities of satellites in their order, at the epoch of the study.
    ///
    /// # Errors
    /// If there are too few catalogue numbers from the first one on.
    pub(super) fn objects(
        &self,
        members: &[ConstellationMember<'_>],
        epoch: Epoch,
    ) -> Result<Vec<Object>, IdentityError> {
        let mut numbers = FreshNumbers::new(self.first_catalog_number, members);
        let mut designators = HashSet::new();
        let names = self.names(members);
        let object = |(member, name): (&ConstellationMember<'_>, String)| {
            let number = own_number(&member.identity);
            let designator = own_designator(&member.identity);
            let designator = designator.filter(|text| designators.insert((*text).to_owned()));
            match (number, designator) {
                (Some(catalog_number), Some(id)) => Ok(Object {
                    name,
                    catalog_number,
                    id: id.to_owned(),
                }),
                (number, id) => {
                    let fresh = numbers.next(&name, epoch)?;
                    Ok(Object {
                        catalog_number: number.unwrap_or(fresh.catalog_number),
                        id: id.map_or(fresh.id, str::to_owned),
                        name,
                    })
                }
            }
        };
        members.iter().zip(names).map(object).collect()
    }

    /// Unique names in printable ASCII, which every format can hold.
    fn names(&self, members: &[ConstellationMember<'_>]) -> Vec<String> {
        let of_files = members.iter().filter(|member| member.slot.is_none());
        let identities: Vec<ObjectIdentity> =
            of_files.map(|member| member.identity.clone()).collect();
        let mut labels = unique_labels(&identities).into_iter();
        let mut names = UniqueTexts::default();
        let name = |member: &ConstellationMember<'_>| {
            let name = match member.slot {
                Some(slot) => format!("{}-{slot}", self.prefix),
                None => plain_ascii(&labels.next().unwrap_or_default()),
            };
            names.take(name, NUMBERED)
        };
        members.iter().map(name).collect()
    }
}

/// Catalogue numbers that no satellite has, with designators that none has.
struct FreshNumbers {
    first: u32,
    next: u32,
    satellites: usize,
    numbers: HashSet<u32>,
    designators: HashSet<String>,
}

impl FreshNumbers {
    fn new(first: u32, members: &[ConstellationMember<'_>]) -> Self {
        let identities = || members.iter().map(|member| &member.identity);
        let numbers = identities().filter_map(own_number);
        let designators = identities().filter_map(ObjectIdentity::designator);
        Self {
            first,
            next: first,
            satellites: members.len(),
            numbers: numbers.map(CatalogNumber::number).collect(),
            designators: designators.map(str::to_owned).collect(),
        }
    }

    fn next(&mut self, name: &str, epoch: Epoch) -> Result<Object, IdentityError> {
        loop {
            let number =
                CatalogNumber::new(self.next).map_err(|_| IdentityError::TooFewNumbers {
                    first: self.first,
                    satellites: self.satellites,
                })?;
            self.next += 1;
            let object = Object::synthetic(name, number, epoch);
            if !self.numbers.contains(&number.number()) && !self.designators.contains(&object.id) {
                return Ok(object);
            }
        }
    }
}

/// The name of an object in its file, if every format can hold it.
pub(super) fn own_name(identity: &ObjectIdentity) -> Option<&str> {
    identity.name().filter(|name| is_plain_ascii(name))
}

/// The catalogue number of an object in its file, if every format can hold it.
pub(super) fn own_number(identity: &ObjectIdentity) -> Option<CatalogNumber> {
    let number = u32::try_from(identity.catalogue_number()?).ok()?;
    CatalogNumber::new(number).ok()
}

/// The designator of an object in its file, in characters that every format can hold.
pub(super) fn own_designator(identity: &ObjectIdentity) -> Option<&str> {
    identity.designator().filter(|text| is_plain_ascii(text))
}

/// What of the identities in files is not written as it is there.
pub(super) fn changed(
    members: &[ConstellationMember<'_>],
    objects: &[Object],
) -> Vec<ChangedIdentity> {
    let mut changed = Vec::new();
    for (member, object) in members.iter().zip(objects) {
        let identity = &member.identity;
        let mut add = |identifier, source: Option<String>, written: String| {
            changed.extend(source.map(|source| ChangedIdentity {
                identifier,
                source,
                written,
            }));
        };
        if own_name(identity).is_none() {
            let name = identity.name().map(str::to_owned);
            add(Identifier::Name, name, object.name.clone());
        }
        if own_number(identity).is_none() {
            let number = identity.catalogue_number().map(|number| number.to_string());
            let written = object.catalog_number.number().to_string();
            add(Identifier::CatalogueNumber, number, written);
        }
        if own_designator(identity).is_none() {
            let designator = identity.designator().map(str::to_owned);
            add(Identifier::Designator, designator, object.id.clone());
        }
    }
    changed
}

fn is_plain_ascii(text: &str) -> bool {
    text.chars().all(|c| (' '..='~').contains(&c))
}

/// A text in printable ASCII, with `_` for other characters.
pub(super) fn plain_ascii(text: &str) -> String {
    let plain = |c: char| if (' '..='~').contains(&c) { c } else { '_' };
    let text: String = text.chars().map(plain).collect();
    text.trim().to_owned()
}

/// Names of files, and of objects in STK: letters, digits, `-` and `_`, different on every file system and in GMAT.
pub(super) fn stems(objects: &[Object]) -> Vec<String> {
    let mut stems = UniqueTexts::default();
    let stem = |object: &Object| {
        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        let plain = |c: char| if allowed(c) { c } else { '_' };
        let stem: String = object.name.chars().take(STEM).map(plain).collect();
        stems.take_by(stem, "_", |stem| script_name(stem).to_ascii_lowercase())
    };
    objects.iter().map(stem).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::members::Origin;

    fn member(set: &sgp4::Elements, number: u64, designator: &str, name: &str) -> Object {
        let member = ConstellationMember {
            slot: None,
            origin: Origin::Set(set),
            identity: ObjectIdentity::new(number, designator, name),
        };
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let mut objects = Naming::default().objects(&[member], epoch).unwrap();
        objects.remove(0)
    }

    fn set() -> sgp4::Elements {
        let line1 = b"1 25544U 98067A   25001.00000000  .00000000  00000-0  00000-0 0  9990";
        let line2 = b"2 25544  51.6400  10.0000 0001000  20.0000  30.0000 15.50000000    00";
        let fixed = |line: &[u8; 69]| {
            let digit = |byte: &u8| match byte {
                b'0'..=b'9' => u32::from(byte - b'0'),
                b'-' => 1,
                _ => 0,
            };
            let mut line = *line;
            line[68] = b'0' + (line[..68].iter().map(digit).sum::<u32>() % 10) as u8;
            line
        };
        sgp4::Elements::from_tle(None, &fixed(line1), &fixed(line2)).unwrap()
    }

    #[test]
    fn what_a_file_has_is_kept_and_the_rest_is_synthetic() {
        let set = set();
        let own = member(&set, 25_544, "1998-067A", "ISS (ZARYA)");
        assert_eq!(
            (own.catalog_number.number(), own.id.as_str()),
            (25_544, "1998-067A")
        );
        assert_eq!(own.name, "ISS (ZARYA)");
        let nothing = member(&set, 0, "", "");
        assert_eq!(
            (nothing.catalog_number.number(), nothing.id.as_str()),
            (90_001, "2025-900A")
        );
        assert_eq!(nothing.name, "satellite 1");
        let long = member(&set, 799_500_123, "", "Ω 1");
        assert_eq!(
            (long.catalog_number.number(), long.name.as_str()),
            (90_001, "_ 1")
        );
    }

    /// No path leads out of the directory, and no two are the same file anywhere.
    #[test]
    fn files_have_safe_names() {
        let set = set();
        let names = ["../up", "a/b", "A-B", "a_b", ".hidden", "IRIDIUM 7 [+]"];
        let objects: Vec<Object> = names.iter().map(|name| member(&set, 0, "", name)).collect();
        assert_eq!(
            stems(&objects),
            ["___up", "a_b", "A-B_2", "a_b_3", "_hidden", "IRIDIUM_7____"]
        );
    }
}
