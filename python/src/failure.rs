//! Errors as `bowden.Error` in Python.

use bowden_lab::record::RecordError;
use pyo3::prelude::*;

pyo3::import_exception!(bowden._error, Error);

/// An error message in one line, which may begin with a file name.
pub fn plain(message: impl std::fmt::Display) -> PyErr {
    of(message.to_string(), None, None, None)
}

/// An error message about the file whose name begins the line.
pub fn in_one_of<'a>(files: impl IntoIterator<Item = &'a str>, message: String) -> PyErr {
    let named = files.into_iter().find(|file| {
        let rest = message.strip_prefix(*file);
        rest.is_some_and(|rest| rest.starts_with(": "))
    });
    let file = named.map(str::to_owned);
    of(message, file, None, None)
}

/// The error of a record, with its position.
pub fn of_record(error: &RecordError) -> PyErr {
    of(
        error.to_string(),
        Some(error.file().to_owned()),
        error.line(),
        error.column().map(str::to_owned),
    )
}

fn of(message: String, file: Option<String>, line: Option<usize>, column: Option<String>) -> PyErr {
    Error::new_err((message, file, line, column))
}
