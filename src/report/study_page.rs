//! The page of studies: one HTML file with their statements and figures, without scripts.

use super::evidence_page::{EvidencePageError, PageFigure, PageSection, PageTable, style};
use super::figures::draw::DrawError;
use super::figures::study_figures;
use super::studies::statements_table;
use super::{StudiesResult, StudyResult};
use crate::keyword::Keyword;
use crate::study::Verdict;
use askama::Template;
use std::io::Write;

#[derive(Template)]
#[template(path = "studies.html")]
struct StudiesHtml<'a> {
    title: &'static str,
    style: String,
    version: &'a str,
    verdicts: Vec<&'static str>,
    studies: Vec<PageStudy<'a>>,
}

/// A study in the page.
struct PageStudy<'a> {
    name: &'a str,
    title: &'a str,
    source: &'a str,
    counts: Vec<usize>,
    statements: PageTable,
    notes: Vec<String>,
    /// What is shown beside the statements.
    sections: Vec<PageSection>,
    /// Each with its name in place of a caption.
    figures: Vec<PageFigure>,
}

impl StudiesResult {
    /// Writes the page.
    ///
    /// # Errors
    /// If a figure cannot be drawn, or writing fails.
    pub fn write_page(&self, mut to: impl Write) -> Result<(), EvidencePageError> {
        let studies = self.studies.iter().map(study);
        let page = StudiesHtml {
            title: "Published numbers",
            style: style(),
            version: self.version,
            verdicts: Verdict::ALL.iter().map(|one| one.keyword()).collect(),
            studies: studies.collect::<Result<_, _>>()?,
        };
        Ok(page.write_into(&mut to)?)
    }
}

fn study(study: &StudyResult) -> Result<PageStudy<'_>, DrawError> {
    let figures = study_figures(study).into_iter();
    let figures = figures.map(|(name, chart)| PageFigure::new(name, &chart));
    Ok(PageStudy {
        name: &study.name,
        title: &study.title,
        source: &study.source,
        counts: study.counts().into_iter().map(|(_, count)| count).collect(),
        statements: statements_table(study).into(),
        sections: study.sections().into_iter().map(Into::into).collect(),
        notes: [study.notes.as_slice(), study.disagreements().as_slice()].concat(),
        figures: figures.collect::<Result<_, _>>()?,
    })
}
