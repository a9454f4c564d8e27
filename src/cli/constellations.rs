//! The constellations that a command works on, from its arguments.

use crate::cli::args::{ChosenArgs, ConstellationArgs, StudyArgs};
use crate::cli::read_constellation::FileContents;
use crate::cli::study::Study;
use crate::cli::{coincidence, output, read_constellation, run};
use crate::ephemeris::Ephemeris;
use crate::evaluate::Setup;
use crate::exchange::constellation::{
    Constellation, ConstellationError, FileSatellites, GNSS_ONLY, accepted_name, is_name,
};
use crate::exchange::import::StateChoice;
use crate::time::TimeGrid;
use anyhow::{Context, Result, anyhow, bail};
use std::collections::BTreeSet;
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

impl Named {
    /// The argument as it was given.
    fn argument(&self) -> String {
        match &self.name {
            Some(name) => format!("{name}={}", self.text),
            None => self.text.clone(),
        }
    }

    /// What is before the first `=` and cannot be a name; a notation has `=` after its first `:` only.
    fn refused_name(&self) -> Option<&str> {
        let (head, _) = self.text.split_once('=')?;
        (self.name.is_none() && !head.contains(':')).then_some(head)
    }
}

/// A constellation that is given, and where its satellites come from.
pub(crate) struct GivenConstellation {
    pub(crate) constellation: Constellation,
    pub(crate) source: ConstellationSource,
}

/// Where the satellites of a constellation come from.
pub(crate) enum ConstellationSource {
    /// A notation.
    Notation,
    /// The scenario, under this name.
    Scenario(String),
    /// Files, with their contents if they are kept.
    Files(Vec<FileContents>),
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
        let (picked, why) = run::pick(directory, &loaded, &chosen.pick)?;
        output::hint(&format!(
            "{} of {}: {why}",
            picked.name,
            directory.display()
        ));
        return Ok((loaded, vec![picked]));
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
    let given = resolve_given(args, study, false)?.into_iter();
    Ok(given.map(|one| one.constellation).collect())
}

/// The same, with where they come from and, to be kept, the contents of their files.
pub(crate) fn resolve_given(
    args: &ConstellationArgs,
    study: &Study,
    with_contents: bool,
) -> Result<Vec<GivenConstellation>> {
    let mut found = Vec::new();
    for given in &args.design {
        found.push(of_notation(given, study)?.named_as(given));
    }
    // A span of time that is none is reported with its place.
    let choice = match study.scenario.time_grid() {
        Ok(grid) => StateChoice::new(args.satellites.filter(), grid),
        Err(_) => StateChoice::default(),
    };
    for given in &args.constellation {
        found.push(of_files(args, given, &choice, with_contents)?.named_as(given));
    }
    require_different_names(found.iter().map(|one| &one.constellation))?;
    Ok(found)
}

/// The error of a selection without files.
pub(crate) fn no_file_to_select_from() -> anyhow::Error {
    anyhow!("--only and --exclude select satellites of files, and no file is given")
}

/// Refuses what is said of files where none is given.
pub(crate) fn require_files(args: &ConstellationArgs) -> Result<()> {
    if !args.constellation.is_empty() {
        return Ok(());
    }
    if !args.satellites.filter().is_empty() {
        return Err(no_file_to_select_from());
    }
    if args.input_format.is_some() {
        bail!("--input-format names the format of files, and no file is given");
    }
    Ok(())
}

/// The satellites of a constellation on the grid of a setup, with warnings of what is old, interpolated, in one
/// place or about to collide.
pub(crate) fn propagate(one: &Constellation, setup: &Setup) -> Result<Ephemeris> {
    let ephemeris = propagate_member(one, setup)?;
    warn_of_files(one, setup.grid);
    coincidence::warn(&setup.gnss, setup.grid, Some(&ephemeris));
    coincidence::warn_of_meetings(&one.name, &ephemeris);
    Ok(ephemeris)
}

/// The same for a member of a run, of which the command that made the run has warned.
pub(crate) fn propagate_member(one: &Constellation, setup: &Setup) -> Result<Ephemeris> {
    match one.in_service(setup) {
        // It says of what, and where it is written.
        Err(ConstellationError::Outage(error)) => Err(error.into()),
        found => found.with_context(|| format!("cannot propagate {}", one.name)),
    }
}

