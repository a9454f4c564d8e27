//! What a study shows beside its statements: tables, fits, assumptions, searches, and other values.

use super::section::ReportSection;
use super::studies::{StudyResult, round, shown};
use super::{Align, Table};
use crate::study::published::{FoundFit, FoundSet, MeasuredRow, MeasuredTable};

const LEFT: Align = Align::Left;
const RIGHT: Align = Align::Right;

/// What is shown of a study beside its statements.
pub(super) fn sections(study: &StudyResult) -> Vec<ReportSection> {
    let mut sections = Vec::new();
    for table in &study.tables {
        sections.push(rows(table));
        if !table.sensitivity.is_empty() {
            sections.push(sensitivity(table));
        }
    }
    let implied = study.fits.iter().filter(|fit| fit.assumption.is_none());
    sections.extend(implied.map(fit));
    if !study.searches.is_empty() {
        sections.push(searches(&study.searches));
    }
    if !study.values.is_empty() {
        sections.push(values(study));
    }
    sections
}

fn table(columns: &[(String, Align)]) -> Table {
    let columns: Vec<(&str, Align)> = (columns.iter())
        .map(|(name, align)| (name.as_str(), *align))
        .collect();
    Table::new(&columns)
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |x| format!("{x:.4}"))
}

/// The change from a published number to ours, percent.
fn change(ours: Option<f64>, published: f64) -> String {
    let percent = ours.map(|ours| 100.0 * (ours / published - 1.0));
    let percent = percent.filter(|percent| percent.is_finite());
    percent.map_or_else(|| "-".to_owned(), |x| format!("{x:+.2}"))
}

fn rows(of: &MeasuredTable) -> ReportSection {
    let printed = of.rows.first().map_or(0, |row| row.published.len());
    let printed = &of.columns[..printed.min(of.columns.len())];
    let mut columns = vec![("row".to_owned(), LEFT), ("as printed".to_owned(), LEFT)];
    for column in printed {
        columns.push((format!("{},\npublished", column.name), RIGHT));
        columns.push(("computed".to_owned(), RIGHT));
        columns.push(("%".to_owned(), RIGHT));
    }
    for element in &of.fits {
        columns.push((format!("fitting\n{element}"), RIGHT));
        for column in printed {
            columns.push((format!("{}\nthere", column.name), RIGHT));
            columns.push(("%".to_owned(), RIGHT));
        }
    }
    let mut table = table(&columns);
    for row in &of.rows {
        table.row(row_cells(row));
    }
    let mut caption = "Differences are computed minus published.".to_owned();
    for element in &of.fits {
        caption += &format!(
            " As printed, and at the fitting {element}: the value nearest to the printed one that gives the published \
             number, where the printed one does not."
        );
    }
    ReportSection {
        title: of.name.clone(),
        caption,
        table,
        remarks: Vec::new(),
    }
}

fn row_cells(row: &MeasuredRow) -> Vec<String> {
    let mut cells = vec![row.name.clone(), row.design.clone()];
    let both = |computed: &[Option<f64>]| -> Vec<(f64, Option<f64>)> {
        let published = row.published.iter().copied();
        published.zip(computed.iter().copied()).collect()
    };
    for (published, ours) in both(&row.computed) {
        cells.extend([published.to_string(), number(ours), change(ours, published)]);
    }
    for fit in &row.fits {
        cells.push(fit.value.map_or_else(|| "-".to_owned(), |x| x.to_string()));
        for (published, ours) in both(&fit.computed) {
            cells.extend([number(ours), change(ours, published)]);
        }
    }
    cells
}

fn fit(fit: &FoundFit) -> ReportSection {
    let (vary, to) = (&fit.vary, &fit.to);
    let mut caption = format!("The {vary} at which each row has its {to}.");
    if let Some(median) = fit.median {
        caption += &format!(" Their median is {}", round(median));
        if let Some((agreeing, within)) = fit.agreeing.zip(fit.agree_within) {
            let all = fit.rows.len();
            caption += &format!(
                ", with which {agreeing} of {all} rows agree to {within}; rows that are misprinted stand out"
            );
        }
        caption.push('.');
    }
    let mut table = table(&[("row".to_owned(), LEFT), (vary.clone(), RIGHT)]);
    for row in &fit.rows {
        table.row([
            row.row.clone(),
            row.value.map_or_else(|| "-".to_owned(), round),
        ]);
    }
    ReportSection {
        title: format!("Fit: {}", fit.name),
        caption,
        table,
        remarks: Vec::new(),
    }
}

fn sensitivity(of: &MeasuredTable) -> ReportSection {
    let printed = of.rows.first().map_or(0, |row| row.published.len());
    let shown: Vec<usize> = (of.shown.iter())
        .filter_map(|name| of.rows.iter().position(|row| row.name == *name))
        .collect();
    let mut columns = vec![("assumption".to_owned(), LEFT)];
    for at in &shown {
        for column in of.columns.iter().take(printed) {
            columns.push((format!("{},\n{}", column.name, of.rows[*at].name), RIGHT));
            columns.push(("change".to_owned(), RIGHT));
        }
    }
    let mut table = table(&columns);
    let difference = |x: Option<f64>, from: Option<f64>| {
        let difference = x.zip(from).map(|(x, from)| x - from);
        difference.map_or_else(|| "-".to_owned(), |d| format!("{d:+.4}"))
    };
    for under in &of.sensitivity {
        let mut cells = vec![under.assumption.clone()];
        for at in &shown {
            for n in 0..printed {
                let (value, from) = (under.computed[*at][n], of.rows[*at].computed[n]);
                cells.extend([number(value), difference(value, from)]);
            }
        }
        table.row(cells);
    }
    ReportSection {
        title: format!("Sensitivity of {}", of.name),
        caption:
            "One assumption changed at a time, constellations as printed; the file has all rows."
                .to_owned(),
        table,
        remarks: Vec::new(),
    }
}

fn searches(sets: &[FoundSet]) -> ReportSection {
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
    for set in sets {
        let mut cells = vec![
            set.name.clone(),
            set.what.clone(),
            set.members.len().to_string(),
        ];
        if let Some(pick) = set.pick() {
            let metrics = &pick.metrics;
            cells.push(pick.design.to_string());
            cells.push(format!("{:.3}", metrics.mean_visible));
            let others = [
                metrics.mean_pdop,
                metrics.max_pdop,
                metrics.j_pos,
                metrics.j_cost,
            ];
            cells.extend(others.map(number));
        }
        table.row(cells);
    }
    ReportSection {
        title: "Searches".to_owned(),
        caption: "With the budget of the scenario; the pick is the fuzzy pick of each set."
            .to_owned(),
        table,
        remarks: Vec::new(),
    }
}

fn values(study: &StudyResult) -> ReportSection {
    let mut table = Table::new(&[
        ("value", LEFT),
        ("of", LEFT),
        ("computed", RIGHT),
        ("unit", LEFT),
    ]);
    for value in &study.values {
        table.row([
            value.name.clone(),
            value.of.clone(),
            number(value.computed),
            shown(value.unit),
        ]);
    }
    ReportSection {
        title: "Other values".to_owned(),
        caption: "Computed, and not judged.".to_owned(),
        table,
        remarks: Vec::new(),
    }
}
