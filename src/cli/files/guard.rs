//! Protection of inputs and foreign files: what may be written, and what `--force` may replace.

use crate::run::{MANIFEST, PROVENANCE, REPORT_PAGE};
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The entries that this program may write to a run directory used as input.
const OWN_PLACES: [&str; 4] = [REPORT_PAGE, "validation", "checkpoints", "figures"];
/// Maximum number of foreign files to name.
const MOST_NAMED: usize = 5;

/// Refuses an output that is an input, contains one, or is inside one; in a run directory, this
/// program's own entries are allowed.
pub(crate) fn refuse_inputs(
    out: &Path,
    inputs: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<()> {
    let place = canonical(out)?;
    for input in inputs {
        let input = input.as_ref();
        let Ok(input_place) = input.canonicalize() else {
            continue;
        };
        let (shown, named) = (out.display(), input.display());
        if input_place == place {
            bail!("{shown} is an input; choose another output");
        }
        if input_place.starts_with(&place) {
            bail!("{shown} contains the input {named}; choose another output");
        }
        let Ok(rest) = place.strip_prefix(&input_place) else {
            continue;
        };
        let first = rest.components().next();
        let is_own = OWN_PLACES
            .iter()
            .any(|own| first.is_some_and(|first| first.as_os_str() == *own));
        if !is_own {
            let in_run = if input.join(MANIFEST).exists() {
                format!(", or in {}", input.join("figures").display())
            } else {
                String::new()
            };
            bail!("{shown} is inside the input {named}; choose an output outside it{in_run}");
        }
    }
    Ok(())
}

/// Refuses to replace a directory that matters beyond this program: the working directory or one
/// above it, a home directory, the root, a repository.
pub(super) fn refuse_ground(place: &Path) -> Result<()> {
    let place = canonical(place)?;
    let holds = |path: io::Result<PathBuf>| path.is_ok_and(|path| path.starts_with(&place));
    if place.parent().is_none() {
        bail!("it is the root of the file system");
    }
    if holds(std::env::current_dir().and_then(|path| path.canonicalize())) {
        bail!("it is or contains the working directory; choose a directory inside it");
    }
    let home = std::env::var_os("HOME").filter(|home| !home.is_empty());
    if home.is_some_and(|home| holds(Path::new(&home).canonicalize())) {
        bail!("it is or contains a home directory; choose a directory inside it");
    }
    if place.join(".git").exists() {
        bail!("it is a repository; choose a directory inside it");
    }
    Ok(())
}

/// Refuses to replace a directory that matters beyond this program, or contains files besides its provenance that are not
/// in `own`, a list of relative paths with `/`; a path that ends in `/` covers everything below it.
pub(crate) fn refuse_foreign(directory: &Path, own: &BTreeSet<String>) -> Result<()> {
    refuse_ground(directory).with_context(|| format!("cannot replace {}", directory.display()))?;
    let is_own = |path: &str| {
        path == PROVENANCE
            || own.contains(path)
            || own
                .iter()
                .any(|own| own.ends_with('/') && path.starts_with(own.as_str()))
    };
    let mut foreign =
        files_below(directory).with_context(|| format!("cannot read {}", directory.display()))?;
    foreign.retain(|path| !is_own(path));
    let Some(named) = foreign
        .get(..foreign.len().min(MOST_NAMED))
        .filter(|n| !n.is_empty())
    else {
        return Ok(());
    };
    let more = foreign.len() - named.len();
    let more = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    bail!(
        "{} contains files that this command did not write, and --force would delete them: {}{more}; choose \
         another directory, or move them",
        directory.display(),
        named.join(", ")
    );
}

/// The files and empty directories below a directory, by relative path.
fn files_below(directory: &Path) -> io::Result<Vec<String>> {
    let mut found = Vec::new();
    let mut waiting = vec![(directory.to_owned(), String::new())];
    while let Some((path, shown)) = waiting.pop() {
        let mut is_empty = true;
        for entry in fs::read_dir(&path)? {
            let entry = entry?;
            is_empty = false;
            let name = entry.file_name();
            if super::is_staged(&name) {
                continue;
            }
            let shown = format!("{shown}{}", name.to_string_lossy());
            if entry.file_type()?.is_dir() {
                waiting.push((entry.path(), shown + "/"));
            } else {
                found.push(shown);
            }
        }
        if is_empty && !shown.is_empty() {
            found.push(shown);
        }
    }
    found.sort();
    Ok(found)
}

/// The absolute path, with links resolved as far as the path exists.
fn canonical(path: &Path) -> Result<PathBuf> {
    let path = super::resolved(path)?;
    let mut missing = Vec::new();
    let mut there = path.as_path();
    loop {
        if let Ok(found) = there.canonicalize() {
            let rest = missing.iter().rev();
            return Ok(rest.fold(found, |found: PathBuf, name| found.join(name)));
        }
        match (there.parent(), there.file_name()) {
            (Some(parent), Some(name)) => {
                missing.push(name.to_owned());
                there = parent;
            }
            _ => bail!("{} is not a path in the file system", path.display()),
        }
    }
}
