//! Gzip decompression with a size limit and clear errors for damaged data.

use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, Read};

/// Signature of gzip data (RFC 1952, 2.3.1).
pub(super) const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Decompressed size that is always allowed, bytes.
const FREE: u64 = 1 << 26;

/// Maximum compression ratio beyond that size: orbit files compress by a factor of 5 to 10, and only files made to
/// exhaust memory by a factor of 1000.
const MOST_FOLD: u64 = 200;

/// The decompressed bytes of gzip data.
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
                io::ErrorKind::UnexpectedEof => damaged("the gzip data are truncated"),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
                    damaged("the gzip data are damaged")
                }
                _ => error,
            })?;
        self.unpacked += count as u64;
        if self.unpacked > FREE + MOST_FOLD * self.decoder.get_ref().taken {
            let message = format!(
                "the gzip data decompress to more than {MOST_FOLD} times their size, which no constellation file does"
            );
            return Err(damaged(&message));
        }
        Ok(count)
    }
}

/// An input that counts the bytes read from it.
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
