//! Commas that may separate thousands.
//!
//! A program that writes decimals writes the same number of decimals in every cell (`900,000`), or
//! as few as the number needs (`1,2`). A program that groups digits writes `900` and `1,197`. A
//! column is rejected as ambiguous under two conditions. Every comma has one to three digits before
//! it and three digits after it, and the column also has whole numbers of at most three digits.

use super::error::{shown, RecordError, SHOWN};

/// A cell and its line.
type Place = (usize, String);

/// The evidence from the cells of one column.
#[derive(Clone, Default)]
struct Column {
    /// Whether a cell cannot contain grouped digits, so that the commas are decimal signs.
    decimal: bool,
    /// The first cell like `1,197`.
    grouped: Option<Place>,
    /// The first whole number of at most three digits without a comma.
    whole: Option<Place>,
}

/// The evidence from the cells of a file, column by column.
#[derive(Default)]
pub(super) struct Thousands {
    columns: Vec<Column>,
}

impl Thousands {
    /// Adds the evidence from a cell that contains a number.
    pub(super) fn see(&mut self, index: usize, cell: &str, line: usize) {
        if self.columns.len() <= index {
            self.columns.resize(index + 1, Column::default());
        }
        let column = &mut self.columns[index];
        if column.decimal || (column.grouped.is_some() && column.whole.is_some()) {
            // Only a cell that decides is still of interest.
            column.decimal |= decides(cell);
        } else if decides(cell) {
            column.decimal = true;
        } else if cell.contains(',') {
            column
                .grouped
                .get_or_insert_with(|| (line, cell.to_owned()));
        } else if digits(cell).is_some() {
            column.whole.get_or_insert_with(|| (line, cell.to_owned()));
        }
    }

    /// Rejects the first ambiguous cell. `name` returns the name of a column.
    pub(super) fn check<'n>(&self, name: impl Fn(usize) -> &'n str) -> Result<(), RecordError> {
        let open = self.columns.iter().enumerate().filter_map(|(index, own)| {
            let pair = own.grouped.as_ref().zip(own.whole.as_ref());
            pair.filter(|_| !own.decimal).map(|pair| (index, pair))
        });
        let first = open.min_by_key(|(index, ((line, _), _))| (*line, *index));
        let Some((index, ((line, grouped), (whole_line, whole)))) = first else {
            return Ok(());
        };
        let number = grouped.trim_start_matches('+');
        let message = format!(
            "`{}` may mean {} or {}, because `{}` in line {whole_line} has no comma; write thousands without a separator, or the same number of decimals in every cell",
            shown(grouped, SHOWN),
            number.replace(',', "."),
            number.replace(',', ""),
            shown(whole, SHOWN),
        );
        Err(RecordError::at(*line, message).on(name(index)))
    }
}

/// The number of digits of a cell that contains only digits, possibly after a sign.
fn digits(cell: &str) -> Option<usize> {
    let own = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    (!own.is_empty() && own.bytes().all(|b| b.is_ascii_digit())).then_some(own.len())
}

/// Whether a cell shows that commas do not group the digits of its column. The number of decimals
/// is then not three, the digits before the comma are more than three or start with zero, or four
/// or more digits have no comma.
fn decides(cell: &str) -> bool {
    match cell.split_once(',') {
        None => digits(cell).is_some_and(|count| count > 3),
        Some((before, behind)) => {
            let leading = before.strip_prefix(['+', '-']).unwrap_or(before);
            let group = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
            !((1..=3).contains(&leading.len())
                && group(leading)
                && !leading.starts_with('0')
                && behind.len() == 3
                && group(behind))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(cells: &[&str]) -> Result<(), String> {
        let mut thousands = Thousands::default();
        for (i, cell) in cells.iter().enumerate() {
            thousands.see(2, cell, i + 2);
        }
        thousands.check(|_| "f").map_err(|e| e.to_string())
    }

    #[test]
    fn what_may_be_thousands_or_decimals_is_refused() {
        for cells in [
            &["900", "1,197", "1,203"][..],
            &["-1,197", "-900", "12,500"],
            &["0", "1,000", "2,000"],
            &["999,999", "5"],
        ] {
            let line = check(cells).unwrap_err();
            assert!(line.contains("column `f`: `"), "{cells:?}: {line}");
        }
        assert_eq!(
            check(&["900", "1,197"]).unwrap_err(),
            ":3: column `f`: `1,197` may mean 1.197 or 1197, because `900` in line 2 has no comma; \
             write thousands without a separator, or the same number of decimals in every cell"
        );
    }

    #[test]
    fn one_cell_that_grouped_digits_do_not_have_decides_for_decimals() {
        for decided in [
            "0,197",
            "1,19",
            "1,1970",
            "1,197e2",
            "1197",
            "-1234,567",
            "01,197",
        ] {
            assert_eq!(check(&["900", "1,197", decided]), Ok(()), "{decided}");
            assert_eq!(check(&[decided, "900", "1,197"]), Ok(()), "{decided}");
        }
        assert_eq!(check(&["900,000", "1,197", "12,500"]), Ok(()));
        assert_eq!(check(&["900", "12", "0"]), Ok(()));
    }
}
