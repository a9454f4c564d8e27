//! The texts and tables of the page.

mod conventions;
mod region;

pub(super) use conventions::conventions;

use super::Page;
use crate::constellation::gnss::Preset;
use crate::keyword::Keyword;
use crate::printable::printable;
use crate::report::figures::quantity_label;
use crate::report::validation::digits;
use crate::report::{Baseline, shown};
use crate::run::{FixedSummary, FrontMember, Run};
use crate::scenario::{Quantity, Scenario};
use crate::units::counted;
use crate::validate::Tally;

/// The summary at the top of the page.
pub(super) struct PageSummary {
    /// The study and its result.
    pub(super) paragraphs: Vec<String>,
    /// Diagnostics of the search.
    pub(super) notes: Vec<String>,
    /// What is missing.
    pub(super) gaps: Vec<String>,
}

/// The best design by one objective.
pub(super) struct Best {
    pub(super) objective: String,
    pub(super) place: usize,
    pub(super) notation: String,
    pub(super) value: String,
}

/// A row of the table of members.
pub(super) struct MemberRow {
    pub(super) place: usize,
    pub(super) index: usize,
    pub(super) notation: String,
    pub(super) chosen: bool,
    /// Objectives, then metrics.
    pub(super) cells: Vec<String>,
}

/// A row of the validation.
pub(super) struct CheckRow {
    pub(super) name: String,
    pub(super) verdict: &'static str,
    pub(super) value: String,
    pub(super) gate: String,
    pub(super) unit: String,
    pub(super) reason: String,
}

/// The title of the page.
pub(super) fn title(run: &Run) -> String {
    match &run.scenario {
        Some(scenario) => format!("Constellation study: {}", scenario.name),
        None => "Constellation study".to_owned(),
    }
}

impl PageSummary {
    pub(super) fn new(page: &Page<'_>, places_with_cuts: &[usize]) -> Self {
        let run = page.run;
        let mut paragraphs = Vec::new();
        paragraphs.extend(run.scenario.as_ref().map(setting));
        if page.stamp.is_none() {
            paragraphs.push(found(run));
        }
        paragraphs.extend(choice(page));
        let notes = run.search.iter().flat_map(|search| &search.diagnostics);
        // The diagnostics of comparison designs are recomputed for all designs on the page.
        let beside = !page.compared.is_empty();
        let notes = notes.filter(|d| !beside || d.code != Baseline::DOMINATES);
        let mut notes: Vec<String> = notes.map(|d| d.message.clone()).collect();
        let pick = run.chosen().map(|n| &run.front[n]);
        let compared = page.compared.iter();
        let outdone = compared.filter_map(|one| one.baseline.diagnose(pick?));
        notes.extend(outdone.map(|d| d.message));
        let mut gaps = run.gaps.clone();
        let (cut, all) = (places_with_cuts.len(), run.front.len());
        if page.evaluator.is_some() && cut < all {
            gaps.push(format!(
                "this page has the maps and series of {cut} of the {all} designs on the front; \
                 use navwalker plot --pick N for the others"
            ));
        }
        let (cut, all) = (page.compared_with_cuts().len(), page.compared.len());
        if page.evaluator.is_some() && cut < all {
            gaps.push(format!(
                "this page has the maps and series of the first {cut} of the {all} constellations; use \
                 navwalker plot --pick NAME for the others"
            ));
        }
        Self {
            paragraphs,
            notes,
            gaps,
        }
    }
}

/// Region, time span and GNSS.
fn setting(scenario: &Scenario) -> String {
    let region = region::region(scenario);
    let gnss: Vec<&str> = scenario
        .gnss
        .constellations
        .iter()
        .map(|preset| preset_title(*preset))
        .collect();
    let gnss = if gnss.is_empty() && scenario.gnss.files.is_empty() {
        "no GNSS".to_owned()
    } else {
        let files = scenario.gnss.files.iter().map(String::as_str);
        gnss.into_iter()
            .chain(files)
            .collect::<Vec<_>>()
            .join(" and ")
    };
    format!(
        "Low-Earth-orbit constellations that augment {gnss} over {region}, sampled every {} s for {} h from \
         {}; {}.",
        scenario.time.step_s,
        scenario.time.duration_h,
        scenario.time.epoch.format("%Y-%m-%d %H:%M:%S UTC"),
        mask_clause(scenario)
    )
}

