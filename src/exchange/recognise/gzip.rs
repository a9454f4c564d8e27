//! Gzip decompression with a size limit and clear errors for damaged data.

use flate2::bufread::GzDecoder;
use std::io::{self, BufRead, Read};

/// Signature of gzip data (RFC 1952, 2.3.1).
pub(super) const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Decompressed size that is always allowed, bytes.
const FREE: u64 = 1 << 26;

/// Maximum compression ratio beyond that size: orbit files compress by a factor of 5 to 10, and only files made to
/// exhaust memory by a factor of 1000.
const MOST_FOLD: u64 = 200;

/// The decompressed bytes of gzip data: of all members, one after the other (RFC 1952, 2.2), up to zeros that fill the
/// last block of a tape or an archive, which gzip(1) ignores too.
pub(super) struct Unpacked<R> {
    member: Member<R>,
    unpacked: u64,
}

/// The input, in the middle of a member or behind the last one.
enum Member<R> {
    Open(Box<GzDecoder<Counted<R>>>),
    Ended,
}

impl<R: BufRead> Unpacked<R> {
    pub(super) fn new(input: R) -> Self {
        let counted = Counted { input, taken: 0 };
        Self {
            member: Member::Open(Box::new(GzDecoder::new(counted))),
            unpacked: 0,
        }
    }
}

impl<R: BufRead> Read for Unpacked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        while let Member::Open(decoder) = &mut self.member {
            let count = decoder.read(buffer).map_err(explained)?;
            if count > 0 {
                self.unpacked += count as u64;
                return match self.unpacked > FREE + MOST_FOLD * decoder.get_ref().taken {
                    true => Err(damaged(format!(
                        "the gzip data decompress to more than {MOST_FOLD} times their size, which no constellation file does"
                    ))),
                    false => Ok(count),
                };
            }
            if let Member::Open(decoder) = std::mem::replace(&mut self.member, Member::Ended) {
                self.member = after(decoder.into_inner())?;
            }
        }
        Ok(0)
    }
}

/// The member that follows one, if any.
fn after<R: BufRead>(mut input: Counted<R>) -> io::Result<Member<R>> {
    let mut padding = 0_u64;
    loop {
        let available = input.fill_buf()?;
        match available.first() {
            None => return Ok(Member::Ended),
            Some(first) if *first == MAGIC[0] && padding == 0 => {
                return Ok(Member::Open(Box::new(GzDecoder::new(input))));
            }
            Some(0) => {
                let zeros = available.iter().take_while(|byte| **byte == 0).count();
                padding += zeros as u64;
                input.consume(zeros);
            }
            Some(_) => {
                let at = input.taken + 1;
                return Err(damaged(format!(
                    "byte {at} follows the end of the gzip data, and is not the beginning of more"
                )));
            }
        }
    }
}

/// An error of the decoder in our words.
fn explained(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged("the gzip data are truncated"),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
            damaged("the gzip data are damaged")
        }
        _ => error,
    }
}

fn damaged(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message.into())
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
