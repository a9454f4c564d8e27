//! `navwalker dop`: the dilution of precision of skies.

use crate::cli::args::{DopArgs, OutputFormat};
use crate::cli::output::shown_path;
use crate::cli::{Status, files, output};
use crate::dop::SkyRule;
use crate::formats::skies::read_skies;
use crate::report::{SkyResult, skies_csv, skies_text};
use anyhow::{Context, Result, bail};
use std::io::{self, Read};
use std::path::Path;

pub(crate) fn run(args: &DopArgs) -> Result<Status> {
    let (label, text) = read(&args.file)?;
    let table = read_skies(&label, &text)?;
    if !table.ignored.is_empty() {
        let ignored = table.ignored.join(", ");
        output::warning(&format!("{label}: columns that are not used: {ignored}"));
    }
    let rule = SkyRule {
        mask_deg: args.mask_deg,
        clocks: args.clocks,
        weights: args.weighting,
    };
    let skies: Vec<SkyResult> = (table.skies.iter())
        .map(|sky| SkyResult::new(sky, rule))
        .collect();
    output::result(&match args.format {
        OutputFormat::Text => skies_text(&skies),
        OutputFormat::Json => crate::printable::json(&skies)? + "\n",
        OutputFormat::Csv => skies_csv(&skies)?,
    })?;
    for sky in &skies {
        if let Some(why) = &sky.unsolved {
            let name = sky
                .sky
                .as_ref()
                .map_or_else(String::new, |name| format!(" {name}"));
            output::warning(&format!("{label}: sky{name} is unsolved: {why}"));
        }
    }
    Ok(Status::Done)
}

/// The table in a file, or in stdin for `-`, and its name in messages.
fn read(path: &Path) -> Result<(String, Vec<u8>)> {
    if path == Path::new("-") {
        let mut text = Vec::new();
        let stdin = io::stdin().lock();
        let read = stdin.take(files::MOST_BYTES + 1).read_to_end(&mut text);
        if read.context("cannot read stdin")? as u64 > files::MOST_BYTES {
            bail!("stdin is larger than {} MiB", files::MOST_BYTES >> 20);
        }
        return Ok(("stdin".to_owned(), text));
    }
    let label = shown_path(path);
    let text = files::read_whole(path).with_context(|| format!("cannot read {label}"))?;
    Ok((label, text))
}
