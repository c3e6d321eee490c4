//! Excel workbooks (`.xlsx`): a sheet becomes a text, one line per row, that is read like any other.
//!
//! The crate `calamine` reads the cells. Numbers keep all their digits. A date becomes
//! `2026-03-01T14:03:21.250000`, a time of day `14:03:21.250000` and a duration its seconds. An
//! error such as `#DIV/0!` becomes an empty cell.

use super::encoding::Decoded;
use super::error::{shown, RecordError, NAME_LENGTH};
use super::limits::{too_large, BYTES, COLUMNS};
use super::{header, layout, npz, Options};
use calamine::{DataRef, ExcelDateTime, ExcelDateTimeType, Reader, SheetType, Xlsx, XlsxError};
use std::borrow::Cow;
use std::fmt::Write;
use std::io::Cursor;
use std::panic::{catch_unwind, AssertUnwindSafe};

/// The separator between cells.
const TAB: char = '\t';

/// A sheet as text.
pub(super) struct Sheet {
    text: String,
    /// Which sheet it is, if others have tables too.
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

/// The sheet that the options request.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Sheet, RecordError> {
    let refuse =
        |why: &str| RecordError::new(format!("the workbook is damaged: {}", shown(why, 200)));
    let size = npz::unpacked_size(bytes).map_err(RecordError::new)?;
    if size > BYTES {
        return Err(too_large(" when unpacked"));
    }
    match catch_unwind(AssertUnwindSafe(|| chosen(bytes, options))) {
        Ok(Ok(sheet)) => Ok(sheet),
        Ok(Err(Failure::Damage(why))) => Err(refuse(&why)),
        Ok(Err(Failure::Refused(error))) => Err(error),
        Err(_) => Err(refuse("it cannot be decoded")),
    }
}

/// Why there is no sheet.
enum Failure {
    Damage(String),
    Refused(RecordError),
}

impl From<XlsxError> for Failure {
    fn from(error: XlsxError) -> Self {
        Self::Damage(error.to_string())
    }
}

fn refused(message: impl Into<String>) -> Failure {
    Failure::Refused(RecordError::new(message))
}

fn chosen(bytes: &[u8], options: &Options) -> Result<Sheet, Failure> {
    let mut book = Xlsx::new(Cursor::new(bytes))?;
    let sheets = book.sheets_metadata().iter();
    let sheets = sheets.filter(|sheet| sheet.typ == SheetType::WorkSheet);
    let names: Vec<String> = sheets.map(|sheet| sheet.name.clone()).collect();
    if let Some(name) = &options.sheet {
        if !names.contains(name) {
            let near = header::nearest(name, names.iter().map(String::as_str));
            let name = shown(name, NAME_LENGTH);
            return Err(refused(format!(
                "--sheet {name}: the workbook has no such sheet{near}"
            )));
        }
        let text = text(&mut book, name)?;
        if text.trim().is_empty() {
            let name = shown(name, NAME_LENGTH);
            return Err(refused(format!("--sheet {name}: the sheet is empty")));
        }
        return Ok(Sheet { text, note: None });
    }
    // With the wanted columns, or else with any.
    let (mut tables, mut wanted): (Vec<(&str, String)>, _) = (Vec::new(), None);
    for name in &names {
        let text = text(&mut book, name)?;
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

/// The text of a sheet; every line has as many cells as the longest.
fn text(book: &mut Xlsx<Cursor<&[u8]>>, name: &str) -> Result<String, Failure> {
    let is_1904 = book.has_1904_epoch();
    let mut cells = book.worksheet_cells_reader(name)?;
    // The rows so far, and how many cells each has.
    let (mut lines, mut counts) = (String::new(), vec![0]);
    while let Some(cell) = cells.next_cell()? {
        let value = written(cell.get_value(), is_1904);
        if value.is_empty() {
            continue;
        }
        let (row, column) = cell.get_position();
        let (row, column) = (row as usize, column as usize);
        if column >= COLUMNS {
            return Err(refused(format!(
                "row {} of sheet `{}` has a cell in column {}, but a sheet may have at most {COLUMNS} columns",
                row + 1,
                shown(name, NAME_LENGTH),
                column + 1
            )));
        }
        if row + 1 < counts.len() || row + 1 == counts.len() && column < counts[row] {
            return Err(Failure::Damage("its cells are not in order".to_owned()));
        }
        while counts.len() <= row {
            lines.push('\n');
            counts.push(0);
        }
        let separators = column + usize::from(counts[row] > 0) - counts[row];
        lines.extend(std::iter::repeat_n(TAB, separators));
        lines.push_str(&value);
        counts[row] = column + 1;
        if lines.len() as u64 > BYTES {
            return Err(Failure::Refused(too_large(" when unpacked")));
        }
    }
    let width = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut padded = String::with_capacity(lines.len());
    for (line, count) in lines.split('\n').zip(counts) {
        padded.push_str(line);
        padded.extend(std::iter::repeat_n(TAB, width - count.max(1)));
        padded.push('\n');
    }
    Ok(padded)
}

/// A cell as a text without tabs and line ends.
fn written(value: &DataRef<'_>, is_1904: bool) -> String {
    let plain = |text: &str| {
        let text = text.replace(char::is_control, " ").replace('"', "'");
        text.trim().to_owned()
    };
    match value {
        DataRef::Int(number) => number.to_string(),
        DataRef::Float(number) => number.to_string(),
        DataRef::Bool(is) => u8::from(*is).to_string(),
        DataRef::String(text) | DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => {
            plain(text)
        }
        DataRef::SharedString(text) => plain(text),
        DataRef::DateTime(stamp) => stamp_of(stamp, is_1904),
        DataRef::Error(_) | DataRef::Empty => String::new(),
    }
}

/// A time stamp to the microsecond, which is the resolution of days in a double; days count from
/// 1900 or 1904.
fn stamp_of(stamp: &ExcelDateTime, is_1904: bool) -> String {
    let day = 86_400_000_000.0;
    let whole = (stamp.as_f64() * day).round();
    if stamp.is_duration() {
        return (whole / 1e6).to_string();
    }
    let days = (whole / day).floor();
    let mut text = String::new();
    if days >= 1.0 {
        // Of the crate only the calendar, because its times have milliseconds.
        let midnight = ExcelDateTime::new(days, ExcelDateTimeType::DateTime, is_1904);
        let (year, month, day, ..) = midnight.to_ymd_hms_milli();
        let _ = write!(text, "{year:04}-{month:02}-{day:02}T");
    }
    let micros = (whole - days * day) as u64;
    let seconds = micros / 1_000_000;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let _ = write!(
        text,
        "{hours:02}:{minutes:02}:{:02}.{:06}",
        seconds % 60,
        micros % 1_000_000
    );
    text
}
