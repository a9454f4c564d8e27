//! Tables by column, with the kind of each column, for files and arrays that keep kinds.

use csv::Writer;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::io;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Numbers.
    Real,
    /// Whole numbers.
    Integer,
    /// Truth values.
    Truth,
    /// Texts.
    Text,
}

/// Columns of whole numbers, by their names in the tables of the program.
const INTEGERS: [&str; 12] = [
    "evaluations",
    "feasible",
    "front_size",
    "generation",
    "index",
    "least_visible",
    "outages",
    "phasing",
    "planes",
    "satellites",
    "satellites_per_plane",
    "seed",
];

/// Columns of truth values.
const TRUTHS: [&str; 3] = ["chosen", "longest_outage_cut", "outage_cut"];

/// Columns of texts.
const TEXTS: [&str; 6] = ["design", "error", "files", "name", "notation", "pattern"];

impl ColumnKind {
    /// The kind of a column of the program's tables, by its name.
    #[must_use]
    pub fn of(name: &str) -> Self {
        match name {
            _ if INTEGERS.contains(&name) => Self::Integer,
            _ if TRUTHS.contains(&name) => Self::Truth,
            _ if TEXTS.contains(&name) => Self::Text,
            _ => Self::Real,
        }
    }
}

/// The values of a column; `None` is a missing one.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValues {
    /// Numbers.
    Real(Vec<Option<f64>>),
    /// Whole numbers.
    Integer(Vec<Option<i64>>),
    /// Truth values.
    Truth(Vec<Option<bool>>),
    /// Texts.
    Text(Vec<Option<String>>),
}

impl ColumnValues {
    /// No values of a kind.
    #[must_use]
    pub fn empty(kind: ColumnKind) -> Self {
        match kind {
            ColumnKind::Real => Self::Real(Vec::new()),
            ColumnKind::Integer => Self::Integer(Vec::new()),
            ColumnKind::Truth => Self::Truth(Vec::new()),
            ColumnKind::Text => Self::Text(Vec::new()),
        }
    }

    /// What the column holds.
    #[must_use]
    pub fn kind(&self) -> ColumnKind {
        match self {
            Self::Real(_) => ColumnKind::Real,
            Self::Integer(_) => ColumnKind::Integer,
            Self::Truth(_) => ColumnKind::Truth,
            Self::Text(_) => ColumnKind::Text,
        }
    }

    /// Number of values, the missing ones included.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Real(of) => of.len(),
            Self::Integer(of) => of.len(),
            Self::Truth(of) => of.len(),
            Self::Text(of) => of.len(),
        }
    }

    /// Whether there is no value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values from texts; numbers that cannot be read as such make a column of texts.
    fn parsed(kind: ColumnKind, cells: Vec<Option<String>>) -> Self {
        fn all<T: std::str::FromStr>(cells: &[Option<String>]) -> Option<Vec<Option<T>>> {
            let parsed = |cell: &Option<String>| match cell {
                Some(text) => text.parse().map(Some).ok(),
                None => Some(None),
            };
            cells.iter().map(parsed).collect()
        }
        let found = match kind {
            ColumnKind::Integer => all(&cells).map(Self::Integer),
            ColumnKind::Real => all(&cells).map(Self::Real),
            ColumnKind::Truth => all(&cells).map(Self::Truth),
            ColumnKind::Text => None,
        };
        found.unwrap_or(Self::Text(cells))
    }

    /// A value as JSON; null where it is missing.
    #[must_use]
    pub fn value(&self, row: usize) -> Value {
        match self {
            Self::Real(of) => of[row].into(),
            Self::Integer(of) => of[row].into(),
            Self::Truth(of) => of[row].into(),
            Self::Text(of) => of[row].as_deref().into(),
        }
    }

    /// A value in the shortest digits that round-trip; empty where it is missing.
    fn cell(&self, row: usize) -> String {
        fn shown<T: ToString>(value: Option<&T>) -> String {
            value.map_or_else(String::new, T::to_string)
        }
        match self {
            Self::Real(of) => shown(of[row].as_ref()),
            Self::Integer(of) => shown(of[row].as_ref()),
            Self::Truth(of) => shown(of[row].as_ref()),
            Self::Text(of) => of[row].clone().unwrap_or_default(),
        }
    }

    fn hash(&self, hash: &mut Sha256) {
        fn each<T>(hash: &mut Sha256, of: &[Option<T>], bytes: impl Fn(&T) -> Vec<u8>) {
            for value in of {
                match value {
                    None => hash.update([0]),
                    Some(value) => {
                        hash.update([1]);
                        hash.update(bytes(value));
                    }
                }
            }
        }
        match self {
            Self::Real(of) => each(hash, of, |value| value.to_bits().to_le_bytes().to_vec()),
            Self::Integer(of) => each(hash, of, |value| value.to_le_bytes().to_vec()),
            Self::Truth(of) => each(hash, of, |value| vec![u8::from(*value)]),
            Self::Text(of) => each(hash, of, |value| {
                let length = (value.len() as u64).to_le_bytes();
                length.into_iter().chain(value.bytes()).collect()
            }),
        }
    }

    /// Adds the values of a column of the same kind; `false` if it is of another.
    pub(crate) fn append(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::Real(of), Self::Real(other)) => of.extend(other),
            (Self::Integer(of), Self::Integer(other)) => of.extend(other),
            (Self::Truth(of), Self::Truth(other)) => of.extend(other),
            (Self::Text(of), Self::Text(other)) => of.extend(other),
            _ => return false,
        }
        true
    }

    /// The first `rows` values, which are taken out.
    fn take_first(&mut self, rows: usize) -> Self {
        fn first<T>(of: &mut Vec<T>, rows: usize) -> Vec<T> {
            let rest = of.split_off(rows.min(of.len()));
            std::mem::replace(of, rest)
        }
        match self {
            Self::Real(of) => Self::Real(first(of, rows)),
            Self::Integer(of) => Self::Integer(first(of, rows)),
            Self::Truth(of) => Self::Truth(first(of, rows)),
            Self::Text(of) => Self::Text(first(of, rows)),
        }
    }
}

