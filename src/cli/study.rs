//! From the command line to a scenario and its inputs.

mod outages;

use crate::cli::args::{ScenarioText, StudyArgs};
use crate::cli::{files, limits, output};
use crate::constellation::Design;
use crate::evaluate::{Evaluator, Setup};
use crate::exchange::constellation::Constellation;
use crate::ground::ignored_columns;
use crate::run::checkpoint::{Identity, hex_sha256};
use crate::run::inputs::{RunManifest, copy_paths, first_files};
use crate::run::{INPUTS, MANIFEST, SCENARIO, ScenarioStamp};
use crate::scenario::{
    Algorithm, KeyDifference, NamedConstellation, Region, Scenario, SetupError, builtin,
};
use crate::search::{DesignProblem, Goals};
use anyhow::{Context, Result};
use std::cell::{OnceCell, RefCell};
use std::io;
use std::path::{Path, PathBuf};

/// A scenario and the files that it names.
#[derive(Clone)]
pub struct Study {
    /// The scenario.
    pub scenario: Scenario,
    written: Written,
    /// Directory to which paths in the scenario are relative.
    directory: PathBuf,
    /// The manifest of the run directory, if the scenario is that of a run.
    manifest: Option<RunManifest>,
    /// Contents of the files that the scenario names, once they are read.
    contents: OnceCell<Vec<Vec<u8>>>,
    /// The files that these name in turn: the skylines of sites.
    named_in_files: RefCell<Vec<PathBuf>>,
}

/// A scenario with the contents of its files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedStudy {
    /// The scenario with every key.
    pub toml: String,
    /// The contents of the files that it names, in its order.
    pub contents: Vec<Vec<u8>>,
}

/// A scenario as written, to locate errors in it.
#[derive(Clone)]
struct Written {
    label: String,
    bytes: Vec<u8>,
    overrides: Vec<String>,
}

impl Study {
    /// The scenario named on the command line, with its overrides.
    pub(crate) fn load(args: &StudyArgs, further: &[String]) -> Result<Self> {
        let overrides: Vec<String> = args.overrides.iter().chain(further).cloned().collect();
        match &args.text {
            Some(of) => Self::of_text(of, &overrides),
            None => Self::open(args.name(), &overrides),
        }
    }

    /// The built-in scenario of a name, or that in a file, with overrides such as `region.step-deg=2`.
    ///
    /// # Errors
    /// If there is no such scenario, it cannot be read, or a key or value is wrong.
    pub fn open(name: &str, overrides: &[String]) -> Result<Self> {
        let (bytes, directory) = read_scenario(name)?;
        let written = Written::new(name, bytes, overrides, &[]);
        Self::parse(written, directory, None)
    }

    /// The scenario of a text.
    ///
    /// # Errors
    /// If a key or value is wrong.
    pub fn of_text(of: &ScenarioText, overrides: &[String]) -> Result<Self> {
        let written = Written::new(&of.label, of.text.as_bytes().to_vec(), overrides, &[]);
        Self::parse(written, of.directory.clone(), None)
    }

    /// The scenario of a run, which names the run's own copies of its files.
    pub(crate) fn of_run(directory: &Path, overrides: &[String]) -> Result<Self> {
        files::recovered(directory)?;
        let path = directory.join(SCENARIO);
        let bytes = files::read_whole(&path)
            .with_context(|| format!("{} is not a run directory", directory.display()))
            .with_context(|| format!("cannot read {}", path.display()))?;
        let written = Written::new(&path.to_string_lossy(), bytes, overrides, &[]);
        Self::parse(written, directory.to_owned(), read_manifest(directory)?)
    }

    fn parse(written: Written, directory: PathBuf, manifest: Option<RunManifest>) -> Result<Self> {
        let Written {
            label,
            bytes,
            overrides,
        } = &written;
        Ok(Self {
            scenario: Scenario::parse(label, bytes, overrides)?,
            written,
            directory,
            manifest,
            contents: OnceCell::new(),
            named_in_files: RefCell::default(),
        })
    }

    /// The same study with another algorithm.
    pub(crate) fn with_algorithm(&self, algorithm: Algorithm) -> Self {
        let mut other = self.clone();
        other.scenario.optimizer.algorithm = algorithm;
        other
    }

    /// The same study with the default optimiser, on which no metric depends.
    ///
    /// # Errors
    /// Never: the defaults are valid.
    pub fn for_sweep(&self) -> Result<Self> {
        let defaults = Scenario::parse("defaults", b"", &[] as &[&str])?;
        let mut other = self.clone();
        other.scenario.optimizer = defaults.optimizer;
        Ok(other)
    }

