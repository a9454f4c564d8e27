//! The values of a file and their places.

use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt;
use thiserror::Error;

/// Keys that say what an object of a list, or a row of a table, is of; the first that all have, with different values.
const KEYS: [&str; 7] = [
    "design",
    "notation",
    "name",
    "satellite",
    "seed",
    "elapsed_s",
    "generation",
];
/// What says where a file comes from and not what was found; a directory has it in its provenance.
const IDENTITY: [&str; 3] = ["version", "scenario", "scenario_hash"];
/// Where something stands in a list says nothing where it has a key.
const NUMBER_IN_LIST: &str = "index";

/// A file that is compared.
#[derive(Debug, Clone, PartialEq)]
pub enum ResultFile {
    /// A JSON file, or a scenario.
    Tree(Value),
    /// A table: its columns, and its rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A page or a figure, which is drawn from other files.
    Drawing(Vec<u8>),
    /// Anything else, by its bytes.
    Other(Vec<u8>),
}

/// The ends of the names of pages and figures.
const DRAWINGS: [&str; 5] = ["html", "htm", "svg", "pdf", "png"];

/// Why a file cannot be read as what its name says.
#[derive(Debug, Error)]
pub enum ResultFileError {
    /// It is not JSON.
    #[error("it is not JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// It is not TOML.
    #[error("it is not TOML: {0}")]
    Toml(#[from] toml::de::Error),
    /// It is not CSV.
    #[error("it is not CSV: {0}")]
    Csv(#[from] csv::Error),
    /// It is not UTF-8.
    #[error("it is not UTF-8 text")]
    Text(#[from] std::str::Utf8Error),
}

impl ResultFile {
    /// Reads a file; its name says as what.
    ///
    /// # Errors
    /// If it is not what its name says.
    pub fn read(name: &str, bytes: Vec<u8>) -> Result<Self, ResultFileError> {
        Ok(match name.rsplit_once('.').map(|(_, end)| end) {
            Some("json") => Self::Tree(serde_json::from_slice(&bytes)?),
            Some("toml") => Self::Tree(toml::from_str(std::str::from_utf8(&bytes)?)?),
            Some("csv") => Self::table(std::str::from_utf8(&bytes)?)?,
            Some(end) if DRAWINGS.contains(&end) => Self::Drawing(bytes),
            _ => Self::Other(bytes),
        })
    }

    /// Reads a table as CSV, whose lines that begin with `#` are passed over.
    ///
    /// # Errors
    /// If it is not a table.
    pub fn table(csv: &str) -> Result<Self, ResultFileError> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(csv.as_bytes());
        let columns = reader.headers()?.iter().map(str::to_owned).collect();
        let row = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
        let rows = reader.records().map(|record| Ok(row(record?)));
        Ok(Self::Table(
            columns,
            rows.collect::<Result<_, ResultFileError>>()?,
        ))
    }

    /// Its values with their places; `None` if it is compared by its bytes.
    pub(super) fn values(&self) -> Option<Vec<(ValuePlace, Leaf)>> {
        let mut values = Vec::new();
        match self {
            Self::Tree(tree) => add(tree, &ValuePlace::default(), &mut values),
            Self::Table(columns, rows) => add_rows(columns, rows, &mut values),
            Self::Drawing(_) | Self::Other(_) => return None,
        }
        Some(values)
    }

    /// Whether it is a page or a figure.
    #[must_use]
    pub fn is_drawing(&self) -> bool {
        matches!(self, Self::Drawing(_))
    }
}

/// Where a value is.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ValuePlace {
    pub(super) quantity: String,
    /// What it is of, from the outermost list on.
    pub(super) of: String,
}

impl ValuePlace {
    fn key(&self, key: &str) -> Self {
        Self {
            quantity: joined(&self.quantity, ".", key),
            of: self.of.clone(),
        }
    }

    fn item(&self, key: &str) -> Self {
        Self {
            quantity: self.quantity.clone(),
            of: joined(&self.of, " / ", key),
        }
    }
}

fn joined(before: &str, between: &str, after: &str) -> String {
    match before {
        "" => after.to_owned(),
        before => format!("{before}{between}{after}"),
    }
}

/// A single value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Leaf {
    /// A number, and how it is written.
    Number(f64, String),
    /// Anything else.
    Text(String),
}

impl Leaf {
    fn of(text: &str) -> Self {
        match text.parse() {
            Ok(number) => Self::Number(number, text.to_owned()),
            Err(_) => Self::Text(text.to_owned()),
        }
    }
}

impl fmt::Display for Leaf {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(_, text) | Self::Text(text) => formatter.pad(text),
        }
    }
}

