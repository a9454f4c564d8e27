//! One file per command.

pub(crate) mod diff;
pub(crate) mod dop;
pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod help;
pub(crate) mod lifetime;
pub(crate) mod lint;
pub(crate) mod optimize;
pub(crate) mod orbit;
pub(crate) mod plot;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod scenario;
pub(crate) mod separation;
pub(crate) mod size;
pub(crate) mod sweep;
pub(crate) mod validate;
