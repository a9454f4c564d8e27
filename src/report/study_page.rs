//! The page of studies: one HTML file with their statements and figures, without scripts.

use super::figures::draw::{DrawError, Sheet, inline_svg};
use super::figures::study_figures;
use super::study_sections::StudySectionTable;
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
    source: &'a str,
    counts: Vec<usize>,
    /// The cells of each statement, and whether they are numbers.
    rows: Vec<Vec<(String, bool)>>,
    notes: Vec<String>,
    /// What is shown beside the statements.
    sections: Vec<PageTable>,
    /// Name and SVG of each figure.
    figures: Vec<(String, String)>,
}

/// A table of a study in the page: headings and cells, and whether they are numbers.
struct PageTable {
    title: String,
    caption: String,
    headings: Vec<(String, bool)>,
    rows: Vec<Vec<(String, bool)>>,
}

impl From<StudySectionTable> for PageTable {
    fn from(section: StudySectionTable) -> Self {
        let are_numbers: Vec<bool> = section.table.are_numbers().collect();
        let headings = section.table.headings().map(str::to_owned);
        let rows = section.table.cells();
        Self {
            title: section.title,
            caption: section.caption,
            headings: headings.zip(are_numbers.clone()).collect(),
            rows: rows
                .map(|row| row.iter().cloned().zip(are_numbers.clone()).collect())
                .collect(),
        }
    }
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
        inline_svg(&chart, Sheet::default(), &mut bytes)?;
        Ok((name, String::from_utf8_lossy(&bytes).into_owned()))
    };
    let figures = study_figures(study).into_iter().map(draw);
    let rows = study.statements.iter();
    Ok(StudySection {
        name: &study.name,
        title: &study.title,
        source: &study.source,
        counts: study.counts().into_iter().map(|(_, count)| count).collect(),
        rows: rows
            .map(|one| one.cells().into_iter().zip(NUMBERS).collect())
            .collect(),
        sections: study.sections().into_iter().map(Into::into).collect(),
        notes: [study.notes.as_slice(), study.disagreements().as_slice()].concat(),
        figures: figures.collect::<Result<_, DrawError>>()?,
    })
}
