//! The rows of the file that the record keeps.

use super::error::{shown, NAME_LENGTH};
use super::header::Header;
use super::roles::Roles;

/// Times, values and lines.
pub(super) struct Kept {
    pub(super) time: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
    pub(super) lines: Vec<usize>,
}

impl Kept {
    pub(super) fn new(columns: usize) -> Self {
        Self {
            time: Vec::new(),
            values: vec![Vec::new(); columns],
            lines: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, time: f64, line: usize, sample: &[f64]) {
        self.time.push(time);
        self.lines.push(line);
        for (values, value) in self.values.iter_mut().zip(sample) {
            values.push(*value);
        }
    }

    /// Whether the time stamps of the input are unique, and so are the time stamps of the output.
    pub(super) fn has_own_stamps(&self) -> bool {
        self.values.iter().take(2).all(|values| {
            let own = values
                .iter()
                .zip(&self.time)
                .filter(|(value, _)| !value.is_nan());
            let own: Vec<f64> = own.map(|(_, t)| *t).collect();
            own.windows(2).all(|pair| pair[0] < pair[1])
        })
    }

    /// The rows in which the column of the input or output has a number.
    pub(super) fn readings(&self, end: usize) -> Vec<usize> {
        let values = self.values[end].iter().enumerate();
        let numbers = values.filter(|(_, value)| !value.is_nan());
        numbers.map(|(row, _)| row).collect()
    }

    /// Sorts the rows by their time stamps.
    pub(super) fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.time.len()).collect();
        order.sort_by(|a, b| self.time[*a].total_cmp(&self.time[*b]));
        let sorted = |own: &[f64]| -> Vec<f64> { order.iter().map(|row| own[*row]).collect() };
        for own in self.values.iter_mut().chain([&mut self.time]) {
            *own = sorted(own);
        }
        self.lines = order.iter().map(|row| self.lines[*row]).collect();
    }

    /// Removes these rows, which are in ascending order.
    pub(super) fn leave_out(&mut self, rows: impl Iterator<Item = usize>) {
        let mut out = rows.peekable();
        let stays = |row: usize| out.next_if_eq(&row).is_none();
        let stays: Vec<bool> = (0..self.time.len()).map(stays).collect();
        self.leave(&stays);
    }

    /// Keeps the rows that stay.
    fn leave(&mut self, stays: &[bool]) {
        only(&mut self.time, stays);
        only(&mut self.lines, stays);
        self.values.iter_mut().for_each(|own| only(own, stays));
    }

    /// Keeps the rows with a reading of the input or the output, whichever has fewer readings,
    /// within the time in which both have readings. Returns a note.
    pub(super) fn on_one_grid(
        &mut self,
        [input, output]: &[Vec<usize>; 2],
        header: &Header,
        roles: &Roles,
    ) -> String {
        let is_input = input.len() < output.len();
        let (grid, other) = match is_input {
            true => (input, output),
            false => (output, input),
        };
        let span = other.first().zip(other.last());
        let inside = |row: &&usize| span.is_some_and(|(first, last)| (first..=last).contains(row));
        let mut stays = vec![false; self.time.len()];
        grid.iter()
            .filter(inside)
            .for_each(|row| stays[*row] = true);
        self.leave(&stays);
        let name = |index: usize| shown(&header.columns[index].name, NAME_LENGTH);
        let (own, moved) = match is_input {
            true => (name(roles.input), name(roles.output)),
            false => (name(roles.output), name(roles.input)),
        };
        format!(
            "`{own}` and `{moved}` have separate time stamps ({} and {} readings); `{moved}` was interpolated linearly at the stamps of `{own}`",
            grid.len(),
            other.len()
        )
    }
}

/// Keeps the values of a column that stay.
fn only<T>(column: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    column.retain(|_| stays.next().is_some_and(|stays| *stays));
}
