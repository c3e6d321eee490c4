//! The rows below the header.

use super::error::RecordError;
use super::header::Header;
use super::roles::Roles;
use super::text::Rows;
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
    rows: &mut Rows<'_>,
    header: &Header,
    roles: &Roles,
    options: &Options,
) -> Result<Table, RecordError> {
    let columns: Vec<usize> = roles.read().collect();
    let mut clock = Clock::new(header, roles.time, options)?;
    let mut values = vec![Vec::new(); columns.len()];
    let (mut time, mut numbers) = (Vec::new(), Vec::new());
    // Rows of several lines.
    let mut carried = 0;
    while let Some(row) = rows.read()? {
        let line = row.line;
        if row.len() != header.columns.len() {
            let mut message = format!(
                "{} cells, the header has {}",
                row.len(),
                header.columns.len()
            );
            if row.last > line {
                message += &format!("; a quote carries the row on to line {}", row.last);
            }
            return Err(RecordError::at(line, message));
        }
        carried += usize::from(row.last > line);
        let Some(t) = clock.stamp(&row)? else {
            continue;
        };
        time.push(t);
        numbers.push(line);
        for (values, index) in values.iter_mut().zip(&columns) {
            values.push(number::read(
                row.cell(*index),
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
        return Err(RecordError::at(rows.line(), message));
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
    match carried {
        0 => {}
        1 => notes.push("1 row goes over several lines, in quotes".to_owned()),
        _ => notes.push(format!("{carried} rows go over several lines, in quotes")),
    }
    Ok(Table {
        time,
        values,
        lines: numbers,
        notes,
    })
}
