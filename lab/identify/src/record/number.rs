//! One cell, one number.

use super::error::{shown, RecordError};

/// Beyond this a product of two values, or its square, would overflow.
pub(super) const LARGEST: f64 = 1e150;

const CELL_LENGTH: usize = 24;

/// The number in a cell.
pub(super) fn read(cell: &str, line: usize, column: &str) -> Result<f64, RecordError> {
    let refuse = |message: String| Err(RecordError::at(line, message).on(column));
    if cell.is_empty() {
        return refuse("the cell is empty, a number was expected".to_owned());
    }
    let number = cell.parse::<f64>();
    if let Some(value) = number.iter().find(|value| value.abs() <= LARGEST) {
        return Ok(*value);
    }
    let text = shown(cell, CELL_LENGTH);
    match number {
        Ok(value) if value.is_finite() => refuse(format!(
            "`{text}` is larger than {LARGEST:e}, a measured value was expected"
        )),
        Ok(_) => refuse(format!(
            "`{text}` is not finite, a finite number was expected"
        )),
        Err(_) if cell.replacen(',', ".", 1).parse::<f64>().is_ok() => refuse(format!(
            "`{text}` has a decimal comma, a decimal point was expected"
        )),
        Err(_) => refuse(format!("`{text}` is not a number")),
    }
}

/// Whether a cell of the header is a number rather than a name.
pub(super) fn is_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
        && cell.parse::<f64>().is_ok()
}
