//! Run directories: results, and the checkpoint that a search resumes from.

use crate::cli::args::MemberPick;
use crate::cli::study::{Study, read_manifest};
use crate::cli::{files, output};
use crate::constellation::Design;
use crate::optimize::{Search, Strategy};
use crate::run::checkpoint::{self, Identity};
use crate::run::{
    CHECKPOINT, FILES, FRONT_JSON, INPUTS, MANIFEST, OptimizeResult, PREVIOUS_CHECKPOINT, SCENARIO,
    VALIDATION, result_files,
};
use crate::scenario::Scenario;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// File that names the process using a run directory.
const HOLDER: &str = ".lock";

/// What this program writes in a run directory.
fn own() -> BTreeSet<String> {
    let mut own: BTreeSet<String> = FILES.iter().map(|name| (*name).to_owned()).collect();
    for directory in [INPUTS, VALIDATION, "figures"] {
        own.insert(format!("{directory}/"));
    }
    own.extend(["report.html".to_owned(), HOLDER.to_owned()]);
    own
}

/// The lock of a directory, if it exists and can be locked; fails if another process is using it.
fn held(directory: &Path) -> Result<Option<File>> {
    match files::lock(directory) {
        Ok(lock) => Ok(Some(lock)),
        Err(TryLockError::Error(_)) => Ok(None),
        Err(TryLockError::WouldBlock) => {
            let holder = fs::read_to_string(directory.join(HOLDER));
            let holder = holder.map_or_else(
                |_| "another process".to_owned(),
                |id| format!("process {id}"),
            );
            bail!("{} is in use: {holder} works in it", directory.display())
        }
    }
}

/// A directory in which a run is under way.
pub(crate) struct RunDirectory {
    path: PathBuf,
    identity: Identity,
    /// The initial contents of the run: the scenario, copies of its files, the manifest.
    first_files: Vec<(String, Vec<u8>)>,
    /// Keeps other processes out; `None` if the file system has no locks.
    lock: Option<File>,
    /// Whether the directory is marked as in use by this process.
    is_holder: bool,
}

impl RunDirectory {
    /// The directory at `path` for a run of `study`, with what a run begins with in it. It is
    /// replaced as at the end, so that a place that cannot be had is found before the work.
    pub(crate) fn open(path: PathBuf, study: &Study, force: bool) -> Result<Self> {
        Self::open_as(path, study, study.identity()?, force)
    }

