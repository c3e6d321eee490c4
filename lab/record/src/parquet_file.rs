//! Parquet: numeric columns that are not nested in lists.
//!
//! The crate `parquet` reads the file without arrow. The supported compressions are snappy, gzip
//! and lz4. For a damaged file, the error contains the message of this crate.

use super::error::RecordError;
use super::limits::PIECES;
use bytes::Bytes;
use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{BoolType, DataType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use std::panic::{catch_unwind, AssertUnwindSafe};

/// A file whose columns are known but not yet read.
pub(super) struct File {
    reader: SerializedFileReader<Bytes>,
    /// The index of each numeric column among all columns of the file.
    places: Vec<usize>,
}

/// The meaning of the numbers in a column.
#[derive(Clone, Copy)]
struct Meaning {
    unsigned: bool,
    /// Whether the numbers are points in time. They are then relative to the first one, so that a
    /// double resolves them.
    stamp: bool,
}

impl File {
    pub(super) fn open(bytes: &[u8]) -> Result<Self, RecordError> {
        let bytes = Bytes::copy_from_slice(bytes);
        let reader = guarded(|| SerializedFileReader::new(bytes))?;
        let columns = reader.metadata().file_metadata().schema_descr().columns();
        let places: Vec<usize> = (0..columns.len())
            .filter(|index| is_numeric(&columns[*index]))
            .collect();
        if places.is_empty() {
            return Err(RecordError::new(
                "the file has no numeric column; each quantity must have one",
            ));
        }
        Ok(Self { reader, places })
    }

    fn descriptor(&self, column: usize) -> &ColumnDescriptor {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        &schema.columns()[self.places[column]]
    }

    /// Name, unit and whole name of each column.
    pub(super) fn names(&self) -> Vec<(String, Option<String>, String)> {
        let name = |column: usize| {
            let own = self.descriptor(column);
            let unit = time_unit(own).map(str::to_owned);
            (own.path().string(), unit, own.path().string())
        };
        (0..self.places.len()).map(name).collect()
    }

    /// The values of a column; `None` for a missing value.
    pub(super) fn read(&self, column: usize) -> Result<Vec<Option<f64>>, RecordError> {
        let descriptor = self.descriptor(column);
        let name = descriptor.path().string();
        let meaning = Meaning {
            unsigned: is_unsigned(descriptor),
            stamp: time_unit(descriptor).is_some(),
        };
        let place = self.places[column];
        let mut values = Vec::new();
        let mut first = None;
        for group in self.reader.metadata().row_groups() {
            let known = group.columns().get(place).map(|chunk| chunk.compression());
            if let Some(unread) = known.and_then(unread) {
                let message = format!(
                    "the column is compressed with {unread}, which bowden does not read; write the file with snappy or gzip"
                );
                return Err(RecordError::new(message).on(&name));
            }
        }
        for group in 0..self.reader.metadata().num_row_groups() {
            let chunk = guarded(|| {
                let reader = self.reader.get_row_group(group)?.get_column_reader(place)?;
                read_chunk(reader, descriptor.max_def_level(), meaning, &mut first)
            });
            values.extend(chunk.map_err(|error| error.on(&name))?);
        }
        Ok(values)
    }
}

/// Converts the errors of the crate, and its panics on damaged files, to errors of the record.
fn guarded<T>(read: impl FnOnce() -> Result<T, ParquetError>) -> Result<T, RecordError> {
    let refuse = |why: &str| {
        let why = super::error::shown(why, 200);
        RecordError::new(format!("the Parquet file is damaged: {why}"))
    };
    match catch_unwind(AssertUnwindSafe(read)) {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(refuse(&error.to_string())),
        Err(_) => Err(refuse("it cannot be decoded")),
    }
}

fn is_numeric(column: &ColumnDescriptor) -> bool {
    let number = matches!(
        column.physical_type(),
        Type::BOOLEAN | Type::INT32 | Type::INT64 | Type::FLOAT | Type::DOUBLE
    );
    let decimal = column.converted_type() == ConvertedType::DECIMAL
        || matches!(column.logical_type_ref(), Some(LogicalType::Decimal(_)));
    number && !decimal && column.max_rep_level() == 0
}

fn is_unsigned(column: &ColumnDescriptor) -> bool {
    matches!(
        column.converted_type(),
        ConvertedType::UINT_8
            | ConvertedType::UINT_16
            | ConvertedType::UINT_32
            | ConvertedType::UINT_64
    ) || matches!(column.logical_type_ref(), Some(LogicalType::Integer(own)) if !own.is_signed)
}

/// The unit of points in time.
fn time_unit(column: &ColumnDescriptor) -> Option<&'static str> {
    match (column.logical_type_ref(), column.converted_type()) {
        (Some(LogicalType::Timestamp(own) | LogicalType::Time(own)), _) => Some(match own.unit {
            TimeUnit::MILLIS => "ms",
            TimeUnit::MICROS => "us",
            TimeUnit::NANOS => "ns",
        }),
        (_, ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS) => Some("ms"),
        (_, ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS) => Some("us"),
        _ => None,
    }
}

fn unread(compression: Compression) -> Option<&'static str> {
    match compression {
        Compression::ZSTD(_) => Some("zstd"),
        Compression::BROTLI(_) => Some("brotli"),
        Compression::LZO => Some("lzo"),
        _ => None,
    }
}

type Values = Vec<Option<f64>>;

fn read_chunk(
    reader: ColumnReader,
    defined: i16,
    meaning: Meaning,
    first: &mut Option<i64>,
) -> Result<Values, ParquetError> {
    let unsigned = meaning.unsigned;
    match reader {
        ColumnReader::BoolColumnReader(own) => {
            all::<BoolType>(own, defined, |v| f64::from(u8::from(*v)))
        }
        ColumnReader::Int32ColumnReader(own) => {
            all::<Int32Type>(own, defined, |v| match unsigned {
                true => f64::from(*v as u32),
                false => f64::from(*v),
            })
        }
        ColumnReader::Int64ColumnReader(own) => all::<Int64Type>(own, defined, |v| match meaning {
            Meaning { stamp: true, .. } => v.wrapping_sub(*first.get_or_insert(*v)) as f64,
            Meaning { unsigned: true, .. } => *v as u64 as f64,
            _ => *v as f64,
        }),
        ColumnReader::FloatColumnReader(own) => all::<FloatType>(own, defined, |v| f64::from(*v)),
        ColumnReader::DoubleColumnReader(own) => all::<DoubleType>(own, defined, |v| *v),
        _ => Err(ParquetError::General(
            "a column changes its type".to_owned(),
        )),
    }
}

fn all<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    defined: i16,
    mut number: impl FnMut(&T::T) -> f64,
) -> Result<Values, ParquetError> {
    let mut all = Vec::new();
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        values.clear();
        let (records, _, _) = reader.read_records(PIECES, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Ok(all);
        }
        let mut own = values.iter().map(&mut number);
        match defined {
            0 => all.extend(own.map(Some)),
            _ => {
                let cell = |level: &i16| (*level == defined).then(|| own.next()).flatten();
                all.extend(levels.iter().map(cell));
            }
        }
    }
}
