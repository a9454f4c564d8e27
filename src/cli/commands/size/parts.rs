//! The files of the parts of a search for the fewest satellites, which shards write and the search that ends it takes up.

use crate::cli::{files, output};
use crate::run::checkpoint::{Identity, hex_sha256};
use crate::search::size::SizeSearch;
use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

/// The directory of the parts, in that of the search.
pub(super) const PARTS: &str = "parts";

/// The end of the name of a part.
const PART: &str = "part";

/// The first line of a part; the second is what was found, the rest are lines of the certificate.
#[derive(Debug, Serialize, Deserialize)]
struct PartHeader {
    #[serde(flatten)]
    identity: Identity,
    /// The fewest satellites of the part that keep the constraints.
    fewest: Option<usize>,
    /// SHA-256 of the other lines, hex.
    sha256: String,
}

/// The parts of a search.
pub(super) struct PartFiles {
    directory: PathBuf,
    identity: Identity,
}

impl PartFiles {
    /// Those in the directory of a search.
    pub(super) fn of(search: &Path, identity: Identity) -> Self {
        Self {
            directory: search.join(PARTS),
            identity,
        }
    }

    fn path(&self, part: u64) -> PathBuf {
        self.directory.join(format!("{part}.{PART}"))
    }

    /// Writes what was found in a part.
    pub(super) fn put(&self, part: u64, search: &SizeSearch, rows: &str) -> Result<()> {
        let rest = format!("{}\n{rows}", serde_json::to_string(&search.kept())?);
        let header = PartHeader {
            identity: self.identity.clone(),
            fewest: search.fewest(),
            sha256: hex_sha256(rest.as_bytes()),
        };
        let text = format!("{}\n{rest}", serde_json::to_string(&header)?);
        files::write_atomically(&self.path(part), text.as_bytes())
    }

    /// What was found in a part, and its lines of the certificate; `None` if it is not there. What cannot be used is said.
    pub(super) fn get(&self, part: u64) -> Option<(SizeSearch, String)> {
        let path = self.path(part);
        match self.read(&path) {
            Ok(found) => found,
            Err(error) => {
                self.warn(part, &format!("{error:#}"));
                None
            }
        }
    }

    /// Says that a part cannot be used.
    pub(super) fn warn(&self, part: u64, reason: &str) {
        let path = self.path(part);
        output::warning(&format!(
            "{}: {reason}; its designs are tried again",
            path.display()
        ));
    }

    fn read(&self, path: &Path) -> Result<Option<(SizeSearch, String)>> {
        let bytes = match files::read_run(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            read => read?,
        };
        let text = String::from_utf8(bytes).context("it is damaged")?;
        let (header, rest) = text.split_once('\n').context("it is damaged")?;
        let header: PartHeader = serde_json::from_str(header).context("it is damaged")?;
        if hex_sha256(rest.as_bytes()) != header.sha256 {
            bail!("it is damaged");
        }
        if header.identity != self.identity {
            bail!("it is of another scenario or version");
        }
        let (state, rows) = rest.split_once('\n').context("it is damaged")?;
        let search = serde_json::from_str(state).context("it is damaged")?;
        Ok(Some((search, rows.to_owned())))
    }

    /// Whether a part is there and can be used.
    pub(super) fn has(&self, part: u64) -> bool {
        self.get(part).is_some()
    }

    /// The fewest satellites that keep the constraints in any part, by the first lines.
    pub(super) fn fewest(&self) -> Option<usize> {
        let headers = self.paths().into_iter().filter_map(|path| {
            let mut line = String::new();
            BufReader::new(File::open(path).ok()?)
                .read_line(&mut line)
                .ok()?;
            serde_json::from_str::<PartHeader>(&line).ok()
        });
        let ours = headers.filter(|header| header.identity == self.identity);
        ours.filter_map(|header| header.fewest).min()
    }

    /// The files of all parts.
    pub(super) fn paths(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(&self.directory).into_iter().flatten();
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        paths
            .filter(|path| path.extension().is_some_and(|end| end == PART))
            .collect()
    }

    /// Removes what the result makes needless.
    pub(super) fn remove(&self) -> Result<()> {
        for path in self.paths() {
            fs::remove_file(&path).with_context(|| format!("cannot remove {}", path.display()))?;
        }
        // It is not there, or somebody has put something else into it.
        let _ = fs::remove_dir(&self.directory);
        Ok(())
    }
}
