//! The page of a validation: what a reviewer reads on the screen or prints, without scripts.

use super::figures::draw::{DrawError, Sheet, inline_svg};
use super::figures::{Chart, residual_figures};
use super::validation::{AppendixSection, Headline, headline, sections};
use crate::run::ValidateResult;
use askama::Template;
use std::io::Write;
use thiserror::Error;

/// Why the page of a validation cannot be written.
#[derive(Debug, Error)]
pub enum ValidationPageError {
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] DrawError),
    /// The page cannot be written.
    #[error("cannot write the page of the validation")]
    Write(#[from] std::io::Error),
}

#[derive(Template)]
#[template(path = "validation.html")]
struct ValidationHtml {
    style: &'static str,
    headline: Headline,
    /// Caption and SVG.
    figures: Vec<(&'static str, String)>,
    sections: Vec<PageSection>,
}

/// A section with the cells of its table, and whether they are numbers.
struct PageSection {
    title: String,
    caption: &'static str,
    headings: Vec<(String, bool)>,
    rows: Vec<Vec<(String, bool)>>,
    remarks: Vec<String>,
}

impl From<AppendixSection> for PageSection {
    fn from(section: AppendixSection) -> Self {
        let are_numbers: Vec<bool> = section.table.are_numbers().collect();
        let headings = section.table.headings().map(str::to_owned);
        let rows = section.table.cells();
        Self {
            headings: headings.zip(are_numbers.clone()).collect(),
            rows: rows
                .map(|row| row.iter().cloned().zip(are_numbers.clone()).collect())
                .collect(),
            title: section.title,
            caption: section.caption,
            remarks: section.remarks,
        }
    }
}

/// Writes the page of a validation.
///
/// # Errors
/// If a figure cannot be drawn, or writing fails.
pub fn write_validation_page(
    result: &ValidateResult,
    mut to: impl Write,
) -> Result<(), ValidationPageError> {
    let draw = |(caption, chart): (&'static str, Chart)| {
        let mut bytes = Vec::new();
        inline_svg(&chart, Sheet::default(), &mut bytes)?;
        Ok((caption, String::from_utf8_lossy(&bytes).into_owned()))
    };
    let figures = residual_figures(result).into_iter().map(draw);
    let page = ValidationHtml {
        style: include_str!("page/style.css"),
        headline: headline(result),
        figures: figures.collect::<Result<_, DrawError>>()?,
        sections: sections(result).into_iter().map(Into::into).collect(),
    };
    Ok(page.write_into(&mut to)?)
}
