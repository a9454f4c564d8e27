//! Where a result comes from: the build, the command and the scenarios.

use crate::evaluate::InstructionSet;
use crate::run::{ScenarioStamp, VERSION};
use serde::{Deserialize, Serialize};

/// The file in each output directory that says where it comes from.
pub const PROVENANCE: &str = "provenance.json";

/// Where the files of a directory come from.
///
/// The command has neither output place nor what only changes how it ran (threads, resuming), so the same
/// work has the same provenance on the same platform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResultProvenance {
    /// The name of this program.
    pub program: String,
    /// Its version.
    pub version: String,
    /// The commit it was built from, with `+` if files were changed since; `None` for a debug build or one from a package.
    pub commit: Option<String>,
    /// The platform it was built for, as a target triple.
    pub platform: String,
    /// The vector instructions that it used; the results do not depend on them.
    pub instruction_set: String,
    /// The command, word by word; `None` for a result that no command made.
    pub command: Option<Vec<String>>,
    /// The scenarios that were studied.
    pub scenarios: Vec<ScenarioStamp>,
}

impl ResultProvenance {
    /// That of this process for a command and its scenarios.
    #[must_use]
    pub fn new(command: Option<Vec<String>>, scenarios: Vec<ScenarioStamp>) -> Self {
        Self {
            program: env!("CARGO_PKG_NAME").to_owned(),
            version: VERSION.to_owned(),
            commit: option_env!("NAVWALKER_COMMIT").map(str::to_owned),
            platform: env!("NAVWALKER_TARGET").to_owned(),
            instruction_set: InstructionSet::detect().to_string(),
            command,
            scenarios,
        }
    }
}
