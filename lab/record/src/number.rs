//! The number in a cell.

use super::error::{shown, Bad, RecordError, SHOWN};
use super::thousands::Thousands;
use std::cell::{Cell, RefCell};

/// Largest magnitude for which a product of two values, and its square, do not overflow.
pub(super) const LARGEST: f64 = 1e150;

/// The decimal sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Point,
    Comma,
}

/// The decimal sign of a file: a point or a comma, never both.
///
/// The first cell with one of the two signs decides. A comma can be part of a number only if it
/// does not separate cells. A file that mixes both signs is rejected at the first cell with the
/// other sign. A column whose commas may separate thousands is also rejected.
pub(super) struct Notation {
    comma_possible: bool,
    sign: Cell<Option<Sign>>,
    /// The line with the first decimal sign.
    decided: Cell<usize>,
    thousands: RefCell<Thousands>,
}

impl Notation {
    pub(super) fn new(separator: u8) -> Self {
        Self {
            comma_possible: separator != b',',
            sign: Cell::new(None),
            decided: Cell::new(0),
            thousands: RefCell::default(),
        }
    }

    /// Whether the numbers are known to have a decimal comma.
    pub(super) fn is_comma(&self) -> bool {
        self.sign.get() == Some(Sign::Comma)
    }

    /// The number in a cell of the column `index`.
    pub(super) fn read_in(
        &self,
        index: usize,
        cell: &str,
        line: usize,
        column: &str,
    ) -> Result<f64, RecordError> {
        let value = self.read(cell, line, column)?;
        if self.comma_possible && self.sign.get() != Some(Sign::Point) {
            self.thousands.borrow_mut().see(index, cell, line);
        }
        Ok(value)
    }

    /// Rejects commas that may separate thousands. `name` returns the name of a column.
    pub(super) fn check<'n>(&self, name: impl Fn(usize) -> &'n str) -> Result<(), RecordError> {
        match self.is_comma() {
            true => self.thousands.borrow().check(name),
            false => Ok(()),
        }
    }

    fn read(&self, cell: &str, line: usize, column: &str) -> Result<f64, RecordError> {
        let parsed = match self.sign.get() {
            Some(Sign::Point) => cell.parse::<f64>().ok(),
            Some(Sign::Comma) if cell.contains('.') => {
                return self.mixed(cell, line, column);
            }
            Some(Sign::Comma) => with_comma(cell),
            None => self.decide(cell, line),
        };
        if let Some(value) = parsed.filter(|value| value.abs() <= LARGEST) {
            return Ok(value);
        }
        refuse(cell, parsed, line, column)
    }

    fn decide(&self, cell: &str, line: usize) -> Option<f64> {
        let (sign, value) = match (cell.contains('.'), cell.contains(',')) {
            (false, true) if self.comma_possible => (Sign::Comma, with_comma(cell)?),
            (true, false) => (Sign::Point, cell.parse().ok()?),
            _ => return cell.parse().ok(),
        };
        self.sign.set(Some(sign));
        self.decided.set(line);
        Some(value)
    }

    fn mixed(&self, cell: &str, line: usize, column: &str) -> Result<f64, RecordError> {
        let text = shown(cell, SHOWN);
        let message = match cell.parse::<f64>() {
            Ok(_) => format!(
                "`{text}` has a decimal point; write a decimal comma, as in line {}",
                self.decided.get()
            ),
            Err(_) => no_number(cell),
        };
        Err(RecordError::at(line, message).on(column))
    }
}

/// A number with at most one comma, which is its decimal sign.
fn with_comma(cell: &str) -> Option<f64> {
    match cell.contains(',') {
        true => cell.replacen(',', ".", 1).parse().ok(),
        false => cell.parse().ok(),
    }
}

/// The error for a cell that is not a measured number.
fn refuse(cell: &str, parsed: Option<f64>, line: usize, column: &str) -> Result<f64, RecordError> {
    let refuse = |message: String| Err(RecordError::at(line, message).on(column));
    if cell.is_empty() {
        let message = "the cell is empty, but it must be a number; --drop-bad drops such rows";
        return Err(RecordError::at(line, message).on(column).from(Bad::Empty));
    }
    let text = shown(cell, SHOWN);
    match parsed {
        Some(value) if value.is_nan() => Err(RecordError::at(line, not_finite(&text))
            .on(column)
            .from(Bad::NotANumber)),
        Some(value) => measured(value, &text, line, column),
        None if cell.replacen(',', ".", 1).parse::<f64>().is_ok() => refuse(format!(
            "`{text}` has a decimal comma; write a decimal point"
        )),
        None => refuse(no_number(cell)),
    }
}

/// Whether a cell is a spreadsheet error, such as `#N/A` or `#VALUE!`, in any language.
pub(super) fn is_sheet_error(cell: &str) -> bool {
    cell.strip_prefix('#').is_some_and(|own| {
        own.starts_with(char::is_alphabetic) && !own.contains(char::is_whitespace)
    })
}

