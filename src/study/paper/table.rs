//! The paper's printed values, as data.

use super::PaperError;
use crate::constellation::Design;
use crate::keyword::{Keyword, keywords};
use serde::{Deserialize, Serialize, Serializer};

keywords! {
    /// The kinds of constellation that the paper compares.
    Scheme {
        /// Its own Walker delta designs.
        Proposed = "proposed",
        /// Planes through the poles.
        Polar = "polar",
        /// A star pattern a few degrees off the poles.
        IridiumLike = "iridium-like",
        /// A lattice flower constellation found by a particle swarm.
        OptimizedLfc = "optimized-lfc",
    }
}

impl Serialize for Scheme {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.keyword())
    }
}

/// One row of Table II.
#[derive(Debug, Clone, PartialEq)]
pub struct TableRow {
    /// The kind of constellation.
    pub scheme: Scheme,
    /// Its number within the kind, from 1.
    pub number: u32,
    /// The design with the printed inclination and altitude.
    pub design: Design,
    /// N̄ as printed.
    pub mean_visible: f64,
    /// E(PDOP) as printed.
    pub mean_pdop: f64,
    /// An inclination that gives the printed N̄ (mask 7°, sphere), if the printed one does not.
    pub fitting_inclination_deg: Option<f64>,
}

impl TableRow {
    /// A name that is unique in the table, such as `polar-2`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}-{}", self.scheme, self.number)
    }
}

/// A row as written in the file.
#[derive(Deserialize)]
struct Printed {
    scheme: String,
    number: u32,
    design: String,
    mean_visible: f64,
    mean_pdop: f64,
    fitting_inclination_deg: Option<f64>,
}

/// Table II, in the order of the paper.
///
/// # Errors
/// Never for the built-in file, as a test confirms.
pub fn table2() -> Result<Vec<TableRow>, PaperError> {
    let text = include_str!("../../../data/paper/table2.csv");
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let row = |printed: Result<Printed, csv::Error>| {
        let printed = printed?;
        Ok(TableRow {
            scheme: Scheme::from_keyword(&printed.scheme)?,
            number: printed.number,
            design: printed.design.parse()?,
            mean_visible: printed.mean_visible,
            mean_pdop: printed.mean_pdop,
            fitting_inclination_deg: printed.fitting_inclination_deg,
        })
    };
    reader.deserialize().map(row).collect()
}

/// A relation between two rows that the paper states in words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Percentage {
    /// Name of the line.
    pub name: &'static str,
    /// Which of the two numbers of a row.
    pub of: Printable,
    /// The row that is compared.
    pub row: &'static str,
    /// The row that it is compared with.
    pub with: &'static str,
    /// Change from the second row to the first, percent.
    pub percent: f64,
}

/// The numbers of a row of Table II.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Printable {
    /// N̄.
    MeanVisible,
    /// E(PDOP).
    MeanPdop,
}

/// The percentages of the abstract and of section IV-B(2), all of designs with 182 satellites.
pub const PERCENTAGES: [Percentage; 5] = [
    Percentage {
        name: "mean visible relative to Polar",
        of: Printable::MeanVisible,
        row: "proposed-2",
        with: "polar-2",
        percent: 42.5,
    },
    Percentage {
        name: "mean visible relative to Iridium-like",
        of: Printable::MeanVisible,
        row: "proposed-2",
        with: "iridium-like-2",
        percent: 42.0,
    },
    Percentage {
        name: "mean visible relative to optimized-LFC",
        of: Printable::MeanVisible,
        row: "proposed-2",
        with: "optimized-lfc-2",
        percent: 24.4,
    },
    Percentage {
        name: "mean PDOP relative to Polar",
        of: Printable::MeanPdop,
        row: "proposed-2",
        with: "polar-2",
        percent: -18.9,
    },
    Percentage {
        name: "mean PDOP relative to optimized-LFC",
        of: Printable::MeanPdop,
        row: "proposed-2",
        with: "optimized-lfc-2",
        percent: -10.5,
    },
];

/// One kind of orbit of Table I: name, satellites, inclination (degrees), altitude (km).
pub const TABLE1: [(&str, usize, f64, f64); 3] = [
    ("MEO", 24, 56.0, 21_528.0),
    ("IGSO", 3, 55.0, 35_786.0),
    ("GEO", 3, 0.0, 35_786.0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_eleven_rows_with_unique_names() {
        let rows = table2().unwrap();
        let names: std::collections::BTreeSet<String> = rows.iter().map(TableRow::name).collect();
        assert_eq!((rows.len(), names.len()), (11, 11));
        for percentage in PERCENTAGES {
            assert!(names.contains(percentage.row) && names.contains(percentage.with));
        }
    }

    #[test]
    fn validate_the_percentages_follow_from_the_table() {
        let rows = table2().unwrap();
        let find = |name: &str| rows.iter().find(|row| row.name() == name).unwrap();
        for percentage in PERCENTAGES {
            let value = |name| match percentage.of {
                Printable::MeanVisible => find(name).mean_visible,
                Printable::MeanPdop => find(name).mean_pdop,
            };
            let change = 100.0 * (value(percentage.row) / value(percentage.with) - 1.0);
            // Half of the last printed digit, and the same again for the digits of N̄.
            let name = percentage.name;
            assert!((change - percentage.percent).abs() < 0.1, "{name} {change}");
        }
    }
}