    /// All that another process needs to compute the same, wherever its files are.
    ///
    /// # Errors
    /// If a file that the scenario names cannot be read.
    pub fn packed(&self) -> Result<PackedStudy> {
        let contents = self.contents()?.to_vec();
        let paths = copy_paths(&self.scenario.files());
        let toml = self.scenario.with_files(&paths).to_toml();
        Ok(PackedStudy { toml, contents })
    }

    /// The study of such a pack.
    ///
    /// # Errors
    /// If it is none.
    pub fn unpacked(pack: PackedStudy) -> Result<Self> {
        let written = Written::new("scenario", pack.toml.into_bytes(), &[], &[]);
        let mut study = Self::parse(written, PathBuf::new(), None)?;
        study.contents = OnceCell::from(pack.contents);
        Ok(study)
    }

    /// The same study with further constellations, with the contents of their files.
    pub(crate) fn with_constellations(
        &self,
        added: Vec<(NamedConstellation, Vec<Vec<u8>>)>,
    ) -> Result<Self> {
        let mut other = self.clone();
        let mut contents = self.contents()?.to_vec();
        for (named, of_files) in added {
            // The files of constellations are the last of all.
            other.scenario.constellations.push(named);
            contents.extend(of_files);
        }
        other.contents = OnceCell::from(contents);
        Ok(other)
    }

    /// Identifies the satellites from files of a constellation: how they are read, and what is in the files.
    pub(crate) fn digest_of_files(&self, named: &NamedConstellation) -> Result<String> {
        let parts = &named.parts;
        let mut text = format!("{:?}", (parts.input_format, &parts.only, &parts.exclude));
        let contents = self.contents()?;
        for file in &parts.files {
            text += &hex_sha256(&self.content(file, contents)?);
        }
        Ok(hex_sha256(text.as_bytes()))
    }

    /// The identification of the study in results.
    ///
    /// # Errors
    /// If a file that the scenario names cannot be read.
    pub fn stamp(&self) -> Result<ScenarioStamp> {
        Ok(ScenarioStamp {
            name: self.scenario.name.clone(),
            hash: self.hash()?,
        })
    }

    /// Hash of everything that determines the results, including the scenario's files.
    pub(crate) fn hash(&self) -> Result<String> {
        let contents = self.contents()?.iter().map(Vec::as_slice);
        Ok(self.scenario.hash(&contents.collect::<Vec<_>>()))
    }

    /// The identity of a run of this study.
    pub(crate) fn identity(&self) -> Result<Identity> {
        Ok(Identity::of(&self.scenario, self.hash()?))
    }

    /// The initial files of a run of this study.
    pub(crate) fn first_files(&self, identity: &Identity) -> Result<Vec<(String, Vec<u8>)>> {
        Ok(first_files(&self.scenario, self.contents()?, identity)?)
    }

    /// Contents of the files that the scenario names, in its order; read once, so that all results and
    /// copies are based on the same bytes.
    fn contents(&self) -> Result<&[Vec<u8>]> {
        if let Some(contents) = self.contents.get() {
            return Ok(contents);
        }
        let named = self.scenario.files().into_iter();
        let contents = named.map(|file| self.read(file)).collect::<Result<_>>()?;
        Ok(self.contents.get_or_init(|| contents))
    }

    fn read(&self, file: &str) -> Result<Vec<u8>> {
        let bytes = files::read_whole(&self.directory.join(file))
            .map_err(|source| self.placed(&self.scenario.unreadable(file, source)))?;
        // A file named by --set may be elsewhere and is not part of the run.
        let is_copy = file.split('/').next() == Some(INPUTS);
        if let Some(manifest) = self.manifest.as_ref().filter(|_| is_copy) {
            manifest
                .check(file, &bytes)
                .with_context(|| format!("{} is damaged", self.directory.display()))?;
        }
        let read = |path: &str| {
            let place = self.directory.join(path);
            self.named_in_files.borrow_mut().push(place.clone());
            files::read_whole(&place)
        };
        let whole = self.scenario.standing_alone(file, bytes, &read);
        whole.map_err(|error| self.placed(&error))
    }

