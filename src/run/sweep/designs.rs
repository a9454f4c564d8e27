//! The designs of a sweep, by their places in it.

use crate::constellation::Design;
use crate::optimize::{OptimizeError, SweepGrid};
use crate::run::evaluations::metrics_of_cells;
use crate::run::typed_columns::TypedColumns;
use crate::search::{DesignProblem, RecordedEvaluation};
use csv::Writer;
use serde::{Deserialize, Serialize};
use std::io;
use std::ops::Range;

/// Designs by which the mean number of satellites is found.
const SPREAD: u64 = 100;

/// A design of a sweep.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweptDesign {
    /// The notation; empty for a vector whose shells are all empty, beside satellites that are fixed.
    pub notation: String,
    /// Its name in a list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// All designs of a sweep.
pub enum SweepDesigns<'a> {
    /// The points of a grid over the search space.
    Space {
        /// The search.
        problem: &'a DesignProblem<'a>,
        /// The grid.
        grid: SweepGrid,
    },
    /// A list.
    List(Vec<SweptDesign>),
}

impl<'a> SweepDesigns<'a> {
    /// Those of the search space, on the steps of its sweep.
    #[must_use]
    pub fn of_space(problem: &'a DesignProblem<'a>) -> Self {
        use crate::optimize::Problem;
        let grid = SweepGrid::new(problem.space(), &problem.designs().steps());
        Self::Space { problem, grid }
    }

    /// Number of points of the grid, or of designs in the list.
    ///
    /// # Errors
    /// If there are more than 2^53.
    pub fn points(&self) -> Result<u64, OptimizeError> {
        match self {
            Self::Space { grid, .. } => grid.count(),
            Self::List(all) => Ok(all.len() as u64),
        }
    }

    /// Mean number of satellites of designs that are spread evenly over the sweep.
    ///
    /// # Errors
    /// If there are more than 2^53 points, or one is repaired to what is not in the space.
    pub fn mean_satellites(&self) -> Result<f64, OptimizeError> {
        let points = self.points()?;
        let some = points.min(SPREAD);
        let mut found = Vec::new();
        for n in 0..some {
            let point = (n as f64 / some as f64 * points as f64) as u64;
            found.extend(self.at(point..point + 1)?);
        }
        let designs = found.iter().filter_map(|one| one.notation.parse().ok());
        let satellites: usize = designs.map(|one: Design| one.satellite_count()).sum();
        Ok(satellites as f64 / found.len().max(1) as f64)
    }

    /// The vectors of the search space at some points, without those that stand for another point.
    ///
    /// # Errors
    /// If a point is repaired to what is not in the space.
    pub fn vectors(&self, points: Range<u64>) -> Result<Vec<Vec<f64>>, OptimizeError> {
        let Self::Space { problem, grid } = self else {
            return Ok(Vec::new());
        };
        let admitted = |point| grid.admitted(*problem, grid.genome(point)).transpose();
        points.filter_map(admitted).collect()
    }

    /// The designs at some points: fewer than points where several are the same design, or cannot be made.
    ///
    /// # Errors
    /// If a point is repaired to what is not in the space.
    pub fn at(&self, points: Range<u64>) -> Result<Vec<SweptDesign>, OptimizeError> {
        match self {
            Self::List(all) => {
                let place = |n| usize::try_from(n).unwrap_or(usize::MAX).min(all.len());
                Ok(all[place(points.start)..place(points.end)].to_vec())
            }
            Self::Space { problem, .. } => {
                let vectors = self.vectors(points)?.into_iter();
                let made = vectors.filter_map(|vector| problem.designs().design(&vector).ok());
                let notation = |design: Option<Design>| SweptDesign {
                    notation: design.map_or_else(String::new, |one| one.to_string()),
                    name: None,
                };
                Ok(made.map(notation).collect())
            }
        }
    }
}

impl SweepDesigns<'_> {
    /// The table of a chunk as evaluations for an optimiser, the designs of a list with their numbers in place of vectors.
    ///
    /// # Errors
    /// If the table is not of the designs at these points, in words.
    pub fn evaluations(
        &self,
        points: Range<u64>,
        table: &TypedColumns,
        problem: &DesignProblem<'_>,
    ) -> Result<Vec<RecordedEvaluation>, String> {
        let wrong = || "it is not of the designs of this sweep".to_owned();
        let first = points.start;
        let vectors = match self {
            Self::List(_) => points.clone().map(|n| vec![n as f64]).collect(),
            Self::Space { .. } => self.vectors(points).map_err(|error| error.to_string())?,
        };
        let notations = table.texts("notation").unwrap_or_default();
        if vectors.len() != notations.len() {
            return Err(format!("{}, from point {}", wrong(), first + 1));
        }
        let pairs = vectors.into_iter().zip(notations).enumerate();
        let evaluation = |(row, (genome, notation)): (usize, (Vec<f64>, &Option<String>))| {
            let names = table.names().iter().map(String::as_str);
            let cells = names.zip(table.values().iter().map(|column| column.value(row)));
            let metrics = metrics_of_cells(cells).map_err(|error| error.to_string())?;
            let notation = notation.as_deref();
            let design = notation.map(str::parse::<Design>).transpose();
            let design = design.map_err(|error| error.to_string())?;
            let evaluated = metrics.map(|metrics| (design, metrics));
            Ok(RecordedEvaluation {
                violation: problem.evaluation(evaluated.as_ref()).violation,
                genome,
                evaluated,
            })
        };
        pairs.map(evaluation).collect()
    }
}

/// The list of a sweep as a table.
///
/// # Errors
/// Never for a list in memory.
pub fn designs_csv(designs: &[SweptDesign]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(["design", "name"])?;
    for one in designs {
        writer.write_record([
            one.notation.as_str(),
            one.name.as_deref().unwrap_or_default(),
        ])?;
    }
    crate::run::tables::text(writer)
}

/// The list in such a table.
///
/// # Errors
/// If it is none.
pub fn read_designs(bytes: &[u8]) -> Result<Vec<SweptDesign>, csv::Error> {
    let mut reader = csv::Reader::from_reader(bytes);
    let record = |record: Result<csv::StringRecord, csv::Error>| {
        let record = record?;
        let cell = |place| record.get(place).unwrap_or_default().to_owned();
        Ok(SweptDesign {
            notation: cell(0),
            name: Some(cell(1)).filter(|name| !name.is_empty()),
        })
    };
    reader.records().map(record).collect()
}
