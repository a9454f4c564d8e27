//! The file of a tile of an evaluation: a line that says what it is a tile of, the values of its samples, and a line of what is
//! counted over them, with the SHA-256 of all before it.

use super::ScenarioStamp;
use super::hashed::Hashed;
use crate::evaluate::TileCounts;
use serde::{Deserialize, Serialize};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use thiserror::Error;

/// Most bytes of a line of a tile.
const MOST_LINE: usize = 4 << 20;

/// What an evaluation in tiles is an evaluation of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TilePlan {
    /// Version of the program.
    pub version: String,
    /// The study.
    pub scenario: ScenarioStamp,
    /// What the constellation is made of, with checksums of its files.
    pub constellation: String,
    /// Whether the GNSS alone is evaluated too.
    pub gnss_alone: bool,
    /// Instants of all tiles.
    pub instants: usize,
    /// Bytes of the values of an instant.
    pub bytes_of_instant: usize,
    /// Number of tiles.
    pub tiles: usize,
}

impl TilePlan {
    /// The instants of a tile, by its number from 1.
    #[must_use]
    pub fn instants_of(&self, tile: usize) -> Range<usize> {
        let bound = |number: usize| {
            let share = self.instants as u128 * number as u128 / self.tiles.max(1) as u128;
            share as usize
        };
        bound(tile - 1)..bound(tile)
    }

    /// Sets of values: with the constellation, and of the GNSS alone.
    #[must_use]
    pub fn parts(&self) -> usize {
        1 + usize::from(self.gnss_alone)
    }

    /// Bytes of all values of some instants.
    #[must_use]
    pub fn bytes_of(&self, instants: usize) -> u64 {
        let each = self.bytes_of_instant as u64;
        each.saturating_mul(instants as u64)
            .saturating_mul(self.parts() as u64)
    }

    /// What differs in `other`, in words, if anything.
    fn difference(&self, other: &Self) -> Option<String> {
        let told = |what: &str, theirs: &dyn std::fmt::Display, ours: &dyn std::fmt::Display| {
            Some(format!("{what} is {theirs} there and {ours} here"))
        };
        if self.version != other.version {
            return told("the version", &self.version, &other.version);
        }
        if self.scenario.hash != other.scenario.hash {
            return Some("the scenario is another".to_owned());
        }
        if self.constellation != other.constellation {
            let (theirs, ours) = (&self.constellation, &other.constellation);
            return told("the constellation", theirs, ours);
        }
        if self.tiles != other.tiles {
            return told("the number of tiles", &self.tiles, &other.tiles);
        }
        (self != other).then(|| "the points or instants are others".to_owned())
    }
}

/// The first line of the file of a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct TileHead {
    /// Its number, from 1.
    tile: usize,
    #[serde(flatten)]
    plan: TilePlan,
}

/// Writes the file of a tile: the values, part by part, are written to it.
#[derive(Debug)]
pub struct TileWriter<W: Write> {
    output: Hashed<W>,
}

impl<W: Write> TileWriter<W> {
    /// The file of a tile, by its number from 1.
    ///
    /// # Errors
    /// If `output` cannot be written.
    pub fn new(output: W, plan: &TilePlan, tile: usize) -> io::Result<Self> {
        let head = TileHead {
            tile,
            plan: plan.clone(),
        };
        let mut output = Hashed::new(output);
        writeln!(output, "{}", serde_json::to_string(&head)?)?;
        Ok(Self { output })
    }

    /// Ends the file with the counts of each part.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub fn finish(mut self, counts: &[TileCounts]) -> io::Result<()> {
        writeln!(self.output, "{}", serde_json::to_string(counts)?)?;
        let (mut output, sha256) = self.output.finish();
        writeln!(output, "{sha256}")?;
        output.flush()
    }
}

impl<W: Write> Write for TileWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.output.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

