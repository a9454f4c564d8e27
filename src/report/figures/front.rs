//! The front in the plane of two objectives.

use super::table::{Csv, optional};
use super::{
    Axis, Chart, Figure, FigureError, Layer, MeasureAxis, PlaneChart, Plate, Style, quantity_label,
};
use crate::constellation::shell_letters;
use crate::report::Baseline;
use crate::run::{FrontMember, Run};
use crate::scenario::{Keyword, Quantity};

/// The front of another run.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedFront {
    /// Its name.
    pub name: String,
    /// Its members.
    pub front: Vec<FrontMember>,
}

/// Rows of the plane: name of the set, generation, index, what it is made of, objectives, quantities under
/// constraints, membership, name of a constellation that is compared.
struct FrontRow<'a> {
    set: &'a str,
    /// Name of the layer of a member.
    layer: String,
    name: &'a str,
    generation: Option<u64>,
    index: Option<usize>,
    made_of: String,
    objectives: Vec<Option<f64>>,
    constraints: Vec<Option<f64>>,
    membership: Option<f64>,
}

/// Figure 2a of the paper: the front in the plane of the first two objectives, with earlier
/// generations behind it, and constellations and fronts for comparison; without a front, the
/// constellations alone.
///
/// # Errors
/// If there is neither a front nor a constellation, or only one objective.
pub fn pareto(
    run: &Run,
    baselines: &[Baseline],
    fronts: &[NamedFront],
) -> Result<Plate, FigureError> {
    let figure = Figure::Pareto;
    let names = run.objective_names();
    if run.front.is_empty() && baselines.is_empty() {
        let reason = "the front is empty";
        return Err(FigureError::Nothing { figure, reason });
    }
    let [x, y, ..] = names.as_slice() else {
        let reason = "a plane needs two objectives";
        return Err(FigureError::Nothing { figure, reason });
    };
    let rows = rows(run, &names, baselines, fronts);
    let points = |keep: &dyn Fn(&FrontRow<'_>) -> bool| -> Vec<(f64, f64)> {
        let kept = rows.iter().filter(|row| keep(row));
        kept.filter_map(|row| Some((row.objectives[0]?, row.objectives[1]?)))
            .collect()
    };
    let layer = |name: &str, points, style| Layer {
        name: name.to_owned(),
        points,
        style,
    };
    let mut layers = vec![layer(
        "earlier generations",
        points(&|row| row.generation.is_some()),
        Style::Faint,
    )];
    for (n, other) in fronts.iter().enumerate() {
        layers.push(layer(
            &other.name,
            points(&|row| row.set == other.name),
            Style::Dots(n + 1),
        ));
    }
    let mut kinds: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.set == "front") {
        if !kinds.contains(&row.layer.as_str()) {
            kinds.push(&row.layer);
        }
    }
    for (n, kind) in kinds.into_iter().enumerate() {
        let own = points(&|row| row.set == "front" && row.layer == kind);
        // The colours after the first are those of other fronts.
        let style = match n {
            0 => Style::Dots(0),
            _ => Style::Dots(fronts.len() + n),
        };
        layers.push(layer(kind, own, style));
    }
    for (n, baseline) in baselines.iter().enumerate() {
        let own = points(&|row| row.set == "baseline" && row.name == baseline.name);
        layers.push(layer(&baseline.name, own, Style::Marks(n + 1)));
    }
    let chosen = run.chosen().map(|n| &run.front[n]);
    let at = chosen.and_then(|m| Some((m.objectives.first()?.1, m.objectives.get(1)?.1)));
    layers.push(layer(
        "fuzzy pick",
        at.into_iter().collect(),
        Style::Marks(0),
    ));
    layers.retain(|layer| !layer.points.is_empty());
    let chart = PlaneChart {
        title: if run.front.is_empty() {
            "Constellations by objectives".to_owned()
        } else {
            "Pareto front".to_owned()
        },
        x: Axis::new(label(run, x)),
        y: Axis::new(label(run, y)),
        measure: MeasureAxis::Neither,
        layers,
    };
    Ok(Plate {
        csv: table(&rows, &[names.clone(), run.constraint_names()].concat())?,
        chart: Chart::Plane(chart),
    })
}

