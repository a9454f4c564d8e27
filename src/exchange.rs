//! From designs to files and back: exports with their manifest, constellations from files, reading
//! products back, and checking files against their standards.

pub mod export;
pub mod import;
pub mod lint;
pub mod manifest;
pub mod read_back;
pub mod recognise;

#[cfg(test)]
mod tests;