fn add(tree: &Value, place: &ValuePlace, values: &mut Vec<(ValuePlace, Leaf)>) {
    match tree {
        Value::Object(members) => {
            let is_outermost = *place == ValuePlace::default();
            let counted = members
                .iter()
                .filter(|(key, _)| !(is_outermost && IDENTITY.contains(&key.as_str())));
            for (key, member) in counted {
                add(member, &place.key(key), values);
            }
        }
        Value::Array(items) => {
            let keys = keys_of(items);
            for (n, item) in items.iter().enumerate() {
                match (&keys, item) {
                    (Some(keys), Value::Object(members)) => {
                        let place = place.item(&keys[n]);
                        for (key, member) in
                            members.iter().filter(|(key, _)| *key != NUMBER_IN_LIST)
                        {
                            add(member, &place.key(key), values);
                        }
                    }
                    _ => add(item, &place.item(&(n + 1).to_string()), values),
                }
            }
        }
        Value::Null => values.push((place.clone(), Leaf::Text("none".to_owned()))),
        Value::Number(number) => values.push((place.clone(), Leaf::of(&number.to_string()))),
        Value::String(text) => values.push((place.clone(), Leaf::Text(text.clone()))),
        Value::Bool(is) => values.push((place.clone(), Leaf::Text(is.to_string()))),
    }
}

/// What the objects of a list are of, if one key says it.
fn keys_of(items: &[Value]) -> Option<Vec<String>> {
    KEYS.iter().find_map(|key| {
        let of = |item: &Value| match item.get(key)? {
            Value::String(text) => Some(text.clone()),
            Value::Object(design) => Some(design.get("notation")?.as_str()?.to_owned()),
            Value::Number(number) => Some(number.to_string()),
            _ => None,
        };
        let keys: Vec<String> = items.iter().map(of).collect::<Option<_>>()?;
        are_different(&keys).then_some(keys)
    })
}

fn are_different(keys: &[String]) -> bool {
    keys.iter().collect::<BTreeSet<_>>().len() == keys.len()
}

fn add_rows(columns: &[String], rows: &[Vec<String>], values: &mut Vec<(ValuePlace, Leaf)>) {
    let keys = KEYS.iter().find_map(|key| {
        let at = columns.iter().position(|column| column == key)?;
        let keys: Vec<String> = rows.iter().map(|row| row[at].clone()).collect();
        are_different(&keys).then_some(keys)
    });
    for (n, row) in rows.iter().enumerate() {
        let of = match &keys {
            Some(keys) => keys[n].clone(),
            None => format!("row {}", n + 1),
        };
        let cells = columns.iter().zip(row);
        let cells = cells.filter(|(column, _)| keys.is_none() || *column != NUMBER_IN_LIST);
        values.extend(cells.map(|(column, cell)| {
            let quantity = column.clone();
            let of = of.clone();
            (ValuePlace { quantity, of }, Leaf::of(cell))
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(name: &str, text: &str) -> Vec<String> {
        let document = ResultFile::read(name, text.as_bytes().to_vec()).unwrap();
        let values = document.values().unwrap().into_iter();
        values
            .map(|(place, leaf)| format!("{} [{}] {leaf}", place.quantity, place.of))
            .collect()
    }

    #[test]
    fn lists_are_matched_by_what_their_items_are_of() {
        let front = r#"{"version": "1", "front": [
            {"index": 1, "design": {"notation": "delta:55:6/3/1@925"}, "metrics": {"mean_pdop": 1.5, "gain": null}}]}"#;
        assert_eq!(
            places("front.json", front),
            [
                "front.design.notation [delta:55:6/3/1@925] delta:55:6/3/1@925",
                "front.metrics.gain [delta:55:6/3/1@925] none",
                "front.metrics.mean_pdop [delta:55:6/3/1@925] 1.5",
            ]
        );
        // Two of one name are told apart by their place.
        assert_eq!(
            places(
                "a.json",
                r#"[{"name": "x", "v": 1}, {"name": "x", "v": 2}]"#
            ),
            ["name [1] x", "v [1] 1", "name [2] x", "v [2] 2"]
        );
    }

    #[test]
    fn tables_are_matched_by_their_first_key() {
        assert_eq!(
            places(
                "a.csv",
                "# note\nindex,design,mean_pdop\n1,star,1.25\n2,delta,\n"
            ),
            [
                "design [star] star",
                "mean_pdop [star] 1.25",
                "design [delta] delta",
                "mean_pdop [delta] "
            ]
        );
        assert_eq!(
            places("a.csv", "index,x\n7,2\n"),
            ["index [row 1] 7", "x [row 1] 2"]
        );
    }

    #[test]
    fn what_is_not_what_its_name_says_is_refused() {
        for (name, text) in [("a.json", "{"), ("a.toml", "x = "), ("a.csv", "a,b\n1\n")] {
            assert!(
                ResultFile::read(name, text.as_bytes().to_vec()).is_err(),
                "{name}"
            );
        }
        assert!(ResultFile::read("a.csv", vec![0xff, 0xfe]).is_err());
    }
}
