//! `navwalker plot`.

mod look;

use super::evaluate::deployment::DeploymentTable;
use super::evaluate::failures::{self, FailureSets};
use crate::cli::args::{MemberPick, PlotArgs};
use crate::cli::run_view::View;
use crate::cli::{Status, files, output};
use crate::ephemeris::Ephemeris;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::Constellation;
use crate::ground::RegionMap;
use crate::optimize::Pick;
use crate::report::Compared;
use crate::report::figures::draw::{Form, Sheet, pdf, png, svg};
use crate::report::figures::{
    self, Figure, Measure, NamedLosses, NamedPhases, NamedProfile, Plate,
};
use crate::report::profile::Profile;
use crate::scenario::Keyword;
use anyhow::{Context, Result, bail};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &PlotArgs) -> Result<Status> {
    let form = form(args)?;
    refuse_figure_of_search(args)?;
    let sheet = look::sheet(&args.look)?;
    let choice = look::axis(&args.look)?;
    let view = View::new(&args.view)?;
    let table = table_of(args, &view, form)?;
    let staged = args
        .out
        .as_deref()
        .map(files::StagedFile::with_directories)
        .transpose()?;
    let mut plate = plate(args, &view)?;
    choice.apply(&mut plate.chart)?;
    look::style(&args.look, &mut plate.chart)?;
    let bytes = render(&plate, form, sheet)?;
    let (Some(out), Some(staged)) = (&args.out, staged) else {
        if matches!(form, Form::Png | Form::Pdf) && io::stdout().is_terminal() {
            bail!("a {form} cannot be written to a terminal; give a file with --out");
        }
        io::stdout().lock().write_all(&bytes)?;
        return Ok(Status::Done);
    };
    if let Some(table) = table.as_deref().filter(|_| !args.force) {
        require_same(table, plate.csv.as_bytes())?;
    }
    staged.commit(&bytes)?;
    let mut written = out.display().to_string();
    if let Some(table) = table {
        files::write_atomically(&table, plate.csv.as_bytes())?;
        written += &format!("\n{}", table.display());
    }
    output::result(&written)?;
    Ok(Status::Done)
}

/// Refuses a figure that only a run has, before anything is computed.
fn refuse_figure_of_search(args: &PlotArgs) -> Result<()> {
    if args.figure != Figure::Failures && (args.failures.is_some() || args.draws.is_some()) {
        bail!(
            "--failures and --draws are of the figure failures, not of {}",
            args.figure
        );
    }
    if args.figure != Figure::Phases && args.phases.is_some() {
        bail!("--phases is of the figure phases, not of {}", args.figure);
    }
    let of_run = matches!(args.figure, Figure::Convergence | Figure::Budget);
    if of_run && args.view.run().is_none() {
        bail!(
            "figure {} is of a run: give its directory in place of the scenario",
            args.figure
        );
    }
    Ok(())
}

/// Where the data of a figure goes: next to it.
fn table_of(args: &PlotArgs, view: &View, form: Form) -> Result<Option<PathBuf>> {
    let Some(out) = &args.out else {
        return Ok(None);
    };
    let inputs = || view.inputs.iter().map(PathBuf::as_path);
    files::refuse_inputs(out, inputs())?;
    if form == Form::Csv {
        return Ok(None);
    }
    let table = out.with_extension("csv");
    files::refuse_inputs(&table, inputs())?;
    Ok(Some(table))
}

/// Refuses to overwrite an existing table with other data, whatever it is.
fn require_same(table: &Path, data: &[u8]) -> Result<()> {
    let is_other = table.exists() && files::read_whole(table).is_ok_and(|found| found != data);
    if is_other {
        bail!(
            "the data of the figure goes to {}, which contains something else; choose another --out, \
             or replace it with --force",
            table.display()
        );
    }
    Ok(())
}

