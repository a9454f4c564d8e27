//! The formats of tables, and a writer of either that keeps no more than a group of rows.

use super::parquet::{ParquetWriter, read_parquet};
use crate::keyword::keywords;
use crate::run::typed_columns::TypedColumns;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

keywords! {
    /// The format of a table.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    TableFormat {
        /// Apache Parquet, version 1, uncompressed: columns of doubles, 64-bit integers and texts.
        Parquet = "parquet",
        /// Comma-separated values with a header.
        Csv = "csv",
    }
}

/// Rows of a merged table that are written together. The bytes of a table do not depend on its chunks.
const GROUP_ROWS: usize = 1 << 16;

/// A table that is written as its rows come.
pub struct TableWriter<W: Write + Send> {
    form: WriterForm<W>,
    waiting: Option<TypedColumns>,
}

enum WriterForm<W: Write + Send> {
    Parquet(Box<ParquetWriter<W>>),
    Csv { output: W, is_begun: bool },
}

impl<W: Write + Send> TableWriter<W> {
    /// A table with the columns of `like`; `notes` are keys and values that Parquet keeps beside it.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn new(
        format: TableFormat,
        output: W,
        like: &TypedColumns,
        notes: &[(&str, String)],
    ) -> io::Result<Self> {
        let form = match format {
            TableFormat::Parquet => {
                WriterForm::Parquet(Box::new(ParquetWriter::new(output, like, notes)?))
            }
            TableFormat::Csv => WriterForm::Csv {
                output,
                is_begun: false,
            },
        };
        Ok(Self {
            form,
            waiting: None,
        })
    }

    /// Adds rows; `false` if their columns are others.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn add(&mut self, rows: TypedColumns) -> io::Result<bool> {
        match &mut self.waiting {
            None => self.waiting = Some(rows),
            Some(waiting) => {
                if !waiting.append(rows) {
                    return Ok(false);
                }
            }
        }
        while let Some(waiting) = self.waiting.as_mut().filter(|one| one.rows() >= GROUP_ROWS) {
            let group = waiting.take_first(GROUP_ROWS);
            self.form.write(&group)?;
        }
        Ok(true)
    }

    /// Writes what is left, and gives the output back.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        if let Some(last) = self.waiting.take() {
            self.form.write(&last)?;
        }
        match self.form {
            WriterForm::Parquet(writer) => writer.finish(),
            WriterForm::Csv { output, .. } => Ok(output),
        }
    }
}

impl<W: Write + Send> WriterForm<W> {
    fn write(&mut self, rows: &TypedColumns) -> io::Result<()> {
        match self {
            Self::Parquet(writer) => writer.group(rows),
            Self::Csv { output, is_begun } => {
                if !std::mem::replace(is_begun, true) {
                    output.write_all(rows.csv_heading()?.as_bytes())?;
                }
                output.write_all(rows.csv_rows()?.as_bytes())
            }
        }
    }
}

/// A whole table in memory, with the notes beside it; for CSV they are lines of a comment at the end.
///
/// # Errors
/// Never for a table in memory.
pub(super) fn table_bytes(
    format: TableFormat,
    table: TypedColumns,
    notes: &[(&str, String)],
) -> io::Result<Vec<u8>> {
    let mut writer = TableWriter::new(format, Vec::new(), &table, notes)?;
    writer.add(table)?;
    let mut bytes = writer.finish()?;
    if format == TableFormat::Csv {
        for (key, value) in notes {
            bytes.extend_from_slice(format!("# {key}={value}\n").as_bytes());
        }
    }
    Ok(bytes)
}

/// A table and the notes beside it, as [`table_bytes`] writes them.
///
/// # Errors
/// Why it is not such a table, in words.
pub(super) fn read_table(
    format: TableFormat,
    bytes: Vec<u8>,
) -> Result<(TypedColumns, Vec<(String, String)>), String> {
    match format {
        TableFormat::Parquet => read_parquet(bytes),
        TableFormat::Csv => {
            let text = String::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
            let notes = text.lines().filter_map(|line| line.strip_prefix("# "));
            let notes = notes.filter_map(|note| note.split_once('='));
            let notes = notes.map(|(key, value)| (key.to_owned(), value.to_owned()));
            let notes = notes.collect();
            let table = TypedColumns::of_csv(&text).map_err(|error| error.to_string())?;
            Ok((table, notes))
        }
    }
}
