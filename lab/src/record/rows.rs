//! The rows below the header.

use super::error::RecordError;
use super::header::Header;
use super::roles::Roles;
use super::text::{cells, Lines};
use super::time::Clock;
use super::{number, Options, MIN_SAMPLES};

/// The numbers that were kept, and where they stood.
pub(super) struct Table {
    /// Time \[s\] since the first sample that was kept.
    pub(super) time: Vec<f64>,
    /// One column a role, in the order of [`Roles::read`].
    pub(super) values: Vec<Vec<f64>>,
    /// Line of each sample.
    pub(super) lines: Vec<usize>,
    pub(super) notes: Vec<String>,
}

/// Reads the rows; values in rows that are cut away are not looked at.
pub(super) fn read(
    lines: &mut Lines<'_>,
    header: &Header,
    roles: &Roles,
    options: &Options,
) -> Result<Table, RecordError> {
    let columns: Vec<usize> = roles.read().collect();
    let mut clock = Clock::new(header, roles.time, options)?;
    let mut values = vec![Vec::new(); columns.len()];
    let (mut time, mut numbers) = (Vec::new(), Vec::new());
    let mut row: Vec<&str> = Vec::with_capacity(header.columns.len());
    while let Some(text) = lines.next() {
        let (text, line) = (text?, lines.number());
        row.clear();
        row.extend(cells(text, header.separator));
        if text.trim().is_empty() && header.columns.len() > 1 {
            return Err(RecordError::at(
                line,
                "the line is blank, but rows follow it",
            ));
        }
        if row.len() != header.columns.len() {
            let message = format!(
                "{} cells, the header has {}",
                row.len(),
                header.columns.len()
            );
            return Err(RecordError::at(line, message));
        }
        let Some(t) = clock.stamp(&row, line)? else {
            continue;
        };
        time.push(t);
        numbers.push(line);
        for (values, index) in values.iter_mut().zip(&columns) {
            values.push(number::read(
                row[*index],
                line,
                &header.columns[*index].name,
            )?);
        }
    }
    clock.finish(header)?;
    if time.len() < MIN_SAMPLES {
        let (all, left) = (clock.rows(), time.len());
        let samples = if left == 1 { "sample" } else { "samples" };
        let cut = if left < all {
            format!(" of {all} are left after cutting")
        } else {
            String::new()
        };
        let message =
            format!("too short: {left} {samples}{cut}, at least {MIN_SAMPLES} are needed");
        return Err(RecordError::at(lines.number(), message));
    }
    let mut notes = clock.notes(&time);
    let start = time.first().copied().unwrap_or_default();
    time.iter_mut().for_each(|t| *t -= start);
    if let Some(unit) = roles
        .time
        .and_then(|index| header.columns[index].unit.as_deref())
    {
        notes.extend((unit != "s").then(|| format!("time converted from {unit} to s")));
    }
    Ok(Table {
        time,
        values,
        lines: numbers,
        notes,
    })
}