/// The label of an objective, with the weight and the level of the tail where it has one.
fn label(run: &Run, name: &str) -> String {
    let label = quantity_label(name);
    let Some(of) = run.scenario.as_ref().map(|scenario| &scenario.objectives) else {
        return label;
    };
    let (weight, level) = (of.cvar_weight, of.cvar_level);
    match Quantity::from_keyword(name) {
        Ok(Quantity::JPos) => format!("{label}, \u{3bb} = {weight}, \u{3b1} = {level}"),
        Ok(Quantity::CvarPdop | Quantity::N1CvarPdop) => format!("{label}, \u{3b1} = {level}"),
        _ => label,
    }
}

fn rows<'a>(
    run: &'a Run,
    names: &[String],
    baselines: &'a [Baseline],
    fronts: &'a [NamedFront],
) -> Vec<FrontRow<'a>> {
    let of_front = |set: &'a str, front: &'a [FrontMember]| {
        let (names, constrained) = (names.to_vec(), run.constraint_names());
        front.iter().map(move |member| FrontRow {
            set,
            layer: used_shells(member),
            name: "",
            generation: None,
            index: Some(member.index),
            made_of: member.made_of(),
            objectives: names.iter().map(|name| member.objective(name)).collect(),
            constraints: constrained.iter().map(|n| member.quantity(n)).collect(),
            membership: Some(member.membership),
        })
    };
    let mut rows: Vec<FrontRow<'_>> = of_front("front", &run.front).collect();
    for other in fronts {
        rows.extend(of_front(&other.name, &other.front));
    }
    rows.extend(baselines.iter().map(|baseline| FrontRow {
        set: "baseline",
        layer: String::new(),
        name: &baseline.name,
        generation: None,
        index: None,
        made_of: baseline.made_of.clone(),
        objectives: baseline.objectives.clone(),
        constraints: baseline.constraints.clone(),
        membership: None,
    }));
    for (generation, objectives) in earlier(run, names) {
        rows.push(FrontRow {
            set: "generation",
            layer: String::new(),
            name: "",
            generation: Some(generation),
            index: None,
            made_of: String::new(),
            objectives: objectives.into_iter().map(Some).collect(),
            constraints: vec![None; run.constraint_names().len()],
            membership: None,
        });
    }
    rows
}

/// Which shells of the search a member has, in words: `front, shells A and B`; `front` where one shell is the
/// whole design.
fn used_shells(member: &FrontMember) -> String {
    let used = member.shells.iter().enumerate();
    let used: Vec<String> = used
        .filter_map(|(n, shell)| shell.as_ref().map(|_| shell_letters(n)))
        .collect();
    match used.as_slice() {
        _ if member.shells.len() < 2 => "front".to_owned(),
        [] => "front, no new shell".to_owned(),
        [one] => format!("front, shell {one} alone"),
        [first @ .., last] => format!("front, shells {} and {last}", first.join(", ")),
    }
}

/// The fronts of earlier generations, point by point, in the original sense of the objectives.
pub(in crate::report) fn earlier(run: &Run, names: &[String]) -> Vec<(u64, Vec<f64>)> {
    let quantities: Vec<_> = names
        .iter()
        .map(|name| Quantity::from_keyword(name).ok())
        .collect();
    let own = |minimised: &Vec<f64>| -> Vec<f64> {
        let pairs = quantities.iter().zip(minimised);
        pairs
            .map(|(q, &v)| q.map_or(v, |q| q.minimised(v)))
            .collect()
    };
    let of_record = |record: &crate::optimize::Record| {
        let fitting = record
            .front
            .iter()
            .filter(|point| point.len() == names.len());
        let generation = record.generation;
        fitting
            .map(|point| (generation, own(point)))
            .collect::<Vec<_>>()
    };
    run.history.iter().flat_map(of_record).collect()
}

fn table(rows: &[FrontRow<'_>], names: &[String]) -> Result<String, FigureError> {
    let columns: Vec<String> = names.iter().map(|name| name.replace('-', "_")).collect();
    let mut header = vec!["set", "generation", "index", "notation"];
    header.extend(columns.iter().map(String::as_str));
    header.extend(["membership", "name"]);
    let mut csv = Csv::new(&header)?;
    for row in rows {
        let number = |value: Option<usize>| value.map_or_else(String::new, |n| n.to_string());
        let mut cells = vec![
            row.set.to_owned(),
            row.generation.map_or_else(String::new, |n| n.to_string()),
            number(row.index),
            row.made_of.clone(),
        ];
        let quantities = row.objectives.iter().chain(&row.constraints);
        cells.extend(quantities.copied().map(optional));
        cells.push(optional(row.membership));
        cells.push(row.name.to_owned());
        csv.row(cells)?;
    }
    csv.text()
}
