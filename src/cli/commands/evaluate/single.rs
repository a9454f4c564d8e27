//! The result of a single constellation.

use super::EvaluationContext;
use crate::cli::args::OutputFormat;
use crate::cli::output;
use crate::evaluate::{DopStatistics, Metrics, OnDemand, SigmaSpread};
use crate::keyword::Keyword;
use crate::report::failures::FailureSummary;
use crate::report::{
    Align, Alone, Assessment, ConstellationEntry, ConstraintCheck, DeploymentSummary,
    ExpectedService, PhaseRange, PhaseSpread, RelativeNodes, Table, in_order, on_demand_quantities,
    quantity_label, shown,
};
use crate::scenario::Scenario;
use crate::search::Quantity;
use crate::units::counted;
use anyhow::Result;

/// The quantities that always have a row.
const ROWS: [Quantity; 13] = [
    Quantity::MeanVisible,
    Quantity::LeastVisible,
    Quantity::MeanPdop,
    Quantity::CvarPdop,
    Quantity::P95Pdop,
    Quantity::P99Pdop,
    Quantity::MaxPdop,
    Quantity::Availability,
    Quantity::LongestOutageS,
    Quantity::Coverage4,
    Quantity::JPos,
    Quantity::JCost,
    Quantity::LeastSeparationKm,
];

/// Prints what was computed of a design, or of the satellites of files.
pub(super) fn print(work: &EvaluationContext<'_>, entry: ConstellationEntry) -> Result<()> {
    let Some(alone) = entry.alone(work.gnss_only.clone(), work.stamp.clone()) else {
        return Ok(());
    };
    if work.args.format == OutputFormat::Json {
        return output::result(&crate::printable::json(&alone)?);
    }
    let (title, evaluated) = match &alone {
        Alone::Design(result) => {
            let notation = &result.design.notation;
            let title = match &result.name {
                Some(name) => format!("{name} ({notation})"),
                None => notation.clone(),
            };
            (title, &result.evaluated)
        }
        Alone::Files(result) => {
            let of = &result.constellation;
            let satellites = counted(of.satellites, "satellite");
            let title = format!("{} ({satellites}, {})", of.name, of.content);
            (title, &result.evaluated)
        }
    };
    let text = text(work.scenario, &title, evaluated);
    let phases = evaluated.gnss_phases.as_ref();
    let text = text + &phases.map_or_else(String::new, phases_table);
    let nodes = evaluated.relative_nodes.as_ref();
    let text = text + &nodes.map_or_else(String::new, nodes_text);
    let expected = evaluated.expected.as_ref();
    let text = text + &expected.map_or_else(String::new, ExpectedService::to_text);
    let phases = evaluated.phases.as_ref();
    let text = text + &phases.map_or_else(String::new, DeploymentSummary::to_text);
    let failures = evaluated.failures.as_ref();
    let text = text + &failures.map_or_else(String::new, FailureSummary::to_text);
    output::result(&(text + &constraint_lines(&evaluated.constraints)))
}

