//! The evaluations of a search in its run directory, and the front of those of another.

use crate::cli::args::{OptimizeArgs, OutputFormat};
use crate::cli::commands::optimize;
use crate::cli::study::Study;
use crate::cli::sweep_store::SweepStore;
use crate::cli::{Status, files, output};
use crate::evaluate::Evaluator;
use crate::optimize::{Search, Strategy};
use crate::report::{EvaluatedFront, EvaluationSource};
use crate::run::checkpoint::hex_sha256;
use crate::run::evaluations::{
    EVALUATIONS_CSV, EVALUATIONS_JSON, EVALUATIONS_PARTIAL, EvaluationColumns, EvaluationsStamp,
    read_evaluations,
};
use crate::run::sweep::{SWEEP_JSON, SweepDesigns, SweepSource};
use crate::run::{OptimizeResult, VERSION, front_csv};
use crate::search::{DesignProblem, RecordingProblem};
use anyhow::{Context, Result, bail};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The table of the evaluations of a search that is under way.
pub(crate) struct EvaluationsFile<'a> {
    problem: &'a DesignProblem<'a>,
    recording: RecordingProblem<'a>,
    columns: EvaluationColumns,
    directory: PathBuf,
    file: File,
    rows: u64,
}

impl<'a> EvaluationsFile<'a> {
    /// The table for a search in its directory, if it is asked for or the search has one already: that of a search that
    /// is resumed is cut to what the search has evaluated.
    pub(crate) fn open(
        is_asked_for: bool,
        directory: &Path,
        problem: &'a DesignProblem<'a>,
        search: &Search,
    ) -> Result<Option<Self>> {
        let rows = search.progress().evaluations;
        let begun = [EVALUATIONS_PARTIAL, EVALUATIONS_CSV].map(|name| directory.join(name));
        let is_continued = rows > 0 && begun.iter().any(|path| path.exists());
        if !is_asked_for && !is_continued {
            return Ok(None);
        }
        let columns = EvaluationColumns::new(problem);
        let text = if rows == 0 {
            columns.heading()?
        } else {
            cut(&begun, &columns.heading()?, rows).with_context(|| {
                format!(
                    "{} has no table of the {rows} evaluations so far; start over with --evaluations and without --resume",
                    directory.display()
                )
            })?
        };
        let path = directory.join(EVALUATIONS_PARTIAL);
        files::write_atomically(&path, text.as_bytes())?;
        let file = File::options().append(true).open(&path);
        Ok(Some(Self {
            problem,
            recording: RecordingProblem::new(problem),
            columns,
            directory: directory.to_owned(),
            file: file.with_context(|| format!("cannot write {}", path.display()))?,
            rows,
        }))
    }

    /// Takes a step of the search, and adds what it evaluates.
    pub(crate) fn step(&mut self, search: &mut Search) -> Result<()> {
        search.step(&self.recording)?;
        let evaluations = self.recording.take();
        let generation = search.progress().step;
        let rows = self
            .columns
            .rows(self.problem, generation, self.rows + 1, &evaluations)?;
        self.rows += evaluations.len() as u64;
        let mut write = || {
            self.file.write_all(rows.as_bytes())?;
            self.file.sync_data()
        };
        write().with_context(|| {
            let path = self.directory.join(EVALUATIONS_PARTIAL);
            format!("cannot write {}", path.display())
        })
    }

    /// Puts the table beside the results of its search.
    pub(crate) fn finish(self, study: &Study) -> Result<()> {
        let path = self.directory.join(EVALUATIONS_PARTIAL);
        let cannot = || format!("cannot read {}", path.display());
        let stamp = EvaluationsStamp {
            scenario: study.stamp()?,
            seed: study.scenario.optimizer.seed,
            version: VERSION.to_owned(),
            evaluations: self.rows,
            sha256: hex_sha256(&files::read_run(&path).with_context(cannot)?),
        };
        let place = self.directory.join(EVALUATIONS_CSV);
        fs::rename(&path, &place).with_context(|| format!("cannot write {}", place.display()))?;
        let json = crate::printable::json(&stamp)? + "\n";
        files::write_atomically(&self.directory.join(EVALUATIONS_JSON), json.as_bytes())
    }
}

/// The first rows of the first table that has as many under the same heading.
fn cut(tables: &[PathBuf], heading: &str, rows: u64) -> Option<String> {
    let rows = usize::try_from(rows).ok()?;
    tables.iter().find_map(|path| {
        let text = String::from_utf8(files::read_run(path).ok()?).ok()?;
        let own = text.strip_prefix(heading)?;
        let mut ends = own.match_indices('\n').map(|(place, _)| place + 1);
        let end = ends.nth(rows.checked_sub(1)?)?;
        Some(heading.to_owned() + &own[..end])
    })
}