/// Named columns of one length.
#[derive(Debug, Clone, PartialEq)]
pub struct TypedColumns {
    names: Vec<String>,
    values: Vec<ColumnValues>,
    rows: usize,
}

impl TypedColumns {
    /// Columns of these names and kinds; a row has a value for each, null where it is missing.
    #[must_use]
    pub fn new(columns: &[(String, ColumnKind)], rows: &[Vec<Value>]) -> Self {
        let column = |(place, (_, kind)): (usize, &(String, ColumnKind))| {
            let cells = rows
                .iter()
                .map(|row| row.get(place).unwrap_or(&Value::Null));
            match kind {
                ColumnKind::Real => ColumnValues::Real(cells.map(Value::as_f64).collect()),
                ColumnKind::Integer => ColumnValues::Integer(cells.map(Value::as_i64).collect()),
                ColumnKind::Truth => ColumnValues::Truth(cells.map(Value::as_bool).collect()),
                ColumnKind::Text => {
                    let text = |cell: &Value| cell.as_str().map(str::to_owned);
                    ColumnValues::Text(cells.map(text).collect())
                }
            }
        };
        Self {
            values: columns.iter().enumerate().map(column).collect(),
            names: columns.iter().map(|(name, _)| name.clone()).collect(),
            rows: rows.len(),
        }
    }

    /// Columns with their names; `None` if they are not of one length.
    #[must_use]
    pub fn of_values(columns: Vec<(String, ColumnValues)>) -> Option<Self> {
        let rows = columns.first().map_or(0, |(_, values)| values.len());
        let is_even = columns.iter().all(|(_, values)| values.len() == rows);
        let (names, values) = columns.into_iter().unzip();
        is_even.then_some(Self {
            names,
            values,
            rows,
        })
    }