/// Texts that instruments and spreadsheets write instead of a number, in capitals.
const MARKS: [&str; 21] = [
    "OVL",
    "OL",
    "O.L",
    "OVLD",
    "OVR",
    "OVER",
    "OVF",
    "OVFL",
    "OVERLOAD",
    "OVERFLOW",
    "OVERRANGE",
    "OPEN",
    "ERR",
    "ERROR",
    "NULL",
    "NONE",
    "NA",
    "N/A",
    "-",
    "--",
    "---",
];

/// The message for a cell that is not a number, with the required form if it can be determined.
fn no_number(cell: &str) -> String {
    let text = shown(cell, SHOWN);
    let upper = cell.to_uppercase();
    let is_mark = is_sheet_error(cell) || MARKS.contains(&upper.trim_start_matches('+'));
    if is_mark || MARKS.contains(&upper.trim_start_matches('-')) {
        return format!(
            "`{text}` is a placeholder, not a number; clear the cell, and use --drop-bad to drop the row"
        );
    }
    match has_thousands(cell) {
        true => format!(
            "`{text}` is not a number, because bowden does not read thousands separators; remove the separators"
        ),
        false => format!("`{text}` is not a number"),
    }
}

/// Whether a cell is a number with digits in groups of three.
fn has_thousands(cell: &str) -> bool {
    let own = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    let Some(separator) = own.chars().find(|c| !c.is_ascii_digit()) else {
        return false;
    };
    let decimal = own.rfind(|c: char| ".,".contains(c) && c != separator);
    let (whole, decimals) = own.split_at(decimal.unwrap_or(own.len()));
    let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let mut groups = whole.split(separator);
    let first = groups.next().unwrap_or_default();
    let mut groups = groups.peekable();
    ['.', ',', ' ', '\'', '’', '\u{a0}', '\u{202f}'].contains(&separator)
        && (1..=3).contains(&first.len())
        && is_digits(first)
        && groups.peek().is_some()
        && groups.all(|group| group.len() == 3 && is_digits(group))
        && is_digits(decimals.get(1..).unwrap_or_default())
}

fn not_finite(text: &str) -> String {
    format!("`{text}` is not a finite number; --drop-bad drops such rows")
}

fn measured(value: f64, text: &str, line: usize, column: &str) -> Result<f64, RecordError> {
    let message = match value {
        value if value.abs() <= LARGEST => return Ok(value),
        value if value.is_finite() => {
            format!("`{text}` is larger than {LARGEST:e}, the largest allowed value")
        }
        _ => format!("`{text}` is not a finite number"),
    };
    Err(RecordError::at(line, message).on(column))
}

/// A value that is stored as a number; `None` means that the file has no value.
pub(super) fn stored(value: Option<f64>, row: usize, column: &str) -> Result<f64, RecordError> {
    match value {
        None => refuse("", None, row, column),
        Some(value) if value.is_nan() => refuse("NaN", Some(value), row, column),
        Some(value) => measured(value, &value.to_string(), row, column),
    }
}

/// Whether a cell contains a number with either decimal sign, or `NaN`.
pub(super) fn is_data(cell: &str, separator: u8) -> bool {
    cell.parse::<f64>().is_ok() || (separator != b',' && with_comma(cell).is_some())
}

/// Whether a cell of the header is a number rather than a name.
pub(super) fn is_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) && is_data(cell, b';')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(separator: u8, cells: &[&str]) -> Result<Vec<f64>, String> {
        let notation = Notation::new(separator);
        let read = |(i, cell): (usize, &&str)| notation.read(cell, i + 2, "x");
        let all: Result<Vec<_>, _> = cells.iter().enumerate().map(read).collect();
        all.map_err(|e| e.to_string())
    }

    #[test]
    fn the_first_decimal_sign_decides_and_the_other_is_refused() {
        assert_eq!(
            all(b';', &["0", "-1,5", "2", "1,5e-3"]),
            Ok(vec![0.0, -1.5, 2.0, 1.5e-3])
        );
        assert_eq!(all(b'\t', &[",5", "1,"]), Ok(vec![0.5, 1.0]));
        assert_eq!(
            all(b';', &["0", "1,5", "1.5"]).unwrap_err(),
            ":4: column `x`: `1.5` has a decimal point; write a decimal comma, as in line 3"
        );
        assert_eq!(
            all(b';', &["0.5", "1,5"]).unwrap_err(),
            ":3: column `x`: `1,5` has a decimal comma; write a decimal point"
        );
        // In quotes, of a file whose cells commas separate: thousands or decimals, who knows.
        assert_eq!(
            all(b',', &["1,5"]).unwrap_err(),
            ":2: column `x`: `1,5` has a decimal comma; write a decimal point"
        );
    }

    #[test]
    fn thousands_are_not_taken_for_decimals() {
        for cells in [&["1.234,5"][..], &["1,234,567"], &["0,5", "1.234,5"]] {
            let line = all(b';', cells).unwrap_err();
            assert!(line.contains("is not a number"), "{line}");
        }
    }
}
