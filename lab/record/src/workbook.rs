//! Excel workbooks (`.xlsx`). A sheet becomes a text with one line per row, which is read like any
//! other text.
//!
//! Source: ECMA-376, *Office Open XML*, part 1, chapter 18. Numbers keep all their digits. A date
//! becomes `2026-03-01T14:03:21.250000`, and a time of day becomes `14:03:21.250000`. A duration
//! becomes its number of seconds. An error such as `#DIV/0!` becomes an empty cell.

use super::encoding::Decoded;
use super::error::{shown, RecordError, NAME_LENGTH};
use super::limits::{too_large, BYTES, COLUMNS};
use super::{header, layout, Options};
use book::{Book, Cell};
use std::borrow::Cow;

mod book;
mod styles;
mod xml;

/// The separator between cells.
const TAB: char = '\t';

/// A sheet as text.
pub(super) struct Sheet {
    text: String,
    /// A note on the selected sheet, if other sheets also contain tables.
    pub(super) note: Option<String>,
}

impl Sheet {
    pub(super) fn text(&self) -> Decoded<'_> {
        Decoded {
            text: Cow::Borrowed(self.text.trim_end_matches('\n')),
            note: None,
            is_ended: true,
        }
    }
}

/// The reason why a workbook cannot be read.
enum Failure {
    Damage(String),
    Refused(RecordError),
}

fn refused(message: impl Into<String>) -> Failure {
    Failure::Refused(RecordError::new(message))
}

fn damaged(what: impl Into<String>) -> Failure {
    Failure::Damage(what.into())
}

/// The sheet that the options request.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Sheet, RecordError> {
    chosen(bytes, options).map_err(|failure| match failure {
        Failure::Refused(error) => error,
        Failure::Damage(why) => {
            let why = shown(&why, 200);
            RecordError::new(format!("the workbook is damaged: {why}"))
        }
    })
}

fn chosen(bytes: &[u8], options: &Options) -> Result<Sheet, Failure> {
    let mut book = Book::open(bytes)?;
    let names: Vec<String> = book.sheets.iter().map(|sheet| sheet.name.clone()).collect();
    if let Some(name) = &options.sheet {
        let Some(index) = names.iter().position(|own| own == name) else {
            let near = header::nearest(name, names.iter().map(String::as_str));
            let name = shown(name, NAME_LENGTH);
            return Err(refused(format!(
                "--sheet {name}: the workbook has no such sheet{near}"
            )));
        };
        let text = text(&mut book, index)?;
        if text.trim().is_empty() {
            let name = shown(name, NAME_LENGTH);
            return Err(refused(format!("--sheet {name}: the sheet is empty")));
        }
        return Ok(Sheet { text, note: None });
    }
    // With the wanted columns, or else with any.
    let (mut tables, mut wanted): (Vec<(&str, String)>, _) = (Vec::new(), None);
    for (index, name) in names.iter().enumerate() {
        let text = text(&mut book, index)?;
        if layout::has_table(&text) {
            if wanted.is_none() && layout::find(&text, options).is_ok() {
                wanted = Some(tables.len());
            }
            // Only one of them is read.
            let is_read = tables.is_empty() || wanted == Some(tables.len());
            tables.push((name, if is_read { text } else { String::new() }));
        }
    }
    if tables.is_empty() {
        return Err(refused(
            "no sheet contains a table, which is two or more columns of numbers below their names",
        ));
    }
    let (name, text) = tables.swap_remove(wanted.unwrap_or(0));
    let others: Vec<String> = names
        .iter()
        .filter(|own| tables.iter().any(|(other, _)| other == own))
        .map(|own| format!("`{}`", shown(own, NAME_LENGTH)))
        .collect();
    let note = (!others.is_empty()).then(|| {
        let name = shown(name, NAME_LENGTH);
        format!(
            "sheet `{name}` read; --sheet selects another sheet with a table: {}",
            others.join(", ")
        )
    });
    Ok(Sheet { text, note })
}

/// The text of a sheet. All lines have the same number of cells.
fn text(book: &mut Book<'_>, sheet: usize) -> Result<String, Failure> {
    // The rows so far, and how many cells each has.
    let (mut lines, mut counts) = (String::new(), vec![0]);
    let name = shown(&book.sheets[sheet].name, NAME_LENGTH);
    book.cells(sheet, |Cell { row, column, text }| {
        if column >= COLUMNS {
            return Err(refused(format!(
                "row {} of sheet `{name}` has a cell in column {}, but a sheet may have at most {COLUMNS} columns",
                row + 1,
                column + 1
            )));
        }
        if row + 1 < counts.len() || row + 1 == counts.len() && column < counts[row] {
            return Err(damaged("its cells are not in order"));
        }
        while counts.len() <= row {
            lines.push('\n');
            counts.push(0);
        }
        let separators = column + usize::from(counts[row] > 0) - counts[row];
        lines.extend(std::iter::repeat_n(TAB, separators));
        lines.push_str(text);
        counts[row] = column + 1;
        if lines.len() as u64 > BYTES {
            return Err(Failure::Refused(too_large(" when unpacked")));
        }
        Ok(())
    })?;
    let width = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut padded = String::with_capacity(lines.len());
    for (line, count) in lines.split('\n').zip(counts) {
        padded.push_str(line);
        padded.extend(std::iter::repeat_n(TAB, width - count.max(1)));
        padded.push('\n');
    }
    Ok(padded)
}