/// Why a file is not a tile.
#[derive(Debug, Error)]
pub enum TileFileError {
    /// It does not begin like one.
    #[error("it is not a tile of an evaluation")]
    Foreign,
    /// It is cut short, or its bytes are not those that were written.
    #[error("it is damaged: {reason}")]
    Damaged {
        /// What is wrong.
        reason: &'static str,
    },
    /// It cannot be read.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// The file of a tile, whole and as it was written.
#[derive(Debug)]
pub struct TileFile<R> {
    input: R,
    head: TileHead,
    /// Where the values begin.
    values_at: u64,
    counts: Vec<TileCounts>,
}

impl<R: Read + Seek> TileFile<R> {
    /// Reads the file once, to check it.
    ///
    /// # Errors
    /// If it is not a tile, or damaged.
    pub fn open(input: R) -> Result<Self, TileFileError> {
        let mut input = BufReader::with_capacity(1 << 20, input);
        let mut hashed = Hashed::new(&mut input);
        let first = line(&mut hashed)?.ok_or(TileFileError::Foreign)?;
        let head: TileHead = serde_json::from_str(&first).map_err(|_| TileFileError::Foreign)?;
        let plan = &head.plan;
        if head.tile == 0 || head.tile > plan.tiles || plan.tiles > plan.instants {
            return Err(TileFileError::Foreign);
        }
        let length = plan.bytes_of(plan.instants_of(head.tile).len());
        if io::copy(&mut (&mut hashed).take(length), &mut io::sink())? < length {
            return Err(cut_short());
        }
        let counts = line(&mut hashed)?.ok_or_else(cut_short)?;
        let (rest, sha256) = hashed.finish();
        if line(rest)?.ok_or_else(cut_short)? != sha256 {
            let reason = "it does not match its checksum";
            return Err(TileFileError::Damaged { reason });
        }
        let damaged = |_| TileFileError::Damaged {
            reason: "its counts cannot be read",
        };
        let counts: Vec<TileCounts> = serde_json::from_str(&counts).map_err(damaged)?;
        if counts.len() != plan.parts() {
            return Err(cut_short());
        }
        Ok(Self {
            values_at: first.len() as u64 + 1,
            input: input.into_inner(),
            head,
            counts,
        })
    }

    /// What it is a tile of.
    #[must_use]
    pub fn plan(&self) -> &TilePlan {
        &self.head.plan
    }

    /// Its instants.
    fn instants(&self) -> Range<usize> {
        self.head.plan.instants_of(self.head.tile)
    }

    /// Reads the values of a part from an instant of the tile on.
    fn read(&mut self, part: usize, instant: usize, to: &mut [u8]) -> io::Result<()> {
        let instants = self.instants();
        let before = instants.len() * part + (instant - instants.start);
        let each = self.head.plan.bytes_of_instant as u64;
        let place = self.values_at + each * before as u64;
        self.input.seek(SeekFrom::Start(place))?;
        self.input.read_exact(to)
    }
}

fn cut_short() -> TileFileError {
    let reason = "it is cut short";
    TileFileError::Damaged { reason }
}

/// A line without its end; `None` if it is cut short or no text.
fn line(input: &mut impl Read) -> io::Result<Option<String>> {
    let (mut bytes, mut byte) = (Vec::new(), [0]);
    // Byte by byte, so that nothing after the line is taken: it is short, and the input is in memory.
    while bytes.len() < MOST_LINE {
        match input.read_exact(&mut byte) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
            read => read?,
        }
        if byte == *b"\n" {
            return Ok(String::from_utf8(bytes).ok());
        }
        bytes.extend(byte);
    }
    Ok(None)
}

