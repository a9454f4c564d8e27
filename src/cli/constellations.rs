//! The constellations that a command works on, from its arguments.

use crate::cli::args::{ChosenArgs, ConstellationArgs, StudyArgs};
use crate::cli::study::Study;
use crate::cli::{coincidence, output, read_constellation, run};
use crate::ephemeris::Ephemeris;
use crate::evaluate::Setup;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::time::TimeGrid;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};

/// An argument that may begin with a name: `NAME=TEXT`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Named {
    /// The name, if given: letters, digits, `-` and `_`.
    pub(crate) name: Option<String>,
    /// What it names.
    pub(crate) text: String,
}

impl std::str::FromStr for Named {
    type Err = std::convert::Infallible;

    fn from_str(argument: &str) -> Result<Self, Self::Err> {
        let is_name = |name: &&str| {
            let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            !name.is_empty() && name.chars().all(allowed)
        };
        let named = argument.split_once('=');
        Ok(match named.filter(|(name, _)| is_name(name)) {
            Some((name, text)) => Self {
                name: Some(name.to_owned()),
                text: text.to_owned(),
            },
            None => Self {
                name: None,
                text: argument.to_owned(),
            },
        })
    }
}

impl ConstellationArgs {
    /// Whether no constellation was given.
    pub(crate) fn is_empty(&self) -> bool {
        self.design.is_empty() && self.constellation.is_empty()
    }

    /// The files and directories that are read.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.constellation.iter().map(|one| Path::new(&one.text))
    }
}

/// The study and the constellations that a command works on: those given, the pick of a run, or else the
/// reference design.
pub(crate) fn study_and_constellations(
    study: &StudyArgs,
    chosen: &ChosenArgs,
) -> Result<(Study, Vec<Constellation>)> {
    if let Some(directory) = &chosen.run {
        if let Some(name) = &study.scenario {
            bail!("a run has its own scenario; omit '{name}' or --run");
        }
        let loaded = Study::of_run(directory, &study.overrides)?;
        let (picked, why) = run::pick(directory, &chosen.pick)?;
        output::hint(&format!("{picked} of {}: {why}", directory.display()));
        return Ok((loaded, vec![Constellation::of_design(picked)]));
    }
    let loaded = Study::load(study, &[])?;
    let mut given = resolve(&chosen.given, &loaded)?;
    let named = &loaded.scenario.constellations;
    if given.is_empty() && !named.is_empty() {
        let names: Vec<&str> = named.iter().map(|one| one.name.as_str()).collect();
        output::hint(&format!(
            "the reference design is taken; --design NAME takes a constellation of the scenario: {}",
            names.join(", ")
        ));
    }
    if given.is_empty() {
        given.push(Constellation::of_design(loaded.reference_design()?));
    }
    Ok((loaded, given))
}

/// The constellations given on the command line: the designs, then the files, each in its order.
pub(crate) fn resolve(args: &ConstellationArgs, study: &Study) -> Result<Vec<Constellation>> {
    let mut found = Vec::new();
    for given in &args.design {
        let one = of_notation(&given.text, study)?;
        found.push(renamed(one, given));
    }
    for given in &args.constellation {
        let one = of_files(args, &PathBuf::from(&given.text))?;
        found.push(renamed(one, given));
    }
    require_different_names(&found)?;
    Ok(found)
}

/// Refuses what is said of files where none is given.
pub(crate) fn require_files(args: &ConstellationArgs) -> Result<()> {
    if !args.constellation.is_empty() {
        return Ok(());
    }
    if !args.satellites.filter().is_empty() {
        bail!("--only and --exclude select satellites of files, and no file is given");
    }
    if args.input_format.is_some() {
        bail!("--input-format names the format of files, and no file is given");
    }
    Ok(())
}

/// The satellites of a constellation on the grid of a setup, with warnings of what is old, interpolated, in one
/// place or about to collide.
pub(crate) fn propagate(one: &Constellation, setup: &Setup) -> Result<Ephemeris> {
    let ephemeris = one
        .ephemeris(setup.grid, setup.model)
        .with_context(|| format!("cannot propagate {}", one.name))?;
    warn_of_files(one, setup.grid);
    coincidence::warn(&setup.gnss, setup.grid, Some(&ephemeris));
    coincidence::warn_of_meetings(&one.name, &ephemeris);
    Ok(ephemeris)
}

/// Warns of old element sets and of interpolated states.
pub(crate) fn warn_of_files(one: &Constellation, grid: TimeGrid) {
    let Some(files) = &one.files else { return };
    if let Some(stale) = files.fleet.stale(&one.name, grid) {
        output::warning(&stale.to_string());
    }
    for note in files.fleet.sampling_notes(grid) {
        output::warning(&note.to_string());
    }
}

fn renamed(one: Constellation, given: &Named) -> Constellation {
    match &given.name {
        Some(name) => one.named(name.clone()),
        None => one,
    }
}

/// A constellation by its name in the scenario, or a design by its notation.
fn of_notation(text: &str, study: &Study) -> Result<Constellation> {
    if let Some(named) = study.scenario.constellation(text) {
        return study.constellation(named);
    }
    let design = study.scenario.design(text);
    let design = design.with_context(|| format!("--design {text}"))?;
    Ok(Constellation::of_design(design))
}

