//! Run directories: results, and the checkpoint that a search resumes from.

mod held_results;

use crate::cli::args::MemberPick;
use crate::cli::interrupt::Removed;
use crate::cli::provenance::provenance;
use crate::cli::study::{Study, read_manifest};
use crate::cli::{files, output};
use crate::exchange::constellation::Constellation;
use crate::optimize::{Search, Strategy};
use crate::run::checkpoint::{self, Identity, RecordLog};
use crate::run::evaluations::EVALUATIONS_FILES;
use crate::run::{
    CHECKPOINT, CHECKPOINT_LOG, FILES, FRONT_JSON, FrontMember, INPUTS, MANIFEST, OptimizeResult,
    PREVIOUS_CHECKPOINT, REPORT_PAGE, ResultProvenance, SCENARIO, VALIDATION, result_files,
};
use crate::scenario::Scenario;
use anyhow::{Context, Result, bail};
use held_results::HeldResults;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// File that names the process using a run directory.
pub(crate) const HOLDER: &str = ".lock";

/// What this program writes in a run directory.
fn own() -> BTreeSet<String> {
    let mut own: BTreeSet<String> = FILES.iter().map(|name| (*name).to_owned()).collect();
    for directory in [INPUTS, VALIDATION, "figures"] {
        own.insert(format!("{directory}/"));
    }
    own.extend([REPORT_PAGE, HOLDER].map(str::to_owned));
    own.extend(EVALUATIONS_FILES.map(str::to_owned));
    own
}

/// The lock of a directory, if it exists and can be locked; fails if another process is using it.
fn held(directory: &Path) -> Result<Option<File>> {
    match files::lock(directory) {
        Ok(lock) => Ok(Some(lock)),
        Err(TryLockError::Error(_)) => Ok(None),
        Err(TryLockError::WouldBlock) => {
            let id = files::read_run(&directory.join(HOLDER)).ok();
            let id = id.and_then(|id| String::from_utf8(id).ok());
            let holder = id.map_or("another process".to_owned(), |id| format!("process {id}"));
            bail!("{} is in use: {holder} works in it", directory.display())
        }
    }
}

/// A directory in which a run is under way.
///
/// Nothing in it is lost to a run that does not get as far: finished results stay until they are
/// replaced by finished results, and a checkpoint until the search has passed it.
pub(crate) struct RunDirectory {
    path: PathBuf,
    identity: Identity,
    provenance: ResultProvenance,
    /// The initial contents of the run: the scenario, copies of its files, the manifest.
    first_files: Vec<(String, Vec<u8>)>,
    /// The checkpoints in the directory when it was opened.
    found: FoundCheckpoints,
    /// The last two checkpoints of this process, the latest first, written or not.
    recent: [Option<String>; 2],
    /// What the log of this search has.
    log: RecordLog,
    /// Whether that is in the directory.
    is_log_written: bool,
    /// Whether the search continues from a checkpoint that was found.
    is_resumed: bool,
    /// Keeps other processes out; `None` if the file system has no locks.
    lock: Option<File>,
    /// Removes the mark that this process uses the directory, also on Ctrl-C; `None` without one.
    holder: Option<Removed>,
}

/// The checkpoints in a run directory.
#[derive(Default)]
struct FoundCheckpoints {
    /// The state in the last intact one.
    search: Option<Search>,
    /// Whether that is [`CHECKPOINT`], not the one before.
    is_latest: bool,
    /// Why others cannot be used.
    damaged: Vec<String>,
}

impl FoundCheckpoints {
    fn of(directory: &Path, identity: &Identity) -> Self {
        let mut found = Self::default();
        let log = files::read_run(&directory.join(CHECKPOINT_LOG)).unwrap_or_default();
        for name in [CHECKPOINT, PREVIOUS_CHECKPOINT] {
            let path = directory.join(name);
            let shown = path.display();
            let bytes = match files::read_run(&path) {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(error) => {
                    found.damaged.push(format!("cannot read {shown}: {error}"));
                    continue;
                }
            };
            match checkpoint::read(&bytes, &log) {
                Ok((of, search)) if of == *identity => {
                    found.search = Some(search);
                    found.is_latest = name == CHECKPOINT;
                    return found;
                }
                Ok(_) => found.damaged.push(format!(
                    "{shown} belongs to another scenario, seed or version"
                )),
                Err(reason) => found.damaged.push(format!("{shown} is damaged: {reason}")),
            }
        }
        found
    }