/// Refuses `--without` where all satellites count, in service or not.
pub(crate) fn refuse_without(names: &[String]) -> Result<()> {
    match names.first() {
        None => Ok(()),
        Some(name) => bail!(
            "--without {name}: validate compares every satellite, in service or not; --without is of evaluate, export, report \
             and plot, and --exclude leaves satellites of files (--constellation) out"
        ),
    }
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

impl GivenConstellation {
    fn named_as(self, given: &Named) -> Self {
        let constellation = match &given.name {
            Some(name) => self.constellation.named(name.clone()),
            None => self.constellation,
        };
        Self {
            constellation,
            ..self
        }
    }
}

/// A constellation by its name in the scenario, or a design by its notation.
fn of_notation(given: &Named, study: &Study) -> Result<GivenConstellation> {
    let text = &given.text;
    if let Some(named) = study.scenario.constellation(text) {
        return Ok(GivenConstellation {
            constellation: study.constellation(named)?,
            source: ConstellationSource::Scenario(named.name.clone()),
        });
    }
    let argument = given.argument();
    if text.is_empty() {
        bail!("--design {argument}: no notation is given");
    }
    let design = study.scenario.design(text);
    if design.is_err() && Path::new(text).exists() {
        bail!("--design {argument}: this is a file; give it as --constellation {argument}");
    }
    if let (Err(_), Some(head)) = (&design, given.refused_name()) {
        bail!(
            "--design {argument}: '{head}' is not a name, expected {}",
            accepted_name()
        );
    }
    let design = design.with_context(|| format!("--design {argument}"))?;
    Ok(GivenConstellation {
        constellation: Constellation::of_design(design),
        source: ConstellationSource::Notation,
    })
}

/// The constellations that the scenario names, in its order.
pub(crate) fn of_scenario(study: &Study) -> Result<Vec<Constellation>> {
    let named = study.scenario.constellations.iter();
    named.map(|one| study.constellation(one)).collect()
}

/// The same as those that are given.
pub(crate) fn given_by_scenario(study: &Study) -> Result<Vec<GivenConstellation>> {
    let given = |constellation: Constellation| GivenConstellation {
        source: ConstellationSource::Scenario(constellation.name.clone()),
        constellation,
    };
    Ok(of_scenario(study)?.into_iter().map(given).collect())
}

/// The satellites of a file or a directory that the arguments select.
fn of_files(
    args: &ConstellationArgs,
    given: &Named,
    choice: &StateChoice,
    with_contents: bool,
) -> Result<GivenConstellation> {
    let path = PathBuf::from(&given.text);
    if given.text.is_empty() {
        bail!("--constellation {}: no file is given", given.argument());
    }
    if let Some(head) = given.refused_name().filter(|_| !path.exists()) {
        bail!(
            "--constellation {}: there is no such file, and '{head}' is not a name, expected {}",
            given.argument(),
            accepted_name()
        );
    }
    let paths = std::slice::from_ref(&path);
    let read = |choice: &StateChoice| match with_contents {
        true => read_constellation::read_with_contents(paths, args.input_format, choice),
        false => {
            let merged = read_constellation::read(paths, args.input_format, choice)?;
            Ok((merged, Vec::new()))
        }
    };
    let filter = args.satellites.filter();
    let (mut merged, mut contents) = read(choice)?;
    if merged.fleet.lacks_states(&filter) {
        (merged, contents) = read(&choice.of_all())?;
    }
    let name = path.file_name().unwrap_or(path.as_os_str());
    let names = vec![output::shown_path(Path::new(name))];
    let files = FileSatellites::new(names, merged, &filter)?;
    Ok(GivenConstellation {
        constellation: Constellation::of_files(files),
        source: ConstellationSource::Files(contents),
    })
}

/// Refuses constellations that have the same name, or that of the GNSS alone.
pub(crate) fn require_different_names<'a>(
    constellations: impl IntoIterator<Item = &'a Constellation>,
) -> Result<()> {
    let mut taken = BTreeSet::new();
    for Constellation { name, .. } in constellations {
        if name == GNSS_ONLY {
            bail!("the name {GNSS_ONLY} is that of the GNSS alone in tables; choose another");
        }
        if !taken.insert(name) {
            bail!(
                "two constellations are named {name}; name them apart, as in --design first=NOTATION or --constellation first=FILE"
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
            ..StudyArgs::default()
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

    #[test]
    fn what_is_mistaken_for_a_design_or_a_name_is_said() {
        let directory = tempfile::TempDir::new().unwrap();
        let study = study(directory.path());
        let error = |text: &str| {
            let error = resolve(&designs(&[text]), &study).unwrap_err();
            format!("{error:#}")
        };
        let file = directory
            .path()
            .join("a.csv")
            .to_string_lossy()
            .into_owned();
        assert_eq!(
            error(&file),
            format!("--design {file}: this is a file; give it as --constellation {file}")
        );
        assert!(error(&format!("x={file}")).ends_with(&format!("--constellation x={file}")));
        assert_eq!(error("x="), "--design x=: no notation is given");
        let long = "n".repeat(65);
        for name in ["a b", "é", long.as_str()] {
            let told = error(&format!("{name}=delta:55:4/2/1@925"));
            let expected =
                format!("'{name}' is not a name, expected a name of letters, digits, '-' and '_'");
            assert!(told.contains(&expected), "{told}");
        }
        let twice = error("delta:55:4/2/1@925,e=0,e=0");
        assert!(twice.ends_with("option e is given twice"), "{twice}");
        let files = ConstellationArgs {
            constellation: vec!["a b=c.tle".parse().unwrap()],
            ..designs(&[])
        };
        let told = format!("{:#}", resolve(&files, &study).unwrap_err());
        assert!(
            told.contains("there is no such file, and 'a b' is not a name"),
            "{told}"
        );
        let empty = ConstellationArgs {
            constellation: vec!["x=".parse().unwrap()],
            ..designs(&[])
        };
        let told = format!("{:#}", resolve(&empty, &study).unwrap_err());
        assert_eq!(told, "--constellation x=: no file is given");
    }
}