/// The form asked for, or that of the file's extension.
fn form(args: &PlotArgs) -> Result<Form> {
    if let Some(form) = args.form {
        return Ok(form);
    }
    let extension = args.out.as_deref().and_then(Path::extension);
    match extension {
        None => Ok(Form::Svg),
        Some(extension) => Form::from_keyword(&extension.to_string_lossy().to_lowercase())
            .context("cannot infer the format from --out; use --as"),
    }
}

fn render(plate: &Plate, form: Form, sheet: Sheet) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match form {
        Form::Svg => svg(&plate.chart, sheet, &mut bytes)?,
        Form::Pdf => pdf(&plate.chart, sheet, &mut bytes)?,
        Form::Png => png(&plate.chart, sheet, &mut bytes)?,
        Form::Csv => bytes.extend_from_slice(plate.csv.as_bytes()),
    }
    Ok(bytes)
}

fn plate(args: &PlotArgs, view: &View) -> Result<Plate> {
    let measure = |usual: Measure| args.measure.unwrap_or(usual);
    Ok(match args.figure {
        Figure::Pareto => figures::pareto(&view.run, &view.baselines(), &view.fronts)?,
        Figure::Convergence => figures::convergence(&view.run)?,
        Figure::Budget => figures::budget(view.run.validation.as_ref())?,
        Figure::Failures => {
            let failing = (args.failures.unwrap_or(1), args.draws);
            figures::failures(&losses(args.pick.as_deref(), failing, view)?)?
        }
        Figure::Phases => figures::phases(&phases(args, view)?, measure(Measure::Availability))?,
        Figure::Map => {
            require_one(args, view)?;
            let profiles = profiles(args, view, false)?;
            let first = &named(&profiles)[0];
            figures::map(first, measure(Measure::MeanPdop), &region_map(view))?
        }
        Figure::Timeline => {
            require_one(args, view)?;
            figures::timeline(&named(&profiles(args, view, false)?)[0])?
        }
        Figure::Histogram => figures::histogram(&named(&profiles(args, view, true)?))?,
        Figure::Cdf => {
            let profiles = profiles(args, view, true)?;
            figures::cdf(&named(&profiles), measure(Measure::MeanVisible))?
        }
        Figure::Series => {
            let profiles = profiles(args, view, true)?;
            figures::series(&named(&profiles), measure(Measure::MaxPdop))?
        }
    })
}

/// Refuses to choose which of several constellations a map or a timeline shows; of a front it is the fuzzy pick.
fn require_one(args: &PlotArgs, view: &View) -> Result<()> {
    let several = view.compared.as_slice();
    if args.pick.is_some() || view.is_of_search() || several.len() < 2 {
        return Ok(());
    }
    bail!(
        "figure {} shows one constellation, and there are {}: choose one with --pick, by its number or its name: {}",
        args.figure,
        several.len(),
        names(several)
    )
}

/// The cells and borders of the region.
fn region_map(view: &View) -> RegionMap {
    let setup = view.evaluator.as_ref().map(Evaluator::setup);
    setup.map_or_else(RegionMap::default, |setup| setup.map.clone())
}

/// A constellation evaluated for a figure.
struct Shown {
    name: String,
    notation: String,
    profile: Profile,
}

/// What was picked: a member of the front, or a constellation.
enum FirstShown<'a> {
    Member(Constellation),
    Constellation(&'a Compared),
}

