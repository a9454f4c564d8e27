//! `navwalker plot`.

use crate::cli::args::PlotArgs;
use crate::cli::run_view::RunView;
use crate::cli::{Status, files, output};
use crate::constellation::Design;
use crate::report::figures::draw::{Form, png, svg};
use crate::report::figures::{self, Figure, Measure, NamedProfile, Plate};
use crate::report::profile::Profile;
use crate::scenario::{Keyword, Region};
use anyhow::{Context, Result, bail};
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &PlotArgs) -> Result<Status> {
    let form = form(args)?;
    let view = RunView::at(&args.run)?;
    let table = table_of(args, form)?;
    make_own_place(args)?;
    let staged = args
        .out
        .as_deref()
        .map(files::StagedFile::new)
        .transpose()?;
    let plate = plate(args, &view)?;
    let bytes = render(&plate, form)?;
    let (Some(out), Some(staged)) = (&args.out, staged) else {
        if form == Form::Png && io::stdout().is_terminal() {
            bail!("a PNG cannot be written to a terminal; give a file with --out");
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

/// Where the data of a figure goes: next to it.
fn table_of(args: &PlotArgs, form: Form) -> Result<Option<PathBuf>> {
    let Some(out) = &args.out else {
        return Ok(None);
    };
    files::refuse_inputs(out, args.run.inputs())?;
    if form == Form::Csv {
        return Ok(None);
    }
    let table = out.with_extension("csv");
    files::refuse_inputs(&table, args.run.inputs())?;
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

/// Makes the directory for figures in the run, if the figure goes there.
fn make_own_place(args: &PlotArgs) -> Result<()> {
    let figures = args.run.directory.join("figures");
    if args.out.as_deref().and_then(Path::parent) == Some(&figures) {
        fs::create_dir_all(&figures)
            .with_context(|| format!("cannot create {}", figures.display()))?;
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

fn render(plate: &Plate, form: Form) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match form {
        Form::Svg => svg(&plate.chart, &mut bytes)?,
        Form::Png => png(&plate.chart, &mut bytes)?,
        Form::Csv => bytes.extend_from_slice(plate.csv.as_bytes()),
    }
    Ok(bytes)
}

fn plate(args: &PlotArgs, view: &RunView) -> Result<Plate> {
    let measure = |usual: Measure| args.measure.unwrap_or(usual);
    Ok(match args.figure {
        Figure::Pareto => figures::pareto(&view.run, &view.baselines(), &view.fronts)?,
        Figure::Convergence => figures::convergence(&view.run)?,
        Figure::Budget => figures::budget(view.run.validation.as_ref())?,
        Figure::Map => {
            let profiles = profiles(args, view, false)?;
            figures::map(&profiles[0].1, measure(Measure::MeanPdop), cell_deg(view))?
        }
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

/// The steps of the region's grid, if it is one.
fn cell_deg(view: &RunView) -> Option<[f64; 2]> {
    match view.run.scenario.as_ref()?.region {
        Region::Grid(grid) => Some(grid.step_deg),
        Region::Points { .. } => None,
    }
}

/// The picked design and those compared with it, evaluated.
fn profiles(args: &PlotArgs, view: &RunView, with_others: bool) -> Result<Vec<(String, Profile)>> {
    let evaluator = view
        .evaluator
        .as_ref()
        .context("this figure needs the scenario of the run, which cannot be set up")?;
    let member = view.pick(&args.pick)?;
    let design: Design = member.design.notation.parse()?;
    let mut wanted = vec![(design.to_string(), design.clone())];
    if with_others {
        let others = view.beside.iter().filter(|(_, other)| *other != design);
        wanted.extend(others.cloned());
    }
    let one = |(name, design): (String, Design)| Ok((name, Profile::new(evaluator, &design)?));
    wanted.into_iter().map(one).collect()
}

fn named(profiles: &[(String, Profile)]) -> Vec<NamedProfile<'_>> {
    let pairs = profiles.iter();
    pairs
        .map(|(name, profile)| NamedProfile {
            name: name.clone(),
            profile,
        })
        .collect()
}
