//! `navwalker evaluate`.

use crate::args::{EvaluateArgs, Format};
use crate::study::Study;
use crate::{Status, output};
use anyhow::Result;
use navwalker::constellation::Design;
use navwalker::evaluate::Metrics;
use navwalker::report::{Align, EvaluateResult, Table, metrics_csv};

pub(crate) fn run(args: &EvaluateArgs) -> Result<Status> {
    let study = Study::load(&args.study, &[])?;
    let metrics = study.evaluator()?.design(&args.design)?;
    let result = EvaluateResult::new(&args.design, metrics, &study.scenario);
    match args.format {
        Format::Text => output::result(&text(&study, &args.design, &metrics))?,
        Format::Json => output::result(&serde_json::to_string_pretty(&result)?)?,
        Format::Csv => output::result(&metrics_csv([(&result.design, &result.metrics)])?)?,
    }
    output::hint(&format!(
        "\nnext: navwalker validate {} --design {} --against sgp4",
        args.study.scenario, args.design
    ));
    Ok(Status::Done)
}

fn text(study: &Study, design: &Design, metrics: &Metrics) -> String {
    let scenario = &study.scenario;
    let mut table = Table::new(&[("", Align::Left), ("", Align::Right), ("", Align::Left)]);
    let mut row = |name: &str, value: Option<f64>, digits: usize, note: String| {
        let value = value.map_or_else(|| "none".to_owned(), |v| format!("{v:.digits$}"));
        table.row([name.to_owned(), value, note]);
    };
    let weight = scenario.objectives.cvar_weight;
    let level = 100.0 * metrics.cvar_level;
    let threshold = scenario.objectives.availability_pdop;
    row(
        "mean visible",
        Some(metrics.mean_visible),
        4,
        "LEO satellites in view, mean over points and times".to_owned(),
    );
    row("mean PDOP", metrics.mean_pdop, 4, String::new());
    row(
        "CVaR PDOP",
        metrics.cvar_pdop,
        4,
        format!("mean of the worst {:.4} %", 100.0 - level),
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
    format!(
        "{design} in scenario {}\n{}",
        scenario.name,
        table.to_text()
    )
}
