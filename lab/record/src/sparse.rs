//! Channels of a slower sensor with numbers in only a few rows (a temperature once per second in a
//! 500 Hz log), and sensors with separate time stamps in one table.
//!
//! A channel with a number in fewer than half of the rows is interpolated linearly between its
//! readings. In other channels, and in the input and the output, a missing number is an error of
//! the record. There is one exception. If most readings of input and output are in different rows,
//! or if one of the two has few readings, all columns are interpolated.

use super::error::{Bad, RecordError};
use super::header::Header;
use super::roles::Roles;
use super::Options;

/// Cells without a number, in the order of reading.
#[derive(Default)]
pub(super) struct Lacking {
    /// Index among the rows that were kept, column of the table, and reason.
    cells: Vec<(usize, usize, Bad)>,
    /// The first error of each column, in the order of the rows.
    first: Vec<(usize, RecordError)>,
    /// Rows with the time stamp of the previous row, if `--drop-bad` omits such rows.
    pub(super) repeats: Vec<usize>,
}

/// The treatment of the rows without these cells.
pub(super) struct Mended {
    /// Rows that `--drop-bad` omits, in ascending order.
    pub(super) out: Vec<(usize, Bad)>,
    /// Columns of the table to fill.
    pub(super) filled: Vec<usize>,
    /// Whether input and output have separate time stamps.
    pub(super) is_apart: bool,
}

impl Lacking {
    pub(super) fn add(&mut self, row: usize, column: usize, bad: Bad, error: RecordError) {
        self.cells.push((row, column, bad));
        if self.first.iter().all(|(known, _)| *known != column) {
            self.first.push((column, error));
        }
    }

    /// The columns with a number in fewer than half of this number of rows.
    fn sparse(&self, rows: usize) -> Vec<usize> {
        let mut lack = vec![0_usize; self.first.iter().map(|(k, _)| k + 1).max().unwrap_or(0)];
        for (_, column, _) in &self.cells {
            lack[*column] += 1;
        }
        // Input and output are no channels.
        (2..lack.len()).filter(|&k| 2 * lack[k] > rows).collect()
    }

    /// The rows, among the given number, in which a column has a number.
    fn readings(&self, column: usize, rows: usize) -> Vec<usize> {
        let mut has = vec![true; rows];
        let own = self.cells.iter().filter(|(_, k, _)| *k == column);
        own.for_each(|(row, ..)| has[*row] = false);
        (0..rows).filter(|row| has[*row]).collect()
    }

    /// Whether most readings of input and output are in different rows, or one of the two has a
    /// number in fewer than half of the rows. `--drop-bad` omits the rows without such a number.
    fn is_apart(&self, rows: usize, drop_bad: bool) -> bool {
        if self.first.iter().all(|(column, _)| *column >= 2) {
            return false;
        }
        let [input, output] = [0, 1].map(|column| self.readings(column, rows));
        let is_together = |row: &&usize| output.binary_search(row).is_ok();
        let together = input.iter().filter(is_together).count();
        let fewest = input.len().min(output.len());
        2 * together < fewest || !drop_bad && 2 * fewest < rows && together > 0
    }

    /// The first empty cell of a column that is not sparse, among the given number of rows.
    pub(super) fn fault(&self, rows: usize) -> Option<RecordError> {
        if self.is_apart(rows, false) {
            return None;
        }
        let sparse = self.sparse(rows);
        let mut own = self.first.iter().filter(|(k, _)| !sparse.contains(k));
        own.next().map(|(_, error)| error.clone())
    }

    /// Determines the sparse channels. A missing number in another channel is an error, or its row
    /// is omitted.
    pub(super) fn mended(
        &self,
        rows: usize,
        has_own_stamps: bool,
        drop_bad: bool,
    ) -> Result<Mended, RecordError> {
        if (has_own_stamps || !drop_bad) && self.is_apart(rows, drop_bad) {
            let mut filled: Vec<usize> = self.first.iter().map(|(k, _)| *k).collect();
            filled.sort_unstable();
            return Ok(Mended {
                out: Vec::new(),
                filled,
                is_apart: true,
            });
        }
        if let Some(error) = self.fault(rows).filter(|_| !drop_bad) {
            return Err(error);
        }
        let filled = self.sparse(rows);
        let others = self.cells.iter().filter(|(_, k, _)| !filled.contains(k));
        let repeats = self.repeats.iter().map(|row| (*row, Bad::Repeated));
        let others = others.map(|(row, _, bad)| (*row, *bad));
        let mut out: Vec<(usize, Bad)> = repeats.chain(others).collect();
        out.sort_by_key(|(row, _)| *row);
        out.dedup_by_key(|(row, _)| *row);
        Ok(Mended {
            out,
            filled,
            is_apart: false,
        })
    }
}

/// Interpolates sparse columns linearly between their readings, and returns notes. A column without
/// a reading keeps its NaN if no option requests the column.
pub(super) fn fill(
    columns: &[usize],
    values: &mut [Vec<f64>],
    at: &[f64],
    header: &Header,
    roles: &Roles,
    options: &Options,
) -> Result<Vec<String>, RecordError> {
    let mut said = Vec::new();
    for &column in columns {
        let readings = line(&mut values[column], at);
        // Parts of a sum come after the channels: the sum speaks for them.
        let Some((name, series)) = column.checked_sub(2).and_then(|k| roles.channels.get(k)) else {
            continue;
        };
        let own = &header.columns[series.first()].name;
        let asked = options.channels.iter().any(|(other, _)| other == name);
        said.push(match readings {
            0 if asked => {
                let message = "there is no number in any row of the record";
                return Err(RecordError::at(header.line, message).on(own));
            }
            0 => format!("`{own}` has no number in any row and was excluded"),
            _ => {
                let (all, span) = (
                    at.len(),
                    at.last().unwrap_or(&0.0) - at.first().unwrap_or(&0.0),
                );
                let what = match readings {
                    1 => "its single reading was used for all samples".to_owned(),
                    _ => format!(
                        "its {readings} readings, one every {:.3} s, were interpolated linearly",
                        span / readings as f64
                    ),
                };
                format!(
                    "`{own}` has no number in {} of {all} rows; {what}",
                    all - readings
                )
            }
        });
    }
    Ok(said)
}

/// Whether a column was left without any number.
pub(super) fn is_empty(values: &[f64]) -> bool {
    values.first().is_some_and(|value| value.is_nan())
}

/// Replaces NaN by linear interpolation between the neighbouring numbers, and at the ends by the
/// nearest number. Returns the number of readings.
fn line(values: &mut [f64], at: &[f64]) -> usize {
    let readings: Vec<usize> = (0..values.len()).filter(|&i| !values[i].is_nan()).collect();
    let (Some(&first), Some(&last)) = (readings.first(), readings.last()) else {
        return 0;
    };
    let (start, end) = (values[first], values[last]);
    values[..first].fill(start);
    values[last..].fill(end);
    for pair in readings.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let width = at[b] - at[a];
        let slope = match width > 0.0 {
            true => (values[b] - values[a]) / width,
            false => 0.0,
        };
        for i in a + 1..b {
            values[i] = values[a] + slope * (at[i] - at[a]);
        }
    }
    readings.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_through_the_readings_and_stays_level_outside() {
        let nan = f64::NAN;
        let mut values = [nan, 2.0, nan, nan, 8.0, nan];
        let at = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(line(&mut values, &at), 2);
        assert_eq!(values, [2.0, 2.0, 4.0, 6.0, 8.0, 8.0]);
        assert_eq!(line(&mut [nan; 3], &at), 0);
    }
}
