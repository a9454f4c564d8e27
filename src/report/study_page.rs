//! The page of studies: one HTML file with their statements and figures, without scripts.

use super::figures::draw::{DrawError, svg};
use super::figures::study_figures;
use super::{StudiesResult, StudyResult};
use crate::keyword::Keyword;
use crate::study::Verdict;
use askama::Template;
use std::io::Write;
use thiserror::Error;

/// Why the page of studies cannot be written.
#[derive(Debug, Error)]
pub enum StudyPageError {
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] DrawError),
    /// The page cannot be written.
    #[error("cannot write the page of studies")]
    Write(#[from] std::io::Error),
}

#[derive(Template)]
#[template(path = "studies.html")]
struct StudiesHtml<'a> {
    title: &'static str,
    style: &'static str,
    version: &'a str,
    verdicts: Vec<&'static str>,
    studies: Vec<StudySection<'a>>,
}

/// A study in the page.
struct StudySection<'a> {
    name: &'a str,
    title: &'a str,
    source: Option<&'a str>,
    counts: Vec<usize>,
    /// The cells of each statement, and whether they are numbers.
    rows: Vec<Vec<(String, bool)>>,
    notes: Vec<String>,
    /// Name and SVG of each figure.
    figures: Vec<(String, String)>,
}

/// Which of the cells of a statement are numbers.
const NUMBERS: [bool; 8] = [false, false, true, true, false, false, false, true];

impl StudiesResult {
    /// Writes the page.
    ///
    /// # Errors
    /// If a figure cannot be drawn, or writing fails.
    pub fn write_page(&self, mut to: impl Write) -> Result<(), StudyPageError> {
        let studies = self.studies.iter().map(section);
        let page = StudiesHtml {
            title: "Published numbers",
            style: include_str!("page/style.css"),
            version: self.version,
            verdicts: Verdict::ALL.iter().map(|one| one.keyword()).collect(),
            studies: studies.collect::<Result<_, _>>()?,
        };
        Ok(page.write_into(&mut to)?)
    }
}

fn section(study: &StudyResult) -> Result<StudySection<'_>, DrawError> {
    let draw = |(name, chart)| {
        let mut bytes = Vec::new();
        svg(&chart, &mut bytes)?;
        Ok((name, String::from_utf8_lossy(&bytes).into_owned()))
    };
    let figures = study_figures(study).into_iter().map(draw);
    let (source, notes) = study.source_and_notes();
    let rows = study.statements().iter();
    Ok(StudySection {
        name: study.name(),
        title: study.title(),
        source,
        counts: study.counts().into_iter().map(|(_, count)| count).collect(),
        rows: rows
            .map(|one| one.cells().into_iter().zip(NUMBERS).collect())
            .collect(),
        notes: [notes, study.disagreements().as_slice()].concat(),
        figures: figures.collect::<Result<_, DrawError>>()?,
    })
}