/// The name of a GNSS as its operator writes it.
fn preset_title(preset: Preset) -> &'static str {
    match preset {
        Preset::Beidou3 => "BeiDou-3",
        Preset::Gps => "GPS",
        Preset::Galileo => "Galileo",
        Preset::Glonass => "GLONASS",
        Preset::Qzss => "QZSS",
        Preset::Navic => "NavIC",
    }
}

/// What is fixed in a search, as a sentence after another.
fn beside(fixed: &FixedSummary) -> String {
    let satellites = counted(fixed.in_design + fixed.from_files, "satellite");
    format!(
        " Beside each design: {satellites} of {}.",
        printable(&fixed.name)
    )
}

/// What the search did.
fn found(run: &Run) -> String {
    let members = match run.front.len() {
        0 => "no design that meets the constraints".to_owned(),
        1 => "one design".to_owned(),
        n => format!("a Pareto set of {n} designs, none of which dominates another"),
    };
    let Some(search) = &run.search else {
        return format!("The search found {members}.");
    };
    if search.is_of_given() {
        let given = counted(run.front.len(), "constellation");
        return format!("{given} evaluated as given, without a search.");
    }
    let mut text = format!(
        "{} (seed {}) evaluated {} designs and found {members}.",
        shown::algorithm(&search.algorithm),
        search.seed,
        search.evaluations
    );
    text.extend(search.fixed.as_ref().map(beside));
    let [done, of] = search.generations;
    if done < of {
        text += &format!(" It was stopped after generation {done} of {of}.");
    }
    if let Some(volume) = shown::hypervolume(&search.hypervolume) {
        text += &format!(" The front has {volume}.");
    }
    text
}

/// The chosen design, why it was chosen, and the designs that dominate it.
fn choice(page: &Page<'_>) -> Option<String> {
    let run = page.run;
    let member = &run.front[run.chosen()?];
    let mut text = format!(
        "The fuzzy pick is {} ({}), with the best worst-case membership on the front, {}.",
        member.made_of(),
        shown::objectives(member),
        shown::membership(member.membership),
    );
    let better: Vec<String> = page
        .compared
        .iter()
        .map(|one| &one.baseline)
        .filter(|baseline| baseline.outdoes(member))
        .map(Baseline::label)
        .collect();
    if !better.is_empty() {
        text += &format!(" It is dominated by {}.", better.join(" and by "));
    }
    let metrics = &member.metrics;
    text += &format!(
        " On average {} LEO satellites are in view; mean PDOP is {}, CVaR of PDOP {}, maximum PDOP {}.",
        shown::named("mean-visible", Some(metrics.mean_visible)),
        shown::pdop(metrics.mean_pdop),
        shown::pdop(metrics.cvar_pdop),
        shown::pdop(metrics.max_pdop)
    );
    let constrained = member
        .constraints
        .iter()
        .map(|(name, v)| (name.as_str(), *v));
    if !member.constraints.is_empty() {
        text += &format!(" Constrained quantities: {}.", shown::pairs(constrained));
    }
    Some(text)
}

/// The best design by each objective.
pub(super) fn best(run: &Run) -> Vec<Best> {
    let of = |name: &String| {
        let quantity = Quantity::from_keyword(name).ok();
        let key = |member: &FrontMember| {
            let value = member.objective(name).unwrap_or(f64::INFINITY);
            quantity.map_or(value, |q| q.minimised(value))
        };
        let members = run.front.iter().enumerate();
        let (place, member) = members.min_by(|a, b| key(a.1).total_cmp(&key(b.1)))?;
        Some(Best {
            objective: quantity_label(name),
            place,
            notation: member.made_of(),
            value: shown::named(name, member.objective(name)),
        })
    };
    run.objective_names().iter().filter_map(of).collect()
}

