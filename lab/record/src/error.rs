//! The one-line message for a bad record.

use std::fmt;

/// Why a record was rejected: ``FILE:LINE: column `NAME`: message``.
///
/// Line and column are omitted if the error has none, for example if the file is missing. The text
/// is always one line. Control characters in names, in the path or in the faulty cell are escaped,
/// and long texts are shortened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordError {
    file: String,
    line: Option<usize>,
    column: Option<String>,
    message: String,
    bad: Option<Bad>,
}

/// The reason why `--drop-bad` omits a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bad {
    /// A cell without a value.
    Empty,
    /// A NaN.
    NotANumber,
    /// The time stamp of the previous row.
    Repeated,
}

impl RecordError {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self {
            file: String::new(),
            line: None,
            column: None,
            message: message.into(),
            bad: None,
        }
    }

    /// An error at a line of the file. The line is 0 if the error does not belong to one line.
    pub(super) fn at(line: usize, message: impl Into<String>) -> Self {
        Self {
            line: (line > 0).then_some(line),
            ..Self::new(message)
        }
    }

    pub(super) fn on(self, column: &str) -> Self {
        Self {
            column: Some(column.to_owned()),
            ..self
        }
    }

    /// An error at the same position with another message.
    pub(super) fn but(self, message: String) -> Self {
        Self { message, ..self }
    }

    pub(super) fn from(self, bad: Bad) -> Self {
        Self {
            bad: Some(bad),
            ..self
        }
    }

    /// The reason for which `--drop-bad` would omit the row.
    pub(super) fn bad(&self) -> Option<Bad> {
        self.bad
    }

    pub(super) fn in_file(self, file: &str) -> Self {
        Self {
            file: file.to_owned(),
            ..self
        }
    }

    /// The path of the file as it was given, or the label.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Line in the file, counted from 1; in a binary file, the row.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The column's name.
    pub fn column(&self) -> Option<&str> {
        self.column.as_deref()
    }

    /// The message, without the location.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", shown(&self.file, usize::MAX))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(column) = &self.column {
            write!(f, ": column `{}`", shown(column, NAME_LENGTH))?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for RecordError {}

/// Maximum length of a name in messages. Longer names are shortened.
pub(super) const NAME_LENGTH: usize = 40;
/// Maximum length of a cell, and of a list of names, in messages. Longer cells and lists are
/// shortened.
pub(super) const SHOWN: usize = 24;

/// A list of names, and how many more there are.
pub(super) fn listed(names: &[String]) -> String {
    let list = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => list,
        more => format!("{list} and {more} more"),
    }
}

/// Text from a file, safe to print on one line of a terminal.
pub(super) fn shown(text: &str, limit: usize) -> String {
    let mut out = String::new();
    for (count, c) in text.chars().enumerate() {
        if count == limit {
            out.push('…');
            break;
        }
        // escape_debug escapes quotes too, which would only be in the way.
        if matches!(c, '"' | '\'' | '\\') {
            out.push(c);
        } else {
            out.extend(c.escape_debug());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_comes_first_and_the_line_stays_one_line() {
        let error = RecordError::at(7, "text")
            .on("a\nb\u{1b}[31m")
            .in_file("dir/x\n.csv");
        assert_eq!(
            error.to_string(),
            "dir/x\\n.csv:7: column `a\\nb\\u{1b}[31m`: text"
        );
    }

    #[test]
    fn long_text_is_cut() {
        assert_eq!(shown("abcdef", 3), "abc…");
        assert_eq!(shown("abc", 3), "abc");
    }
}
