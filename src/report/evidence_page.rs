//! Pages without scripts, to read on the screen or to print: an answer, figures, and tables.

use super::Table;
use super::figures::Chart;
use super::figures::draw::{DrawError, Sheet, inline_svg, typeface_rule};
use super::section::{Headline, ReportSection};
use askama::Template;
use std::io::Write;
use thiserror::Error;

/// Why a page of evidence cannot be written.
#[derive(Debug, Error)]
pub enum EvidencePageError {
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] DrawError),
    /// The page cannot be written.
    #[error("cannot write the page")]
    Write(#[from] std::io::Error),
}

/// The style of these pages, with the typeface of the figures.
pub(super) fn style() -> String {
    let sheets = concat!(
        include_str!("page/style.css"),
        include_str!("page/evidence.css")
    );
    sheets.to_owned() + &typeface_rule()
}

/// A figure of a page with what it shows.
pub(super) struct PageFigure {
    pub(super) caption: String,
    pub(super) svg: String,
}

impl PageFigure {
    pub(super) fn new(caption: String, chart: &Chart) -> Result<Self, DrawError> {
        let mut bytes = Vec::new();
        inline_svg(chart, Sheet::default(), &mut bytes)?;
        Ok(Self {
            caption,
            svg: String::from_utf8_lossy(&bytes).into_owned(),
        })
    }
}

/// A table of a page: headings and cells, and whether they are numbers.
pub(super) struct PageTable {
    pub(super) headings: Vec<(String, bool)>,
    pub(super) rows: Vec<Vec<(String, bool)>>,
}

impl From<Table> for PageTable {
    fn from(table: Table) -> Self {
        let are_numbers: Vec<bool> = table.are_numbers().collect();
        let headings = table.headings().map(str::to_owned);
        let rows = table.cells();
        Self {
            headings: headings.zip(are_numbers.clone()).collect(),
            rows: rows
                .map(|row| row.iter().cloned().zip(are_numbers.clone()).collect())
                .collect(),
        }
    }
}

/// A section of a page.
pub(super) struct PageSection {
    pub(super) title: String,
    pub(super) caption: String,
    pub(super) table: PageTable,
    pub(super) remarks: Vec<String>,
}

impl From<ReportSection> for PageSection {
    fn from(section: ReportSection) -> Self {
        Self {
            title: section.title,
            caption: section.caption,
            table: section.table.into(),
            remarks: section.remarks,
        }
    }
}

#[derive(Template)]
#[template(path = "evidence.html")]
struct EvidenceHtml {
    title: String,
    style: String,
    headline: Headline,
    figures: Vec<PageFigure>,
    sections: Vec<PageSection>,
}

/// Writes a page with an answer, figures with their captions, and tables.
pub(super) fn write_evidence(
    headline: Headline,
    figures: Vec<(String, Chart)>,
    sections: Vec<ReportSection>,
    mut to: impl Write,
) -> Result<(), EvidencePageError> {
    let figures = figures.into_iter();
    let figures = figures.map(|(caption, chart)| PageFigure::new(caption, &chart));
    let page = EvidenceHtml {
        title: headline.title.clone(),
        style: style(),
        headline,
        figures: figures.collect::<Result<_, _>>()?,
        sections: sections.into_iter().map(Into::into).collect(),
    };
    Ok(page.write_into(&mut to)?)
}
