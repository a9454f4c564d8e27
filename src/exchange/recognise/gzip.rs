//! Gzip data, read through: bounded, and with words for what is damaged.

use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, Read};

/// How gzip data begin (RFC 1952, 2.3.1).
pub(super) const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Bytes that any file may unpack to.
const FREE: u64 = 1 << 26;

/// Most bytes beyond them for each that is packed: orbits shrink to a fifth or a tenth, and only what is made to
/// fill the memory to a thousandth.
const MOST_FOLD: u64 = 200;

/// The bytes that gzip data unpack to.
pub(super) struct Unpacked<R> {
    decoder: MultiGzDecoder<Counted<R>>,
    unpacked: u64,
}

impl<R: BufRead> Unpacked<R> {
    pub(super) fn new(input: R) -> Self {
        let counted = Counted { input, taken: 0 };
        Self {
            decoder: MultiGzDecoder::new(counted),
            unpacked: 0,
        }
    }
}

impl<R: BufRead> Read for Unpacked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let damaged =
            |message: &str| io::Error::new(io::ErrorKind::InvalidData, message.to_owned());
        let count = self
            .decoder
            .read(buffer)
            .map_err(|error| match error.kind() {
                io::ErrorKind::UnexpectedEof => damaged("the gzip data are cut short"),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
                    damaged("the gzip data are damaged")
                }
                _ => error,
            })?;
        self.unpacked += count as u64;
        if self.unpacked > FREE + MOST_FOLD * self.decoder.get_ref().taken {
            let message = format!(
                "the gzip data unpack to more than {MOST_FOLD} times their size: no constellation does"
            );
            return Err(damaged(&message));
        }
        Ok(count)
    }
}

/// An input that counts what is taken from it.
struct Counted<R> {
    input: R,
    taken: u64,
}

impl<R: BufRead> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.taken += count as u64;
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Counted<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.input.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.taken += count as u64;
        self.input.consume(count);
    }
}