    /// Replaces the scenario's files by the copies in the run in `directory`, since the originals may
    /// have changed: a resumed run must use the same inputs.
    pub(crate) fn take_files_of(&mut self, directory: &Path) -> Result<()> {
        let paths = copy_paths(&self.scenario.files());
        if paths.is_empty() || !directory.join(MANIFEST).exists() {
            return Ok(());
        }
        let run = Self::of_run(directory, &[])?;
        let computed = self.scenario.computed_files();
        let theirs = &run.scenario.files()[..run.scenario.computed_files()];
        if theirs != &paths[..computed] {
            return Ok(());
        }
        // The constellations that the run is compared with may be others by now.
        let same = run.scenario.files() == paths;
        let taken = if same { paths.len() } else { computed };
        let mut copies = run.contents()?[..taken].to_vec();
        for (file, copy) in self.scenario.files().into_iter().zip(&copies) {
            let found = self.read(file);
            if !found.is_ok_and(|bytes| bytes == *copy) {
                output::warning(&format!(
                    "{file} is missing or has changed since the run began; using its copy in {}",
                    directory.display()
                ));
            }
        }
        for file in self.scenario.files().into_iter().skip(taken) {
            copies.push(self.read(file)?);
        }
        self.contents = OnceCell::from(copies);
        Ok(())
    }

    /// How the scenario of the run in `directory` differs, if that can be determined.
    pub(crate) fn difference_from_run(&self, directory: &Path) -> Option<String> {
        let run = Self::of_run(directory, &[]).ok()?;
        let there_and_here = run.scenario.differences(&self.scenario).into_iter();
        let shown = |value: Option<String>| value.unwrap_or_else(|| "not given".to_owned());
        let mut told: Vec<String> = there_and_here
            .map(|KeyDifference { key, value, other }| {
                format!("{key} is {} there and {} here", shown(value), shown(other))
            })
            .collect();
        let (theirs, ours) = (
            run.scenario.computed_files(),
            self.scenario.computed_files(),
        );
        if theirs != ours {
            told.push(format!("it names {theirs} files there and {ours} here"));
        }
        let copies = &run.manifest.as_ref()?.inputs;
        let files = self.scenario.files().into_iter().take(ours);
        for ((file, bytes), copy) in files.zip(self.contents().ok()?).zip(copies) {
            if !copy.is_of(bytes) {
                told.push(format!("{file} has other contents"));
            }
        }
        (!told.is_empty()).then(|| told.join(", "))
    }

    /// The setup of a search, if it is not very large.
    pub(crate) fn setup(&self) -> Result<Setup> {
        let setup = self.setup_in_tiles()?;
        limits::check_search(&setup)?;
        Ok(setup)
    }

    /// The setup of an evaluation in tiles, of any number of samples.
    pub(crate) fn setup_in_tiles(&self) -> Result<Setup> {
        let contents = self.contents()?;
        let setup = self
            .scenario
            .setup_with_notes(&|file| self.content(file, contents));
        let (setup, notes) = setup.map_err(|error| self.placed(&error))?;
        self.warn_of_columns(contents);
        for note in &notes {
            output::warning(note);
        }
        Ok(setup)
    }

    /// The contents of a file that the scenario names.
    pub(crate) fn named_file(&self, file: &str) -> io::Result<Vec<u8>> {
        let contents = self.contents().map_err(io::Error::other)?;
        self.content(file, contents)
    }

