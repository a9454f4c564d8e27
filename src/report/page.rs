//! The page of a run, or of constellations that are compared: one self-contained HTML file.
//!
//! Texts and tables are in the page itself; the figures are drawn by the script of the plotly crate
//! from numbers embedded in the page. A click on a design updates everything below it, so the page
//! contains the cuts of all members and compared constellations, packed: maps, series, quantiles and
//! orbit. If there are too many for that, only some have them and the page says so.

mod comparison;
mod failures;
mod pack;
mod payload;
mod words;

use super::Compared;
use super::figures::NamedFront;
use super::profile::Profile;
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::printable::printable_json;
use crate::run::{Run, ScenarioStamp};
use askama::Template;
use comparison::Comparison;
pub use failures::{FailureSection, FailureSectionError};
use payload::Payload;
use rayon::prelude::*;
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
    /// The run; with a scenario alone if there was no search.
    pub run: &'a Run,
    /// The study, if there was no search.
    pub stamp: Option<&'a ScenarioStamp>,
    /// The scenario as written.
    pub scenario_toml: Option<&'a str>,
    /// Computes maps and series; without it the page has none.
    pub evaluator: Option<&'a Evaluator>,
    /// Constellations that are compared with the front and with each other.
    pub compared: &'a [Compared],
    /// Fronts of other runs.
    pub fronts: &'a [NamedFront],
    /// Satellites from files that every member of the front has beside its design.
    pub fixed: Option<&'a FileSatellites>,
    /// What failures of satellites do, where asked for.
    pub failures: Option<&'a FailureSection>,
}

impl Page<'_> {
    /// Whether two or more compared constellations have places in the plane of the objectives.
    fn has_plane_without_front(&self) -> bool {
        let is_placed = |one: &&Compared| {
            let values = &one.baseline.objectives;
            values.len() > 1 && values.iter().all(Option::is_some)
        };
        self.compared.iter().filter(is_placed).count() > 1
    }

    /// The constellations whose cuts are in the page: the first ones.
    fn compared_with_cuts(&self) -> &[Compared] {
        let count = self.most_cuts().min(self.compared.len());
        &self.compared[..count]
    }

    /// Maximum number of cuts in the page, of members and of compared constellations each.
    fn most_cuts(&self) -> usize {
        let Some(evaluator) = self.evaluator else {
            return 0;
        };
        let setup = evaluator.setup();
        let of_members = self
            .run
            .front
            .iter()
            .filter_map(|member| member.design.as_ref());
        let of_members = of_members.map(|design| design.satellites);
        let shells = |one: &Compared| {
            one.constellation
                .design
                .as_ref()
                .map(Design::satellite_count)
        };
        let satellites = of_members.chain(self.compared.iter().filter_map(shells));
        let satellites = satellites.max().unwrap_or(0);
        let each = payload::cut_bytes(setup.grid.len(), setup.sites.len(), satellites);
        (CUTS_BYTES / each).clamp(1, MOST_CUTS)
    }

    /// Maximum bytes for the positions of satellites from files, of each constellation that has some.
    fn track_bytes(&self) -> usize {
        let shown = self.compared_with_cuts().iter();
        let with_files = shown.filter(|one| one.constellation.files.is_some());
        TRACKS_BYTES / with_files.count().max(1)
    }
}

/// Maximum bytes for the cuts of the members, and of the compared constellations. With these, the positions of
/// satellites from files and the script for the figures (4.7 MB), the page stays below 8 MB, apart from the
/// history of a long search.
const CUTS_BYTES: usize = 1_000_000;

/// Maximum bytes for the positions of satellites from files, of all constellations.
const TRACKS_BYTES: usize = 900_000;

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
    is_search: bool,
    has_plane: bool,
    comparison: Option<Comparison>,
    best: Vec<Best>,
    members: Vec<MemberRow>,
    members_left_out: usize,
    objectives: Vec<String>,
    constraints: Vec<String>,
    failures: Option<&'a FailureSection>,
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
    let constellations: Vec<Constellation> = places
        .iter()
        .filter_map(|&n| members[n].constellation(page.fixed))
        .collect();
    let profiles = match page.evaluator {
        Some(evaluator) => Profile::of_constellations(evaluator, &constellations),
        None => vec![None; constellations.len()],
    };
    let payload = Payload::new(page, &places, &profiles, &of_compared(page));
    let plotly = plotly::Plot::offline_js_sources();
    let html = Html {
        title: words::title(page.run),
        style: include_str!("page/style.css"),
        plotly: first_script(&plotly),
        data: safe_json(&payload)?,
        scripts: [
            include_str!("page/core.js"),
            include_str!("page/maps.js"),
            include_str!("page/figures.js"),
            include_str!("page/globe.js"),
            include_str!("page/instants.js"),
            include_str!("page/sites.js"),
            include_str!("page/main.js"),
        ]
        .concat(),
        summary: PageSummary::new(page, &places),
        is_search: page.stamp.is_none(),
        has_plane: !members.is_empty() || page.has_plane_without_front(),
        comparison: Comparison::new(page),
        best: words::best(page.run),
        members: words::members(page.run, MOST_ROWS),
        members_left_out: members.len().saturating_sub(MOST_ROWS),
        objectives: page.run.objective_names(),
        constraints: words::further(page.run),
        failures: page.failures,
        checks: words::checks(page.run),
        validated: words::validated(page.run),
        conventions: words::conventions(page),
        scenario_toml: page.scenario_toml,
        version: crate::run::VERSION,
    };
    Ok(html.write_into(&mut to)?)
}

/// The cuts of the compared constellations; `None` for one that has no place in the page.
fn of_compared(page: &Page<'_>) -> Vec<Option<Profile>> {
    let Some(evaluator) = page.evaluator else {
        return vec![None; page.compared.len()];
    };
    let one = |one: &Compared| Profile::new(evaluator, &one.ephemeris).ok();
    let shown = page.compared_with_cuts();
    let mut profiles: Vec<_> = shown.par_iter().map(one).collect();
    profiles.resize(page.compared.len(), None);
    profiles
}

/// The members whose cuts are in the page, by position: evenly spaced over the front, plus the chosen one.
fn members_with_cuts(page: &Page<'_>) -> Vec<usize> {
    let members = &page.run.front;
    let propagated: Vec<usize> = (0..members.len())
        .filter(|&n| members[n].constellation(page.fixed).is_some())
        .collect();
    let count = page.most_cuts().min(propagated.len());
    if count == 0 {
        return Vec::new();
    }
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
