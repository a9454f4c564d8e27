//! The texts and tables of the page.

use super::Page;
use crate::constellation::gnss::Preset;
use crate::earth;
use crate::report::figures::quantity_label;
use crate::report::validation::digits;
use crate::run::{FrontMember, Hypervolume, Run, VERSION};
use crate::scenario::{Algorithm, Keyword, Quantity, Region, Scenario};
use crate::units::round_decimal;

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

/// The name of an algorithm as written in the literature.
fn algorithm_title(word: &str) -> &str {
    match Algorithm::from_keyword(word) {
        Ok(Algorithm::Nsga2) => "NSGA-II",
        Ok(Algorithm::Mopso) => "MOPSO",
        Ok(Algorithm::Random) => "Random search",
        Ok(Algorithm::Exhaustive) => "Exhaustive search",
        Err(_) => word,
    }
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "none".to_owned(), |value| format!("{value:.4}"))
}

impl PageSummary {
    pub(super) fn new(page: &Page<'_>, places_with_cuts: &[usize]) -> Self {
        let run = page.run;
        let mut paragraphs = Vec::new();
        paragraphs.extend(run.scenario.as_ref().map(setting));
        paragraphs.push(found(run));
        paragraphs.extend(choice(run));
        let notes = run.search.iter().flat_map(|search| &search.diagnostics);
        let notes = notes.map(|d| d.message.clone()).collect();
        let mut gaps = run.gaps.clone();
        let (cut, all) = (places_with_cuts.len(), run.front.len());
        if page.evaluator.is_some() && cut < all {
            gaps.push(format!(
                "this page has the maps and series of {cut} of the {all} designs on the front; \
                 use navwalker plot --pick N for the others"
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
    let region = match &scenario.region {
        Region::Grid(grid) => {
            let [south, north] = grid.latitude_deg;
            let [west, east] = grid.longitude_deg;
            let [dlat, dlon] = grid.step_deg;
            format!(
                "{} to {} and {} to {}, every {dlat}\u{b0} by {dlon}\u{b0}",
                latitude_label(south),
                latitude_label(north),
                longitude_label(west),
                longitude_label(east)
            )
        }
        Region::Points { file } => format!("the points in {file}"),
    };
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
         {}; elevation mask {}\u{b0}.",
        scenario.time.step_s,
        scenario.time.duration_h,
        scenario.time.epoch.format("%Y-%m-%d %H:%M:%S UTC"),
        scenario.visibility.mask_deg
    )
}

/// The name of a GNSS as its operator writes it.
fn preset_title(preset: Preset) -> &'static str {
    match preset {
        Preset::Beidou3 => "BeiDou-3",
        Preset::Gps => "GPS",
        Preset::Galileo => "Galileo",
        Preset::Glonass => "GLONASS",
    }
}

fn latitude_label(degrees: f64) -> String {
    hemisphere(degrees, 'N', 'S')
}

fn longitude_label(degrees: f64) -> String {
    let wrapped = crate::units::wrap_360(degrees);
    let east = if wrapped > 180.0 {
        wrapped - 360.0
    } else {
        wrapped
    };
    hemisphere(east, 'E', 'W')
}

/// `53° N`, `10° W`, and `0°` without a hemisphere.
fn hemisphere(degrees: f64, positive: char, negative: char) -> String {
    let size = round_decimal(degrees.abs(), 6);
    if size == 0.0 {
        return "0\u{b0}".to_owned();
    }
    let letter = if degrees > 0.0 { positive } else { negative };
    format!("{size}\u{b0} {letter}")
}

/// What the search did.
fn found(run: &Run) -> String {
    let members = match run.front.len() {
        0 => "no design that meets the constraints".to_owned(),
        1 => "one design".to_owned(),
        n => format!("{n} designs, none of which dominates another"),
    };
    let Some(search) = &run.search else {
        return format!("The search found {members}.");
    };
    let mut text = format!(
        "{} (seed {}) evaluated {} designs and found {members}.",
        algorithm_title(&search.algorithm),
        search.seed,
        search.evaluations
    );
    let [done, of] = search.generations;
    if done < of {
        text += &format!(" It was stopped after generation {done} of {of}.");
    }
    let Hypervolume { value, reference } = &search.hypervolume;
    if let (Some(value), Some(reference)) = (value, reference) {
        let at: Vec<String> = reference.iter().map(ToString::to_string).collect();
        text += &format!(" The hypervolume at ({}) is {value:.4}.", at.join(", "));
    }
    text
}

/// The chosen design and why.
fn choice(run: &Run) -> Option<String> {
    let member = &run.front[run.chosen()?];
    let objectives: Vec<String> = member
        .objectives
        .iter()
        .map(|(name, value)| format!("{name} {value:.4}"))
        .collect();
    let metrics = &member.metrics;
    Some(format!(
        "The fuzzy pick is {} ({}), with the best worst-case membership on the front, {}. \
         On average {} LEO satellites are in view; mean PDOP is {}, CVaR of PDOP {}, maximum PDOP {}.",
        member.design.notation,
        objectives.join(", "),
        number(Some(member.membership)),
        number(Some(metrics.mean_visible)),
        number(metrics.mean_pdop),
        number(metrics.cvar_pdop),
        number(metrics.max_pdop)
    ))
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
            notation: member.design.notation.clone(),
            value: number(member.objective(name)),
        })
    };
    run.objective_names().iter().filter_map(of).collect()
}

