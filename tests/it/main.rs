//! One binary for all integration tests.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod cli;
mod common;
mod compared;
#[cfg(unix)]
mod ctrl_c;
mod evaluations;
mod evidence;
mod exports;
mod failures;
mod fire;
mod flags;
mod gallery;
mod given_runs;
mod hostile;
mod hybrids;
mod interchange;
mod keys;
mod limits;
mod look;
mod names;
mod pages;
mod provenance;
mod readers;
mod reference;
mod regions;
mod relative;
mod runs;
mod scenes;
mod series;
mod shells;
mod singular;
mod size;
mod skies;
mod study;
mod sweep;
mod tidy;
mod tiles;
mod trust;
