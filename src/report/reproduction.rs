//! The reproduction of the paper as text, Markdown and CSV.

mod files;

pub use files::{REPRODUCTION_FILES, reproduction_files};

use super::{Align, StatementRecord, Table};
use crate::keyword::Keyword;
use crate::run::{ScenarioStamp, VERSION};
use crate::scenario::Scenario;
use crate::study::paper::Reproduction;
use crate::study::{Expected, Statement, Verdict};
use serde::Serialize;
use std::fmt::Write;

/// The paper's study among those of `reproduce`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReproduceResult {
    /// Its name.
    pub name: &'static str,
    /// The scenario.
    pub scenario: ScenarioStamp,
    /// The statements, as those of other studies.
    pub statements: Vec<StatementRecord>,
    /// Version of the program.
    #[serde(skip)]
    pub version: &'static str,
    /// Seed of the searches.
    pub seed: u64,
    /// The reproduced study.
    #[serde(flatten)]
    pub study: Reproduction,
}

impl ReproduceResult {
    /// The name of the paper's study.
    pub const NAME: &'static str = "paper";

    /// The result for a scenario.
    #[must_use]
    pub fn new(study: Reproduction, scenario: &Scenario, stamp: ScenarioStamp) -> Self {
        Self {
            name: Self::NAME,
            scenario: stamp,
            statements: study.lines.iter().map(Into::into).collect(),
            version: VERSION,
            seed: scenario.optimizer.seed,
            study,
        }
    }

    /// Number of statements with each verdict, in the order of [`Verdict::ALL`].
    #[must_use]
    pub fn counts(&self) -> Vec<(Verdict, usize)> {
        let count = |verdict: &Verdict| {
            let lines = self.study.lines.iter();
            (
                *verdict,
                lines.filter(|line| line.verdict == *verdict).count(),
            )
        };
        Verdict::ALL.iter().map(count).collect()
    }
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |x| format!("{x:.digits$}"))
}

/// The change from the paper's value to ours, percent.
fn change(ours: Option<f64>, paper: f64) -> String {
    let percent = ours.map(|ours| 100.0 * (ours / paper - 1.0));
    percent.map_or_else(|| "-".to_owned(), |x| format!("{x:+.2}"))
}

const LEFT: Align = Align::Left;
const RIGHT: Align = Align::Right;

fn rows_table(study: &Reproduction) -> Table {
    let mut table = Table::new(&[
        ("row", LEFT),
        ("design as printed", LEFT),
        ("mean visible,\npaper", RIGHT),
        ("ours", RIGHT),
        ("%", RIGHT),
        ("mean PDOP,\npaper", RIGHT),
        ("ours", RIGHT),
        ("%", RIGHT),
        ("fitting i\n(deg)", RIGHT),
        ("mean visible\nat that i", RIGHT),
        ("mean PDOP\nat that i", RIGHT),
        ("%", RIGHT),
    ]);
    for row in &study.rows {
        let (printed, fitting) = (&row.as_printed, &row.at_fitting);
        table.row([
            row.name.clone(),
            row.design.clone(),
            number(Some(row.paper_mean_visible), 2),
            number(Some(printed.mean_visible), 3),
            change(Some(printed.mean_visible), row.paper_mean_visible),
            number(Some(row.paper_mean_pdop), 4),
            number(printed.mean_pdop, 4),
            change(printed.mean_pdop, row.paper_mean_pdop),
            number(row.fitting_inclination_deg, 1),
            number(Some(fitting.mean_visible), 3),
            number(fitting.mean_pdop, 4),
            change(fitting.mean_pdop, row.paper_mean_pdop),
        ]);
    }
    table
}

fn mask_table(study: &Reproduction) -> Table {
    let mut table = Table::new(&[
        ("row", LEFT),
        ("mask implied by its mean visible (deg)", RIGHT),
    ]);
    for row in &study.mask_fit.rows {
        table.row([row.row.clone(), number(row.mask_deg, 2)]);
    }
    table
}

