//! A stream whose bytes are hashed as they pass.

use super::checkpoint::hex;
use sha2::{Digest, Sha256};
use std::io::{self, Read, Write};

/// A stream whose bytes are hashed as they are written or read.
#[derive(Debug)]
pub(crate) struct Hashed<S> {
    stream: S,
    hash: Sha256,
}

impl<S> Hashed<S> {
    pub(crate) fn new(stream: S) -> Self {
        Self {
            stream,
            hash: Sha256::new(),
        }
    }

    /// The stream, and the SHA-256 of what has passed, hex.
    pub(crate) fn finish(self) -> (S, String) {
        (self.stream, hex(&self.hash.finalize()))
    }
}

impl<S: Write> Write for Hashed<S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.stream.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl<S: Read> Read for Hashed<S> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(bytes)?;
        self.hash.update(&bytes[..read]);
        Ok(read)
    }
}
