//! The directory of a search for the fewest satellites: the certificate grows in it, and the checkpoint says how far.

use super::parts::{PARTS, PartFiles};
use crate::cli::provenance::provenance;
use crate::cli::study::{Study, read_manifest};
use crate::cli::{files, output};
use crate::report::write_size_page;
use crate::run::checkpoint::{Identity, hex_sha256};
use crate::run::size::{
    CERTIFICATE_CSV, SIZE_CHECKPOINT, SIZE_CSV, SIZE_JSON, SizeCertificate, SizeResult,
    certificate_heading, certificate_rows, size_csv,
};
use crate::run::{INPUTS, REPORT_PAGE};
use crate::search::size::{SizeSearch, Witness};
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

/// The first line of a checkpoint; the second is the state of the search.
#[derive(Debug, Serialize, Deserialize)]
struct SizeHeader {
    #[serde(flatten)]
    identity: Identity,
    /// Bytes of the certificate that belong to the state.
    certificate_bytes: u64,
    /// SHA-256 of the second line, hex.
    sha256: String,
}

/// A directory in which a search is under way.
pub(super) struct SizeDirectory {
    path: PathBuf,
    identity: Identity,
    certificate: File,
    bytes: u64,
    found: Option<SizeSearch>,
    _lock: Option<File>,
}

/// What this program writes in such a directory, and in that of another search.
fn own() -> BTreeSet<String> {
    let files = [
        SIZE_JSON,
        SIZE_CSV,
        SIZE_CHECKPOINT,
        CERTIFICATE_CSV,
        REPORT_PAGE,
    ];
    let files = files.into_iter().chain(crate::run::FILES);
    let directories = [INPUTS, PARTS].map(|name| format!("{name}/"));
    files
        .into_iter()
        .map(str::to_owned)
        .chain(directories)
        .collect()
}

impl SizeDirectory {
    /// The directory at `path`, begun anew or, to resume, as it is.
    pub(super) fn open(path: PathBuf, study: &Study, force: bool, resumes: bool) -> Result<Self> {
        let identity = study.identity()?;
        files::recovered(&path)?;
        let lock = held(&path)?;
        let is_vacant = files::is_vacant(&path)?;
        let is_ours = is_of(&path, &identity);
        if resumes && is_ours {
            return Self::taken_up(path, identity, lock);
        }
        if !is_vacant && !is_ours {
            if !force {
                bail!(other(&path, ", or replace it with --force"));
            }
            files::refuse_inputs(&path, study.inputs().iter().map(PathBuf::as_path))?;
        }
        if !is_vacant {
            files::refuse_foreign(&path, &own())?;
        }
        let staged = first_files(&path, study, &identity)?;
        let lock = staged.commit_keeping(&[], &provenance(vec![study.stamp()?]))?;
        Ok(Self {
            certificate: appended(&path.join(CERTIFICATE_CSV))?,
            bytes: certificate_heading().len() as u64,
            path,
            identity,
            found: None,
            _lock: lock,
        })
    }

    /// The parts of the search in a directory in which several processes work, with its lock; the first of them begins it. `None` if
    /// it has the result already.
    pub(super) fn join(path: &Path, study: &Study) -> Result<Option<(PartFiles, Option<File>)>> {
        let identity = study.identity()?;
        files::recovered(path)?;
        if files::is_vacant(path)? {
            let staged = first_files(path, study, &identity)?;
            fs::create_dir(staged.path().join(PARTS))?;
            // Of several processes that begin the same search, the first one makes it and the others take it.
            staged.commit_if_vacant(&provenance(vec![study.stamp()?]))?;
        }
        if !is_of(path, &identity) {
            bail!(other(path, ""));
        }
        let lock = files::shared_lock(path);
        if path.join(SIZE_JSON).exists() {
            return Ok(None);
        }
        let parts = path.join(PARTS);
        fs::create_dir_all(&parts).with_context(|| format!("cannot make {}", parts.display()))?;
        Ok(Some((PartFiles::of(path, identity), lock)))
    }

    /// The parts that shards have left in it.
    pub(super) fn parts(&self) -> PartFiles {
        PartFiles::of(&self.path, self.identity.clone())
    }

    fn taken_up(path: PathBuf, identity: Identity, lock: Option<File>) -> Result<Self> {
        let read = read_checkpoint(&path, &identity)?;
        let (found, bytes) = match read {
            Some((search, bytes)) => (Some(search), bytes),
            None => (None, certificate_heading().len() as u64),
        };
        let place = path.join(CERTIFICATE_CSV);
        let certificate = appended(&place)?;
        let cannot = || format!("cannot continue {}", place.display());
        if certificate.metadata().with_context(cannot)?.len() < bytes {
            bail!(
                "{} is shorter than its checkpoint says; start over without --resume",
                place.display()
            );
        }
        certificate.set_len(bytes).with_context(cannot)?;
        Ok(Self {
            path,
            identity,
            certificate,
            bytes,
            found,
            _lock: lock,
        })
    }

    /// The search to resume, if the directory has one; fails if it is of another slack or objective.
    pub(super) fn resume(
        &mut self,
        suits: impl Fn(&SizeSearch) -> bool,
    ) -> Result<Option<SizeSearch>> {
        let Some(search) = self.found.take() else {
            return Ok(None);
        };
        if !suits(&search) {
            bail!(
                "{} has a search with another --slack or further objective; resume with the same, or start over",
                self.path.display()
            );
        }
        output::hint(&format!("resuming after {} designs", search.tried()));
        Ok(Some(search))
    }

