//! Run directories: results, and the checkpoint that a search resumes from.

use crate::cli::pick::Pick;
use crate::cli::{files, output};
use crate::constellation::Design;
use crate::optimize::{Search, Strategy};
use crate::report::{OptimizeResult, VERSION, front_csv, history_csv};
use crate::scenario::Scenario;
use crate::search::Quantity;
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

const CHECKPOINT: &str = "checkpoint";
const PREVIOUS: &str = "checkpoint.previous";

/// What a run is a run of: only the same continues or replaces it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Identity {
    scenario_hash: String,
    seed: u64,
    version: String,
}

impl Identity {
    pub(crate) fn of(scenario: &Scenario, hash: String) -> Self {
        Self {
            scenario_hash: hash,
            seed: scenario.optimizer.seed,
            version: VERSION.to_owned(),
        }
    }
}

/// The first line of a checkpoint; the second is the state of the search as JSON.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    #[serde(flatten)]
    identity: Identity,
    /// SHA-256 of the second line, hex.
    sha256: String,
}

/// Files of a run; whatever else lies in its directory was put there about it.
const OWN: [&str; 7] = [
    CHECKPOINT,
    PREVIOUS,
    "scenario.toml",
    "front.json",
    "front.csv",
    "history.json",
    "history.csv",
];

/// A directory in which a run is under way.
pub(crate) struct RunDirectory {
    path: PathBuf,
    identity: Identity,
    /// What else the directory holds about the same run: a validation, a report.
    kept: Vec<OsString>,
}

impl RunDirectory {
    /// The directory at `path`, which is created where it is missing.
    pub(crate) fn open(path: PathBuf, identity: Identity, force: bool) -> Result<Self> {
        let mut run = Self {
            path,
            identity,
            kept: Vec::new(),
        };
        if !files::is_vacant(&run.path)? {
            let others = run.others()?;
            if run.found_identity().as_ref() == Some(&run.identity) {
                run.kept = others;
            } else if !force {
                bail!(
                    "{} holds {}; choose another --out, or replace it with --force",
                    run.path.display(),
                    run.what_else()
                );
            } else if !others.is_empty() {
                let names: Vec<_> = others.iter().map(|name| name.to_string_lossy()).collect();
                output::warning(&format!(
                    "{} is replaced, and with it {}",
                    run.path.display(),
                    names.join(", ")
                ));
            }
        }
        fs::create_dir_all(&run.path)
            .with_context(|| format!("cannot create {}", run.path.display()))?;
        Ok(run)
    }

    /// What the directory holds besides the files of a run, by name.
    fn others(&self) -> Result<Vec<OsString>> {
        let cannot = || format!("cannot read {}", self.path.display());
        let mut others = Vec::new();
        for entry in fs::read_dir(&self.path).with_context(cannot)? {
            let name = entry.with_context(cannot)?.file_name();
            if !OWN.iter().any(|own| name == *own) {
                others.push(name);
            }
        }
        others.sort();
        Ok(others)
    }

    /// What the directory holds when it is not this run.
    fn what_else(&self) -> String {
        match self.found_identity() {
            Some(found) if found.version != self.identity.version => {
                let (theirs, ours) = (found.version, &self.identity.version);
                format!("a run by version {theirs}, and this is {ours}")
            }
            Some(found) if found.seed != self.identity.seed => {
                let (theirs, ours) = (found.seed, self.identity.seed);
                format!("a run with seed {theirs}, and this is seed {ours}")
            }
            Some(_) => "a run of another scenario".to_owned(),
            None if self.path.join(CHECKPOINT).exists() => {
                "a run whose checkpoint is damaged, and no earlier one is whole".to_owned()
            }
            None => "something else than a run of this scenario, seed and version".to_owned(),
        }
    }

    /// What the directory says it is a run of, by either checkpoint.
    fn found_identity(&self) -> Option<Identity> {
        [CHECKPOINT, PREVIOUS].into_iter().find_map(|name| {
            let text = fs::read_to_string(self.path.join(name)).ok()?;
            let header: Header = serde_json::from_str(text.lines().next()?).ok()?;
            Some(header.identity)
        })
    }