    /// The columns of a CSV that the program wrote; lines that begin with `#` are passed over.
    ///
    /// # Errors
    /// If it is not a table.
    pub fn of_csv(text: &str) -> Result<Self, csv::Error> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
        let records = reader.records().collect::<Result<Vec<_>, _>>()?;
        let cell = |record: &csv::StringRecord, place: usize| -> Option<String> {
            let cell = record.get(place).filter(|cell| !cell.is_empty());
            cell.map(str::to_owned)
        };
        let column = |(place, name): (usize, &String)| {
            let cells = records.iter().map(|record| cell(record, place));
            ColumnValues::parsed(ColumnKind::of(name), cells.collect())
        };
        Ok(Self {
            values: names.iter().enumerate().map(column).collect(),
            names,
            rows: records.len(),
        })
    }

    /// The names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The values of the columns, in the order of their names.
    #[must_use]
    pub fn values(&self) -> &[ColumnValues] {
        &self.values
    }

    /// The values of a column.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&ColumnValues> {
        let place = self.names.iter().position(|one| one == name)?;
        self.values.get(place)
    }

    /// The texts of a column; `None` if it is missing or of another kind.
    #[must_use]
    pub fn texts(&self, name: &str) -> Option<&[Option<String>]> {
        match self.get(name)? {
            ColumnValues::Text(of) => Some(of),
            _ => None,
        }
    }

    /// Adds the rows of a table with the same columns; `false` if they are not.
    #[must_use]
    pub fn append(&mut self, other: Self) -> bool {
        let kinds = |table: &Self| -> Vec<ColumnKind> {
            table.values.iter().map(ColumnValues::kind).collect()
        };
        if self.names != other.names || kinds(self) != kinds(&other) {
            return false;
        }
        self.rows += other.rows;
        let pairs = self.values.iter_mut().zip(other.values);
        pairs
            .into_iter()
            .all(|(column, further)| column.append(further))
    }

    /// The first rows, which are taken out; fewer if there are not as many.
    #[must_use]
    pub fn take_first(&mut self, rows: usize) -> Self {
        let rows = rows.min(self.rows);
        self.rows -= rows;
        let values = self.values.iter_mut();
        Self {
            names: self.names.clone(),
            values: values.map(|column| column.take_first(rows)).collect(),
            rows,
        }
    }

    /// SHA-256, hex, of names, kinds and values: the same for the same table in whatever format it is kept.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        hash.update((self.rows as u64).to_le_bytes());
        for (name, values) in self.names.iter().zip(&self.values) {
            hash.update((name.len() as u64).to_le_bytes());
            hash.update(name);
            hash.update([values.kind() as u8]);
            values.hash(&mut hash);
        }
        super::checkpoint::hex(&hash.finalize())
    }

    /// The heading as CSV.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn csv_heading(&self) -> io::Result<String> {
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(&self.names)?;
        super::tables::text(writer)
    }

    /// The rows as CSV, numbers in the shortest digits that round-trip.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn csv_rows(&self) -> io::Result<String> {
        let mut writer = Writer::from_writer(Vec::new());
        for row in 0..self.rows {
            writer.write_record(self.values.iter().map(|column| column.cell(row)))?;
        }
        super::tables::text(writer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn table() -> TypedColumns {
        let names = ["name", "planes", "mean_pdop", "chosen"];
        let columns = names.map(|name| (name.to_owned(), ColumnKind::of(name)));
        let rows = [
            vec![json!("a,\"b\""), json!(13), json!(0.1 + 0.2), json!(true)],
            vec![json!(null), json!(null), json!(null), json!(false)],
            vec![json!("c"), json!(7), json!(-1e-300), json!(null)],
        ];
        TypedColumns::new(&columns, &rows)
    }

    #[test]
    fn csv_keeps_every_value_and_kind() {
        let table = table();
        let text = table.csv_heading().unwrap() + &table.csv_rows().unwrap() + "# a comment\n";
        let read = TypedColumns::of_csv(&text).unwrap();
        assert_eq!(read, table);
        assert_eq!(read.digest(), table.digest());
    }

    #[test]
    fn the_digest_sees_every_bit_and_what_is_missing() {
        let table = table();
        let mut near = table.clone();
        if let ColumnValues::Real(of) = &mut near.values[2] {
            of[0] = of[0].map(f64::next_up);
        }
        let mut zero = table.clone();
        if let ColumnValues::Integer(of) = &mut zero.values[1] {
            of[1] = Some(0);
        }
        assert_ne!(near.digest(), table.digest());
        assert_ne!(zero.digest(), table.digest());
    }

    #[test]
    fn rows_are_added_and_taken_in_their_order() {
        let mut all = table();
        assert!(all.append(table()));
        assert_eq!(all.rows(), 6);
        assert_eq!(all.take_first(3), table());
        assert_eq!(all.take_first(9), table());
        assert_eq!(all.rows(), 0);
        let other = TypedColumns::new(&[("planes".to_owned(), ColumnKind::Integer)], &[]);
        assert!(!all.append(other));
    }
}