/// Rows of Table II for which the sensitivity is shown; the files have all of them.
const SHOWN_ROWS: [&str; 2] = ["proposed-2", "polar-2"];

fn sensitivity_table(study: &Reproduction) -> Table {
    let mut table = Table::new(&[
        ("assumption", LEFT),
        ("mean visible,\nproposed-2", RIGHT),
        ("change", RIGHT),
        ("mean PDOP", RIGHT),
        ("change", RIGHT),
        ("mean visible,\npolar-2", RIGHT),
        ("change", RIGHT),
        ("mean PDOP", RIGHT),
        ("change", RIGHT),
    ]);
    let indices = SHOWN_ROWS.map(|name| study.rows.iter().position(|row| row.name == name));
    let Some(base) = study.sensitivity.first() else {
        return table;
    };
    let difference = |x: Option<f64>, from: Option<f64>| {
        let difference = x.zip(from).map(|(x, from)| x - from);
        difference.map_or_else(|| "-".to_owned(), |d| format!("{d:+.4}"))
    };
    for measured in &study.sensitivity {
        let mut cells = vec![measured.assumption.clone()];
        for index in indices.into_iter().flatten() {
            let (value, from) = (&measured.values[index], &base.values[index]);
            let visible = Some(value.mean_visible);
            cells.push(number(visible, 3));
            cells.push(difference(visible, Some(from.mean_visible)));
            cells.push(number(value.mean_pdop, 4));
            cells.push(difference(value.mean_pdop, from.mean_pdop));
        }
        table.row(cells);
    }
    table
}

fn searches_table(study: &Reproduction) -> Table {
    let mut table = Table::new(&[
        ("search", LEFT),
        ("space, objectives and algorithm", LEFT),
        ("designs", RIGHT),
        ("pick", LEFT),
        ("mean visible", RIGHT),
        ("mean PDOP", RIGHT),
        ("maximum\nPDOP", RIGHT),
        ("J_pos", RIGHT),
        ("J_cost", RIGHT),
    ]);
    for set in &study.searches {
        let mut cells = vec![
            set.name.to_owned(),
            set.what.clone(),
            set.members.len().to_string(),
        ];
        if let Some(pick) = set.pick() {
            let metrics = &pick.metrics;
            cells.push(pick.design.to_string());
            cells.push(number(Some(metrics.mean_visible), 3));
            for value in [
                metrics.mean_pdop,
                metrics.max_pdop,
                metrics.j_pos,
                metrics.j_cost,
            ] {
                cells.push(number(value, 4));
            }
        }
        table.row(cells);
    }
    table
}

fn expected(line: &Statement) -> String {
    match line.expected {
        Expected::Value { value, tolerance } => {
            format!("{} ± {}", round(value), round(tolerance))
        }
        Expected::AtLeast(bound) => format!(">= {bound}"),
        Expected::MoreThan(bound) => format!("> {bound}"),
    }
}