    /// The same for a run of given designs, which `given` names.
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
            lock: None,
            is_holder: false,
        };
        files::recovered(&run.path)?;
        run.lock = held(&run.path)?;
        if files::is_vacant(&run.path)? {
            run.begin(&[])?;
        } else if run.found_identity().as_ref() == Some(&run.identity) {
            let begun = |name: &OsString| {
                [SCENARIO, MANIFEST, INPUTS, HOLDER]
                    .iter()
                    .any(|n| name == n)
            };
            let mut kept = run.entries()?;
            kept.retain(|name| !begun(name));
            run.begin(&kept)?;
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
        // Only waiting processes read it.
        let holder = fs::write(run.path.join(HOLDER), std::process::id().to_string());
        run.is_holder = holder.is_ok();
        Ok(run)
    }

    /// Puts a directory with what a run begins with in the place, and these entries of the one there.
    fn begin(&mut self, kept: &[OsString]) -> Result<()> {
        let staged = files::StagedDirectory::new(&self.path)?;
        files::write_all(staged.path(), &self.first_files)?;
        self.lock = staged.commit_keeping(kept)?;
        Ok(())
    }

    /// The directory, to be shown.
    pub(crate) fn display(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// The names of the directory's entries.
    fn entries(&self) -> Result<Vec<OsString>> {
        let cannot = || format!("cannot read {}", self.path.display());
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.path).with_context(cannot)? {
            names.push(entry.with_context(cannot)?.file_name());
        }
        names.retain(|name| !files::is_staged(name));
        names.sort();
        Ok(names)
    }

    /// Names of the entries that a run does not write.
    fn others(&self) -> Result<Vec<OsString>> {
        let mut others = self.entries()?;
        others.retain(|name| name != HOLDER && !FILES.iter().any(|own| name == *own));
        Ok(others)
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
                let is_search = found.given.is_empty();
                if is_search {
                    "a search"
                } else {
                    "a run of other designs"
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
                let text = fs::read_to_string(self.path.join(name)).ok()?;
                Identity::read(&text)
            })
    }

    /// Writes the state of a search and keeps the previous one.
    pub(crate) fn save(&self, search: &Search) -> Result<()> {
        let text = checkpoint::write(&self.identity, search)?;
        let path = self.path.join(CHECKPOINT);
        let previous = self.path.join(PREVIOUS_CHECKPOINT);
        let cannot = || format!("cannot write in {}", self.path.display());
        let is_first = search.progress().step <= 1;
        if path.exists() && !is_first {
            fs::rename(&path, &previous).with_context(cannot)?;
        }
        files::write_atomically(&path, text.as_bytes())?;
        if previous.exists() && is_first {
            fs::remove_file(&previous).with_context(cannot)?;
        }
        Ok(())
    }

    /// The state to resume from, the last intact checkpoint; `None` if there is no checkpoint.
    pub(crate) fn resume(&self) -> Result<Option<Search>> {
        let mut damaged = Vec::new();
        for name in [CHECKPOINT, PREVIOUS_CHECKPOINT] {
            let path = self.path.join(name);
            let Ok(bytes) = fs::read(&path) else {
                continue;
            };
            match checkpoint::read(&bytes) {
                Ok((identity, search)) if identity == self.identity => {
                    if let Some(reason) = damaged.first() {
                        output::warning(&format!("{reason}; resuming from the one before it"));
                        // Otherwise it would replace the one before at the next generation.
                        fs::remove_file(self.path.join(CHECKPOINT))
                            .with_context(|| format!("cannot write in {}", self.path.display()))?;
                    }
                    return Ok(Some(search));
                }
                Ok(_) => bail!(
                    "{} belongs to another scenario, seed or version; start over with --force",
                    path.display()
                ),
                Err(reason) => damaged.push(format!("{} is damaged: {reason}", path.display())),
            }
        }
        match damaged.first() {
            Some(reason) => {
                bail!("{reason}, and no earlier checkpoint is intact; start over without --resume")
            }
            None => Ok(None),
        }
    }

    /// Writes all results, and the state of the search if there was one, to a sibling directory and moves it into
    /// place.
    pub(crate) fn finish(
        &mut self,
        scenario: &Scenario,
        search: Option<&Search>,
        result: &OptimizeResult,
    ) -> Result<()> {
        let staged = files::StagedDirectory::new(&self.path)?;
        files::write_all(staged.path(), &self.first_files)?;
        for (name, text) in result_files(scenario, result)? {
            files::write_atomically(&staged.path().join(name), text.as_bytes())?;
        }
        if let Some(search) = search {
            self.save_at(staged.path(), search)?;
        }
        self.lock = staged.commit_keeping(&self.others()?)?;
        Ok(())
    }

    /// Writes the state of a search, and the one before it, to a directory that will replace this one.
    fn save_at(&self, staged: &Path, search: &Search) -> Result<()> {
        Self {
            path: staged.to_owned(),
            identity: self.identity.clone(),
            first_files: Vec::new(),
            lock: None,
            is_holder: false,
        }
        .save(search)?;
        let previous = self.path.join(PREVIOUS_CHECKPOINT);
        if previous.exists() {
            fs::copy(&previous, staged.join(PREVIOUS_CHECKPOINT))
                .with_context(|| format!("cannot copy {}", previous.display()))?;
        }
        Ok(())
    }
}

impl Drop for RunDirectory {
    fn drop(&mut self) {
        // An interrupted run leaves only files that belong to the run.
        if self.is_holder {
            let _ = fs::remove_file(self.path.join(HOLDER));
        }
    }
}

/// The design that `pick` selects from the front of a run, and why.
pub(crate) fn pick(directory: &Path, pick: &MemberPick) -> Result<(Design, String)> {
    let path = directory.join(FRONT_JSON);
    let bytes = fs::read(&path).with_context(|| {
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
    let design = found.front[picked.place].design.notation.parse()?;
    Ok((design, picked.reason))
}