    /// Steps that the state has behind it; 0 without one.
    fn step(&self) -> u64 {
        self.search
            .as_ref()
            .map_or(0, |search| search.progress().step)
    }
}

/// What became of the results of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Placed {
    /// They are in the run directory.
    Written,
    /// There are none, for a search that was stopped before its first generation.
    Nothing,
    /// The run directory keeps those it had, since they are finished or of as many generations.
    Kept {
        /// Generations behind the results that are kept.
        generations: u64,
    },
}

impl RunDirectory {
    /// The directory at `path` for a run of `study`, with what a run begins with in it. It is
    /// replaced as at the end, so that a place that cannot be had is found before the work.
    pub(crate) fn open(path: PathBuf, study: &Study, force: bool) -> Result<Self> {
        Self::open_as(path, study, study.identity()?, force)
    }

    /// The same for a run of given constellations, which `given` names. The directory is tried and not touched
    /// before [`Self::place`].
    pub(crate) fn open_for(
        path: PathBuf,
        study: &Study,
        given: Vec<String>,
        force: bool,
    ) -> Result<Self> {
        Self::open_as(path, study, study.identity()?.of_given(given), force)
    }

    fn open_as(path: PathBuf, study: &Study, identity: Identity, force: bool) -> Result<Self> {
        let mut run = Self {
            path,
            first_files: study.first_files(&identity)?,
            identity,
            provenance: provenance(vec![study.stamp()?]),
            found: FoundCheckpoints::default(),
            recent: [None, None],
            log: RecordLog::default(),
            is_log_written: false,
            is_resumed: false,
            lock: None,
            holder: None,
        };
        files::recovered(&run.path)?;
        run.lock = held(&run.path)?;
        if files::is_vacant(&run.path)? {
            run.begin(&[])?;
        } else if run.found_identity().as_ref() == Some(&run.identity) {
            run.take_up()?;
        } else if force {
            files::refuse_inputs(&run.path, study.inputs().iter().map(PathBuf::as_path))?;
            files::refuse_foreign(&run.path, &own())?;
            run.warn_of_others()?;
            run.begin(&[])?;
        } else {
            bail!(
                "{} holds {}; choose another --out, or replace it with --force",
                run.path.display(),
                run.what_else(study)
            );
        }
        let holder = run.path.join(HOLDER);
        run.holder = Some(Removed::new(&holder));
        // Only waiting processes read it.
        if fs::write(holder, std::process::id().to_string()).is_err() {
            run.holder = None;
        }
        Ok(run)
    }

    /// Takes up a directory with a run of the same scenario, seed and version.
    fn take_up(&mut self) -> Result<()> {
        self.found = FoundCheckpoints::of(&self.path, &self.identity);
        if HeldResults::of(&self.path).is_some_and(|held| held.is_finished()) {
            // Not touched before the end, but tried.
            return files::StagedDirectory::new(&self.path).map(drop);
        }
        let begun = [SCENARIO, MANIFEST, INPUTS, HOLDER].map(str::to_owned);
        let kept = files::others(&self.path, &begun.into())?;
        self.begin(&kept)
    }

    /// Puts a directory with what a run begins with in the place, and these entries of the one there; without a
    /// search, only tries the place.
    fn begin(&mut self, kept: &[OsString]) -> Result<()> {
        let staged = files::StagedDirectory::new(&self.path)?;
        if !self.identity.given.is_empty() {
            return Ok(());
        }
        files::write_all(staged.path(), &self.first_files)?;
        self.lock = staged.commit_keeping(kept, &self.provenance)?;
        Ok(())
    }

