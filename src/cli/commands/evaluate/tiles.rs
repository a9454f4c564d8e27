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
use crate::run::sweep::{SampleShape, sweep_time_s};
use crate::run::tile::{TileFile, TilePlan, TileSet, TileWriter};
use anyhow::{Context, Result, anyhow, bail};
use std::fs::File;
use std::io::{self, BufWriter, Write};
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
    require_tiles(instants, tile.parts).map_err(|error| anyhow!("--tile {tile}: {error}"))?;
    say_of_tiles(&setup, &size(&setup, &one.constellation, tile));
    say_of_setup(&setup);
    let evaluator = Evaluator::new(setup)?;
    let described = described(given)?;
    let work = TileWork::new(
        study,
        &evaluator,
        (&one.constellation, described),
        tile.parts,
    )?;
    files::StagedFile::new(out)?
        .commit_written(|file| work.write(tile.part, BufWriter::new(file)))?;
    output::hint(&format!(
        "{} written\nwhen all tiles are: the same command with --merge FILE... in place of --tile and --out",
        quoted(&out.display().to_string())
    ));
    Ok(Status::Done)
}

/// An evaluation in so many tiles.
struct TileWork<'a> {
    evaluator: &'a Evaluator,
    plan: TilePlan,
    leo: Ephemeris,
}

impl<'a> TileWork<'a> {
    /// Of a constellation, and what it is made of.
    fn new(
        study: &Study,
        evaluator: &'a Evaluator,
        (constellation, described): (&Constellation, String),
        tiles: usize,
    ) -> Result<Self> {
        let plan = TilePlan {
            tiles,
            ..plan(study, evaluator, described)?
        };
        let leo = constellations::propagate(constellation, evaluator.setup())?;
        evaluator.require_divisible()?;
        Ok(Self {
            evaluator,
            plan,
            leo,
        })
    }

    /// Evaluates a tile, by its number from 1, and writes its file.
    fn write(&self, tile: usize, output: impl Write) -> io::Result<()> {
        let none = Ephemeris::new(self.evaluator.setup().grid, Vec::new());
        let mut writer = TileWriter::new(output, &self.plan, tile)?;
        let mut counts = Vec::new();
        for ephemeris in [&self.leo, &none].into_iter().take(self.plan.parts()) {
            let instants = self.plan.instants_of(tile);
            let found = self
                .evaluator
                .evaluate_tile(ephemeris, instants, &mut writer);
            counts.push(found.map_err(io::Error::other)?);
        }
        writer.finish(&counts)
    }
}

/// The file of a tile of a design, as bytes: tile I of N.
///
/// # Errors
/// If there is no such tile, or the evaluation cannot be cut into tiles.
pub fn design_tile(
    study: &Study,
    evaluator: &Evaluator,
    one: &Constellation,
    (tile, tiles): (usize, usize),
) -> Result<Vec<u8>> {
    require_tiles(evaluator.setup().grid.len(), tiles)?;
    let work = TileWork::new(study, evaluator, (one, one.made_of()), tiles)?;
    let mut bytes = Vec::new();
    work.write(tile.clamp(1, tiles), &mut bytes)?;
    Ok(bytes)
}

/// The metrics of a design from the files of all its tiles.
///
/// # Errors
/// If a file is no tile of it, or one is missing.
pub fn merged_design(
    study: &Study,
    evaluator: &Evaluator,
    one: &Constellation,
    paths: Vec<PathBuf>,
) -> Result<Metrics> {
    let constellation = one.made_of();
    let tiles = TilePaths {
        paths,
        constellation,
    };
    let tiles = tiles.open(study, evaluator)?;
    let setup = evaluator.setup();
    let alone = if setup.gnss.is_empty() {
        None
    } else {
        let none = Ephemeris::new(setup.grid, Vec::new());
        Some(tiles.merge(evaluator, &none)?.0)
    };
    let leo = constellations::propagate(one, setup)?;
    let (metrics, _) = tiles.merge(evaluator, &leo)?;
    Ok(alone.map_or(metrics, |alone| metrics.with_gain_over(&alone)))
}

/// Refuses more tiles than instants.
fn require_tiles(instants: usize, tiles: usize) -> Result<()> {
    if tiles == 0 || tiles > instants {
        bail!("there are {instants} instants, and a tile has at least one");
    }
    Ok(())
}

/// What a tile comes to.
fn size(setup: &Setup, one: &Constellation, tile: Shard) -> TileSize {
    let samples = SampleShape::from(setup);
    let sets = if setup.gnss.is_empty() { 1 } else { 2 };
    let time_s = |satellites: usize| sweep_time_s(1.0, samples, satellites as f64);
    TileSize {
        tiles: tile.parts,
        all_bytes: setup.sample_count() as u64 * size_of::<f32>() as u64 * sets,
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
