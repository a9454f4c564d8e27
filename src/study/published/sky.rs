//! A sky in a study: a table of azimuth and elevation, in the study or in a file.

use crate::dop::SkyView;
use crate::formats::skies::read_skies;
use serde::Deserialize;
use std::io;

/// A sky by name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudySky {
    pub(super) name: String,
    pub(super) table: SkySource,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

/// Where the table of a sky is.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "expected the text of a table, or { file = \"…\" }"
)]
pub(super) enum SkySource {
    /// In the study.
    Text(String),
    /// In a file.
    File {
        /// Its path.
        file: String,
    },
}

impl StudySky {
    /// The sky; `read` gives the bytes of a file.
    pub(super) fn view(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<SkyView, String> {
        let (label, text) = match &self.table {
            SkySource::Text(text) => ("table", text.clone().into_bytes()),
            SkySource::File { file } => {
                let text = read(file).map_err(|error| format!("cannot read {file}: {error}"))?;
                (file.as_str(), text)
            }
        };
        let mut skies = read_skies(label, &text)
            .map_err(|error| error.to_string())?
            .skies;
        match (skies.pop(), skies.len()) {
            (Some(sky), 0) => Ok(sky),
            (_, others) => Err(format!("{label} holds {} skies, expected one", others + 1)),
        }
    }
}