    /// The directory.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The directory, to be shown.
    pub(crate) fn display(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// Names of the entries that a run does not write.
    fn others(&self) -> Result<Vec<OsString>> {
        let own = FILES.into_iter().chain([HOLDER]);
        files::others(&self.path, &own.map(str::to_owned).collect())
    }

    fn warn_of_others(&self) -> Result<()> {
        let others = self.others()?;
        if !others.is_empty() {
            let names: Vec<_> = others.iter().map(|name| name.to_string_lossy()).collect();
            output::warning(&format!(
                "replacing {}, including {}",
                self.path.display(),
                names.join(", ")
            ));
        }
        Ok(())
    }

    /// A description of the contents when they are not this run.
    fn what_else(&self, study: &Study) -> String {
        match self.found_identity() {
            Some(found) if found.version != self.identity.version => {
                let (theirs, ours) = (found.version, &self.identity.version);
                format!("a run by version {theirs}; this is version {ours}")
            }
            Some(found) if found.given != self.identity.given => {
                match (found.given.as_slice(), self.identity.given.as_slice()) {
                    ([], _) => "a search",
                    (_, []) => "constellations evaluated as given, without a search",
                    _ => "a run of other constellations",
                }
                .to_owned()
            }
            Some(_) => match study.difference_from_run(&self.path) {
                Some(difference) => format!("a run of another scenario: {difference}"),
                None => "a run of another scenario".to_owned(),
            },
            None if self.path.join(CHECKPOINT).exists() => {
                "a run whose checkpoints are damaged".to_owned()
            }
            None => "something other than a run of this scenario, seed and version".to_owned(),
        }
    }

    /// The identity of the run in the directory, from its manifest or either checkpoint.
    fn found_identity(&self) -> Option<Identity> {
        if let Ok(Some(manifest)) = read_manifest(&self.path) {
            return Some(manifest.identity);
        }
        [CHECKPOINT, PREVIOUS_CHECKPOINT]
            .into_iter()
            .find_map(|name| {
                let bytes = files::read_run(&self.path.join(name)).ok()?;
                Identity::read(str::from_utf8(&bytes).ok()?)
            })
    }

    /// Writes the state of a search and keeps the previous one, unless the directory holds a state as
    /// far or further.
    pub(crate) fn save(&mut self, search: &mut Search) -> Result<()> {
        let (text, lines) = checkpoint::write(&self.identity, search, &mut self.log)?;
        if search.progress().step > self.found.step() {
            self.write_log(search, &lines)?;
            self.write_checkpoint(&text)?;
        }
        self.recent = [Some(text), self.recent[0].take()];
        Ok(())
    }

    /// Adds lines to the log; the first time all of it is written, in place of what a process that was
    /// killed may have left of a line.
    fn write_log(&mut self, search: &Search, lines: &str) -> Result<()> {
        let path = self.path.join(CHECKPOINT_LOG);
        if !self.is_log_written {
            let all = RecordLog::default().extend(search.history())?;
            self.is_log_written = true;
            return files::write_atomically(&path, all.as_bytes());
        }
        let append = || -> io::Result<()> {
            let mut log = File::options().append(true).open(&path)?;
            log.write_all(lines.as_bytes())?;
            log.sync_data()
        };
        append().with_context(|| format!("cannot write {}", path.display()))
    }

    fn write_checkpoint(&mut self, text: &str) -> Result<()> {
        let path = self.path.join(CHECKPOINT);
        let previous = self.path.join(PREVIOUS_CHECKPOINT);
        let cannot = || format!("cannot write in {}", self.path.display());
        if self.found.is_latest {
            fs::rename(&path, &previous).with_context(cannot)?;
        }
        // Otherwise the last intact checkpoint, if any, is the previous one already.
        files::write_atomically(&path, text.as_bytes())?;
        if !self.found.is_latest && self.found.search.is_none() && previous.exists() {
            fs::remove_file(&previous).with_context(cannot)?;
        }
        self.found.is_latest = true;
        Ok(())
    }

    /// The state to resume from, the last intact checkpoint; `None` if there is no checkpoint.
    pub(crate) fn resume(&mut self) -> Result<Option<Search>> {
        let FoundCheckpoints {
            search, damaged, ..
        } = &self.found;
        match (search, damaged.first()) {
            (Some(_), Some(reason)) => {
                output::warning(&format!("{reason}; resuming from the one before it"));
            }
            (None, Some(reason)) => {
                bail!("{reason}, and no earlier checkpoint is intact; start over without --resume")
            }
            (_, None) => {}
        }
        self.is_resumed = search.is_some();
        Ok(search.clone())
    }

    /// Writes all results to a sibling directory and moves it into place, unless an interrupted search
    /// has less than the directory holds.
    pub(crate) fn finish(
        &mut self,
        scenario: &Scenario,
        search: &mut Search,
        result: &OptimizeResult,
    ) -> Result<Placed> {
        if !search.is_done() {
            let step = search.progress().step;
            if let Some(held) = HeldResults::of(&self.path)
                && (held.is_finished() || held.generations[0] >= step)
            {
                let [generations, _] = held.generations;
                return Ok(Placed::Kept { generations });
            }
            if step == 0 {
                return Ok(Placed::Nothing);
            }
        }
        let staged = self.staged_results(scenario, result)?;
        let mut log = RecordLog::default();
        let (latest, lines) = checkpoint::write(&self.identity, search, &mut log)?;
        for (name, text) in [(CHECKPOINT, latest), (CHECKPOINT_LOG, lines)] {
            files::write_atomically(&staged.path().join(name), text.as_bytes())?;
        }
        if let Some(previous) = self.before_last()? {
            files::write_atomically(&staged.path().join(PREVIOUS_CHECKPOINT), &previous)?;
        }
        self.lock = staged.commit_keeping(&self.others()?, &self.provenance)?;
        Ok(Placed::Written)
    }

    /// Writes the results of given constellations to a sibling directory and moves it into place.
    pub(crate) fn place(&mut self, scenario: &Scenario, result: &OptimizeResult) -> Result<()> {
        let staged = self.staged_results(scenario, result)?;
        self.lock = staged.commit_keeping(&self.others()?, &self.provenance)?;
        Ok(())
    }

    /// A sibling directory with what a run begins with and its results.
    fn staged_results(
        &self,
        scenario: &Scenario,
        result: &OptimizeResult,
    ) -> Result<files::StagedDirectory> {
        let staged = files::StagedDirectory::new(&self.path)?;
        files::write_all(staged.path(), &self.first_files)?;
        for (name, text) in result_files(scenario, result)? {
            files::write_atomically(&staged.path().join(name), text.as_bytes())?;
        }
        Ok(staged)
    }

    /// The checkpoint before the last one of this search, if there is one.
    fn before_last(&self) -> Result<Option<Vec<u8>>> {
        if let [_, Some(before)] = &self.recent {
            return Ok(Some(before.clone().into_bytes()));
        }
        if !self.is_resumed {
            return Ok(None);
        }
        let path = self.path.join(PREVIOUS_CHECKPOINT);
        match files::read_run(&path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error).with_context(|| format!("cannot copy {}", path.display())),
        }
    }
}

