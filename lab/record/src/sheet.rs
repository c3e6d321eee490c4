//! Records from files that contain columns instead of lines of text.

use super::error::{RecordError, NAME_LENGTH};
use super::header::Header;
use super::kind::Kind;
#[cfg(feature = "mat")]
use super::mat;
#[cfg(feature = "parquet")]
use super::parquet_file::File;
use super::roles::{self, Roles};
use super::scale::counted;
use super::source::{Sheet, Source};
use super::text::Rows;
use super::vectors::{vectors, Vector};
use super::{json, npz, Column, Options, Record};

/// The columns of a file by name.
pub(super) struct Columns {
    header: Header,
    /// Whether `--names` gave the names.
    is_given: bool,
    stored: Stored,
}

enum Stored {
    Values(Vec<Vec<f64>>),
    #[cfg(feature = "parquet")]
    Parquet(File),
}

/// The columns of a file that is neither text nor compressed.
pub(super) fn of(kind: Kind, bytes: &[u8], options: &Options) -> Result<Columns, RecordError> {
    match kind {
        Kind::Npz => of_vectors(vectors(npz::variables(bytes))?),
        Kind::Npy => Ok(Columns {
            is_given: !options.names.is_empty(),
            ..of_vectors(vectors(npz::lone(bytes, &options.names))?)?
        }),
        #[cfg(feature = "mat")]
        Kind::Mat => of_vectors(mat::read(bytes)?),
        #[cfg(feature = "mat")]
        Kind::MatHdf5 => of_vectors(mat::read_hdf5(bytes)?),
        #[cfg(feature = "parquet")]
        Kind::Parquet => {
            let file = File::open(bytes)?;
            Ok(Columns {
                header: Header::of(file.names())?,
                is_given: false,
                stored: Stored::Parquet(file),
            })
        }
        Kind::Gzip => Err(RecordError::new(
            "the file is compressed with gzip twice; unpack it once",
        )),
        #[allow(unreachable_patterns)]
        _ => Err(RecordError::new(
            "this build of bowden does not read this file format; save the file as CSV",
        )),
    }
}

fn of_vectors(vectors: Vec<Vector>) -> Result<Columns, RecordError> {
    let (names, values): (Vec<_>, Vec<_>) = vectors
        .into_iter()
        .map(|own| ((own.name, own.unit, own.path), own.values))
        .unzip();
    Ok(Columns {
        header: Header::of(names)?,
        is_given: false,
        stored: Stored::Values(values),
    })
}

/// Columns in memory. The whole name of a column has the form of a header cell in a text.
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
        is_given: false,
        stored: Stored::Values(values),
    })
}

impl Columns {
    /// The header and the values of all columns. Missing values are NaN.
    pub(super) fn all(self) -> (Header, Vec<Vec<f64>>) {
        // Without Parquet there is only one form.
        #[allow(clippy::infallible_destructuring_match)]
        let values = match self.stored {
            Stored::Values(all) => all,
            #[cfg(feature = "parquet")]
            Stored::Parquet(file) => (0..self.header.columns.len())
                .map(|index| {
                    let own = file.read(index).unwrap_or_default();
                    own.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect()
                })
                .collect(),
        };
        (self.header, values)
    }
}

/// Rejects options for the names of a text, because the columns of such a file have names, unless
/// `--names` gave the names.
fn without_lines(is_given: bool, options: &Options) -> Result<(), RecordError> {
    if let Some(line) = options.header_line {
        return Err(RecordError::new(format!(
            "--header-line {line}: the file has no lines, and its columns already have names"
        )));
    }
    if let Some(number) = options.segment {
        return Err(RecordError::new(format!(
            "--segment {number}: the file is not text, so it has no segments"
        )));
    }
    if !is_given && !options.names.is_empty() {
        return Err(RecordError::new(
            "--names: the file is not text, and its columns already have names",
        ));
    }
    Ok(())
}

/// The record of a table of JSON.
pub(super) fn of_json(text: &str, options: &Options) -> Result<Record, RecordError> {
    let table = json::read(text, &options.names)?;
    without_lines(table.is_given, options)?;
    let mut header = Header::of(table.names())?;
    let roles = roles::assign(&mut header, options)?;
    let rows = same_length(&header, &roles, &table.lengths())?;
    let used: Vec<usize> = roles.time.into_iter().chain(roles.read()).collect();
    let text = table.text(rows, &used);
    let rows = Source::Text(Box::new(Rows::separated_by(b';', &text)));
    let mut record = super::record(&header, roles, rows, options)?;
    record.notes.splice(0..0, table.notes);
    Ok(record)
}

/// The record of the columns of a file. Only columns with a role are read.
pub(super) fn record(file: Columns, options: &Options) -> Result<Record, RecordError> {
    let Columns {
        mut header,
        is_given,
        mut stored,
    } = file;
    without_lines(is_given, options)?;
    let roles = roles::assign(&mut header, options)?;
    let mut columns = vec![Vec::new(); header.columns.len()];
    for index in roles.time.into_iter().chain(roles.read()) {
        if columns[index].is_empty() {
            columns[index] = match &mut stored {
                Stored::Values(all) => {
                    let own = std::mem::take(&mut all[index]);
                    own.into_iter().map(Some).collect()
                }
                #[cfg(feature = "parquet")]
                Stored::Parquet(file) => file.read(index)?,
            };
        }
    }
    let lengths: Vec<usize> = columns.iter().map(Vec::len).collect();
    let rows = same_length(&header, &roles, &lengths)?;
    let sheet = Sheet {
        columns,
        rows,
        done: 0,
    };
    super::record(&header, roles, Source::Sheet(sheet), options)
}

/// The common length of all columns that are read.
fn same_length(header: &Header, roles: &Roles, lengths: &[usize]) -> Result<usize, RecordError> {
    let first = roles.time.unwrap_or(roles.input);
    let length = lengths[first];
    match roles.read().find(|index| lengths[*index] != length) {
        Some(other) => Err(RecordError::new(format!(
            "the column has {}, but it must have {length}, as `{}` does",
            counted(lengths[other], "value"),
            super::error::shown(&header.columns[first].name, NAME_LENGTH)
        ))
        .on(&header.columns[other].name)),
        None => Ok(length),
    }
}
