//! One evaluation in tiles, which may be evaluated on several machines.

use super::{EvaluateArgs, constellations};
use crate::cli::args::{Shard, quoted};
use crate::cli::constellations::{ConstellationSource, GivenConstellation};
use crate::cli::limits::{TileSize, say_of_tiles};
use crate::cli::study::{Study, say_of_setup};
use crate::cli::{Status, files, output};
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Evaluator, Metrics, Setup, ViewHistograms};
use crate::exchange::constellation::Constellation;
use crate::run::VERSION;
use crate::run::checkpoint::hex_sha256;
use crate::run::sweep::sweep_time_s;
use crate::run::tile::{TileFile, TilePlan, TileSet, TileWriter};
use anyhow::{Context, Result, anyhow, bail};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Evaluates a tile and writes its file.
pub(super) fn evaluate(
    args: &EvaluateArgs,
    study: &Study,
    given: &[GivenConstellation],
    tile: Shard,
) -> Result<Status> {
    let one = only(given)?;
    let Some(out) = &args.out else {
        bail!("--tile needs --out FILE");
    };
    let inputs = study.inputs();
    let inputs = inputs.iter().map(PathBuf::as_path);
    files::refuse_inputs(out, inputs.chain(args.constellations.inputs()))?;
    let setup = study.setup_in_tiles()?;
    let instants = setup.grid.len();
    if tile.parts > instants {
        bail!("--tile {tile}: there are {instants} instants, and a tile has at least one");
    }
    say_of_tiles(&setup, &size(&setup, &one.constellation, tile));
    say_of_setup(&setup);
    let evaluator = Evaluator::new(setup)?;
    let setup = evaluator.setup();
    let plan = TilePlan {
        tiles: tile.parts,
        ..plan(study, &evaluator, described(given)?)?
    };
    let instants = plan.instants_of(tile.part);
    let leo = constellations::propagate(&one.constellation, setup)?;
    evaluator.require_divisible()?;
    let none = Ephemeris::new(setup.grid, Vec::new());
    let parts = [&leo, &none];
    files::StagedFile::new(out)?.commit_written(|file| {
        let mut writer = TileWriter::new(BufWriter::new(file), &plan, tile.part)?;
        let mut counts = Vec::new();
        for ephemeris in parts.into_iter().take(plan.parts()) {
            let found = evaluator.evaluate_tile(ephemeris, instants.clone(), &mut writer);
            counts.push(found.map_err(io::Error::other)?);
        }
        writer.finish(&counts)
    })?;
    output::hint(&format!(
        "{} written\nwhen all tiles are: the same command with --merge FILE... in place of --tile and --out",
        quoted(&out.display().to_string())
    ));
    Ok(Status::Done)
}

/// The evaluator of tiles, however many samples they have together.
pub(super) fn evaluator(study: &Study) -> Result<Evaluator> {
    let setup = study.setup_in_tiles()?;
    say_of_setup(&setup);
    Ok(Evaluator::new(setup)?)
}

/// What a tile comes to.
fn size(setup: &Setup, one: &Constellation, tile: Shard) -> TileSize {
    let samples = setup.sample_count();
    let sets = if setup.gnss.is_empty() { 1 } else { 2 };
    let time_s = |satellites: usize| sweep_time_s(1.0, samples, satellites as f64);
    TileSize {
        tiles: tile.parts,
        all_bytes: samples as u64 * size_of::<f32>() as u64 * sets,
        one_thread_s: (time_s(one.satellite_count()) + time_s(0)) / tile.parts as f64,
    }
}

/// The only constellation.
fn only(given: &[GivenConstellation]) -> Result<&GivenConstellation> {
    match given {
        [one] => Ok(one),
        more => bail!(
            "a tile is of one constellation, and there are {}; give one by --design or --constellation",
            more.len()
        ),
    }
}

/// What the satellites are made of, with a checksum of the files that the scenario does not name.
fn described(given: &[GivenConstellation]) -> Result<String> {
    let one = only(given)?;
    let mut described = one.constellation.made_of();
    if let ConstellationSource::Files(files) = &one.source {
        for (_, bytes) in files {
            described += &format!(" sha256 {}", hex_sha256(bytes));
        }
        described += &format!(", {} satellites", one.constellation.satellite_count());
    }
    Ok(described)
}

/// What is evaluated, in one tile.
fn plan(study: &Study, evaluator: &Evaluator, constellation: String) -> Result<TilePlan> {
    Ok(TilePlan {
        version: VERSION.to_owned(),
        scenario: study.stamp()?,
        constellation,
        gnss_alone: !evaluator.setup().gnss.is_empty(),
        instants: evaluator.setup().grid.len(),
        bytes_of_instant: evaluator.bytes_of_instant(),
        tiles: 1,
    })
}

/// Files that are to be merged.
pub(super) struct TilePaths {
    paths: Vec<PathBuf>,
    constellation: String,
}

/// The tiles of an evaluation, which are merged in place of evaluating.
pub(super) struct MergedTiles {
    set: Mutex<TileSet<File>>,
}

impl MergedTiles {
    /// The files of `--merge`, if it is given.
    pub(super) fn paths(
        args: &EvaluateArgs,
        given: &[GivenConstellation],
    ) -> Result<Option<TilePaths>> {
        if args.merge.is_empty() {
            return Ok(None);
        }
        Ok(Some(TilePaths {
            paths: args.merge.clone(),
            constellation: described(given)?,
        }))
    }

    /// The metrics of some satellites, or of the GNSS alone, and the histograms of those in view.
    pub(super) fn merge(
        &self,
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
    ) -> Result<(Metrics, ViewHistograms)> {
        let part = usize::from(ephemeris.satellites().is_empty());
        let mut set = self.set.lock().unwrap_or_else(PoisonError::into_inner);
        let counts = set.counts(part);
        let merged = evaluator.merge_tiles(ephemeris, counts, &mut |instant, bytes| {
            set.read(part, instant, bytes)
        });
        merged.context("the tiles cannot be merged")
    }
}

impl TilePaths {
    /// Opens and checks them.
    pub(super) fn open(self, study: &Study, evaluator: &Evaluator) -> Result<MergedTiles> {
        let mut tiles = Vec::new();
        for path in &self.paths {
            let name = path.display().to_string();
            let file = File::open(path).with_context(|| format!("cannot read {name}"))?;
            let tile = TileFile::open(file).map_err(|error| anyhow!("{name}: {error}"))?;
            tiles.push((name, tile));
        }
        let plan = plan(study, evaluator, self.constellation)?;
        let set = Mutex::new(TileSet::new(tiles, &plan)?);
        Ok(MergedTiles { set })
    }
}
