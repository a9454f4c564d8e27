//! The selection of satellites of files.

use crate::exchange::import::SatelliteFilter;
use clap::Args;

/// Which satellites of files are used.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct SatelliteArgs {
    /// Keep only these satellites of the files: a name, a designator, a catalogue number, or a pattern in
    /// which `*` stands for any characters and `?` for one, as in 'NW-P01-*'; may be repeated.
    #[arg(long, value_name = "PATTERN")]
    pub(crate) only: Vec<String>,

    /// Leave these satellites of the files out, named as for `--only`; may be repeated.
    #[arg(long, value_name = "PATTERN")]
    pub(crate) exclude: Vec<String>,
}

impl SatelliteArgs {
    /// The selection.
    pub(crate) fn filter(&self) -> SatelliteFilter {
        SatelliteFilter {
            only: self.only.clone(),
            exclude: self.exclude.clone(),
        }
    }
}
