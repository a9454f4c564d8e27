//! What moved between two results: the values of their files, by quantity and place.

mod text;
mod values;

pub use values::{ResultFile, ResultFileError};

use crate::run::ResultProvenance;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use values::{Leaf, ValuePlace};

/// How far two numbers may be apart that count as equal: `absolute + relative × the larger magnitude`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tolerance {
    /// In the unit of the number.
    pub absolute: f64,
    /// As a share.
    pub relative: f64,
}

impl Tolerance {
    fn allows(self, a: f64, b: f64) -> bool {
        // Infinities are equal to themselves, and their difference is no number.
        let apart = (b - a).abs();
        a == b || apart.is_finite() && apart <= self.absolute + self.relative * a.abs().max(b.abs())
    }
}

/// A result: its files by name, and where it comes from if that is known.
#[derive(Debug, Clone, Default)]
pub struct Side {
    /// The files.
    pub files: BTreeMap<String, ResultFile>,
    /// Where they come from.
    pub provenance: Option<ResultProvenance>,
}

/// A value that is not the same on both sides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moved {
    /// The file.
    pub file: String,
    /// The quantity: a column, or the keys of a JSON file that lead to it.
    pub quantity: String,
    /// What it is of: a design, a name or a row; empty for what a file has once.
    pub of: String,
    /// The value of A, as written; `None` if A has none.
    pub a: Option<String>,
    /// The value of B.
    pub b: Option<String>,
    /// B minus A; `None` unless both are finite numbers.
    pub difference: Option<f64>,
    /// The difference by the larger magnitude.
    pub relative: Option<f64>,
}

/// The two sides compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diff {
    /// Where A and B come from.
    pub provenance: [Option<ResultProvenance>; 2],
    /// What counts as equal.
    pub tolerance: Tolerance,
    /// Values compared, by file.
    pub compared: BTreeMap<String, usize>,
    /// The values that moved, file by file in the order of A.
    pub moved: Vec<Moved>,
    /// Files whose bytes differ and whose values cannot be compared.
    pub differing_files: Vec<String>,
    /// Pages and figures whose bytes differ. They are drawn from the other files and from the program, so that they say
    /// nothing of values.
    pub differing_drawings: Vec<String>,
    /// Files that only A has, drawings left out.
    pub only_in_a: Vec<String>,
    /// Files that only B has.
    pub only_in_b: Vec<String>,
}

impl Diff {
    /// Compares two results. Tables and texts beside a JSON file of the same name say the same and are compared only
    /// if that is equal.
    #[must_use]
    pub fn of(a: &Side, b: &Side, tolerance: Tolerance) -> Self {
        let missing = |from: &Side, of: &Side| -> Vec<String> {
            let files = from.files.iter();
            let own =
                files.filter(|(name, file)| !file.is_drawing() && !of.files.contains_key(*name));
            own.map(|(name, _)| name.clone()).collect()
        };
        let mut diff = Self {
            provenance: [a.provenance.clone(), b.provenance.clone()],
            tolerance,
            compared: BTreeMap::new(),
            moved: Vec::new(),
            differing_files: Vec::new(),
            differing_drawings: Vec::new(),
            only_in_a: missing(a, b),
            only_in_b: missing(b, a),
        };
        let mut told = BTreeSet::new();
        let both = a
            .files
            .iter()
            .filter_map(|(name, one)| Some((name, one, b.files.get(name)?)));
        let (trees, others): (Vec<_>, Vec<_>) =
            both.partition(|(name, ..)| name.ends_with(".json"));
        for (name, one, other) in trees.into_iter().chain(others) {
            let stem = name.split_once('.').map_or(name.as_str(), |(stem, _)| stem);
            if told.contains(stem) {
                continue;
            }
            if diff.file(name, one, other) {
                told.insert(stem);
            }
        }
        diff
    }

