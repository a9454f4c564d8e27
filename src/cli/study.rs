//! From the command line to a scenario and its inputs.

use crate::cli::args::{DesignArgs, StudyArgs};
use crate::cli::{files, output, run};
use crate::constellation::Design;
use crate::constellation::gnss::System;
use crate::evaluate::{Evaluator, Setup};
use crate::run::ScenarioStamp;
use crate::scenario::{Algorithm, Scenario, builtin};
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};

/// A scenario and the directory of its files.
#[derive(Clone)]
pub(crate) struct Study {
    pub(crate) scenario: Scenario,
    /// Directory to which paths in the scenario are relative.
    directory: PathBuf,
}

impl Study {
    /// The scenario named on the command line, with its overrides.
    pub(crate) fn load(args: &StudyArgs, further: &[String]) -> Result<Self> {
        let overrides: Vec<&String> = args.overrides.iter().chain(further).collect();
        let name = args.name();
        let (bytes, directory) = read_scenario(name)?;
        let scenario = Scenario::parse(name, &bytes, &overrides)?;
        Ok(Self {
            scenario,
            directory,
        })
    }

    /// The scenario of a run.
    pub(crate) fn of_run(directory: &Path, overrides: &[String]) -> Result<Self> {
        let path = directory.join("scenario.toml");
        let bytes = files::read_whole(&path)
            .with_context(|| format!("{} is not a run directory", directory.display()))
            .with_context(|| format!("cannot read {}", path.display()))?;
        let scenario = Scenario::parse(&path.to_string_lossy(), &bytes, overrides)?;
        Ok(Self {
            scenario,
            directory: directory.to_owned(),
        })
    }

    /// The same study with another algorithm.
    pub(crate) fn with_algorithm(&self, algorithm: Algorithm) -> Self {
        let mut other = self.clone();
        other.scenario.optimizer.algorithm = algorithm;
        other
    }

    /// The identification of the study in results.
    pub(crate) fn stamp(&self) -> Result<ScenarioStamp> {
        Ok(ScenarioStamp {
            name: self.scenario.name.clone(),
            hash: self.hash()?,
        })
    }

    /// Hash of everything that determines the results, including the scenario's files.
    pub(crate) fn hash(&self) -> Result<String> {
        let read = |file: &str| {
            let path = self.directory.join(file);
            files::read_whole(&path).with_context(|| format!("cannot read {}", path.display()))
        };
        let files = self.scenario.files().into_iter();
        let contents: Vec<Vec<u8>> = files.map(read).collect::<Result<_>>()?;
        let contents: Vec<&[u8]> = contents.iter().map(Vec::as_slice).collect();
        Ok(self.scenario.hash(&contents))
    }

    /// The setup of an evaluation, if it fits into memory.
    pub(crate) fn setup(&self) -> Result<Setup> {
        let read = |file: &str| files::read_whole(&self.directory.join(file));
        let setup = self.scenario.setup(&read)?;
        check_memory(&setup)?;
        for system in &setup.gnss {
            if let System::Sets(sets) = system
                && let Some(stale) = sets.stale(setup.grid)
            {
                output::warning(&stale.to_string());
            }
        }
        Ok(setup)
    }

    /// The evaluator of the scenario.
    pub(crate) fn evaluator(&self) -> Result<Evaluator> {
        Ok(Evaluator::new(self.setup()?)?)
    }
}

fn read_scenario(name: &str) -> Result<(Vec<u8>, PathBuf)> {
    let is_path = name.contains(['/', '\\']) || Path::new(name).extension().is_some();
    if !is_path {
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

/// Fails before starting if a scenario needs more memory than is available.
fn check_memory(setup: &Setup) -> Result<()> {
    let needed = setup.memory_bytes(rayon::current_num_threads());
    let Some(available) = available_memory() else {
        return Ok(());
    };
    if needed > available {
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        bail!(
            "{} points x {} instants need {:.1} GiB of memory, but {:.1} GiB are available; \
             use a coarser region.step-deg or time.step-s, or fewer --threads",
            setup.sites.len(),
            setup.grid.len(),
            gib(needed),
            gib(available)
        );
    }
    Ok(())
}

/// Available memory, bytes; `None` if unknown (other than Linux).
fn available_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

/// The study and the design that a command works on.
pub(crate) fn study_and_design(study: &StudyArgs, design: &DesignArgs) -> Result<(Study, Design)> {
    if let Some(directory) = &design.run {
        if let Some(name) = &study.scenario {
            bail!("a run has its own scenario; omit '{name}' or --run");
        }
        let loaded = Study::of_run(directory, &study.overrides)?;
        let (picked, why) = run::pick(directory, design.pick)?;
        output::hint(&format!("{picked} of {}: {why}", directory.display()));
        return Ok((loaded, picked));
    }
    let loaded = Study::load(study, &[])?;
    let design = match design.design {
        Some(design) => design,
        None => loaded.scenario.reference_design()?,
    };
    Ok((loaded, design))
}