    /// The contents of a file that the scenario names, among those of all.
    fn content(&self, file: &str, contents: &[Vec<u8>]) -> io::Result<Vec<u8>> {
        let mut files = self.scenario.files().into_iter();
        let at = files.position(|known| known == file);
        let bytes = at.and_then(|at| contents.get(at)).cloned();
        bytes.ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    /// A constellation of the scenario, with warnings of the parts of its files that are not read.
    pub(crate) fn constellation(&self, named: &NamedConstellation) -> Result<Constellation> {
        let contents = self.contents()?;
        let grid = self.scenario.time_grid();
        let grid = grid.map_err(|error| self.placed(&error.into()))?;
        let (constellation, notes) = named
            .read(&|file| self.content(file, contents), grid)
            .map_err(|error| self.placed(&error))?;
        for note in &notes {
            output::warning(note);
        }
        Ok(constellation)
    }

    /// Warns of ignored columns of the points file, since one of them may be misspelt.
    fn warn_of_columns(&self, contents: &[Vec<u8>]) {
        if let (Region::Points { file }, Some(points)) = (&self.scenario.region, contents.first()) {
            let ignored = ignored_columns(points.as_slice());
            if !ignored.is_empty() {
                output::warning(&format!("{file}: columns ignored: {}", ignored.join(", ")));
            }
        }
    }

    /// What the study is read from: its scenario or the run directory, and every file that it names, which
    /// with --set may be outside the run, and that those name.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let own = if self.manifest.is_some() {
            Some(self.directory.clone())
        } else {
            is_path(&self.written.label).then(|| PathBuf::from(&self.written.label))
        };
        let named = self.scenario.files().into_iter();
        let named = named.map(|file| self.directory.join(file));
        // An error is told by what needs the contents.
        let _ = self.contents();
        let in_files = self.named_in_files.borrow().clone();
        own.into_iter().chain(named).chain(in_files).collect()
    }

    /// The default design.
    ///
    /// # Errors
    /// If the scenario has none.
    pub fn reference_design(&self) -> Result<Design> {
        let design = self.scenario.reference_design();
        design.map_err(|error| self.placed(&error))
    }

    /// An error of the setup with its place in what was written.
    fn placed(&self, error: &SetupError) -> anyhow::Error {
        let Written {
            label,
            bytes,
            overrides,
        } = &self.written;
        Scenario::setup_problem(label, bytes, overrides, error).into()
    }

    /// The search of the scenario, with the satellites from files that are fixed.
    ///
    /// # Errors
    /// If the space is empty, or a file cannot be read.
    pub fn problem<'e>(&self, evaluator: &'e Evaluator) -> Result<DesignProblem<'e>> {
        let (space, goals) = (self.scenario.design_space(), self.scenario.goals());
        let problem = DesignProblem::new(evaluator, space, goals)?;
        let Some(files) = self.fixed()?.and_then(|fixed| fixed.files) else {
            return Ok(problem);
        };
        let setup = evaluator.setup();
        let satellites = files.fleet.propagate(setup.grid, setup.model)?;
        Ok(problem.with_satellites(&satellites)?)
    }

    /// What every design of the search has beside its own shells, if anything.
    pub(crate) fn fixed(&self) -> Result<Option<Constellation>> {
        let named = self.scenario.fixed()?;
        named.map(|named| self.constellation(&named)).transpose()
    }

    /// What counts in the search, with the satellites from files that are fixed.
    pub(crate) fn goals(&self, fixed: Option<&Constellation>) -> Goals {
        let files = fixed.and_then(|fixed| fixed.files.as_ref());
        Goals {
            fixed_from_files: files.map_or(0, |files| files.fleet.len()),
            ..self.scenario.goals()
        }
    }

    /// The evaluator of the scenario.
    ///
    /// # Errors
    /// If a file that the scenario names cannot be read or is wrong, or a GNSS satellite cannot be propagated.
    pub fn evaluator(&self) -> Result<Evaluator> {
        let setup = self.setup_in_tiles()?;
        limits::check_whole(&setup)?;
        say_of_setup(&setup);
        Ok(Evaluator::new(setup)?)
    }

    /// The evaluator of the scenario for evaluations in tiles.
    ///
    /// # Errors
    /// As [`Study::evaluator`].
    pub fn evaluator_in_tiles(&self) -> Result<Evaluator> {
        let setup = self.setup_in_tiles()?;
        say_of_setup(&setup);
        Ok(Evaluator::new(setup)?)
    }
}

/// Says what is slow in a scenario, and warns of what has no effect.
pub(crate) fn say_of_setup(setup: &Setup) {
    if let Some(note) = setup.plain_path_note() {
        output::hint(&note);
    }
    for note in setup.outages.iter().filter_map(|one| one.note(setup.grid)) {
        output::warning(&note);
    }
}

impl Written {
    fn new(label: &str, bytes: Vec<u8>, overrides: &[String], further: &[String]) -> Self {
        Self {
            label: label.to_owned(),
            bytes,
            overrides: overrides.iter().chain(further).cloned().collect(),
        }
    }
}

/// The manifest of a run directory, if there is one.
pub(crate) fn read_manifest(directory: &Path) -> Result<Option<RunManifest>> {
    let path = directory.join(MANIFEST);
    match files::read_whole(&path) {
        Ok(bytes) => {
            let manifest = RunManifest::read(&bytes);
            let manifest = manifest.with_context(|| format!("{} is damaged", path.display()))?;
            Ok(Some(manifest))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("cannot read {}", path.display())),
    }
}

/// Whether the name of a scenario is that of a file.
fn is_path(name: &str) -> bool {
    name.contains(['/', '\\']) || Path::new(name).extension().is_some()
}

fn read_scenario(name: &str) -> Result<(Vec<u8>, PathBuf)> {
    if !is_path(name) {
        let text = builtin(name).map_err(|unknown| {
            anyhow::anyhow!(
                "no built-in scenario: {unknown}; a file name needs an extension, as in study.toml"
            )
        })?;
        return Ok((text.as_bytes().to_vec(), PathBuf::new()));
    }
    let path = Path::new(name);
    let bytes =
        files::read_whole(path).with_context(|| format!("cannot read the scenario {name}"))?;
    let directory = path.parent().map_or_else(PathBuf::new, Path::to_owned);
    Ok((bytes, directory))
}