    /// Writes the state of a search, keeping the state before it; before the first there is none.
    pub(crate) fn save(&self, search: &Search) -> Result<()> {
        let state = serde_json::to_string(search)?;
        let header = Header {
            identity: self.identity.clone(),
            sha256: hex_sha256(state.as_bytes()),
        };
        let text = format!("{}\n{state}\n", serde_json::to_string(&header)?);
        let path = self.path.join(CHECKPOINT);
        let previous = self.path.join(PREVIOUS);
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

    /// The state to go on from: the last whole checkpoint; `None` when there is none at all.
    pub(crate) fn resume(&self) -> Result<Option<Search>> {
        let mut damaged = Vec::new();
        for name in [CHECKPOINT, PREVIOUS] {
            let path = self.path.join(name);
            let Ok(bytes) = fs::read(&path) else {
                continue;
            };
            match read_checkpoint(&bytes) {
                Ok((identity, search)) if identity == self.identity => {
                    if let Some(reason) = damaged.first() {
                        output::warning(&format!("{reason}; the one before it is used"));
                        // Lest it takes the place of the one before at the next generation.
                        fs::remove_file(self.path.join(CHECKPOINT))
                            .with_context(|| format!("cannot write in {}", self.path.display()))?;
                    }
                    return Ok(Some(search));
                }
                Ok(_) => bail!(
                    "{} is of another scenario, seed or version; start anew with --force",
                    path.display()
                ),
                Err(reason) => damaged.push(format!("{} is damaged: {reason}", path.display())),
            }
        }
        match damaged.first() {
            Some(reason) => {
                bail!("{reason}, and no earlier one is whole; start anew without --resume")
            }
            None => Ok(None),
        }
    }

    /// Writes all results beside the directory and puts them in its place.
    pub(crate) fn finish(
        &self,
        scenario: &Scenario,
        search: &Search,
        result: &OptimizeResult,
    ) -> Result<()> {
        let staged = files::StagedDirectory::new(&self.path)?;
        let write = |name: &str, text: String| {
            files::write_atomically(&staged.path().join(name), text.as_bytes())
        };
        let objectives: Vec<String> = scenario
            .objectives
            .minimize
            .iter()
            .map(Quantity::to_string)
            .collect();
        write("scenario.toml", scenario.to_toml())?;
        write("front.json", serde_json::to_string_pretty(result)? + "\n")?;
        write("front.csv", front_csv(result)?)?;
        write(
            "history.json",
            serde_json::to_string_pretty(&result.history)? + "\n",
        )?;
        write("history.csv", history_csv(&result.history, &objectives)?)?;
        Self {
            path: staged.path().to_owned(),
            identity: self.identity.clone(),
            kept: Vec::new(),
        }
        .save(search)?;
        let previous = self.path.join(PREVIOUS);
        if previous.exists() {
            fs::copy(&previous, staged.path().join(PREVIOUS))
                .with_context(|| format!("cannot copy {}", previous.display()))?;
        }
        staged.commit_keeping(&self.kept)
    }
}

fn read_checkpoint(bytes: &[u8]) -> Result<(Identity, Search)> {
    let text = str::from_utf8(bytes).context("it is no text")?;
    let (header, state) = text.split_once('\n').context("it is cut short")?;
    let header: Header = serde_json::from_str(header).context("its header cannot be read")?;
    let state = state.trim_end();
    if hex_sha256(state.as_bytes()) != header.sha256 {
        bail!("its checksum does not fit");
    }
    let search = serde_json::from_str(state).context("its state cannot be read")?;
    Ok((header.identity, search))
}

fn hex_sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// What of `front.json` a pick needs.
#[derive(Deserialize)]
struct StoredFront {
    front: Vec<StoredMember>,
}

#[derive(Deserialize)]
struct StoredMember {
    design: StoredDesign,
    objectives: serde_json::Map<String, serde_json::Value>,
}

#[derive(Deserialize)]
struct StoredDesign {
    notation: String,
}

/// The front of a run, and the file that it stands in.
fn stored_front(directory: &Path) -> Result<(PathBuf, Vec<StoredMember>)> {
    let path = directory.join("front.json");
    let text = fs::read_to_string(&path).with_context(|| {
        format!(
            "{} has no front; is it a finished run?",
            directory.display()
        )
    })?;
    let stored: StoredFront = serde_json::from_str(&text)
        .with_context(|| format!("{} is no front of a run", path.display()))?;
    Ok((path, stored.front))
}

/// The design that `pick` names in the front of a run, and why it is that.
pub(crate) fn pick(directory: &Path, pick: Pick) -> Result<(Design, String)> {
    let (path, members) = stored_front(directory)?;
    let points: Vec<Vec<f64>> = members.iter().map(minimised).collect::<Result<_>>()?;
    let Some((place, why)) = pick.place(&points) else {
        bail!(
            "{} has {} members and not that one",
            path.display(),
            members.len()
        );
    };
    Ok((members[place].design.notation.parse()?, why))
}

fn minimised(member: &StoredMember) -> Result<Vec<f64>> {
    let value = |(name, value): (&String, &serde_json::Value)| {
        let quantity: Quantity = name.parse()?;
        let value = value
            .as_f64()
            .with_context(|| format!("{name} is no number"))?;
        Ok(quantity.minimised(value))
    };
    member.objectives.iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spoiled_checkpoint_is_noticed() {
        let state = "{}";
        let identity = Identity {
            scenario_hash: "h".to_owned(),
            seed: 1,
            version: VERSION.to_owned(),
        };
        let header = Header {
            identity,
            sha256: hex_sha256(b"other"),
        };
        let text = format!("{}\n{state}\n", serde_json::to_string(&header).unwrap());
        let error = read_checkpoint(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error, "its checksum does not fit");
        assert!(read_checkpoint(b"").is_err());
        let error = read_checkpoint(b"\xff\n{}").unwrap_err().to_string();
        assert_eq!(error, "it is no text");
    }
}
