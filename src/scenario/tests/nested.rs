//! What declarations can carry beyond the present keys: lists of tables, tables with free names, and
//! values of one type or another. A rule for each is all that it takes; they move to `rule/` with
//! the first key that needs them, as [`SectionTable`] and [`ListOf`] did.

use std::collections::BTreeMap;

use serde_json::{Value as Json, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scenario::keys::{list, paths, section};
use crate::scenario::problem::{ProblemList, Problems};
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Integer, ListOf, Node, Number, OneOf, Reading, Rule, SectionTable};
use crate::scenario::source::{Source, TableSources};
use crate::scenario::{KeyDescription, Pattern};

section! {
    /// A shell of a constellation.
    #[derive(Debug, Clone, PartialEq)]
    struct Shell in "search.shells", finish check_shell {
        /// Number of planes.
        pub planes: u32 = Integer { low: 1, high: 40 }, default 3;
        /// Altitude over the equatorial radius.
        pub altitude_km: f64 = Number::above(0.0), unit "km", default 500.0;
    }
}

fn check_shell(shell: &mut Shell, reader: &mut Reader<'_>) {
    let count = f64::from(shell.planes) * shell.altitude_km;
    let keys = paths::<Shell>();
    reader.at_most(40_000, count, "planes times kilometres", &keys);
}

section! {
    /// Keys of every nested kind.
    #[derive(Debug, Clone, PartialEq)]
    struct Nested in "search" {
        /// A list of tables.
        pub shells: Vec<Shell> = ListOf(SectionTable::new()), default Vec::new();
        /// Tables with free names.
        pub constellations: BTreeMap<String, Shell> = Named(SectionTable::new()),
            default BTreeMap::new();
        /// A word or a table.
        pub design: Either<Pattern, Shell> = OneOrOther(OneOf::new(), SectionTable::new()),
            default Either::One(Pattern::Delta);
        /// A list of words or a single word.
        pub patterns: Either<Vec<Pattern>, Pattern> =
            OneOrOther(ListOf(OneOf::new()), OneOf::new()), default Either::Other(Pattern::Star);
    }
}

/// A table with free names.
struct Named<R>(R);

impl<R: Rule> Rule for Named<R> {
    type Value = BTreeMap<String, R::Value>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        let Some(table) = node.get_ref().as_table() else {
            reading.refuse(node);
            return None;
        };
        let each = table.iter();
        let values: Vec<(String, Option<R::Value>)> = each
            .map(|(name, node)| (name.get_ref().to_string(), self.0.read(node, reading)))
            .collect();
        let values = values.into_iter();
        values.map(|(name, value)| Some((name, value?))).collect()
    }

    fn accepted(&self) -> String {
        format!("names, each with {}", self.0.accepted())
    }

    fn schema(&self) -> Json {
        json!({ "type": "object", "additionalProperties": self.0.schema() })
    }

    fn write(&self, value: &Self::Value) -> String {
        let each = value.iter();
        let each: Vec<String> = each
            .map(|(name, value)| format!("{name} = {}", self.0.write(value)))
            .collect();
        format!("{{ {} }}", each.join(", "))
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Either<A, B> {
    One(A),
    Other(B),
}

/// What the first rule accepts, or the second; the type of the value decides which.
struct OneOrOther<A, B>(A, B);

impl<A: Rule, B: Rule> Rule for OneOrOther<A, B> {
    type Value = Either<A::Value, B::Value>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        let is_plain = |node: &Node<'_>| !node.get_ref().is_table() && !node.get_ref().is_array();
        let other_is_plain = self.1.schema()["type"].is_null();
        if is_plain(node) == other_is_plain {
            self.1.read(node, reading).map(Either::Other)
        } else {
            self.0.read(node, reading).map(Either::One)
        }
    }

    fn accepted(&self) -> String {
        format!("{}, or {}", self.0.accepted(), self.1.accepted())
    }

    fn schema(&self) -> Json {
        json!({ "oneOf": [self.0.schema(), self.1.schema()] })
    }

    fn write(&self, value: &Self::Value) -> String {
        match value {
            Either::One(value) => self.0.write(value),
            Either::Other(value) => self.1.write(value),
        }
    }
}

fn read(text: &str) -> Result<Nested, Problems> {
    let source = Source::file("nested.toml", text);
    let table = DeTable::parse(text).unwrap();
    let node = Spanned::new(0..text.len(), DeValue::Table(table.into_inner()));
    let rule = SectionTable::<Nested>::new();
    let mut report = ProblemList::default();
    let mut reading = Reading {
        source: &source,
        parts: &TableSources::new(),
        key: "search".to_owned(),
        accepted: rule.accepted(),
        report: &mut report,
    };
    rule.read(&node, &mut reading).ok_or_else(|| report.into())
}

const TEXT: &str = "\
design = { planes = 5 }
patterns = [\"delta\", \"star\"]
[[shells]]
planes = 2
[[shells]]
altitude-km = 900
[constellations]
low = { planes = 7, altitude-km = 400.5 }
";

#[test]
fn nested_keys_are_read_and_written() {
    let nested = read(TEXT).unwrap();
    let shell = |planes, altitude_km| Shell {
        planes,
        altitude_km,
    };
    assert_eq!(nested.shells, [shell(2, 500.0), shell(3, 900.0)]);
    assert_eq!(nested.constellations["low"], shell(7, 400.5));
    assert_eq!(nested.design, Either::Other(shell(5, 500.0)));
    let both = vec![Pattern::Delta, Pattern::Star];
    assert_eq!(nested.patterns, Either::One(both));
    let written = SectionTable::<Nested>::new().write(&nested);
    let inner = written.trim_start_matches('{').trim_end_matches('}');
    let lines = inner.replace(", constellations", "\nconstellations");
    let lines = lines.replace(", design", "\ndesign");
    assert_eq!(read(&lines.replace(", patterns", "\npatterns")), Ok(nested));
}

#[test]
fn nested_problems_are_reported_all_at_once_where_they_are() {
    let text = TEXT.replace("planes = 2", "planes = 0\naltitude = 3");
    let text = text.replace(
        "planes = 7, altitude-km = 400.5",
        "planes = 40, altitude-km = 1001",
    );
    let problems = read(&text).unwrap_err();
    let lines: Vec<String> = problems.as_slice().iter().map(|p| p.to_string()).collect();
    assert_eq!(
        lines,
        [
            "nested.toml:4: search.shells.1.planes: found 0, expected an integer >= 1 and <= 40",
            "nested.toml:5: search.shells.1.altitude: unknown key, did you mean `altitude-km`? \
             (choices: planes, altitude-km)",
            "nested.toml:9: search.constellations.planes: 40040 planes times kilometres, expected at most 40000",
        ]
    );
}

#[test]
fn nested_keys_are_described() {
    let keys = list::<Nested>();
    let described: Vec<&KeyDescription> = keys.iter().map(|key| &key.description).collect();
    let shells = described[0];
    assert_eq!(
        shells.accepted,
        "a list, each a table of planes, altitude-km"
    );
    assert_eq!(
        (shells.meaning, shells.shown.as_str()),
        ("A list of tables", "[]")
    );
    assert_eq!(described[2].shown, "\"delta\"");
    let planes = &keys[0].schema["items"]["properties"]["planes"];
    assert_eq!(planes["description"], "Number of planes");
    assert_eq!(planes["default"], 3);
}
