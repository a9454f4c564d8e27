//! The designs of a list, evaluated as they are read.

use super::EvaluationContext;
use super::print::Printer;
use crate::cli::study::Study;
use crate::cli::{Status, output};
use crate::ephemeris::Ephemeris;
use crate::exchange::constellation::{Constellation, GNSS_ONLY};
use crate::report::ConstellationEntry;
use crate::run::sweep::SweptDesign;
use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// Longest line that is read, bytes: a design of some two thousand shells.
const MAX_LINE: usize = 1 << 16;

/// Designs per thread that are evaluated before they are printed.
const BATCH_PER_THREAD: usize = 8;

/// The columns that hold a notation, in order of preference; the second is that of our own tables.
const NOTATION_COLUMNS: [&str; 2] = ["design", "notation"];

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A list of designs that is being read.
pub(in crate::cli::commands) struct DesignList {
    /// Its name in messages.
    label: String,
    input: BufReader<Box<dyn Read>>,
    /// Number of the last line, from 1.
    number: usize,
    layout: ListLayout,
    /// The first line, if it is a design.
    first: Option<NumberedLine>,
}

/// What a line of the list holds.
enum ListLayout {
    /// A notation.
    Notation,
    /// The cells of a table.
    Table {
        columns: usize,
        design: usize,
        name: Option<usize>,
    },
}

/// A line that is not blank and no comment, or why it cannot be read.
type NumberedLine = (usize, Result<String, String>);

impl DesignList {
    /// The list in a file, or in stdin for `-`.
    pub(in crate::cli::commands) fn open(path: &Path) -> Result<Self> {
        let (label, input): (_, Box<dyn Read>) = if path == Path::new("-") {
            ("stdin".to_owned(), Box::new(io::stdin()))
        } else {
            let label = path.display().to_string();
            let file = File::open(path).with_context(|| format!("cannot read {label}"))?;
            (label, Box::new(file))
        };
        Self::read(label, input)
    }

    fn read(label: String, input: Box<dyn Read>) -> Result<Self> {
        let mut list = Self {
            label,
            input: BufReader::new(input),
            number: 0,
            layout: ListLayout::Notation,
            first: None,
        };
        let first = list.next_line()?;
        if let Some((_, Ok(text))) = &first
            && let Some(layout) = layout(text, &list.label)?
        {
            list.layout = layout;
        } else {
            list.first = first;
        }
        Ok(list)
    }

    /// All designs of the list, as a sweep needs them before it begins.
    pub(in crate::cli::commands) fn swept(mut self, study: &Study) -> Result<Vec<SweptDesign>> {
        let mut known = NamedConstellations {
            study,
            read: BTreeMap::new(),
        };
        let mut all = Vec::new();
        while let Some((number, line)) = self.next_line()? {
            let one = line.and_then(|line| self.layout.constellation(&line, &mut known));
            let one = one.map_err(|why| anyhow::anyhow!("{}:{number}: {why}", self.label))?;
            let Some(design) = one.only_design() else {
                bail!(
                    "{}:{number}: {} has satellites from files, and a sweep is of designs",
                    self.label,
                    one.name
                );
            };
            let notation = design.to_string();
            all.push(SweptDesign {
                name: Some(one.name).filter(|name| *name != notation),
                notation,
            });
        }
        if all.is_empty() {
            bail!("{} contains no design", self.label);
        }
        Ok(all)
    }

    /// Whether its designs may have names.
    pub(super) fn has_names(&self) -> bool {
        matches!(self.layout, ListLayout::Table { name: Some(_), .. })
    }

    /// The next line that is not blank and no comment.
    fn next_line(&mut self) -> Result<Option<NumberedLine>> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        loop {
            let mut bytes = Vec::new();
            let limit = MAX_LINE as u64 + 1;
            let cannot = || format!("cannot read {}", self.label);
            let mut line = self.input.by_ref().take(limit);
            line.read_until(b'\n', &mut bytes).with_context(cannot)?;
            if bytes.is_empty() {
                return Ok(None);
            }
            self.number += 1;
            if self.number == 1 && bytes.starts_with(BYTE_ORDER_MARK) {
                bytes.drain(..BYTE_ORDER_MARK.len());
            }
            if bytes.len() > MAX_LINE && !bytes.ends_with(b"\n") {
                self.input.skip_until(b'\n').with_context(cannot)?;
                let message = format!("the line is longer than {MAX_LINE} bytes");
                return Ok(Some((self.number, Err(message))));
            }
            let Ok(text) = str::from_utf8(&bytes) else {
                return Ok(Some((self.number, Err("not UTF-8".to_owned()))));
            };
            let text = text.trim();
            if !text.is_empty() && !text.starts_with('#') {
                return Ok(Some((self.number, Ok(text.to_owned()))));
            }
        }
    }

    /// The next lines, at most `count`; fewer if the writer of a pipe has not written more yet.
    fn batch(&mut self, count: usize) -> Result<Vec<NumberedLine>> {
        let mut lines = Vec::new();
        while lines.len() < count {
            match self.next_line()? {
                Some(line) => lines.push(line),
                None => break,
            }
            if !self.input.buffer().contains(&b'\n') {
                break;
            }
        }
        Ok(lines)
    }
}