/// The pick, and those compared with it, without each of their satellites.
pub(super) fn losses(
    pick: Option<&str>,
    (k, draws): (u8, Option<u32>),
    view: &View,
) -> Result<Vec<NamedLosses>> {
    let evaluator = view
        .evaluator
        .as_ref()
        .context("this figure needs the scenario of the run, which cannot be set up")?;
    let k = usize::from(k);
    let seed = seed_of(view);
    let of = |name: &str, notation: &str, ephemeris: &Ephemeris| -> Result<NamedLosses> {
        let satellites = ephemeris.satellites();
        failures::require_one_left(name, satellites.len(), k)?;
        let sets = FailureSets::new(satellites.len(), k, (draws, seed));
        let lost = evaluator.without_each(ephemeris, &sets.sets)?;
        let names = |set: &Vec<usize>| {
            let names = set.iter().map(|place| satellites[*place].name.as_str());
            names.collect::<Vec<_>>().join("+")
        };
        Ok(NamedLosses {
            name: name.to_owned(),
            notation: notation.to_owned(),
            whole: evaluator.evaluate_ephemeris(ephemeris)?,
            lost: sets.sets.iter().map(names).zip(lost).collect(),
            k,
            is_drawn: sets.drawn.is_some(),
        })
    };
    let picked = picked(pick, view)?;
    let first = match &picked {
        FirstShown::Member(one) => of(&one.name, &one.name, &one.in_service(evaluator.setup())?)?,
        FirstShown::Constellation(one) => {
            of(&one.baseline.name, &one.baseline.made_of, &one.ephemeris)?
        }
    };
    let mut all = vec![first];
    for other in &view.compared {
        if all.iter().all(|known| known.name != other.baseline.name) {
            let made_of = &other.baseline.made_of;
            all.push(of(&other.baseline.name, made_of, &other.ephemeris)?);
        }
    }
    Ok(all)
}

/// The map of the maximum PDOP of the pick, or the first constellation: without any one satellite, each point by itself, or
/// without the worst set of several.
pub(super) fn map_of_losses(
    losses: &NamedLosses,
    draws: Option<u32>,
    view: &View,
) -> Result<Plate> {
    let evaluator = evaluator_of(view)?;
    let ephemeris = match &picked(None, view)? {
        FirstShown::Member(one) => one.in_service(evaluator.setup())?,
        FirstShown::Constellation(one) => one.constellation.in_service(evaluator.setup())?,
    };
    let worst = losses.worst_first().first().copied();
    let (name, measure, profile) = match worst.filter(|_| losses.k > 1) {
        Some(worst) => {
            let satellites = ephemeris.satellites().len();
            let sets = FailureSets::new(satellites, losses.k, (draws, seed_of(view)));
            let left = ephemeris.without(&sets.sets[worst]);
            let name = format!("{} without {}", losses.name, losses.lost[worst].0);
            (name, Measure::MaxPdop, Profile::new(evaluator, &left)?)
        }
        None => {
            let profile = Profile::new(evaluator, &ephemeris)?;
            let profile = profile.with_one_lost(evaluator, &ephemeris)?;
            (losses.name.clone(), Measure::OneLostMaxPdop, profile)
        }
    };
    let named = NamedProfile {
        notation: name.clone(),
        name,
        profile: &profile,
    };
    Ok(figures::map(&named, measure, &region_map(view))?)
}

/// The seed of draws.
fn seed_of(view: &View) -> u64 {
    view.run.scenario.as_ref().map_or(1, |of| of.optimizer.seed)
}

/// The phases of the constellations, or of the pick of a search.
fn phases(args: &PlotArgs, view: &View) -> Result<Vec<NamedPhases>> {
    let evaluator = evaluator_of(view)?;
    let table = DeploymentTable::read(args.phases.as_deref())?;
    let table = table.context("figure phases needs its table: give --phases FILE")?;
    let of = |one: &Constellation, notation: &str| -> Result<NamedPhases> {
        let ephemeris = one.in_service(evaluator.setup())?;
        Ok(NamedPhases {
            name: one.name.clone(),
            notation: notation.to_owned(),
            phases: table.phases(evaluator, one, &ephemeris)?,
        })
    };
    if let FirstShown::Member(one) = &picked(args.pick.as_deref(), view)? {
        return Ok(vec![of(one, &one.name)?]);
    }
    let compared = view.compared.iter();
    compared
        .map(|one| of(&one.constellation, &one.baseline.made_of))
        .collect()
}

fn evaluator_of(view: &View) -> Result<&Evaluator> {
    let evaluator = view.evaluator.as_ref();
    evaluator.context("this needs the scenario of the run, which cannot be set up")
}

