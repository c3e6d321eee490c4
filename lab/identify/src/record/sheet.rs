//! Records from files that hold columns of numbers rather than text.

use super::error::{RecordError, NAME_LENGTH};
use super::header::Header;
use super::parquet_file::File;
use super::roles::{self, Roles};
use super::source::{Sheet, Source};
use super::{mat, Column, Options, Record};

/// The columns of a file by name.
pub(super) struct Columns {
    header: Header,
    stored: Stored,
}

enum Stored {
    Values(Vec<Vec<f64>>),
    Parquet(File),
}

pub(super) fn of_mat(bytes: &[u8]) -> Result<Columns, RecordError> {
    of_vectors(mat::read(bytes)?)
}

pub(super) fn of_mat_hdf5(bytes: &[u8]) -> Result<Columns, RecordError> {
    of_vectors(mat::read_hdf5(bytes)?)
}

fn of_vectors(vectors: Vec<mat::Vector>) -> Result<Columns, RecordError> {
    let (names, values): (Vec<_>, Vec<_>) = vectors
        .into_iter()
        .map(|own| ((own.name, own.unit, own.path), own.values))
        .unzip();
    Ok(Columns {
        header: Header::of(names)?,
        stored: Stored::Values(values),
    })
}

/// Columns in memory; the whole name of one is that in the header of a text.
pub(super) fn of_columns(columns: Vec<Column>) -> Result<Columns, RecordError> {
    let named = |column: Column| {
        let Column {
            name, unit, values, ..
        } = column;
        let whole = match &unit {
            Some(unit) => format!("{name} [{unit}]"),
            None => name.clone(),
        };
        ((name, unit, whole), values)
    };
    let (names, values): (Vec<_>, Vec<_>) = columns.into_iter().map(named).unzip();
    Ok(Columns {
        header: Header::of(names)?,
        stored: Stored::Values(values),
    })
}

pub(super) fn of_parquet(bytes: &[u8]) -> Result<Columns, RecordError> {
    let file = File::open(bytes)?;
    Ok(Columns {
        header: Header::of(file.names())?,
        stored: Stored::Parquet(file),
    })
}

/// The record of a file's columns; only those that have a part are read.
pub(super) fn record(file: Columns, options: &Options) -> Result<Record, RecordError> {
    if let Some(line) = options.header_line {
        return Err(RecordError::new(format!(
            "--header-line {line}: the file has no lines; its columns have names already"
        )));
    }
    if let Some(number) = options.segment {
        return Err(RecordError::new(format!(
            "--segment {number}: the file is not text and has no segments"
        )));
    }
    if !options.names.is_empty() {
        return Err(RecordError::new(
            "--names: the file is not text; its columns have names already",
        ));
    }
    let Columns {
        mut header,
        mut stored,
    } = file;
    let roles = roles::assign(&mut header, options)?;
    let mut columns = vec![Vec::new(); header.columns.len()];
    for index in roles.time.into_iter().chain(roles.read()) {
        if columns[index].is_empty() {
            columns[index] = match &mut stored {
                Stored::Values(all) => {
                    let own = std::mem::take(&mut all[index]);
                    own.into_iter().map(Some).collect()
                }
                Stored::Parquet(file) => file.read(index)?,
            };
        }
    }
    let rows = same_length(&header, &roles, &columns)?;
    let sheet = Sheet {
        columns,
        rows,
        done: 0,
    };
    super::record(&header, roles, Source::Sheet(sheet), options)
}

/// The length that all columns which are read have.
fn same_length(
    header: &Header,
    roles: &Roles,
    columns: &[Vec<Option<f64>>],
) -> Result<usize, RecordError> {
    let first = roles.time.unwrap_or(roles.input);
    let length = columns[first].len();
    match roles.read().find(|index| columns[*index].len() != length) {
        Some(other) => Err(RecordError::new(format!(
            "has {} values; it must have {length}, as `{}` does",
            columns[other].len(),
            super::error::shown(&header.columns[first].name, NAME_LENGTH)
        ))
        .on(&header.columns[other].name)),
        None => Ok(length),
    }
}