impl Drop for RunDirectory {
    fn drop(&mut self) {
        // An interrupted run leaves only files that belong to the run.
        if self.holder.is_some() {
            let _ = fs::remove_file(self.path.join(HOLDER));
        }
    }
}

/// The constellation that `pick` selects from the front of the run of `study`, and why.
pub(crate) fn pick(
    directory: &Path,
    study: &Study,
    pick: &MemberPick,
) -> Result<(Constellation, String)> {
    let path = directory.join(FRONT_JSON);
    let bytes = files::read_run(&path).with_context(|| {
        format!(
            "{} has no front; is it a finished run?",
            directory.display()
        )
    })?;
    let found = OptimizeResult::read(&bytes)
        .with_context(|| format!("{} is not a front written by this program", path.display()))?;
    let picked = pick
        .apply(&found.front)
        .with_context(|| format!("cannot pick from {}", path.display()))?;
    let member = &found.front[picked.place];
    if found.search.is_of_given() {
        return Ok((constellation_of(member, study)?, picked.reason));
    }
    let fixed = study.fixed()?.and_then(|fixed| fixed.files);
    let one = member.constellation(fixed.as_ref());
    let one = one.with_context(|| format!("design {} has no valid notation", member.index))?;
    Ok((one, picked.reason))
}

/// The constellation of a member of the run of `study`: its design, or what the scenario of the run has of it.
pub(crate) fn constellation_of(member: &FrontMember, study: &Study) -> Result<Constellation> {
    let Some(files) = &member.files else {
        let design = member.design.as_ref();
        let design = design.with_context(|| format!("design {} has no notation", member.index))?;
        return Ok(Constellation::of_design(design.notation.parse()?));
    };
    let named = study.scenario.constellation(&files.constellation);
    let named = named.with_context(|| {
        format!(
            "the scenario of the run has no constellation '{}', which its {FRONT_JSON} names",
            files.constellation
        )
    })?;
    let mut one = study.constellation(named)?;
    if let Some(of_files) = &mut one.files {
        of_files.names.clone_from(&files.names);
    }
    let name = member.name.clone();
    Ok(one.named(name.unwrap_or_else(|| files.constellation.clone())))
}