/// The layout of a table with this header; `None` if the line is not a header.
fn layout(line: &str, label: &str) -> Result<Option<ListLayout>> {
    let Ok(names) = fields(line) else {
        return Ok(None);
    };
    let column = |wanted: &str| {
        let is_wanted = |name: &String| name.eq_ignore_ascii_case(wanted);
        names.iter().position(is_wanted)
    };
    if let Some(design) = NOTATION_COLUMNS.into_iter().find_map(column) {
        return Ok(Some(ListLayout::Table {
            columns: names.len(),
            design,
            name: column("name"),
        }));
    }
    if names.len() > 1 && !line.contains(':') {
        bail!(
            "{label}: the header has no column 'design' (found: {})",
            names.join(", ")
        );
    }
    Ok(None)
}

/// The cells of a line of CSV.
fn fields(line: &str) -> Result<Vec<String>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line.as_bytes());
    match reader.records().next() {
        Some(Ok(record)) => Ok(record.iter().map(str::to_owned).collect()),
        Some(Err(error)) => Err(error.to_string()),
        None => Ok(Vec::new()),
    }
}

impl ListLayout {
    /// The constellation of a line, by its notation or its name in the scenario.
    fn constellation(
        &self,
        line: &str,
        known: &mut NamedConstellations<'_>,
    ) -> Result<Constellation, String> {
        let (notation, name) = match self {
            Self::Notation => (line.to_owned(), None),
            Self::Table {
                columns,
                design,
                name,
            } => {
                let mut cells = fields(line)?;
                if cells.len() != *columns {
                    return Err(format!(
                        "{} cells below a header of {columns}; a notation with a comma needs quotation marks",
                        cells.len()
                    ));
                }
                let name = name.map(|name| std::mem::take(&mut cells[name]));
                (cells.swap_remove(*design), name)
            }
        };
        if notation.is_empty() {
            return Err("no design".to_owned());
        }
        let one = known.get(&notation)?;
        match name.filter(|name| !name.is_empty()) {
            Some(name) if name == GNSS_ONLY => Err(format!(
                "the name {name} is that of the GNSS alone in tables"
            )),
            Some(name) => Ok(one.named(name)),
            None => Ok(one),
        }
    }
}

/// The constellations that the scenario names, each read when a line names it first.
struct NamedConstellations<'a> {
    study: &'a Study,
    read: BTreeMap<String, Result<Constellation, String>>,
}

impl NamedConstellations<'_> {
    /// The constellation of this notation or name.
    fn get(&mut self, text: &str) -> Result<Constellation, String> {
        let Some(named) = self.study.scenario.constellation(text) else {
            let design = self.study.scenario.design(text);
            let design = design.map_err(|error| format!("{text}: {error}"))?;
            return Ok(Constellation::of_design(design));
        };
        let read = || {
            let read = self.study.constellation(named);
            read.map_err(|error| format!("{error:#}"))
        };
        self.read
            .entry(text.to_owned())
            .or_insert_with(read)
            .clone()
    }
}

/// Evaluates the designs of a list in parallel and prints them in its order.
pub(super) fn evaluate(
    mut list: DesignList,
    study: &Study,
    work: &EvaluationContext<'_>,
    printer: &mut Printer<'_>,
) -> Result<Status> {
    let size = BATCH_PER_THREAD * rayon::current_num_threads();
    let (mut good, mut bad) = (0_usize, 0_usize);
    let mut known = NamedConstellations {
        study,
        read: BTreeMap::new(),
    };
    loop {
        let lines = list.batch(size)?;
        if lines.is_empty() {
            break;
        }
        let mut of_line = |line: String| -> Result<Constellation, String> {
            list.layout.constellation(&line, &mut known)
        };
        let lines = lines.into_iter();
        let constellations: Vec<_> = lines
            .map(|(number, line)| (number, line.and_then(&mut of_line)))
            .collect();
        let entries: Vec<_> = constellations
            .into_par_iter()
            .map(|(number, one)| (number, one.and_then(|one| entry(&one, work))))
            .collect();
        for (number, entry) in entries {
            match entry {
                Ok(entry) => {
                    printer.entry(entry)?;
                    good += 1;
                }
                Err(why) => {
                    let why = anyhow::anyhow!("{}:{number}: {why}", list.label);
                    output::error(&why);
                    bad += 1;
                }
            }
        }
    }
    match (good, bad) {
        (0, 0) => bail!("{} contains no design", list.label),
        (0, _) => bail!("no design of {} can be evaluated", list.label),
        (_, 0) => Ok(Status::Done),
        _ => Ok(Status::Failed),
    }
}

fn entry(one: &Constellation, work: &EvaluationContext<'_>) -> Result<ConstellationEntry, String> {
    let setup = work.evaluator.setup();
    let evaluate = || -> Result<ConstellationEntry> {
        let ephemeris: Ephemeris = one.in_service(setup)?;
        work.entry(one, &ephemeris)
    };
    evaluate().map_err(|error| format!("{}: {error}", one.made_of()))
}
