//! Tables as Parquet, by the columns of the `parquet` crate without Arrow.

use crate::run::VERSION;
use crate::run::typed_columns::{ColumnKind, ColumnValues, TypedColumns};
use parquet::basic::{LogicalType, Repetition, Type as PhysicalType};
use parquet::column::reader::ColumnReader;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::io::{self, Write};
use std::sync::Arc;

/// A file under way.
pub(super) struct ParquetWriter<W: Write + Send>(SerializedFileWriter<W>);

fn failed(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(error) => io::Error::other(error),
        },
        error => io::Error::other(error),
    }
}

impl<W: Write + Send> ParquetWriter<W> {
    /// A file with the columns of a table, and these notes in its metadata.
    pub(super) fn new(
        output: W,
        like: &TypedColumns,
        notes: &[(&str, String)],
    ) -> io::Result<Self> {
        let notes = notes
            .iter()
            .map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone()));
        let properties = WriterProperties::builder()
            .set_created_by(format!("navwalker {VERSION}"))
            .set_key_value_metadata(Some(notes.collect()))
            .build();
        let schema = schema(like).map_err(failed)?;
        let writer = SerializedFileWriter::new(output, schema, Arc::new(properties));
        Ok(Self(writer.map_err(failed)?))
    }

    /// Writes rows as one group.
    pub(super) fn group(&mut self, rows: &TypedColumns) -> io::Result<()> {
        let mut write = || -> Result<(), ParquetError> {
            let mut group = self.0.next_row_group()?;
            for values in rows.values() {
                write_column(&mut group, values)?;
            }
            group.close().map(drop)
        };
        write().map_err(failed)
    }

    /// Ends the file.
    pub(super) fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(failed)
    }
}

fn schema(table: &TypedColumns) -> Result<TypePtr, ParquetError> {
    let field = |(name, values): (&String, &ColumnValues)| {
        let (physical, logical) = match values.kind() {
            ColumnKind::Real => (PhysicalType::DOUBLE, None),
            ColumnKind::Integer => (PhysicalType::INT64, None),
            ColumnKind::Truth => (PhysicalType::BOOLEAN, None),
            ColumnKind::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical)
            .build();
        field.map(Arc::new)
    };
    let fields = table.names().iter().zip(table.values()).map(field);
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let root = Type::group_type_builder("navwalker").with_fields(fields);
    Ok(Arc::new(root.build()?))
}

/// Whether each value is there, as Parquet counts it, and those that are.
fn present<T, U>(of: &[Option<T>], value: impl Fn(&T) -> U) -> (Vec<i16>, Vec<U>) {
    let levels = of.iter().map(|one| i16::from(one.is_some()));
    (levels.collect(), of.iter().flatten().map(value).collect())
}

fn write_column<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &ColumnValues,
) -> Result<(), ParquetError> {
    let missing = || ParquetError::General("a column without a place in the schema".to_owned());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    match values {
        ColumnValues::Real(of) => {
            let (levels, found) = present(of, |one| *one);
            let typed = column.typed::<DoubleType>();
            typed.write_batch(&found, Some(&levels), None)?;
        }
        ColumnValues::Integer(of) => {
            let (levels, found) = present(of, |one| *one);
            let typed = column.typed::<Int64Type>();
            typed.write_batch(&found, Some(&levels), None)?;
        }
        ColumnValues::Truth(of) => {
            let (levels, found) = present(of, |one| *one);
            let typed = column.typed::<BoolType>();
            typed.write_batch(&found, Some(&levels), None)?;
        }
        ColumnValues::Text(of) => {
            let (levels, found) = present(of, |one| ByteArray::from(one.as_str()));
            let typed = column.typed::<ByteArrayType>();
            typed.write_batch(&found, Some(&levels), None)?;
        }
    }
    column.close()
}

/// A table and the notes beside it; otherwise why it is none, in words.
pub(super) fn read_parquet(
    bytes: Vec<u8>,
) -> Result<(TypedColumns, Vec<(String, String)>), String> {
    let read = || -> Result<_, ParquetError> {
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes))?;
        let metadata = reader.metadata().file_metadata();
        let notes = metadata.key_value_metadata().into_iter().flatten();
        let notes = notes.filter_map(|note| Some((note.key.clone(), note.value.clone()?)));
        let notes: Vec<(String, String)> = notes.collect();
        let fields = metadata.schema_descr().columns().iter();
        let mut columns: Vec<(String, Option<ColumnValues>)> = fields
            .map(|field| (field.name().to_owned(), None))
            .collect();
        for number in 0..reader.num_row_groups() {
            let group = reader.get_row_group(number)?;
            let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            for (place, (_, values)) in columns.iter_mut().enumerate() {
                let further = read_column(group.get_column_reader(place)?, rows)?;
                *values = Some(joined(values.take(), further)?);
            }
        }
        Ok((columns, notes))
    };
    let (columns, notes) = read().map_err(|error| error.to_string())?;
    let columns = columns.into_iter().map(|(name, values)| {
        let kind = ColumnKind::of(&name);
        (name, values.unwrap_or_else(|| ColumnValues::empty(kind)))
    });
    let table = TypedColumns::of_values(columns.collect());
    let table = table.ok_or_else(|| "its columns differ in length".to_owned())?;
    Ok((table, notes))
}

fn joined(
    before: Option<ColumnValues>,
    further: ColumnValues,
) -> Result<ColumnValues, ParquetError> {
    let Some(mut before) = before else {
        return Ok(further);
    };
    if before.append(further) {
        return Ok(before);
    }
    Err(ParquetError::General("a column of two kinds".to_owned()))
}

/// Values with the missing ones in their places.
fn spread<T>(levels: &[i16], found: Vec<T>) -> Vec<Option<T>> {
    let mut found = found.into_iter();
    let one = |level: &i16| (*level > 0).then(|| found.next()).flatten();
    levels.iter().map(one).collect()
}

fn read_column(column: ColumnReader, rows: usize) -> Result<ColumnValues, ParquetError> {
    let mut levels = Vec::new();
    macro_rules! values {
        ($reader:expr) => {{
            let mut reader = $reader;
            let mut found = Vec::new();
            while levels.len() < rows {
                let left = rows - levels.len();
                let (records, ..) =
                    reader.read_records(left, Some(&mut levels), None, &mut found)?;
                if records == 0 {
                    let error = format!("{} of {rows} values", levels.len());
                    return Err(ParquetError::EOF(error));
                }
            }
            spread(&levels, found)
        }};
    }
    Ok(match column {
        ColumnReader::DoubleColumnReader(reader) => ColumnValues::Real(values!(reader)),
        ColumnReader::Int64ColumnReader(reader) => ColumnValues::Integer(values!(reader)),
        ColumnReader::BoolColumnReader(reader) => ColumnValues::Truth(values!(reader)),
        ColumnReader::ByteArrayColumnReader(reader) => {
            let texts = values!(reader).into_iter();
            let text = |one: ByteArray| one.as_utf8().map(str::to_owned);
            let texts = texts.map(|one| one.map(text).transpose());
            ColumnValues::Text(texts.collect::<Result<_, _>>()?)
        }
        _ => return Err(ParquetError::General("a column of another type".to_owned())),
    })
}