/// `optimize --from`: the front of the evaluations in a directory, for the goals of the command line.
pub(crate) fn front(args: &OptimizeArgs, directory: &Path) -> Result<Status> {
    let own = Study::of_run(directory, &[])?;
    let study = Study::of_run(directory, &args.study.overrides)?;
    check_goals_alone(&own, &study)?;
    let evaluator = Evaluator::new(study.setup()?)?;
    let problem = study.problem(&evaluator)?;
    let (scenario, stamp) = (&study.scenario, study.stamp()?);
    let result = if directory.join(SWEEP_JSON).exists() {
        front_of_sweep(directory, &problem)?.result(&problem, scenario, stamp)
    } else {
        let bytes = table(directory, &own)?;
        let place = directory.join(EVALUATIONS_CSV);
        let evaluations = read_evaluations(&bytes, &problem)
            .with_context(|| format!("cannot read {}", place.display()))?;
        OptimizeResult::of_evaluations(&problem, &evaluations, scenario, stamp)?
    };
    output::result(&match args.format {
        OutputFormat::Text => optimize::text_from_evaluations(&result, &scenario.name),
        OutputFormat::Json => crate::printable::json(&result)?,
        OutputFormat::Csv => front_csv(&result.front)?,
    })?;
    Ok(optimize::status(&result))
}

/// The front of a sweep, chunk by chunk; every chunk must be done.
fn front_of_sweep(directory: &Path, problem: &DesignProblem<'_>) -> Result<EvaluatedFront> {
    let store = SweepStore::read(directory)?;
    let (designs, source) = match store.plan().source {
        SweepSource::Space => (SweepDesigns::of_space(problem), EvaluationSource::Space),
        SweepSource::List => (SweepDesigns::List(store.list()?), EvaluationSource::List),
    };
    let mut front = EvaluatedFront::new(source);
    for number in 0..store.chunks().len() {
        let cannot = || {
            let place = directory.display();
            format!(
                "chunk {} of {place} cannot be used; sweep --resume completes it",
                number + 1
            )
        };
        let table = store.table(number).with_context(cannot)?;
        let points = store.plan().points_of(number as u64);
        let evaluations = designs.evaluations(points, &table, problem);
        let evaluations = evaluations
            .map_err(anyhow::Error::msg)
            .with_context(cannot)?;
        front.offer(problem, &evaluations)?;
    }
    Ok(front)
}

/// Keys that evaluations do not depend on.
const GOALS: [&str; 4] = [
    "objectives.minimize",
    "objectives.constraints",
    "objectives.hypervolume-reference",
    "objectives.launch-cost-",
];

/// Refuses a change of anything that the evaluations depend on.
fn check_goals_alone(own: &Study, study: &Study) -> Result<()> {
    let differences = own.scenario.differences(&study.scenario).into_iter();
    let other = differences
        .map(|difference| difference.key)
        .find(|key| !GOALS.iter().any(|goal| key.starts_with(goal)));
    match other {
        None => Ok(()),
        Some(key) => bail!(
            "--set {key}: the evaluations in the directory were made with another value; only {}…, which they do not depend \
             on, can be set with --from",
            GOALS.join(", ")
        ),
    }
}

/// The table in a directory, if it is that of its study.
fn table(directory: &Path, study: &Study) -> Result<Vec<u8>> {
    let path = directory.join(EVALUATIONS_JSON);
    let bytes = files::read_run(&path).with_context(|| {
        format!(
            "{} has no evaluations; a search writes them with --evaluations",
            directory.display()
        )
    })?;
    let stamp: EvaluationsStamp = serde_json::from_slice(&bytes)
        .with_context(|| format!("{} is not a record of evaluations", path.display()))?;
    let place = directory.join(EVALUATIONS_CSV);
    if stamp.scenario != study.stamp()? || stamp.version != VERSION {
        bail!(
            "{} has evaluations of another scenario or version than that of {} beside it",
            place.display(),
            crate::run::SCENARIO
        );
    }
    let bytes =
        files::read_run(&place).with_context(|| format!("cannot read {}", place.display()))?;
    if hex_sha256(&bytes) != stamp.sha256 {
        bail!(
            "{}: checksum mismatch with {EVALUATIONS_JSON}",
            place.display()
        );
    }
    Ok(bytes)
}
