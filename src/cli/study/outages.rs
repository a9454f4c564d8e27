//! Satellites that the command line takes out of service.

use super::Study;
use crate::cli::args::StudyArgs;
use anyhow::Result;

impl Study {
    /// The same with further satellites out of service throughout.
    pub(crate) fn without(self, args: &StudyArgs, satellites: &[String]) -> Result<Self> {
        match self.taking_out(satellites)? {
            Some(key) => Self::load(args, &[key]),
            None => Ok(self),
        }
    }

    /// The key of further satellites that are out of service throughout, beside those of the scenario; `None` without any.
    pub(crate) fn taking_out(&self, satellites: &[String]) -> Result<Option<String>> {
        if satellites.is_empty() {
            return Ok(None);
        }
        let mut all = self.scenario.outages.satellites.clone();
        for name in satellites {
            if !all.contains(name) {
                all.push(name.clone());
            }
        }
        Ok(Some(format!(
            "outages.satellites={}",
            serde_json::to_string(&all)?
        )))
    }
}