/// The members in the table: at most `most`, evenly spaced over the front, plus the chosen one.
pub(super) fn members(run: &Run, most: usize) -> Vec<MemberRow> {
    let all = &run.front;
    let further = further(run);
    let shown = all.len().min(most);
    let at = |k: usize| k * (all.len() - 1) / (shown - 1).max(1);
    let mut places: Vec<usize> = (0..shown).map(at).collect();
    if let Some(chosen) = run.chosen().filter(|chosen| !places.contains(chosen)) {
        places.push(chosen);
        places.sort_unstable();
    }
    places
        .into_iter()
        .map(|place| row(place, &all[place], &further))
        .collect()
}

/// Metrics with a column of their own in the table of members.
const ALWAYS: [&str; 5] = [
    "mean-visible",
    "mean-pdop",
    "cvar-pdop",
    "max-pdop",
    "availability",
];

/// Constrained quantities that have no other column.
pub(super) fn further(run: &Run) -> Vec<String> {
    let mut names = run.constraint_names();
    names.retain(|name| !ALWAYS.contains(&name.as_str()));
    names
}

fn row(place: usize, member: &FrontMember, further: &[String]) -> MemberRow {
    let metrics = &member.metrics;
    let objectives = member.objectives.iter();
    let mut cells: Vec<String> = objectives.map(|(n, v)| shown::named(n, Some(*v))).collect();
    let values = [
        Some(metrics.mean_visible),
        metrics.mean_pdop,
        metrics.cvar_pdop,
        metrics.max_pdop,
        Some(metrics.availability),
    ];
    let of_metrics = ALWAYS.iter().zip(values);
    cells.extend(of_metrics.map(|(name, value)| shown::named(name, value)));
    let of_constraints = further.iter();
    cells.extend(of_constraints.map(|name| shown::named(name, member.quantity(name))));
    cells.push(shown::membership(member.membership));
    MemberRow {
        place,
        index: member.index,
        notation: member.made_of(),
        chosen: member.chosen,
        cells,
    }
}

/// The verdict of the validation.
pub(super) fn validated(run: &Run) -> Option<String> {
    let validation = run.validation.as_ref()?;
    Some(format!(
        "{}, model {}: {}.",
        validation.subject(),
        validation.model,
        Tally::of(&validation.findings.checks)
    ))
}

/// The checks of the validation.
pub(super) fn checks(run: &Run) -> Vec<CheckRow> {
    let checks = run
        .validation
        .iter()
        .flat_map(|validation| &validation.findings.checks);
    let row = checks.map(|check| CheckRow {
        name: check.name.clone(),
        verdict: check.outcome().keyword(),
        value: digits(check.value),
        gate: check.gate.map_or_else(String::new, digits),
        unit: check.unit.clone(),
        reason: check.reason.clone(),
    });
    row.collect()
}

/// The masks in a sentence; only one if both are the same.
fn mask_clause(scenario: &Scenario) -> String {
    let visibility = &scenario.visibility;
    let (leo, gnss) = (visibility.mask_deg, visibility.gnss_mask_deg);
    let mut text = if leo == gnss {
        format!("elevation mask {leo}\u{b0}")
    } else {
        format!("elevation masks {leo}\u{b0} (LEO) and {gnss}\u{b0} (GNSS)")
    };
    let heights = visibility.mask_table.iter().map(|point| point.mask_deg);
    if let Some(highest) = heights.reduce(f64::max) {
        text += &format!(", with a skyline of up to {highest}\u{b0}");
    }
    if scenario.terrain.terrain.is_some() {
        text += ", over the skyline of the terrain";
    }
    text
}