/// The members in the table: at most `most`, evenly spaced over the front, plus the chosen one.
pub(super) fn members(run: &Run, most: usize) -> Vec<MemberRow> {
    let all = &run.front;
    let shown = all.len().min(most);
    let at = |k: usize| k * (all.len() - 1) / (shown - 1).max(1);
    let mut places: Vec<usize> = (0..shown).map(at).collect();
    if let Some(chosen) = run.chosen().filter(|chosen| !places.contains(chosen)) {
        places.push(chosen);
        places.sort_unstable();
    }
    places
        .into_iter()
        .map(|place| row(place, &all[place]))
        .collect()
}

fn row(place: usize, member: &FrontMember) -> MemberRow {
    let metrics = &member.metrics;
    let mut cells: Vec<String> = member
        .objectives
        .iter()
        .map(|o| number(Some(o.1)))
        .collect();
    cells.extend(
        [
            Some(metrics.mean_visible),
            metrics.mean_pdop,
            metrics.cvar_pdop,
            metrics.max_pdop,
            Some(metrics.availability),
            Some(member.membership),
        ]
        .map(number),
    );
    MemberRow {
        place,
        index: member.index,
        notation: member.design.notation.clone(),
        chosen: member.chosen,
        cells,
    }
}

/// The verdict of the validation.
pub(super) fn validated(run: &Run) -> Option<String> {
    let validation = run.validation.as_ref()?;
    let gated = validation
        .findings
        .checks
        .iter()
        .filter(|check| check.gate.is_some());
    let (gated, failed) = gated.fold((0, 0), |(n, f), check| {
        (n + 1, f + usize::from(!check.passed))
    });
    Some(match failed {
        0 => format!("{}: all {gated} gates passed.", validation.design.notation),
        _ => format!(
            "{}: {failed} of {gated} gates failed.",
            validation.design.notation
        ),
    })
}

/// The checks of the validation.
pub(super) fn checks(run: &Run) -> Vec<CheckRow> {
    let checks = run
        .validation
        .iter()
        .flat_map(|validation| &validation.findings.checks);
    let row = checks.map(|check| CheckRow {
        name: check.name.clone(),
        verdict: match (check.gate, check.passed) {
            (None, _) => "info",
            (Some(_), true) => "pass",
            (Some(_), false) => "FAIL",
        },
        value: if check.value.is_finite() {
            digits(check.value)
        } else {
            "none".to_owned()
        },
        gate: check.gate.map_or_else(String::new, digits),
        unit: check.unit.clone(),
        reason: check.reason.clone(),
    });
    row.collect()
}

/// The conventions behind every number.
pub(super) fn conventions(run: &Run) -> Vec<(&'static str, String)> {
    let mut rows = vec![
        (
            "Constants",
            format!(
                "\u{3bc} = {} km\u{b3}/s\u{b2}, R = {} km, J2 = {:e} (EGM96), f = 1/298.257223563",
                earth::MU_KM3_S2,
                earth::RADIUS_KM,
                earth::J2
            ),
        ),
        (
            "Frames",
            "mean elements and propagation in TEME; Earth-fixed by GMST (IAU 1982), UT1 = UTC, no polar \
             motion"
                .to_owned(),
        ),
        (
            "PDOP",
            "unit-weight least squares; unsolved samples are excluded"
                .to_owned(),
        ),
        (
            "Quantiles and CVaR",
            "order statistics; CVaR is the mean of the worst 1 - \u{3b1} of the samples, with fractional weight \
             on the quantile (Rockafellar and Uryasev)"
                .to_owned(),
        ),
    ];
    if let Some(scenario) = &run.scenario {
        rows.extend(of_scenario(scenario));
    }
    if let Some(search) = &run.search {
        rows.push(("Scenario hash", search.scenario.hash.clone()));
    }
    let by = run.search.as_ref();
    let by = by.map_or("unknown", |search| &search.version);
    rows.push((
        "Versions",
        format!("run by navwalker {by}; this page by navwalker {VERSION}"),
    ));
    rows.push((
        "Credits",
        "figures by plotly.js (MIT licence), through the plotly crate; coastlines from Natural Earth \
         (public domain)"
            .to_owned(),
    ));
    rows
}

fn of_scenario(scenario: &Scenario) -> Vec<(&'static str, String)> {
    let objectives = &scenario.objectives;
    vec![
        ("Surface", scenario.earth.surface.to_string()),
        ("LEO propagation", scenario.propagation.model.to_string()),
        ("Receiver clocks", scenario.gnss.clocks.to_string()),
        (
            "Masks",
            format!(
                "LEO {}\u{b0}, GNSS {}\u{b0}; PDOP above {} counts as unsolved",
                scenario.visibility.mask_deg,
                scenario.visibility.gnss_mask_deg,
                scenario.visibility.pdop_cap
            ),
        ),
        (
            "Objectives",
            format!(
                "{}; CVaR weight \u{3bb} = {}, CVaR level \u{3b1} = {}; available means PDOP at most {}",
                run_names(scenario),
                objectives.cvar_weight,
                objectives.cvar_level,
                objectives.availability_pdop
            ),
        ),
    ]
}

fn run_names(scenario: &Scenario) -> String {
    let names: Vec<&str> = scenario
        .objectives
        .minimize
        .iter()
        .map(|q| q.keyword())
        .collect();
    names.join(", ")
}