/// Why some tiles are not one evaluation.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TileSetError {
    /// A tile of another evaluation.
    #[error("{file} is a tile of another evaluation: {difference}")]
    Other {
        /// The name of the file.
        file: String,
        /// What differs.
        difference: String,
    },
    /// A tile that is there twice.
    #[error("{first} and {second} are both tile {tile} of {tiles}")]
    Twice {
        /// The name of a file.
        first: String,
        /// The name of the other file.
        second: String,
        /// The number of the tile.
        tile: usize,
        /// The number of tiles.
        tiles: usize,
    },
    /// Tiles that are not there.
    #[error("{}", missing_of(.missing, *.tiles))]
    Missing {
        /// Their numbers.
        missing: Vec<usize>,
        /// The number of tiles.
        tiles: usize,
    },
}

/// Which tiles are missing: `tiles 2, 4 of 4 are missing`.
fn missing_of(missing: &[usize], tiles: usize) -> String {
    if let [one] = missing {
        return format!("tile {one} of {tiles} is missing");
    }
    let shown = missing.iter().take(MOST_LISTED).map(usize::to_string);
    let shown = shown.collect::<Vec<_>>().join(", ");
    let more = if missing.len() > MOST_LISTED {
        ", …"
    } else {
        ""
    };
    format!("tiles {shown}{more} of {tiles} are missing")
}

/// Most numbers of tiles in an error.
const MOST_LISTED: usize = 20;

/// All tiles of an evaluation, in order.
#[derive(Debug)]
pub struct TileSet<R> {
    tiles: Vec<TileFile<R>>,
}

impl<R: Read + Seek> TileSet<R> {
    /// The tiles in files, each with its name in messages, of an evaluation whose number of tiles is that of the first.
    ///
    /// # Errors
    /// If one is of another evaluation, or there twice or missing.
    pub fn new(files: Vec<(String, TileFile<R>)>, of: &TilePlan) -> Result<Self, TileSetError> {
        let tiles = files.first().map_or(0, |(_, file)| file.plan().tiles);
        let expected = TilePlan {
            tiles,
            ..of.clone()
        };
        for (name, file) in &files {
            if let Some(difference) = file.plan().difference(&expected) {
                let file = name.clone();
                return Err(TileSetError::Other { file, difference });
            }
        }
        let mut places: Vec<Option<(String, TileFile<R>)>> = Vec::new();
        places.resize_with(tiles, || None);
        for (name, file) in files {
            let tile = file.head.tile;
            if let Some((first, _)) = places[tile - 1].replace((name.clone(), file)) {
                let second = name;
                return Err(TileSetError::Twice {
                    first,
                    second,
                    tile,
                    tiles,
                });
            }
        }
        let open = (1..).zip(&places).filter(|(_, place)| place.is_none());
        let missing: Vec<usize> = open.map(|(number, _)| number).collect();
        if !missing.is_empty() || tiles == 0 {
            return Err(TileSetError::Missing { missing, tiles });
        }
        let tiles = places.into_iter().flatten().map(|(_, file)| file).collect();
        Ok(Self { tiles })
    }

    /// The counts of all tiles together: with the constellation (part 0), or of the GNSS alone (part 1).
    #[must_use]
    pub fn counts(&self, part: usize) -> TileCounts {
        let mut all = TileCounts::default();
        let of_tiles = self.tiles.iter().filter_map(|tile| tile.counts.get(part));
        of_tiles.for_each(|counts| all.merge(counts));
        all
    }

    /// Reads values of a part from an instant on, whatever tiles they are in.
    ///
    /// # Errors
    /// If a file cannot be read, or the values go on after the last tile.
    pub fn read(&mut self, part: usize, instant: usize, to: &mut [u8]) -> io::Result<()> {
        let (mut instant, mut to) = (instant, to);
        for tile in &mut self.tiles {
            let (each, end) = (tile.plan().bytes_of_instant, tile.instants().end);
            if to.is_empty() || instant >= end {
                continue;
            }
            let (here, rest) = to.split_at_mut(to.len().min((end - instant) * each));
            tile.read(part, instant, here)?;
            (instant, to) = (end, rest);
        }
        match to.is_empty() {
            true => Ok(()),
            false => Err(io::ErrorKind::UnexpectedEof.into()),
        }
    }
}

#[cfg(test)]
mod tests;