/// The pick, and those compared with it, evaluated.
fn profiles(args: &PlotArgs, view: &View, with_others: bool) -> Result<Vec<Shown>> {
    let evaluator = view
        .evaluator
        .as_ref()
        .context("this figure needs the scenario of the run, which cannot be set up")?;
    let of_constellation = |one: &Compared| -> Result<Shown> {
        Ok(Shown {
            name: one.baseline.name.clone(),
            notation: one.baseline.made_of.clone(),
            profile: Profile::new(evaluator, &one.ephemeris)?,
        })
    };
    let picked = picked(args.pick.as_deref(), view)?;
    let mut first = match &picked {
        FirstShown::Member(one) => Shown {
            name: one.name.clone(),
            notation: one.name.clone(),
            profile: Profile::of_constellation(evaluator, one)?,
        },
        FirstShown::Constellation(one) => of_constellation(one)?,
    };
    if args.figure == Figure::Map && args.measure.is_some_and(Measure::is_of_one_lost) {
        first.profile = match &picked {
            FirstShown::Member(one) => {
                let ephemeris = one.in_service(evaluator.setup())?;
                first.profile.with_one_lost(evaluator, &ephemeris)?
            }
            FirstShown::Constellation(one) => {
                first.profile.with_one_lost(evaluator, &one.ephemeris)?
            }
        };
    }
    let is_first = |other: &&Compared| match &picked {
        FirstShown::Member(one) => other.constellation.name == one.name,
        FirstShown::Constellation(one) => std::ptr::eq(*one, *other),
    };
    let mut shown = vec![first];
    if with_others {
        for other in view.compared.iter().filter(|other| !is_first(other)) {
            shown.push(of_constellation(other)?);
        }
    }
    Ok(shown)
}

/// The constellation of that name; else the design picked from a front, or that number of the constellations.
fn picked<'a>(pick: Option<&str>, view: &'a View) -> Result<FirstShown<'a>> {
    let compared = &view.compared;
    let named = pick.and_then(|pick| compared.iter().find(|one| one.constellation.name == pick));
    if let Some(one) = named {
        return Ok(FirstShown::Constellation(one));
    }
    let method = pick.and_then(|pick| pick.parse::<Pick>().ok());
    if view.is_of_search() {
        if let (Some(pick), None) = (pick, method) {
            bail!(
                "--pick {pick}: expected fuzzy, sum, topsis, knee, the index of a design on the front, or a name \
                 among {}",
                names(compared)
            );
        }
        let member = view.pick(&MemberPick::Pick(method.unwrap_or(Pick::Fuzzy)))?;
        let one = member.constellation(view.fixed.as_ref());
        let one = one.with_context(|| format!("design {} has no notation", member.index))?;
        return Ok(FirstShown::Member(one));
    }
    let place = match (pick, method) {
        (None, _) => Some(0),
        (Some(_), Some(Pick::Index(number))) => number.checked_sub(1),
        (Some(_), Some(method)) => {
            let picked = MemberPick::Pick(method).apply(&view.given);
            picked.ok().map(|picked| picked.place)
        }
        (Some(_), None) => None,
    };
    let one = place.and_then(|place| compared.get(place));
    one.map(FirstShown::Constellation).with_context(|| {
        format!(
            "--pick {}: expected a number from 1 to {}, or a name among {}",
            pick.unwrap_or_default(),
            compared.len(),
            names(compared)
        )
    })
}

fn names(compared: &[Compared]) -> String {
    let names: Vec<&str> = compared
        .iter()
        .map(|one| one.baseline.name.as_str())
        .collect();
    names.join(", ")
}

fn named(shown: &[Shown]) -> Vec<NamedProfile<'_>> {
    let each = shown.iter().map(|one| NamedProfile {
        name: one.name.clone(),
        notation: one.notation.clone(),
        profile: &one.profile,
    });
    each.collect()
}
