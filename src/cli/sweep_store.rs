//! The directory of a sweep: what it is a sweep of, the results of its chunks, and the merged table.
//!
//! Several processes may work in one, on one machine or on a shared file system: every file is written beside its place and
//! renamed, and two results of one chunk are the same bytes.

use crate::cli::provenance::provenance;
use crate::cli::study::Study;
use crate::cli::{files, output};
use crate::evaluate::Evaluator;
use crate::keyword::Keyword;
use crate::report::{SweepSummary, write_sweep_page};
use crate::run::checkpoint::hex_sha256;
use crate::run::hashed::Hashed;
use crate::run::sweep::{
    CHUNKS, CHUNKS_CSV, ChunkEntry, DESIGNS_CSV, INDEX_JSON, IndexedChunk, SWEEP_JSON, SweepChunk,
    SweepDesigns, SweepEvaluator, SweepIndex, SweepPlan, SweepSource, SweptDesign, TableFormat,
    TableWriter, chunks_csv, designs_csv, read_chunk, read_chunks, read_designs, write_chunk,
};
use crate::run::typed_columns::TypedColumns;
use crate::run::{INPUTS, MANIFEST, REPORT_PAGE, SCENARIO, VERSION};
use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// A sweep in its directory.
#[derive(Debug)]
pub struct SweepStore {
    path: PathBuf,
    plan: SweepPlan,
    chunks: Vec<ChunkEntry>,
    /// Keeps the directory from being replaced; `None` if the file system has no locks.
    _lock: Option<File>,
}

/// The state of the result of a chunk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChunkState {
    /// It is there and intact.
    Done,
    /// It is not there.
    Missing,
    /// It is there and cannot be used.
    Damaged(String),
}

/// What this program writes in the directory.
fn own() -> BTreeSet<String> {
    let tables = TableFormat::ALL
        .iter()
        .map(|format| format!("table.{format}"));
    let files = [
        SCENARIO,
        MANIFEST,
        SWEEP_JSON,
        CHUNKS_CSV,
        DESIGNS_CSV,
        INDEX_JSON,
        REPORT_PAGE,
    ];
    let directories = [INPUTS, CHUNKS].map(|name| format!("{name}/"));
    let files = files.into_iter().map(str::to_owned);
    files.chain(directories).chain(tables).collect()
}

impl SweepStore {
    /// The sweep in a directory.
    ///
    /// # Errors
    /// If there is none, or what says so is damaged.
    pub fn read(path: &Path) -> Result<Self> {
        let json = path.join(SWEEP_JSON);
        let bytes = files::read_run(&json)
            .with_context(|| format!("{} has no sweep", path.display()))
            .with_context(|| format!("cannot read {}", json.display()))?;
        let damaged = |name: &str| format!("{} is damaged", path.join(name).display());
        let plan: SweepPlan =
            serde_json::from_slice(&bytes).with_context(|| damaged(SWEEP_JSON))?;
        let bytes = files::read_run(&path.join(CHUNKS_CSV))
            .with_context(|| format!("cannot read {}", path.join(CHUNKS_CSV).display()))?;
        let chunks = read_chunks(&bytes).with_context(|| damaged(CHUNKS_CSV))?;
        if chunks.len() as u64 != plan.chunks() {
            bail!(damaged(CHUNKS_CSV));
        }
        Ok(Self {
            path: path.to_owned(),
            plan,
            chunks,
            _lock: files::shared_lock(path),
        })
    }

    /// The sweep of a plan in a directory: the one that is there if `joins`, or else a new one. `force` replaces another.
    ///
    /// # Errors
    /// If the directory holds something else, or cannot be written.
    pub fn open(
        path: &Path,
        study: &Study,
        plan: SweepPlan,
        designs: &SweepDesigns<'_>,
        (joins, force): (bool, bool),
    ) -> Result<Self> {
        files::recovered(path)?;
        if path.join(SWEEP_JSON).exists() {
            let found = Self::read(path);
            let difference = match &found {
                Ok(found) => found.plan.difference(&plan),
                Err(error) => Some(format!("{error:#}")),
            };
            match (found, difference) {
                (Ok(found), None) if joins => return Ok(found),
                (_, None) if !force => bail!(
                    "{} holds this sweep already; continue it with --resume, or begin it anew with --force",
                    path.display()
                ),
                (_, Some(difference)) if !force => bail!(
                    "{} holds another sweep: {difference}; choose another --out, or replace it with --force",
                    path.display()
                ),
                _ => {}
            }
        } else if !files::is_vacant(path)? && !force {
            bail!(
                "{} holds something other than a sweep; choose another --out",
                path.display()
            );
        }
        files::refuse_inputs(path, study.inputs().iter().map(PathBuf::as_path))?;
        if !files::is_vacant(path)? {
            files::refuse_foreign(path, &own())?;
        }
        Self::create(path, study, &plan, designs, force)?;
        let made = Self::read(path)?;
        match made.plan.difference(&plan) {
            None => Ok(made),
            // Another process has made it at the same time.
            Some(difference) => bail!("{} holds another sweep: {difference}", path.display()),
        }
    }

