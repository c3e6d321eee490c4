//! Rows of numbers from any kind of file.

use super::clock_time;
use super::error::RecordError;
use super::header::Header;
use super::layout::{is_comment, only_text};
use super::number;
use super::text::{self, Place};

/// The successive rows below the names.
pub(super) enum Source<'a> {
    Text(Box<text::Rows<'a>>),
    Sheet(Sheet),
}

/// The columns of a file that is not text. Columns that are not read stay empty.
pub(super) struct Sheet {
    pub(super) columns: Vec<Vec<Option<f64>>>,
    pub(super) rows: usize,
    /// Number of rows that were returned.
    pub(super) done: usize,
}

/// One row.
pub(super) enum Row<'a> {
    Text(text::Row<'a>),
    Sheet {
        columns: &'a [Vec<Option<f64>>],
        row: usize,
    },
}

impl Source<'_> {
    pub(super) fn read(&mut self) -> Result<Option<Row<'_>>, RecordError> {
        match self {
            Self::Text(rows) => Ok(rows.read()?.map(Row::Text)),
            Self::Sheet(sheet) => {
                let row = sheet.done;
                sheet.done += usize::from(row < sheet.rows);
                let columns = sheet.columns.as_slice();
                Ok((row < sheet.rows).then_some(Row::Sheet { columns, row }))
            }
        }
    }

    /// The line of the row that was read last.
    pub(super) fn line(&self) -> usize {
        match self {
            Self::Text(rows) => rows.line(),
            Self::Sheet(sheet) => sheet.done,
        }
    }

    /// Number of lines with only text after the last row; `None` if a row of numbers is among them.
    pub(super) fn text_below(&self, used: &[usize]) -> Option<usize> {
        let rows = match self {
            Self::Text(rows) if !rows.has_more() => rows,
            _ => return None,
        };
        let rest = rows.here();
        only_text(rest, rows.separator(), used).then(|| rest.split('\n').count())
    }

    /// Whether the file may end within the row that was read last.
    pub(super) fn may_be_cut(&self) -> bool {
        match self {
            Self::Text(rows) => rows.may_be_cut(),
            Self::Sheet(_) => false,
        }
    }

    /// Rejects ambiguous numbers.
    pub(super) fn check(&self, header: &Header) -> Result<(), RecordError> {
        match self {
            Self::Text(rows) => rows.notation().check(|index| &header.columns[index].name),
            Self::Sheet(_) => Ok(()),
        }
    }

    /// A note on the notation of the numbers.
    pub(super) fn note(&self) -> Option<String> {
        match self {
            Self::Text(rows) if rows.notation().is_comma() => {
                Some("decimal commas were read".to_owned())
            }
            _ => None,
        }
    }
}

impl Row<'_> {
    /// The line of the row, from 1, or its row number if the file has no lines.
    pub(super) fn line(&self) -> usize {
        match self {
            Self::Text(row) => row.line,
            Self::Sheet { row, .. } => row + 1,
        }
    }

    /// Whether the file may end within this row.
    pub(super) fn may_be_cut(&self) -> bool {
        matches!(self, Self::Text(row) if row.may_be_cut)
    }

    /// Whether the row is a line of text with a comment mark, or a row that the mark disables. A
    /// spreadsheet error next to a number is not a comment, and neither is a row of numbers after a
    /// name.
    pub(super) fn is_comment(&self, used: &[usize]) -> bool {
        let Self::Text(row) = self else {
            return false;
        };
        let first = row.cell(0);
        let is_marked = is_comment(first);
        let is_number = |index: usize| {
            let cell = row.cell(index);
            number::is_data(cell, b';') || clock_time::seconds(cell).is_some()
        };
        let is_error = || number::is_sheet_error(first) && (1..row.len()).any(is_number);
        let is_row = || !used.contains(&0) && used.iter().all(|index| is_number(*index));
        is_marked && row.last == row.line && !is_error() && !is_row()
    }

    /// The segment that begins with this row, unless it is the first segment.
    pub(super) fn opens(&self) -> Option<Place> {
        match self {
            Self::Text(row) => row.opens,
            Self::Sheet { .. } => None,
        }
    }

    /// Number of cells, or the number of columns if the file is not text.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Text(row) => row.len(),
            Self::Sheet { columns, .. } => columns.len(),
        }
    }

    /// The number in a column. `name` is the name of the column in an error.
    pub(super) fn number(&self, index: usize, name: &str) -> Result<f64, RecordError> {
        match self {
            Self::Text(row) => row.number(index, name),
            Self::Sheet { row, .. } => number::stored(self.stored(index), row + 1, name),
        }
    }

    fn stored(&self, index: usize) -> Option<f64> {
        match self {
            Self::Text(_) => None,
            Self::Sheet { columns, row } => columns.get(index)?.get(*row).copied().flatten(),
        }
    }

    /// The cell as text, if the file is text.
    pub(super) fn text(&self, index: usize) -> Option<&str> {
        match self {
            Self::Text(row) => Some(row.cell(index)),
            Self::Sheet { .. } => None,
        }
    }

    /// The cell for a message.
    pub(super) fn shown(&self, index: usize) -> String {
        match (self.text(index), self.stored(index)) {
            (Some(text), _) => text.to_owned(),
            (None, value) => value.map_or_else(String::new, |value| value.to_string()),
        }
    }
}
