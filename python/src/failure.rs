//! Errors as Python's `bowden.Error`.

use bowden_lab::record::RecordError;
use pyo3::prelude::*;

pyo3::import_exception!(bowden._error, Error);

/// One line that may begin with a file's name.
pub fn plain(message: impl std::fmt::Display) -> PyErr {
    of(message.to_string(), None, None, None)
}

/// One line about one of these files: the file whose name begins the line.
pub fn in_one_of<'a>(files: impl IntoIterator<Item = &'a str>, message: String) -> PyErr {
    let named = files.into_iter().find(|file| {
        let rest = message.strip_prefix(*file);
        rest.is_some_and(|rest| rest.starts_with(": "))
    });
    let file = named.map(str::to_owned);
    of(message, file, None, None)
}

/// The refusal of a record, with its place.
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