    fn create(
        path: &Path,
        study: &Study,
        plan: &SweepPlan,
        designs: &SweepDesigns<'_>,
        force: bool,
    ) -> Result<()> {
        let staged = files::StagedDirectory::new(path)?;
        let provenance = provenance(vec![study.stamp()?]);
        let mut first = study.first_files(&study.identity()?)?;
        if let SweepDesigns::List(list) = designs {
            first.push((DESIGNS_CSV.to_owned(), designs_csv(list)?.into_bytes()));
        }
        let chunks = entries(plan, designs)?;
        first.push((CHUNKS_CSV.to_owned(), chunks_csv(&chunks)?.into_bytes()));
        let json = crate::printable::json(plan)? + "\n";
        first.push((SWEEP_JSON.to_owned(), json.into_bytes()));
        files::write_all(staged.path(), &first)?;
        fs::create_dir(staged.path().join(CHUNKS))?;
        if force {
            return staged.commit(&provenance);
        }
        // Of several processes that begin the same sweep, the first one makes it and the others take it.
        staged.commit_if_vacant(&provenance)
    }

    /// What it is a sweep of.
    #[must_use]
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// Its chunks, in the order of the sweep.
    #[must_use]
    pub fn chunks(&self) -> &[ChunkEntry] {
        &self.chunks
    }

    /// The directory.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The designs of its list; none for a space.
    ///
    /// # Errors
    /// If the list is damaged.
    pub fn list(&self) -> Result<Vec<SweptDesign>> {
        if self.plan.source == SweepSource::Space {
            return Ok(Vec::new());
        }
        let path = self.path.join(DESIGNS_CSV);
        let bytes =
            files::read_run(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let is_ours = self.plan.designs_sha256 == Some(hex_sha256(&bytes));
        let read = read_designs(&bytes);
        match read {
            Ok(list) if is_ours => Ok(list),
            _ => bail!("{} is damaged", path.display()),
        }
    }

    /// A chunk by its number from 0, with its designs.
    ///
    /// # Errors
    /// If the designs are not those of the sweep.
    pub fn chunk(&self, number: usize, designs: &SweepDesigns<'_>) -> Result<SweepChunk> {
        let points = self.plan.points_of(number as u64);
        let chunk = SweepChunk::new(&self.plan, designs.at(points)?);
        if chunk.name != self.chunks[number].name {
            bail!(
                "chunk {} of {} is of other designs than those of this search space",
                number + 1,
                self.path.display()
            );
        }
        Ok(chunk)
    }

    fn result_path(&self, number: usize) -> PathBuf {
        self.path
            .join(self.plan.chunk_path(&self.chunks[number].name))
    }

    /// The bytes of the result of a chunk and the table in it; `None` if it is missing.
    fn result(&self, number: usize) -> Result<Option<(Vec<u8>, TypedColumns)>, String> {
        let bytes = match files::read_run(&self.result_path(number)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|error| error.to_string())?,
        };
        let entry = &self.chunks[number];
        let table = read_chunk(self.plan.format, &entry.name, bytes.clone());
        let table = table.map_err(|error| error.to_string())?;
        if table.rows() as u64 != entry.designs {
            let (found, expected) = (table.rows(), entry.designs);
            return Err(format!("it has {found} designs, expected {expected}"));
        }
        Ok(Some((bytes, table)))
    }

    /// The table of a chunk.
    ///
    /// # Errors
    /// If it is missing or damaged.
    pub fn table(&self, number: usize) -> Result<TypedColumns> {
        match self.result(number) {
            Ok(Some((_, table))) => Ok(table),
            Ok(None) => bail!("it is missing"),
            Err(reason) => bail!(reason),
        }
    }

    /// The state of the result of a chunk, which is read whole.
    #[must_use]
    pub fn state(&self, number: usize) -> ChunkState {
        match self.result(number) {
            Ok(Some(_)) => ChunkState::Done,
            Ok(None) => ChunkState::Missing,
            Err(reason) => ChunkState::Damaged(reason),
        }
    }

    /// The states of all chunks.
    #[must_use]
    pub fn states(&self) -> Vec<ChunkState> {
        let all = (0..self.chunks.len()).into_par_iter();
        all.map(|number| self.state(number)).collect()
    }

    /// Puts the result of a chunk in its place, if it is that.
    ///
    /// # Errors
    /// If it is not, or cannot be written.
    pub fn put(&self, number: usize, bytes: &[u8]) -> Result<()> {
        let entry = &self.chunks[number];
        let told = || format!("the result of chunk {} cannot be used", number + 1);
        let table = read_chunk(self.plan.format, &entry.name, bytes.to_vec()).with_context(told)?;
        if table.rows() as u64 != entry.designs {
            bail!("{}: it has {} designs", told(), table.rows());
        }
        files::write_atomically(&self.result_path(number), bytes)
    }

