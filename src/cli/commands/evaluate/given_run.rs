//! A run directory of constellations that were given.

use super::EvaluationContext;
use crate::cli::args::{EvaluateArgs, quoted};
use crate::cli::constellations::{ConstellationSource, GivenConstellation};
use crate::cli::run::RunDirectory;
use crate::cli::study::Study;
use crate::cli::{files, output};
use crate::exchange::constellation::similar_name;
use crate::optimize::Pick;
use crate::report::ConstellationEntry;
use crate::run::OptimizeResult;
use crate::scenario::{ConstellationParts, NamedConstellation};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};

/// The run, whose place has been tried.
pub(super) struct GivenRun {
    directory: RunDirectory,
    /// The study of the run, which names every constellation with satellites from files.
    study: Study,
    /// The name of each constellation in that study, if it has satellites from files.
    in_scenario: Vec<Option<String>>,
}

impl GivenRun {
    /// The run of these constellations, if it is asked for; fails if one cannot be a member, or the directory may
    /// not be replaced.
    pub(super) fn open(
        args: &EvaluateArgs,
        study: &Study,
        given: &[GivenConstellation],
    ) -> Result<Option<Self>> {
        let Some(out) = &args.out else {
            return Ok(None);
        };
        for GivenConstellation { constellation, .. } in given {
            let name = &constellation.name;
            if name.parse::<Pick>().is_ok() {
                bail!(
                    "--pick {name} is a method or an index, so that no constellation of a run can have this name"
                );
            }
        }
        let inputs = study.inputs();
        let inputs = inputs.iter().map(PathBuf::as_path);
        files::refuse_inputs(out, inputs.chain(args.constellations.inputs()))?;
        let (study, in_scenario) = with_files(args, study, given)?;
        let each = given.iter().zip(&in_scenario);
        let lines = each.map(|(one, key)| described(one, key.as_deref(), &study));
        let lines = lines.collect::<Result<_>>()?;
        let directory = RunDirectory::open_for(out.clone(), &study, lines, args.force)?;
        Ok(Some(Self {
            directory,
            study,
            in_scenario,
        }))
    }

    /// The results of the run.
    pub(super) fn result(
        &self,
        work: &EvaluationContext<'_>,
        entries: &[ConstellationEntry],
    ) -> Result<OptimizeResult> {
        let (scenario, stamp) = (work.scenario, work.stamp.clone());
        OptimizeResult::of_given(entries, &self.in_scenario, scenario, stamp)
            .with_context(|| format!("cannot write a run to {}", self.directory.display()))
    }

    /// Puts the run in its place.
    pub(super) fn finish(mut self, result: &OptimizeResult) -> Result<()> {
        self.directory.place(&self.study.scenario, result)?;
        let place = self.directory.display().to_string();
        output::hint(&format!(
            "\nrun written to {place}\nnext: navwalker report {}",
            quoted(&place)
        ));
        Ok(())
    }
}

/// The study with a constellation for each that is read from files, and the names of those with satellites from
/// files.
fn with_files(
    args: &EvaluateArgs,
    study: &Study,
    given: &[GivenConstellation],
) -> Result<(Study, Vec<Option<String>>)> {
    let mut added: Vec<(NamedConstellation, Vec<Vec<u8>>)> = Vec::new();
    let mut in_scenario = Vec::new();
    for one in given {
        in_scenario.push(match &one.source {
            ConstellationSource::Notation => None,
            ConstellationSource::Scenario(name) => {
                let has_files = one.constellation.files.is_some();
                has_files.then(|| name.clone())
            }
            ConstellationSource::Files(files) => {
                let is_taken = |name: &str| {
                    let of_scenario = study.scenario.constellation(name).is_some();
                    of_scenario || added.iter().any(|(known, _)| known.name == name)
                };
                let name = similar_name(&one.constellation.name, is_taken);
                let paths = files.iter().map(|(path, _)| absolute(path));
                let parts = parts(args, paths.collect());
                let contents = files.iter().map(|(_, bytes)| bytes.clone());
                let named = NamedConstellation {
                    name: name.clone(),
                    parts,
                };
                added.push((named, contents.collect()));
                Some(name)
            }
        });
    }
    Ok((study.with_constellations(added)?, in_scenario))
}

/// The path as the scenario of the run names it until it names the copy.
fn absolute(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    absolute.to_string_lossy().into_owned()
}

/// The files of a constellation, read as the arguments say.
fn parts(args: &EvaluateArgs, files: Vec<String>) -> ConstellationParts {
    let once = |patterns: &[String]| {
        let mut once: Vec<String> = Vec::new();
        for pattern in patterns {
            if !once.contains(pattern) {
                once.push(pattern.clone());
            }
        }
        once
    };
    let satellites = &args.constellations.satellites;
    ConstellationParts {
        input_format: args.constellations.input_format,
        only: once(&satellites.only),
        exclude: once(&satellites.exclude),
        ..ConstellationParts::of_files(files)
    }
}

/// A constellation as it identifies the run: its name, what it is made of, and what is in its files.
fn described(
    given: &GivenConstellation,
    in_scenario: Option<&str>,
    study: &Study,
) -> Result<String> {
    let one = &given.constellation;
    let described = format!("{} = {}", one.name, one.made_of());
    let named = in_scenario.and_then(|name| study.scenario.constellation(name));
    Ok(match named {
        Some(named) => format!("{described}, sha256 {}", study.digest_of_files(named)?),
        None => described,
    })
}
