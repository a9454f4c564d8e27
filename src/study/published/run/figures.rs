//! The data of the figures of a study.

use super::{StudyRun, StudyRunError, Under};
use crate::evaluate::EpochMetrics;
use crate::optimize::fuzzy;
use crate::search::Quantity;
use crate::study::published::StudyKeys;
use crate::study::published::steps::{StudyFigure, StudyPlot, StudyReference, rows_of};

/// A figure of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundFigure {
    /// Stem of its files.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What is drawn.
    pub data: FigureData,
}

/// What a figure shows.
#[derive(Debug, Clone, PartialEq)]
pub enum FigureData {
    /// Designs in the plane of the two objectives.
    Objectives {
        /// The objectives.
        objectives: [Quantity; 2],
        /// The designs.
        places: Vec<PlacedDesign>,
    },
    /// The distribution of the mean visible satellites over the instants.
    VisibleDistribution(Vec<Curve>),
    /// The maximum PDOP over time.
    MaxPdopCourse(Vec<Curve>),
}

/// A design in the plane of the objectives, with its fuzzy memberships over its set.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedDesign {
    /// `table` for what the study states, `search` for all that its searches found.
    pub set: &'static str,
    /// The group of its row, or the search.
    pub scheme: String,
    /// Where it is stated: the table.
    pub table: Option<String>,
    /// Walker notation.
    pub design: String,
    /// The objectives.
    pub objectives: [f64; 2],
    /// The worst-case membership over the objectives.
    pub membership: f64,
    /// The normalised sum of memberships.
    pub membership_sum: f64,
}

/// The time series of one design.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the figure.
    pub name: String,
    /// Walker notation.
    pub design: String,
    /// Instant by instant.
    pub epochs: Vec<EpochMetrics>,
}

impl Curve {
    /// The mean visible satellites of all instants in ascending order: the abscissae of their distribution function,
    /// which rises in equal steps.
    #[must_use]
    pub fn sorted_visible(&self) -> Vec<f64> {
        let mut visible: Vec<f64> = self.epochs.iter().map(|epoch| epoch.mean_visible).collect();
        visible.sort_by(f64::total_cmp);
        visible
    }
}

/// A design to be placed: set, scheme, table and notation.
type ToPlace = (&'static str, String, Option<String>, String);

impl StudyRun<'_> {
    pub(super) fn figures(&mut self) -> Result<Vec<FoundFigure>, StudyRunError> {
        let study = self.study;
        let figures = study.figures.iter();
        figures.map(|figure| self.figure(figure)).collect()
    }

    fn figure(&mut self, figure: &StudyFigure) -> Result<FoundFigure, StudyRunError> {
        let data = match figure.plot {
            StudyPlot::Objectives => self.places(figure)?,
            StudyPlot::VisibleDistribution => FigureData::VisibleDistribution(self.drawn(figure)?),
            StudyPlot::MaxPdopCourse => FigureData::MaxPdopCourse(self.drawn(figure)?),
        };
        Ok(FoundFigure {
            name: figure.name.clone(),
            title: figure.title.clone(),
            data,
        })
    }

    fn drawn(&mut self, figure: &StudyFigure) -> Result<Vec<Curve>, StudyRunError> {
        let place = self.world(None, &StudyKeys::default())?;
        let mut curves = Vec::new();
        for text in &figure.of {
            curves.extend(self.curves(place, text, Under::Scenario, figure.line)?);
        }
        Ok(curves)
    }

    /// The time series of the constellations of a reference; of a search its fuzzy pick, if there is one.
    pub(super) fn curves(
        &mut self,
        place: usize,
        text: &str,
        under: Under<'_>,
        line: usize,
    ) -> Result<Vec<Curve>, StudyRunError> {
        let mut curves = Vec::new();
        for (name, of) in self.named(text, under) {
            let of = match StudyReference::of(&of) {
                StudyReference::Search(search) => {
                    let set = self.searches.iter().find(|set| set.name == search);
                    match set.and_then(super::FoundSet::pick) {
                        Some(pick) => pick.design.to_string(),
                        None => continue,
                    }
                }
                _ => of,
            };
            let (evaluator, _, measured) = self.measured(place, &of, line)?;
            curves.push(Curve {
                epochs: evaluator.series(&measured.ephemeris)?.epochs,
                name,
                design: of,
            });
        }
        Ok(curves)
    }

    fn places(&mut self, figure: &StudyFigure) -> Result<FigureData, StudyRunError> {
        let place = self.world(None, &StudyKeys::default())?;
        let Ok(objectives) =
            <[Quantity; 2]>::try_from(self.worlds[place].scenario.objectives.minimize.as_slice())
        else {
            let reason = "plot: the plane of the objectives needs objectives.minimize of two";
            return Err(self.study.wrong_at(figure.line, reason.to_owned()));
        };
        let mut sets: [Vec<(ToPlace, [f64; 2])>; 2] = Default::default();
        for text in &figure.of {
            for one in self.to_place(text) {
                let point = self.objectives(place, &one.3, figure.line)?;
                if let Some(&[x, y]) = point.as_deref() {
                    let set = usize::from(one.0 == "search");
                    let shown = [objectives[0].minimised(x), objectives[1].minimised(y)];
                    sets[set].push((one, shown));
                }
            }
        }
        let mut places = Vec::new();
        for set in sets {
            places.extend(placed(set, objectives)?);
        }
        Ok(FigureData::Objectives { objectives, places })
    }

    fn to_place(&self, text: &str) -> Vec<ToPlace> {
        if let StudyReference::Search(name) = StudyReference::of(text) {
            let members = self.members(name).into_iter();
            return members
                .map(|design| ("search", name.to_owned(), None, design))
                .collect();
        }
        let tables = &self.study.tables;
        let rows = rows_of(tables, text).into_iter();
        let row = rows.map(|row| {
            let table = tables.iter().find(|table| table.rows.contains(row));
            let scheme = row.group.clone().unwrap_or_else(|| row.name.clone());
            let table = table.map(|table| table.name.clone());
            ("table", scheme, table, row.of.clone())
        });
        let found: Vec<ToPlace> = row.collect();
        match found.is_empty() {
            true => vec![("table", text.to_owned(), None, text.to_owned())],
            false => found,
        }
    }
}

/// Designs with their memberships over all of them.
fn placed(
    designs: Vec<(ToPlace, [f64; 2])>,
    objectives: [Quantity; 2],
) -> Result<Vec<PlacedDesign>, StudyRunError> {
    if designs.is_empty() {
        return Ok(Vec::new());
    }
    let minimised = |[x, y]: [f64; 2]| [objectives[0].minimised(x), objectives[1].minimised(y)];
    let points: Vec<[f64; 2]> = designs.iter().map(|(_, point)| minimised(*point)).collect();
    let memberships = fuzzy(&points)?;
    let values = memberships.minimum.iter().zip(&memberships.share);
    let place = |(((set, scheme, table, design), objectives), (&membership, &membership_sum)): (
        (ToPlace, [f64; 2]),
        _,
    )| PlacedDesign {
        set,
        scheme,
        table,
        design,
        objectives,
        membership,
        membership_sum,
    };
    Ok(designs.into_iter().zip(values).map(place).collect())
}