fn text(scenario: &Scenario, title: &str, evaluated: &Assessment) -> String {
    let metrics = &evaluated.metrics;
    let dops = evaluated.dops.as_ref();
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
    row(
        "least visible",
        Some(metrics.least_visible.into()),
        0,
        "LEO satellites in view, over all points and instants".to_owned(),
    );
    let coverage = metrics.coverage;
    row(
        "coverage",
        coverage.of(4),
        5,
        format!(
            "fraction with at least 4 LEO satellites in view; 1: {:.5}, 8: {:.5}",
            coverage.of(1).unwrap_or(0.0),
            coverage.of(8).unwrap_or(0.0)
        ),
    );
    row(
        "mean visible, GNSS",
        Some(metrics.mean_gnss_visible),
        4,
        format!("with LEO {:.4}", metrics.mean_total_visible),
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
    let cut = match metrics.longest_outage_cut {
        true => ", cut by an end of the span",
        false => "",
    };
    row(
        "longest outage",
        Some(metrics.longest_outage_s),
        0,
        format!("s at any point, unsolved or PDOP > {threshold}{cut}"),
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
    let further = objective_rows(scenario, evaluated).into_iter();
    let further = separation_row(evaluated).into_iter().chain(further);
    for row in further.chain(on_demand_rows(scenario, metrics)) {
        table.row(row);
    }
    let dops = dops.map_or_else(String::new, |dops| format!("\n{}", dops_table(dops)));
    format!(
        "{title} in scenario {}\n{}{dops}",
        scenario.name,
        table.to_text()
    )
}

/// How close satellites come to each other.
fn separation_row(evaluated: &Assessment) -> Option<[String; 3]> {
    let all = evaluated.separation.iter();
    let least = all.min_by(|a, b| a.least_km.total_cmp(&b.least_km))?;
    let shells = least.shells.as_ref();
    let shells = shells.map_or_else(String::new, |of| format!("shells {of}: "));
    let between = least.between();
    Some([
        "least separation".to_owned(),
        format!("{:.2}", least.least_km),
        format!("km, {shells}{between}, by mean elements over all time"),
    ])
}

/// What is computed on demand: the gain over the GNSS alone, the information of windows, and the accuracy in metres.
fn on_demand_rows(scenario: &Scenario, metrics: &Metrics) -> Vec<[String; 3]> {
    let row = |quantity: Quantity| {
        let label = quantity_label(quantity.keyword());
        let value = shown::quantity(quantity, quantity.of_metrics(metrics));
        [label, value, note(quantity, metrics)]
    };
    on_demand_quantities(scenario)
        .into_iter()
        .map(row)
        .collect()
}

/// What is said beside a quantity on demand.
fn note(quantity: Quantity, metrics: &Metrics) -> String {
    let spread = |p95, cvar| {
        let [p95, cvar] = [p95, cvar].map(shown::pdop);
        format!("mean; 95 % quantile {p95}, CVaR {cvar}")
    };
    let sigma = |of: OnDemand<SigmaSpread>| {
        let of = of.flatten();
        let solved = shown::share(metrics.accuracy_solved_fraction);
        let spread = spread(of.map(|of| of.p95), of.map(|of| of.cvar));
        format!("{spread}; of {solved} of points and instants")
    };
    match quantity {
        Quantity::InformationPdop => metrics.information_pdop.map_or_else(String::new, |of| {
            let spread = spread(of.p95, of.cvar);
            format!("{spread}; solved {:.5} of the windows", of.solved_fraction)
        }),
        Quantity::Sigma3dM => sigma(metrics.sigma_3d_m),
        Quantity::SigmaHM => sigma(metrics.sigma_h_m),
        Quantity::SigmaVM => sigma(metrics.sigma_v_m),
        Quantity::GainMeanPdop => "GNSS alone minus the above, as for the other gains".to_owned(),
        one if one.is_in_metres() => {
            "exceeded by 5 % of all errors; without a solution any length is".to_owned()
        }
        _ => String::new(),
    }
}

/// The objectives that no other row shows.
fn objective_rows(scenario: &Scenario, evaluated: &Assessment) -> Vec<[String; 3]> {
    let elsewhere = [ROWS.as_slice(), &on_demand_quantities(scenario)].concat();
    let objectives = scenario.goals().objectives.into_iter();
    let further = objectives.filter(|one| !elsewhere.contains(one));
    let row = |one: Quantity| {
        let value = shown::quantity(one, evaluated.value(one));
        [quantity_label(one.keyword()), value, String::new()]
    };
    further.map(row).collect()
}

/// The range of each metric over the phases of the GNSS.
fn phases_table(spread: &PhaseSpread) -> String {
    format!(
        "\nover {} phases of the GNSS, the first of which is that above\n{}",
        spread.phases,
        ranges_table(&spread.rows())
    )
}

/// How the shells turn against each other, and the range of each metric over relative nodes.
fn nodes_text(nodes: &RelativeNodes) -> String {
    let spread = nodes.spread.as_ref().map(|of| {
        format!(
            "\nover {} relative nodes, equally spaced in {:.1} days, the first of which is that above\n{}",
            of.nodes,
            of.period_days,
            ranges_table(&in_order(&of.spread.metrics))
        )
    });
    nodes.to_text() + &spread.unwrap_or_default()
}

fn ranges_table(rows: &[(&str, Option<PhaseRange>)]) -> String {
    let mut table = Table::new(&[
        ("metric", Align::Left),
        ("minimum", Align::Right),
        ("mean", Align::Right),
        ("maximum", Align::Right),
    ]);
    for &(name, range) in rows {
        let parts = [
            range.map(|of| of.min),
            range.map(|of| of.mean),
            range.map(|of| of.max),
        ];
        let digits = |value| match name {
            "solved_fraction" | "availability" => shown::share(value),
            _ => shown::pdop(value),
        };
        table.row([name.to_owned()].into_iter().chain(parts.map(digits)));
    }
    table.to_text()
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
        let verdict = check.verdict();
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