    /// Whether everything that both have is equal, and neither has more.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.moved.is_empty()
            && self.differing_files.is_empty()
            && self.only_in_a.is_empty()
            && self.only_in_b.is_empty()
    }

    /// Compares a file of both; whether it differs.
    fn file(&mut self, name: &str, a: &ResultFile, b: &ResultFile) -> bool {
        let (Some(a_values), Some(b_values)) = (a.values(), b.values()) else {
            let differs = a != b;
            if differs {
                let list = match a.is_drawing() {
                    true => &mut self.differing_drawings,
                    false => &mut self.differing_files,
                };
                list.push(name.to_owned());
            }
            return differs;
        };
        let before = self.moved.len();
        let of_b: BTreeMap<&ValuePlace, &Leaf> =
            b_values.iter().map(|(place, leaf)| (place, leaf)).collect();
        let of_a: BTreeSet<&ValuePlace> = a_values.iter().map(|(place, _)| place).collect();
        for (place, leaf) in &a_values {
            self.value(name, place, Some(leaf), of_b.get(place).copied());
        }
        let only_b = b_values.iter().filter(|(place, _)| !of_a.contains(place));
        self.compared
            .insert(name.to_owned(), a_values.len() + only_b.clone().count());
        for (place, leaf) in only_b {
            self.value(name, place, None, Some(leaf));
        }
        self.moved.len() > before
    }

    fn value(&mut self, file: &str, place: &ValuePlace, a: Option<&Leaf>, b: Option<&Leaf>) {
        let numbers = match (a, b) {
            (Some(Leaf::Number(a, _)), Some(Leaf::Number(b, _))) => Some((*a, *b)),
            _ => None,
        };
        let is_equal = numbers.map_or(a == b, |(a, b)| self.tolerance.allows(a, b));
        if is_equal {
            return;
        }
        let difference = numbers.map(|(a, b)| b - a).filter(|by| by.is_finite());
        let larger = numbers.map(|(a, b)| a.abs().max(b.abs()));
        let relative = difference.zip(larger).map(|(by, of)| by / of);
        let written = |leaf: Option<&Leaf>| leaf.map(Leaf::to_string);
        self.moved.push(Moved {
            file: file.to_owned(),
            quantity: place.quantity.clone(),
            of: place.of.clone(),
            a: written(a),
            b: written(b),
            difference,
            relative,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(files: &[(&str, &str)]) -> Side {
        let read = |(name, text): &(&str, &str)| {
            let document = ResultFile::read(name, text.as_bytes().to_vec()).unwrap();
            ((*name).to_owned(), document)
        };
        Side {
            files: files.iter().map(read).collect(),
            provenance: None,
        }
    }

    fn moved(a: &[(&str, &str)], b: &[(&str, &str)], absolute: f64, relative: f64) -> Diff {
        Diff::of(&side(a), &side(b), Tolerance { absolute, relative })
    }

    #[test]
    fn numbers_are_equal_within_the_tolerance_and_at_it() {
        let (a, b) = (
            [("a.csv", "name,x\none,8\n")],
            [("a.csv", "name,x\none,10\n")],
        );
        assert_eq!(moved(&a, &b, 0.0, 0.0).moved[0].difference, Some(2.0));
        assert_eq!(moved(&a, &b, 0.0, 0.0).moved[0].relative, Some(0.2));
        assert!(moved(&a, &b, 2.0, 0.0).is_none());
        assert!(!moved(&a, &b, 1.99, 0.0).is_none());
        assert!(moved(&a, &b, 0.0, 0.2).is_none());
        assert!(!moved(&a, &b, 0.0, 0.19).is_none());
        // Texts have no tolerance, and infinity is equal to itself alone.
        let (a, b) = ([("a.csv", "x,y\ninf,a\n")], [("a.csv", "x,y\ninf,b\n")]);
        assert_eq!(moved(&a, &b, 9.0, 1.0).moved.len(), 1);
        let b = [("a.csv", "x,y\n1,a\n")];
        assert_eq!(moved(&a, &b, 9.0, 0.5).moved[0].difference, None);
    }

    #[test]
    fn rows_are_matched_by_design_and_not_by_place() {
        let a = [("a.csv", "index,design,x\n1,s,1\n2,d,2\n")];
        let b = [("a.csv", "index,design,x\n1,d,2\n2,s,1\n3,e,1\n")];
        let diff = moved(&a, &b, 0.0, 0.0);
        assert!(
            diff.moved
                .iter()
                .all(|one| one.of == "e" && one.a.is_none()),
            "{diff:?}"
        );
        assert_eq!(diff.compared["a.csv"], 6);
    }

    #[test]
    fn files_that_say_the_same_are_told_once() {
        let (json, csv) = (r#"{"x": 1}"#, "x\n1\n");
        let a = [
            ("r.json", json),
            ("r.csv", csv),
            ("r.txt", "one"),
            ("s.txt", "s"),
            ("t.txt", "t"),
        ];
        let b = [
            ("r.json", r#"{"x": 2}"#),
            ("r.csv", "x\n2\n"),
            ("r.txt", "two"),
            ("s.txt", "S"),
        ];
        let diff = moved(&a, &b, 0.0, 0.0);
        assert_eq!(diff.moved.len(), 1);
        assert_eq!(diff.differing_files, ["s.txt"]);
        assert_eq!(
            (diff.only_in_a, diff.only_in_b.len()),
            (vec!["t.txt".to_owned()], 0)
        );
        // Where the JSON is the same, the others are compared.
        let b = [
            ("r.json", json),
            ("r.csv", "x\n2\n"),
            ("r.txt", "two"),
            ("s.txt", "s"),
            ("t.txt", "t"),
        ];
        let diff = moved(&a, &b, 0.0, 0.0);
        assert_eq!((diff.moved.len(), diff.differing_files.len()), (1, 0));
    }

    #[test]
    fn the_text_has_a_row_for_a_quantity_with_its_largest_move() {
        let a = [("a.csv", "name,x,y\none,1,5\ntwo,1,5\n")];
        let b = [("a.csv", "name,x,y\none,1.5,5\ntwo,3,5\n")];
        let text = moved(&a, &b, 0.0, 0.0).to_text();
        let row = text.lines().find(|line| line.starts_with("a.csv")).unwrap();
        let cells: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(
            cells,
            ["a.csv", "x", "2", "1", "3", "+2", "66.667", "%", "two"]
        );
        assert!(
            text.ends_with("6 values in 1 file compared, 2 moved\n"),
            "{text}"
        );
        // What only one side has is compared, too: here x of one and of two.
        let diff = moved(
            &[("a.csv", "name,x\none,1\n")],
            &[("a.csv", "name,x\ntwo,1\n")],
            0.0,
            0.0,
        );
        assert_eq!((diff.compared["a.csv"], diff.moved.len()), (4, 4));
    }

    /// A page is drawn from the other files: it tells of nothing that moved, and is not missed.
    #[test]
    fn drawings_are_named_and_move_nothing() {
        let values = ("front.json", r#"{"x": 1}"#);
        let a = [
            values,
            ("report.html", "<p>1</p>"),
            ("map.svg", "<svg/>"),
            ("map.pdf", "1"),
        ];
        let b = [
            values,
            ("report.html", "<p>2</p>"),
            ("map.svg", "<svg/>"),
            ("other.png", "2"),
        ];
        let diff = moved(&a, &b, 0.0, 0.0);
        assert!(diff.is_none(), "{diff:?}");
        assert_eq!(diff.differing_drawings, ["report.html"]);
        let text = diff.to_text();
        assert!(text.contains("drawn differently: report.html\n"), "{text}");
    }
}