/// At most four decimals, without trailing zeros.
pub(super) fn round(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn lines_table(study: &Reproduction) -> Table {
    let mut table = Table::new(&[
        ("verdict", LEFT),
        ("place in the paper", LEFT),
        ("statement", LEFT),
        ("paper", RIGHT),
        ("ours", RIGHT),
        ("unit", LEFT),
        ("assumption under which it is met", LEFT),
        ("ours under it", RIGHT),
    ]);
    for line in &study.lines {
        table.row([
            line.verdict.to_string(),
            line.place.clone(),
            line.statement.clone(),
            expected(line),
            line.ours.map_or_else(|| "-".to_owned(), round),
            line.unit.clone(),
            line.assumption.clone().unwrap_or_default(),
            line.ours_there.map_or_else(String::new, round),
        ]);
    }
    table
}

/// Conclusions, computed from the tables.
fn notes(result: &ReproduceResult) -> Vec<String> {
    let study = &result.study;
    let fit = &study.mask_fit;
    let mut notes = Vec::new();
    if let Some(median) = fit.median_deg {
        notes.push(format!(
            "The paper states no elevation mask. Fitted row by row, its visibility implies {median:.2}° (median); \
             {} of {} rows agree with this to 0.1°. The scenario uses {}°.",
            fit.agreeing,
            fit.rows.len(),
            study.mask_deg
        ));
    }
    let size = &study.cost_of_size;
    if let [Some(small), Some(large)] = size.j_cost {
        notes.push(format!(
            "J_cost = satellites / mean visible is one over the fraction of satellites in view: from {} to {} satellites \
             it goes from {small:.4} to {large:.4} ({:+.3} %). Under the paper's two objectives satellites are free, \
             so the front is where there are most of them; minimise satellites, planes or launch-cost to make them count.",
            size.satellites[0],
            size.satellites[1],
            100.0 * (large / small - 1.0)
        ));
    }
    notes.push(
        "Step (3) of the paper's algorithm sorts the offspring; here the merged population is sorted, as in \
         the paper's equation (19) and in Deb et al. (2002)."
            .to_owned(),
    );
    notes.push(
        "Table II gives only the product P x S, without phasing or pattern. Rows are read as 13 x 15, 13 x 14, \
         14 x 15 and 13 x 13 with F = 1, the polar and Iridium-like ones as star patterns."
            .to_owned(),
    );
    notes
}

fn summary(result: &ReproduceResult) -> String {
    let counts = result.counts();
    let words: Vec<String> = counts
        .iter()
        .map(|(verdict, count)| format!("{count} {verdict}"))
        .collect();
    format!(
        "{} statements: {}",
        result.study.lines.len(),
        words.join(", ")
    )
}

type ReportSection = (&'static str, &'static str, fn(&Reproduction) -> Table);

const SECTIONS: [ReportSection; 5] = [
    (
        "Statements and verdicts",
        "met: within the tolerance under the scenario; met-under-assumption: within the tolerance with the one change named, taken from the list under Sensitivity or the fitting inclination; fitted: within the tolerance, but the assumption was derived from the statement itself or from what it follows from; input: copied from the paper; not-met: under none of the assumptions tried; unconfirmed: not computed. Only the first two are evidence.",
        lines_table,
    ),
    (
        "Table II",
        "As printed, and at the fitting i: the inclination nearest to the printed one that gives the paper's mean visible. Differences are ours minus the paper's.",
        rows_table,
    ),
    (
        "The mask",
        "The mask is fitted to each row at its printed inclination; rows with a misprinted inclination stand out.",
        mask_table,
    ),
    (
        "Sensitivity",
        "One assumption changed at a time, designs as printed.",
        sensitivity_table,
    ),
    (
        "Searches",
        "With the paper's budget; the pick is the fuzzy pick of each set.",
        searches_table,
    ),
];

/// The study for a terminal.
#[must_use]
pub fn reproduction_text(result: &ReproduceResult) -> String {
    let mut text = format!(
        "Reproduction of the paper: scenario {}, seed {}, navwalker {}\n{}\n",
        result.scenario.name,
        result.seed,
        result.version,
        summary(result)
    );
    for (title, caption, table) in SECTIONS {
        let table = table(&result.study).to_text();
        let _ = write!(text, "\n{title}. {caption}\n{table}");
    }
    text.push('\n');
    for note in notes(result) {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

/// The study for an appendix.
#[must_use]
pub fn reproduction_markdown(result: &ReproduceResult) -> String {
    let mut text = format!(
        "# Reproduction of the paper\n\nScenario {} (`{}`), seed {}, navwalker {}.\n\n**{}.**\n\n",
        result.scenario.name,
        result.scenario.hash,
        result.seed,
        result.version,
        summary(result)
    );
    for note in notes(result) {
        let _ = writeln!(text, "- {note}");
    }
    for (title, caption, table) in SECTIONS {
        let table = table(&result.study).to_markdown();
        let _ = write!(text, "\n## {title}\n\n{caption}\n\n{table}");
    }
    text
}
