//! The table behind a figure.

use super::FigureError;
use ::csv::Writer;

/// Rows of text under a header.
pub(super) struct Csv(Writer<Vec<u8>>);

impl Csv {
    pub(super) fn new(header: &[&str]) -> Result<Self, FigureError> {
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(header)?;
        Ok(Self(writer))
    }

    pub(super) fn row<S: AsRef<[u8]>>(
        &mut self,
        cells: impl IntoIterator<Item = S>,
    ) -> Result<(), FigureError> {
        Ok(self.0.write_record(cells)?)
    }

    pub(super) fn text(self) -> Result<String, FigureError> {
        let bytes = self
            .0
            .into_inner()
            .map_err(|error| ::csv::Error::from(error.into_error()))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// The shortest digits that round-trip; empty for no value.
pub(super) fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
