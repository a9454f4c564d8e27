//! `navwalker evaluate`.

use crate::cli::args::{EvaluateArgs, OutputFormat};
use crate::cli::files::StagedDirectory;
use crate::cli::study::Study;
use crate::cli::{Status, coincidence, files, output, read_constellation};
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{DopStatistics, Evaluator, Metrics};
use crate::report::{
    Align, ConstellationResult, ConstellationSummary, ConstraintCheck, EvaluateResult, Table,
    constellation_csv, dops_csv, metrics_csv, records_csv, shown,
};
use crate::run::VERSION;
use crate::units::counted;
use anyhow::Result;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The tables of a series.
const SERIES: [&str; 2] = ["epochs.csv", "points.csv"];

pub(crate) fn run(args: &EvaluateArgs) -> Result<Status> {
    if let Some(directory) = &args.series {
        let own = SERIES.map(str::to_owned).into();
        files::require_replaceable(directory, args.force, &own)?;
    }
    let study = Study::load(&args.study, &[])?;
    if let Some(directory) = &args.series {
        let inputs = study.inputs();
        let inputs = inputs.iter().chain(&args.constellation);
        files::refuse_inputs(directory, inputs.map(PathBuf::as_path))?;
    }
    let series = args
        .series
        .as_deref()
        .map(StagedDirectory::new)
        .transpose()?;
    match &args.design {
        Some(design) => run_design(args, &study, design, series.as_ref())?,
        None => run_constellation(args, &study, series.as_ref())?,
    }
    if let Some(series) = series {
        series.commit()?;
    }
    if let Some(directory) = &args.series {
        output::hint(&format!(
            "\nepochs.csv and points.csv written to {}",
            directory.display()
        ));
    }
    if let Some(design) = &args.design {
        output::hint(&format!(
            "\nnext: navwalker validate {} --design {design} --against sgp4",
            args.study.name()
        ));
    }
    Ok(Status::Done)
}

fn run_design(
    args: &EvaluateArgs,
    study: &Study,
    design: &Design,
    series: Option<&StagedDirectory>,
) -> Result<()> {
    let evaluator = study.evaluator()?;
    let setup = evaluator.setup();
    let ephemeris = Ephemeris::of_design(design, setup.model, setup.grid)?;
    coincidence::warn(&setup.gnss, setup.grid, Some(&ephemeris));
    let metrics = evaluator.evaluate(design)?;
    let dops = further(args, &evaluator, &ephemeris, series)?;
    let result = EvaluateResult::new(
        design,
        metrics,
        dops,
        &study.scenario.goals(),
        study.stamp()?,
    );
    let csv = || metrics_csv(&result);
    let notation = &result.design.notation;
    let dops = result.dops.as_ref();
    let constraints = constraint_lines(&result.constraints);
    let text = text(study, notation, &result.metrics, dops) + &constraints;
    print(args, &text, dops, &result, csv)
}

fn run_constellation(
    args: &EvaluateArgs,
    study: &Study,
    series: Option<&StagedDirectory>,
) -> Result<()> {
    let (formats, mut fleet) = read_constellation::read(&args.constellation, args.input_format)?;
    fleet.choose(&args.satellites.filter())?;
    let evaluator = study.evaluator()?;
    let setup = evaluator.setup();
    let name = |path: &PathBuf| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    let names: Vec<String> = args.constellation.iter().filter_map(name).collect();
    let name = names.join("+");
    if let Some(stale) = fleet.stale(&name, setup.grid) {
        output::warning(&stale.to_string());
    }
    let ephemeris = fleet.propagate(setup.grid, setup.model)?;
    for note in fleet.sampling_notes(setup.grid) {
        output::warning(&note.to_string());
    }
    coincidence::warn(&setup.gnss, setup.grid, Some(&ephemeris));
    let metrics = evaluator.evaluate_ephemeris(&ephemeris)?;
    let dops = further(args, &evaluator, &ephemeris, series)?;
    let result = ConstellationResult {
        constellation: ConstellationSummary {
            name,
            format: read_constellation::names(&formats),
            content: fleet.content(),
            satellites: fleet.len(),
        },
        metrics,
        dops,
        scenario: study.stamp()?,
        version: VERSION,
    };
    let title = format!(
        "{} ({}, {})",
        result.constellation.name,
        counted(result.constellation.satellites, "satellite"),
        result.constellation.content
    );
    let dops = result.dops.as_ref();
    let text = text(study, &title, &result.metrics, dops);
    print(args, &text, dops, &result, || constellation_csv(&result))
}

