//! One binary for all integration tests.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod cli;
mod evidence;
mod exports;
mod fire;
mod gallery;
mod interchange;
mod look;
mod names;
mod reference;
mod runs;
mod scenes;
mod singular;
mod study;
mod tidy;
mod trust;
