//! A table whose names are repeated, such as the blocks of a load frame, the segments of LabVIEW,
//! or the file of a restarted logger.
//!
//! The rows continue below the same names, and the same units if there are any. The segments form
//! one record if the time also continues. Otherwise `--segment N` selects one of them. Text above
//! the names of a segment is skipped like a preamble.

use super::clock_time;
use super::error::RecordError;
use super::layout::{cells, Table};
use super::number::is_data;
use super::text::{Place, Segment};
use super::Options;

/// The table with the rows of all its segments, or of the requested one.
pub(super) fn of<'a>(mut table: Table<'a>, options: &Options) -> Result<Table<'a>, RecordError> {
    let all = segments(&table);
    let count = all.len();
    let own = match options.segment {
        None if count == 1 => return Ok(table),
        None => all,
        Some(number) => {
            let Some(own) = number.checked_sub(1).and_then(|index| all.get(index)) else {
                return Err(RecordError::new(format!(
                    "--segment {number} is out of range (1 to {count})"
                )));
            };
            vec![*own]
        }
    };
    if let Some(other) = own.iter().find(|own| !own.is_alike) {
        let message = "the column names are repeated, but the lines below them differ from the lines below the first names; write the records to separate files";
        return Err(RecordError::at(other.place.names, message));
    }
    match (own.as_slice(), options.rate) {
        ([_, second, ..], Some(_)) => {
            let why = "the column names are repeated, and without a time column bowden cannot tell whether the record continues";
            return Err(ask(second.place, why));
        }
        ([_, second, ..], None) => table.notes.push(format!(
            "the column names are repeated, first in line {}; {count} segments were read as one record",
            second.place.names
        )),
        ([one], _) if count > 1 => table.notes.push(format!(
            "segment {} of {count}, with its names in line {}",
            one.place.number, one.place.names
        )),
        _ => {}
    }
    table.rows = table.rows.of(own);
    Ok(table)
}

/// The error for a segment that is another record, because its time restarts.
pub(super) fn restarts(place: Place, last: f64, stamp: f64) -> RecordError {
    let records = match place.count {
        2 => "two records",
        _ => "several records",
    };
    let why = format!(
        "the file contains {records}: the column names are repeated, and the time jumps back from {last} to {stamp} s"
    );
    ask(place, &why)
}

/// An error that suggests a segment.
fn ask(place: Place, why: &str) -> RecordError {
    let Place {
        names,
        number,
        count,
    } = place;
    let message =
        format!("{why}; --segment N reads one of {count} segments (segment {number} begins here)");
    RecordError::at(names, message)
}

/// The segments of a table. There is one segment if the names appear once. Segments without rows do
/// not count.
fn segments<'a>(table: &Table<'a>) -> Vec<Segment<'a>> {
    let (text, before) = table.rows.rest();
    let names = table.names.trim();
    let mut segment = Segment {
        text,
        before,
        is_alike: true,
        place: Place {
            names: table.header.line,
            number: 1,
            count: 1,
        },
    };
    if names.is_empty() || !text.contains(names) {
        return vec![segment];
    }
    let between = table.below_names.len() - text.len();
    let between: Vec<&str> = table.below_names[..between]
        .lines()
        .map(str::trim)
        .collect();
    let used = table.roles.time.unwrap_or(table.roles.input);
    let separator = table.rows.separator();
    let is_row = |line: &str| {
        let cells = cells(line, separator);
        let cell = cells.get(used).copied().unwrap_or_default();
        is_data(cell, separator) || clock_time::seconds(cell).is_some()
    };
    let mut start = 0;
    let lines = text.split_inclusive('\n').map(|line| {
        start += line.len();
        (start - line.len(), line)
    });
    let lines: Vec<(usize, &str)> = lines.collect();
    let at = |line: usize| lines.get(line).map_or(text.len(), |(at, _)| *at);
    let rows = |line: usize| lines.get(line).is_some_and(|(_, own)| is_row(own));
    let (mut all, mut first) = (Vec::new(), 0);
    let is_names = |line: &str| line.trim() == names;
    for again in (0..lines.len()).filter(|line| is_names(lines[*line].1)) {
        // Names below names are those of one segment.
        if again < first {
            continue;
        }
        // What is above the names, from the last row on, is a preamble.
        let end = (first..again)
            .rev()
            .find(|line| rows(*line))
            .map_or(first, |line| line + 1);
        segment.text = &text[at(first)..at(end)];
        all.push(segment);
        let values = (again + 1..lines.len())
            .find(|line| rows(*line))
            .unwrap_or(lines.len());
        let own = lines[again + 1..values].iter().map(|(_, line)| line.trim());
        let mut own = own.filter(|line| !is_names(line)).peekable();
        segment.is_alike = own.peek().is_none() || own.eq(between.iter().copied());
        segment.before = before + values;
        segment.place.names = before + again + 1;
        first = values;
    }
    segment.text = &text[at(first)..];
    all.push(segment);
    all.retain(|own| !own.text.trim().is_empty());
    let count = all.len();
    for (index, own) in all.iter_mut().enumerate() {
        own.place.number = index + 1;
        own.place.count = count;
    }
    all
}