/// All dilutions of precision and the series, as requested.
fn further(
    args: &EvaluateArgs,
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    series: Option<&StagedDirectory>,
) -> Result<Option<DopStatistics>> {
    let dops = args.dops.then(|| evaluator.dops(ephemeris)).transpose()?;
    if let Some(series) = series {
        write_series(evaluator, ephemeris, series.path())?;
    }
    Ok(dops)
}

fn print(
    args: &EvaluateArgs,
    text: &str,
    dops: Option<&DopStatistics>,
    result: &impl Serialize,
    csv: impl Fn() -> std::io::Result<String>,
) -> Result<()> {
    match args.format {
        OutputFormat::Text => output::result(text),
        OutputFormat::Json => output::result(&serde_json::to_string_pretty(result)?),
        OutputFormat::Csv => {
            output::result(&csv()?)?;
            match dops {
                Some(dops) => output::result(&format!("\n{}", dops_csv(dops)?)),
                None => Ok(()),
            }
        }
    }
}

fn write_series(evaluator: &Evaluator, ephemeris: &Ephemeris, directory: &Path) -> Result<()> {
    let series = evaluator.series(ephemeris)?;
    let write =
        |name: &str, text: String| files::write_atomically(&directory.join(name), text.as_bytes());
    write(SERIES[0], records_csv(&series.epochs)?)?;
    write(SERIES[1], records_csv(&series.points)?)
}

fn text(study: &Study, title: &str, metrics: &Metrics, dops: Option<&DopStatistics>) -> String {
    let scenario = &study.scenario;
    let mut table = Table::new(&[("", Align::Left), ("", Align::Right), ("", Align::Left)]);
    let mut row = |name: &str, value: Option<f64>, digits: usize, note: String| {
        let value = value.map_or_else(|| "none".to_owned(), |v| format!("{v:.digits$}"));
        table.row([name.to_owned(), value, note]);
    };
    let weight = scenario.objectives.cvar_weight;
    let tail = 100.0 * (1.0 - metrics.cvar_level);
    let threshold = scenario.objectives.availability_pdop;
    let seen = "LEO satellites in view, mean over points and instants";
    row(
        "mean visible",
        Some(metrics.mean_visible),
        4,
        seen.to_owned(),
    );
    row("mean PDOP", metrics.mean_pdop, 4, String::new());
    row(
        "CVaR of PDOP",
        metrics.cvar_pdop,
        4,
        format!(
            "mean of the worst {} %",
            crate::units::round_decimal(tail, 4)
        ),
    );
    row("median PDOP", metrics.p50_pdop, 4, String::new());
    row("95 % quantile of PDOP", metrics.p95_pdop, 4, String::new());
    row("99 % quantile of PDOP", metrics.p99_pdop, 4, String::new());
    row("maximum PDOP", metrics.max_pdop, 4, String::new());
    row(
        "solved fraction",
        Some(metrics.solved_fraction),
        5,
        "of points and instants".to_owned(),
    );
    row(
        "availability",
        Some(metrics.availability),
        5,
        format!("fraction with PDOP <= {threshold}"),
    );
    row(
        "J_pos",
        metrics.j_pos,
        4,
        format!("mean PDOP + {weight} CVaR of PDOP"),
    );
    row(
        "J_cost",
        metrics.j_cost,
        4,
        "satellites / mean visible".to_owned(),
    );
    let dops = dops.map_or_else(String::new, |dops| format!("\n{}", dops_table(dops)));
    format!(
        "{title} in scenario {}\n{}{dops}",
        scenario.name,
        table.to_text()
    )
}

/// The constraints of the scenario, one per line: the value, and whether the bound is met.
fn constraint_lines(checks: &[ConstraintCheck]) -> String {
    if checks.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        ("constraint", Align::Left),
        ("value", Align::Right),
        ("", Align::Left),
    ]);
    for check in checks {
        let verdict = if check.met { "met" } else { "violated" };
        let value = shown::named(&check.quantity, check.value);
        table.row([check.constraint.clone(), value, verdict.to_owned()]);
    }
    format!("\n{}", table.to_text())
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
