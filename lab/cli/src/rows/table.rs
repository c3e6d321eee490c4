//! The rows as Parquet, in one row group, packed by Snappy.

use super::row::Row;
use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::sync::Arc;

/// The columns in their order. A list is written as Arrow does.
const SCHEMA: &str = "message rows {
    optional binary file (STRING);
    optional binary status (STRING);
    optional binary error (STRING);
    optional int64 line;
    optional binary column (STRING);
    optional binary verdict (STRING);
    optional group mechanisms (LIST) { repeated group list { optional binary element (STRING); } }
    optional group names (LIST) { repeated group list { optional binary element (STRING); } }
    optional group confidences (LIST) { repeated group list { optional binary element (STRING); } }
    optional double baseline_held_out;
    optional double final_held_out;
    optional double floor;
    optional group parameters (LIST) { repeated group list { optional binary element (STRING); } }
    optional group values (LIST) { repeated group list { optional double element; } }
    optional group units (LIST) { repeated group list { optional binary element (STRING); } }
    optional int64 evaluations;
    optional int64 jacobians;
    optional int64 columns_filtered;
    optional int64 searches;
}";

/// The bytes of the file.
pub fn parquet(rows: &[Row]) -> Result<Vec<u8>, String> {
    write(rows).map_err(|e| format!("Parquet: {e}"))
}

fn write(rows: &[Row]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .build();
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    let mut all = Columns(&mut group);
    all.texts(rows.iter().map(|row| Some(row.file.as_str())))?;
    all.texts(rows.iter().map(|row| Some(row.status.as_str())))?;
    all.texts(rows.iter().map(|row| row.error.as_deref()))?;
    all.integers(rows.iter().map(|row| row.line))?;
    all.texts(rows.iter().map(|row| row.column.as_deref()))?;
    all.texts(rows.iter().map(|row| row.verdict.as_deref()))?;
    all.text_lists(rows.iter().map(|row| some(row.mechanisms.as_deref())))?;
    all.text_lists(rows.iter().map(|row| some(row.names.as_deref())))?;
    all.text_lists(rows.iter().map(|row| some(row.confidences.as_deref())))?;
    all.numbers(rows.iter().map(|row| row.baseline_held_out))?;
    all.numbers(rows.iter().map(|row| row.final_held_out))?;
    all.numbers(rows.iter().map(|row| row.floor))?;
    all.text_lists(rows.iter().map(|row| some(row.parameters.as_deref())))?;
    all.lists::<DoubleType>(rows.iter().map(|row| row.values.clone()))?;
    all.text_lists(rows.iter().map(|row| row.units.clone()))?;
    all.integers(rows.iter().map(|row| row.evaluations))?;
    all.integers(rows.iter().map(|row| row.jacobians))?;
    all.integers(rows.iter().map(|row| row.columns_filtered))?;
    all.integers(rows.iter().map(|row| row.searches))?;
    group.close()?;
    file.into_inner()
}

/// A list whose elements are all there.
fn some(list: Option<&[String]>) -> Option<Vec<Option<String>>> {
    list.map(|list| list.iter().cloned().map(Some).collect())
}

fn bytes(text: &str) -> ByteArray {
    ByteArray::from(text.as_bytes().to_vec())
}

/// Writes one column after the other.
struct Columns<'a, 'b>(&'a mut SerializedRowGroupWriter<'b, Vec<u8>>);

impl Columns<'_, '_> {
    fn texts<'t>(
        &mut self,
        cells: impl Iterator<Item = Option<&'t str>>,
    ) -> Result<(), ParquetError> {
        self.cells::<ByteArrayType>(cells.map(|cell| cell.map(bytes)))
    }

    fn integers(&mut self, cells: impl Iterator<Item = Option<i64>>) -> Result<(), ParquetError> {
        self.cells::<Int64Type>(cells)
    }

    fn numbers(&mut self, cells: impl Iterator<Item = Option<f64>>) -> Result<(), ParquetError> {
        self.cells::<DoubleType>(cells)
    }

    fn text_lists(
        &mut self,
        cells: impl Iterator<Item = Option<Vec<Option<String>>>>,
    ) -> Result<(), ParquetError> {
        let of = |list: Vec<Option<String>>| {
            let of = |text: Option<String>| text.as_deref().map(bytes);
            list.into_iter().map(of).collect()
        };
        self.lists::<ByteArrayType>(cells.map(|cell| cell.map(of)))
    }

    fn cells<T: DataType>(
        &mut self,
        cells: impl Iterator<Item = Option<T::T>>,
    ) -> Result<(), ParquetError> {
        let (mut values, mut defined) = (Vec::new(), Vec::new());
        for cell in cells {
            defined.push(i16::from(cell.is_some()));
            values.extend(cell);
        }
        self.column::<T>(&values, &defined, None)
    }

    /// Definition levels: 0 no list, 1 an empty one, 2 an element without value, 3 a value.
    fn lists<T: DataType>(
        &mut self,
        cells: impl Iterator<Item = Option<Vec<Option<T::T>>>>,
    ) -> Result<(), ParquetError> {
        let (mut values, mut defined, mut repeated) = (Vec::new(), Vec::new(), Vec::new());
        for cell in cells {
            let list = match cell {
                Some(list) if !list.is_empty() => list,
                empty => {
                    defined.push(i16::from(empty.is_some()));
                    repeated.push(0);
                    continue;
                }
            };
            for (index, element) in list.into_iter().enumerate() {
                defined.push(2 + i16::from(element.is_some()));
                repeated.push(i16::from(index > 0));
                values.extend(element);
            }
        }
        self.column::<T>(&values, &defined, Some(&repeated))
    }

    fn column<T: DataType>(
        &mut self,
        values: &[T::T],
        defined: &[i16],
        repeated: Option<&[i16]>,
    ) -> Result<(), ParquetError> {
        let missing = || ParquetError::General("more columns than the schema has".to_owned());
        let mut column = self.0.next_column()?.ok_or_else(missing)?;
        let typed = column.typed::<T>();
        typed.write_batch(values, Some(defined), repeated)?;
        column.close()
    }
}
