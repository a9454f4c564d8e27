//! `navwalker evaluate`.

use crate::args::{EvaluateArgs, Format};
use crate::study::Study;
use crate::{Status, files, output};
use anyhow::Result;
use navwalker::ephemeris::Ephemeris;
use navwalker::evaluate::{DopStatistics, Evaluator};
use navwalker::report::{Align, EvaluateResult, Table, dops_csv, metrics_csv, records_csv};
use std::path::Path;

pub(crate) fn run(args: &EvaluateArgs) -> Result<Status> {
    if let Some(directory) = &args.series {
        files::require_vacant(directory, args.force)?;
    }
    let study = Study::load(&args.study, &[])?;
    let evaluator = study.evaluator()?;
    let setup = evaluator.setup();
    let ephemeris = Ephemeris::of_design(&args.design, setup.model, setup.grid)?;
    let metrics = evaluator.design(&args.design)?;
    let dops = args.dops.then(|| evaluator.dops(&ephemeris)).transpose()?;
    if let Some(directory) = &args.series {
        write_series(&evaluator, &ephemeris, directory)?;
    }
    let result = EvaluateResult::new(&args.design, metrics, dops, &study.scenario);
    match args.format {
        Format::Text => output::result(&text(&study, &result))?,
        Format::Json => output::result(&serde_json::to_string_pretty(&result)?)?,
        Format::Csv => {
            output::result(&metrics_csv([(&result.design, &result.metrics)])?)?;
            if let Some(dops) = &result.dops {
                output::result(&format!("\n{}", dops_csv(dops)?))?;
            }
        }
    }
    if let Some(directory) = &args.series {
        output::hint(&format!(
            "\nepochs.csv and points.csv written to {}",
            directory.display()
        ));
    }
    output::hint(&format!(
        "\nnext: navwalker validate {} --design {} --against sgp4",
        args.study.scenario, args.design
    ));
    Ok(Status::Done)
}

fn write_series(evaluator: &Evaluator, ephemeris: &Ephemeris, directory: &Path) -> Result<()> {
    let series = evaluator.series(ephemeris)?;
    let staged = files::StagedDirectory::new(directory)?;
    let write = |name: &str, text: String| {
        files::write_atomically(&staged.path().join(name), text.as_bytes())
    };
    write("epochs.csv", records_csv(&series.epochs)?)?;
    write("points.csv", records_csv(&series.points)?)?;
    staged.commit()
}

fn text(study: &Study, result: &EvaluateResult) -> String {
    let scenario = &study.scenario;
    let metrics = &result.metrics;
    let mut table = Table::new(&[("", Align::Left), ("", Align::Right), ("", Align::Left)]);
    let mut row = |name: &str, value: Option<f64>, digits: usize, note: String| {
        let value = value.map_or_else(|| "none".to_owned(), |v| format!("{v:.digits$}"));
        table.row([name.to_owned(), value, note]);
    };
    let weight = scenario.objectives.cvar_weight;
    let tail = 100.0 * (1.0 - metrics.cvar_level);
    let threshold = scenario.objectives.availability_pdop;
    let seen = "LEO satellites in view, mean over points and times";
    row(
        "mean visible",
        Some(metrics.mean_visible),
        4,
        seen.to_owned(),
    );
    row("mean PDOP", metrics.mean_pdop, 4, String::new());
    row(
        "CVaR PDOP",
        metrics.cvar_pdop,
        4,
        format!("mean of the worst {tail:.4} %"),
    );
    row("median PDOP", metrics.p50_pdop, 4, String::new());
    row("95 % PDOP", metrics.p95_pdop, 4, String::new());
    row("99 % PDOP", metrics.p99_pdop, 4, String::new());
    row("maximum PDOP", metrics.max_pdop, 4, String::new());
    row(
        "solved",
        Some(100.0 * metrics.solved_fraction),
        3,
        "% of points and times".to_owned(),
    );
    row(
        "available",
        Some(100.0 * metrics.availability),
        3,
        format!("% with PDOP <= {threshold}"),
    );
    row("J_pos", metrics.j_pos, 4, format!("mean + {weight} CVaR"));
    row(
        "J_cost",
        metrics.j_cost,
        4,
        "satellites per visible satellite".to_owned(),
    );
    let dops = result
        .dops
        .as_ref()
        .map_or_else(String::new, |dops| format!("\n{}", dops_table(dops)));
    format!(
        "{} in scenario {}\n{}{dops}",
        result.design.notation,
        scenario.name,
        table.to_text()
    )
}

fn dops_table(dops: &DopStatistics) -> String {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("dilution", Align::Left),
        ("mean", right),
        ("median", right),
        ("95 %", right),
        ("99 %", right),
        ("maximum", right),
        ("CVaR", right),
    ]);
    for (name, summary) in dops.named() {
        let cells = match summary {
            Some(s) => [s.mean, s.p50, s.p95, s.p99, s.max, s.cvar].map(|x| format!("{x:.4}")),
            None => std::array::from_fn(|_| "none".to_owned()),
        };
        table.row([name].into_iter().chain(cells));
    }
    table.to_text()
}