    /// Writes the merged table, the index and the page, from results of all chunks; the bytes do not depend on where they were
    /// computed, nor on their size. `Err` of the inner result names the chunks that cannot be used, by number from 0.
    ///
    /// # Errors
    /// If the table cannot be written.
    pub fn merge(&self) -> Result<std::result::Result<SweepIndex, Vec<(usize, ChunkState)>>> {
        let states = self.states().into_iter().enumerate();
        let open: Vec<_> = states
            .filter(|(_, state)| *state != ChunkState::Done)
            .collect();
        if !open.is_empty() {
            return Ok(Err(open));
        }
        let place = self.path.join(self.plan.table());
        let cannot = || format!("cannot write {}", place.display());
        let mut indexed = Vec::new();
        let mut without_metrics = 0;
        let mut summary = SweepSummary::default();
        let first = self.table(0)?;
        let sha256 = files::StagedFile::new(&place)?.commit_written(|file| {
            let mut writer = self.table_writer(file, &first)?;
            for (number, entry) in self.chunks.iter().enumerate() {
                let found = self.result(number).map_err(io::Error::other)?;
                let (bytes, table) = found.ok_or(io::ErrorKind::NotFound)?;
                without_metrics += rows_without_metrics(&table);
                summary.add(&table);
                indexed.push(IndexedChunk {
                    name: entry.name.clone(),
                    designs: entry.designs,
                    sha256: hex_sha256(&bytes),
                });
                if !writer.add(table)? {
                    let message = format!("chunk {} has other columns", number + 1);
                    return Err(io::Error::other(message));
                }
            }
            Ok(writer.finish()?.finish().1)
        });
        let sha256 = sha256.with_context(cannot)?;
        let index = SweepIndex::new(&self.plan, indexed, without_metrics, sha256);
        let json = crate::printable::json(&index)? + "\n";
        files::write_atomically(&self.path.join(INDEX_JSON), json.as_bytes())?;
        let mut page = Vec::new();
        write_sweep_page(&self.plan, &index, &summary, &mut page)?;
        files::write_atomically(&self.path.join(REPORT_PAGE), &page)?;
        Ok(Ok(index))
    }

    fn table_writer<'f>(
        &self,
        file: &'f mut File,
        like: &TypedColumns,
    ) -> io::Result<TableWriter<Hashed<&'f mut File>>> {
        let notes = [
            ("navwalker.scenario", self.plan.scenario.name.clone()),
            ("navwalker.scenario_hash", self.plan.scenario.hash.clone()),
        ];
        TableWriter::new(self.plan.format, Hashed::new(file), like, &notes)
    }
}

/// The chunks of a sweep with their names, in parallel.
fn entries(plan: &SweepPlan, designs: &SweepDesigns<'_>) -> Result<Vec<ChunkEntry>> {
    let entry = |number: u64| {
        let chunk = SweepChunk::new(plan, designs.at(plan.points_of(number))?);
        Ok(ChunkEntry {
            designs: chunk.designs.len() as u64,
            name: chunk.name,
        })
    };
    (0..plan.chunks()).into_par_iter().map(entry).collect()
}

/// Designs that have no metrics: those without a mean number of satellites in view.
fn rows_without_metrics(table: &TypedColumns) -> u64 {
    use crate::run::typed_columns::ColumnValues;
    match table.get("mean_visible") {
        Some(ColumnValues::Real(of)) => of.iter().filter(|value| value.is_none()).count() as u64,
        _ => 0,
    }
}

/// Evaluates a chunk for the study that it is of, and gives its result as a file; `None` if it was stopped.
///
/// # Errors
/// If the chunk is of another version or scenario, or is damaged.
pub fn sweep_chunk(
    study: &Study,
    evaluator: &Evaluator,
    (chunk, format): (&SweepChunk, TableFormat),
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<u8>>> {
    if chunk.version != VERSION {
        let theirs = &chunk.version;
        bail!(
            "the sweep is of version {theirs} and this worker of version {VERSION}; install the same"
        );
    }
    if !chunk.is_intact() {
        bail!("the chunk {} was changed on its way", chunk.name);
    }
    let study = study.for_sweep()?;
    if chunk.scenario_hash != study.hash()? {
        bail!("the chunk is of another scenario than that of this worker");
    }
    let problem = study.problem(evaluator)?;
    let table = SweepEvaluator::new(&problem).evaluate(chunk, is_stopped);
    let written = table.map(|table| write_chunk(format, &chunk.name, table));
    Ok(written.transpose()?)
}

/// Says that a result is damaged, and that its chunk is computed again.
pub(crate) fn warn_of_damage(store: &SweepStore, number: usize, reason: &str) {
    output::warning(&format!(
        "{}: {reason}; its chunk is computed again",
        store.result_path(number).display()
    ));
}
