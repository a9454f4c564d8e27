//! The page of a run: one self-contained HTML file.
//!
//! Texts and tables are in the page itself; the figures are drawn by the script of the plotly crate
//! from numbers embedded in the page. A click on a design updates everything below it, so the page
//! contains the cuts of all members, packed: maps, series, quantiles and orbit. If the front is too
//! large for that, only some members have them and the page says so.

mod pack;
mod payload;
mod words;

use super::Baseline;
use super::figures::NamedFront;
use super::profile::Profile;
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::printable::printable_json;
use crate::run::Run;
use askama::Template;
use payload::Payload;
use std::io::Write;
use thiserror::Error;
use words::{Best, CheckRow, MemberRow, PageSummary};

/// Why a page cannot be written.
#[derive(Debug, Error)]
pub enum PageError {
    /// The numbers cannot be serialised.
    #[error("cannot write the page's numbers")]
    Numbers(#[from] serde_json::Error),
    /// Writing fails.
    #[error("cannot write the page")]
    Write(#[from] std::io::Error),
}

/// The content of a page.
#[derive(Clone, Copy)]
pub struct Page<'a> {
    /// The run.
    pub run: &'a Run,
    /// Its scenario as written.
    pub scenario_toml: Option<&'a str>,
    /// Computes maps and series; without it the page has none.
    pub evaluator: Option<&'a Evaluator>,
    /// Designs compared with the front, with their objectives.
    pub baselines: &'a [Baseline],
    /// The same designs by name.
    pub beside: &'a [(String, Design)],
    /// Fronts of other runs.
    pub fronts: &'a [NamedFront],
}

/// Maximum bytes for the cuts of the members: with the script for the figures (4.7 MB) the page
/// stays below 6 MB.
const CUTS_BYTES: usize = 900_000;

/// Maximum number of members whose cuts are computed: more would take minutes.
const MOST_CUTS: usize = 100;

/// Maximum number of members in the table.
const MOST_ROWS: usize = 200;

#[derive(Template)]
#[template(path = "report.html")]
struct Html<'a> {
    title: String,
    style: &'static str,
    plotly: &'a str,
    data: String,
    scripts: String,
    summary: PageSummary,
    best: Vec<Best>,
    members: Vec<MemberRow>,
    members_left_out: usize,
    objectives: Vec<String>,
    constraints: Vec<String>,
    checks: Vec<CheckRow>,
    validated: Option<String>,
    conventions: Vec<(&'static str, String)>,
    scenario_toml: Option<&'a str>,
    version: &'static str,
}

/// Writes the page of a run. The same run gives the same bytes.
///
/// # Errors
/// If it cannot be written. A run with gaps gives a page that lists them.
pub fn write(page: &Page<'_>, mut to: impl Write) -> Result<(), PageError> {
    let places = members_with_cuts(page);
    let members = &page.run.front;
    let designs: Vec<Design> = places
        .iter()
        .filter_map(|&n| members[n].design.design())
        .collect();
    let beside: Vec<Design> = page
        .beside
        .iter()
        .map(|(_, design)| design.clone())
        .collect();
    let profiles = |designs: &[Design]| match page.evaluator {
        Some(evaluator) => Profile::of_all(evaluator, designs),
        None => vec![None; designs.len()],
    };
    let payload = Payload::new(page, &places, &profiles(&designs), &profiles(&beside));
    let plotly = plotly::Plot::offline_js_sources();
    let html = Html {
        title: words::title(page.run),
        style: include_str!("page/style.css"),
        plotly: first_script(&plotly),
        data: safe_json(&payload)?,
        scripts: [
            include_str!("page/core.js"),
            include_str!("page/figures.js"),
            include_str!("page/globe.js"),
            include_str!("page/main.js"),
        ]
        .concat(),
        summary: PageSummary::new(page, &places),
        best: words::best(page.run),
        members: words::members(page.run, MOST_ROWS),
        members_left_out: members.len().saturating_sub(MOST_ROWS),
        objectives: page.run.objective_names(),
        constraints: words::further(page.run),
        checks: words::checks(page.run),
        validated: words::validated(page.run),
        conventions: words::conventions(page.run),
        scenario_toml: page.scenario_toml,
        version: crate::run::VERSION,
    };
    Ok(html.write_into(&mut to)?)
}

/// The members whose cuts are in the page, by position: evenly spaced over the front, plus the chosen one.
fn members_with_cuts(page: &Page<'_>) -> Vec<usize> {
    let members = &page.run.front;
    let Some(evaluator) = page.evaluator else {
        return Vec::new();
    };
    let propagated: Vec<usize> = (0..members.len())
        .filter(|&n| members[n].design.design().is_some())
        .collect();
    let setup = evaluator.setup();
    let each = payload::cut_bytes(setup.grid.len(), setup.sites.len());
    let count = (CUTS_BYTES / each)
        .clamp(1, MOST_CUTS)
        .min(propagated.len());
    let at = |k: usize| propagated[k * (propagated.len() - 1) / (count - 1).max(1)];
    let mut places: Vec<usize> = (0..count).map(at).collect();
    if let Some(chosen) = page
        .run
        .chosen()
        .filter(|chosen| propagated.contains(chosen))
        && !places.contains(&chosen)
    {
        places.push(chosen);
        places.sort_unstable();
    }
    places
}

/// The content of the first script in a piece of HTML: in plotly's output that is plotly itself; the
/// second is MathJax, which the page does not need.
fn first_script(html: &str) -> &str {
    let after_tag = html.find('>').map_or(0, |end| end + 1);
    let script = &html[after_tag..];
    &script[..script.find("</script>").unwrap_or(script.len())]
}

/// JSON that is safe in a script element, whatever texts it contains.
fn safe_json(payload: &Payload) -> Result<String, PageError> {
    let json = serde_json::to_string(payload)?;
    let json = printable_json(&json);
    // These characters occur in JSON only within strings.
    Ok(json
        .replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('&', "\\u0026"))
}

#[cfg(test)]
mod tests;