/// The constellations that the scenario names, in its order.
pub(crate) fn of_scenario(study: &Study) -> Result<Vec<Constellation>> {
    let named = study.scenario.constellations.iter();
    named.map(|one| study.constellation(one)).collect()
}

/// The satellites of a file or a directory that the arguments select.
fn of_files(args: &ConstellationArgs, path: &PathBuf) -> Result<Constellation> {
    let (formats, mut fleet) =
        read_constellation::read(std::slice::from_ref(path), args.input_format)?;
    fleet.choose(&args.satellites.filter())?;
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(Constellation::of_files(FileSatellites {
        names: vec![output::shown_path(Path::new(name))],
        formats,
        fleet,
        file_of: Vec::new(),
    }))
}

/// The name of the GNSS alone in tables.
const RESERVED: &str = "gnss-only";

/// Refuses constellations that have the same name, or that of the GNSS alone.
pub(crate) fn require_different_names(constellations: &[Constellation]) -> Result<()> {
    for (n, one) in constellations.iter().enumerate() {
        if one.name == RESERVED {
            bail!("the name {RESERVED} is that of the GNSS alone in tables; choose another");
        }
        if constellations[..n]
            .iter()
            .any(|other| other.name == one.name)
        {
            bail!(
                "two constellations are named {}; name them apart, as in --design first=NOTATION or --constellation first=FILE",
                one.name
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{SatelliteArgs, StudyArgs};
    use std::fs;

    const ELEMENTS: &str = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n\
        A-1,2025-01-01T00:00:00Z,7300,0,50,0,0,0\n\
        A-2,2025-01-01T00:00:00Z,7300,0,50,0,0,180\n";

    /// A study that names a hybrid and a constellation of files.
    fn study(place: &Path) -> Study {
        let text = "[constellations]\n\
            hybrid = \"delta:53:4/2/1@1000+star:90:4/2/1@1100\"\n\
            mixed = { design = \"delta:55:4/2/1@925\", files = [\"a.csv\"], only = [\"A-2\"] }\n";
        fs::write(place.join("study.toml"), text).unwrap();
        fs::write(place.join("a.csv"), ELEMENTS).unwrap();
        let args = StudyArgs {
            scenario: Some(place.join("study.toml").to_string_lossy().into_owned()),
            overrides: Vec::new(),
        };
        Study::load(&args, &[]).unwrap()
    }

    fn designs(texts: &[&str]) -> ConstellationArgs {
        ConstellationArgs {
            design: texts.iter().map(|text| text.parse().unwrap()).collect(),
            constellation: Vec::new(),
            input_format: None,
            satellites: SatelliteArgs::default(),
        }
    }

    #[test]
    fn a_design_may_be_the_name_of_a_constellation_of_the_scenario() {
        let directory = tempfile::TempDir::new().unwrap();
        let study = study(directory.path());
        let args = designs(&["mixed", "second=hybrid", "star:90:4/2/1@925"]);
        let found = resolve(&args, &study).unwrap();
        let told = |one: &Constellation| (one.name.clone(), one.satellite_count());
        let told: Vec<(String, usize)> = found.iter().map(told).collect();
        let expected = [("mixed", 5), ("second", 8), ("star:90:4/2/1@925", 4)];
        assert_eq!(told, expected.map(|(name, count)| (name.to_owned(), count)));
        let named = of_scenario(&study).unwrap();
        let names: Vec<&str> = named.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["hybrid", "mixed"]);
        assert_eq!(named[1], found[0]);
        let unknown = resolve(&designs(&["hybird"]), &study).unwrap_err();
        let unknown = format!("{unknown:#}");
        assert!(
            unknown.starts_with("--design hybird: 'hybird' is not a design; the form is "),
            "{unknown}"
        );
        assert!(
            unknown.ends_with("did you mean 'hybrid'? (choices: hybrid, mixed)"),
            "{unknown}"
        );
    }

    #[test]
    fn files_of_constellations_that_are_missing_have_their_line() {
        let directory = tempfile::TempDir::new().unwrap();
        let study = study(directory.path());
        fs::remove_file(directory.path().join("a.csv")).unwrap();
        let error = format!("{:#}", of_scenario(&study).unwrap_err());
        assert!(
            error.contains("study.toml:3: constellations.mixed.files: a.csv: cannot read it: "),
            "{error}"
        );
    }

    #[test]
    fn a_name_ends_at_the_first_equals_sign() {
        for (argument, name, text) in [
            (
                "delta:55:4/2/1@925,e=0.01",
                None,
                "delta:55:4/2/1@925,e=0.01",
            ),
            (
                "polar=star:90:4/2/1@925",
                Some("polar"),
                "star:90:4/2/1@925",
            ),
            ("a_b-3=x=y.tle", Some("a_b-3"), "x=y.tle"),
            ("./a=b.tle", None, "./a=b.tle"),
            ("=b.tle", None, "=b.tle"),
        ] {
            let found: Named = argument.parse().unwrap();
            assert_eq!(found.name.as_deref(), name, "{argument}");
            assert_eq!(found.text, text, "{argument}");
        }
    }
}