    /// Adds witnesses to the certificate.
    pub(super) fn append(&mut self, witnesses: &[(usize, Witness)]) -> Result<()> {
        self.append_rows(&certificate_rows(witnesses)?)
    }

    /// Adds lines to the certificate.
    pub(super) fn append_rows(&mut self, rows: &str) -> Result<()> {
        let cannot = || format!("cannot write {}", self.path.join(CERTIFICATE_CSV).display());
        self.certificate
            .write_all(rows.as_bytes())
            .with_context(cannot)?;
        self.bytes += rows.len() as u64;
        Ok(())
    }

    /// Writes the state of the search.
    pub(super) fn save(&mut self, search: &SizeSearch) -> Result<()> {
        let cannot = || format!("cannot write {}", self.path.join(CERTIFICATE_CSV).display());
        self.certificate.sync_data().with_context(cannot)?;
        let state = serde_json::to_string(&search.kept())?;
        let header = SizeHeader {
            identity: self.identity.clone(),
            certificate_bytes: self.bytes,
            sha256: hex_sha256(state.as_bytes()),
        };
        let text = format!("{}\n{state}\n", serde_json::to_string(&header)?);
        files::write_atomically(&self.path.join(SIZE_CHECKPOINT), text.as_bytes())
    }

    /// The certificate of a finished search.
    pub(super) fn certificate(&self) -> Result<SizeCertificate> {
        read_certificate(&self.path, |_| Ok(()))
    }

    /// Writes the result.
    pub(super) fn finish(&self, result: &SizeResult) -> Result<()> {
        let json = crate::printable::json(result)? + "\n";
        files::write_atomically(&self.path.join(SIZE_JSON), json.as_bytes())?;
        files::write_atomically(&self.path.join(SIZE_CSV), size_csv(result)?.as_bytes())?;
        let mut page = Vec::new();
        write_size_page(result, &mut page)?;
        files::write_atomically(&self.path.join(REPORT_PAGE), &page)?;
        self.parts().remove()
    }
}

/// Whether a directory has a search of this scenario and version.
fn is_of(path: &Path, identity: &Identity) -> bool {
    let manifest = || read_manifest(path).ok().flatten();
    path.join(CERTIFICATE_CSV).exists()
        && manifest().is_some_and(|found| found.identity == *identity)
}

/// Says that a directory holds something else, and what else can be done.
fn other(path: &Path, further: &str) -> String {
    format!(
        "{} holds something other than a search for the fewest satellites of this scenario and version; choose another \
         --out{further}",
        path.display()
    )
}

/// A directory with what a search begins with.
fn first_files(path: &Path, study: &Study, identity: &Identity) -> Result<files::StagedDirectory> {
    let staged = files::StagedDirectory::new(path)?;
    files::write_all(staged.path(), &study.first_files(identity)?)?;
    let heading = certificate_heading();
    files::write_atomically(&staged.path().join(CERTIFICATE_CSV), heading.as_bytes())?;
    Ok(staged)
}

/// The number of rows of the certificate in a directory and its checksum; each row is passed to `see`.
pub(super) fn read_certificate(
    directory: &Path,
    mut see: impl FnMut(&str) -> Result<()>,
) -> Result<SizeCertificate> {
    let path = directory.join(CERTIFICATE_CSV);
    let cannot = || format!("cannot read {}", path.display());
    let mut reader = BufReader::new(File::open(&path).with_context(cannot)?);
    let (mut hash, mut designs) = (Sha256::new(), 0_u64);
    let mut line = String::new();
    let mut is_heading = true;
    while reader.read_line(&mut line).with_context(cannot)? > 0 {
        hash.update(&line);
        if !is_heading {
            designs += 1;
            see(line.trim_end())?;
        }
        is_heading = false;
        line.clear();
    }
    let digest = hash.finalize();
    let sha256 = digest.iter().map(|byte| format!("{byte:02x}"));
    Ok(SizeCertificate {
        path: CERTIFICATE_CSV.to_owned(),
        designs,
        sha256: sha256.collect(),
    })
}

fn appended(path: &Path) -> Result<File> {
    let file = File::options().append(true).open(path);
    file.with_context(|| format!("cannot write {}", path.display()))
}

/// The state of a search and the bytes of the certificate that go with it; `None` before the first.
fn read_checkpoint(directory: &Path, identity: &Identity) -> Result<Option<(SizeSearch, u64)>> {
    let path = directory.join(SIZE_CHECKPOINT);
    if !path.exists() {
        return Ok(None);
    }
    let damaged = || format!("{} is damaged; start over without --resume", path.display());
    let bytes =
        files::read_run(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let text = String::from_utf8(bytes).with_context(damaged)?;
    let (header, state) = text.split_once('\n').with_context(damaged)?;
    let header: SizeHeader = serde_json::from_str(header).with_context(damaged)?;
    let state = state.trim_end();
    if header.identity != *identity || hex_sha256(state.as_bytes()) != header.sha256 {
        bail!(damaged());
    }
    let search = serde_json::from_str(state).with_context(damaged)?;
    Ok(Some((search, header.certificate_bytes)))
}

/// The lock of a directory, if it exists and can be locked; fails if another process is using it.
fn held(directory: &Path) -> Result<Option<File>> {
    match files::lock(directory) {
        Ok(lock) => Ok(Some(lock)),
        Err(TryLockError::Error(_)) => Ok(None),
        Err(TryLockError::WouldBlock) => {
            bail!(
                "{} is in use: another process works in it",
                directory.display()
            )
        }
    }
}
