//! Constellations, and from designs to files and back: exports with their manifest, constellations from files, products
//! read back, and files checked against their standards.

pub mod constellation;
pub mod deployment;
mod element_sets;
pub mod export;
mod identities;
pub mod import;
pub mod lint;
pub mod manifest;
mod members;
pub mod read_back;
pub mod recognise;

#[cfg(test)]
mod tests;
