//! Several records of one rig: the same mode, channels and units in all of them.

use super::sizes::factor;
use super::{Column, Mode, Record, RecordError};

/// Whether two texts name the same unit, for example `Nm` and `N·m`.
#[must_use]
pub fn is_same_unit(one: &str, other: &str) -> bool {
    one == other || factor(one, other) == Some(1.0)
}

/// Converts all records to the channels and units of the first record.
///
/// # Errors
/// A message with file and column if a mode, a channel or a unit differs, or if two files contain
/// the same samples. The same samples twice would look like two experiments that agree.
pub fn agree(records: &mut [Record]) -> Result<(), RecordError> {
    let Some((first, others)) = records.split_first_mut() else {
        return Ok(());
    };
    for other in others {
        follow(first, other).map_err(|error| error.in_file(&other.path))?;
    }
    let same = |a: &Record, b: &Record| {
        a.output.values == b.output.values && a.input.values == b.input.values
    };
    for (index, later) in records.iter().enumerate() {
        if let Some(earlier) = records[..index].iter().find(|earlier| same(earlier, later)) {
            let error = RecordError::new(format!(
                "the samples are the same as in {}; pass each record once",
                earlier.path
            ));
            return Err(error.in_file(&later.path));
        }
    }
    Ok(())
}

fn follow(first: &Record, other: &mut Record) -> Result<(), RecordError> {
    let words = |mode| match mode {
        Mode::Torque => "torque",
        Mode::Displacement => "displacement",
    };
    if first.mode != other.mode {
        return Err(RecordError::new(format!(
            "this is the input of {} mode, but the mode must be {}, as in {}",
            words(other.mode),
            words(first.mode),
            first.path
        ))
        .on(&other.input.name));
    }
    let missing = |name: &str| {
        RecordError::new(format!(
            "the file has no such channel, but {} has one; all files must have the same channels",
            first.path
        ))
        .on(name)
    };
    if let Some(more) = other
        .channels
        .iter()
        .find(|c| first.channel(&c.name).is_none())
    {
        return Err(RecordError::new(format!(
            "{} has no such channel; all files must have the same channels",
            first.path
        ))
        .on(&more.name));
    }
    let mut notes = Vec::new();
    notes.extend(convert(&first.input, &mut other.input, &first.path)?);
    notes.extend(convert(&first.output, &mut other.output, &first.path)?);
    let mut channels = Vec::with_capacity(first.channels.len());
    for column in &first.channels {
        let own = other.channels.iter().position(|c| c.name == column.name);
        let mut own = other
            .channels
            .swap_remove(own.ok_or_else(|| missing(&column.name))?);
        notes.extend(convert(column, &mut own, &first.path)?);
        channels.push(own);
    }
    other.channels = channels;
    other.notes.extend(notes);
    Ok(())
}

/// Converts a column to the unit of `whence`, and returns a note if the values change.
///
/// # Errors
/// One line with file and column if the column has no unit, or a unit of another kind.
pub fn to_unit(
    column: &mut Column,
    unit: &str,
    whence: &str,
    file: &str,
) -> Result<Option<String>, RecordError> {
    let wanted = Column {
        name: column.name.clone(),
        unit: Some(unit.to_owned()),
        values: Vec::new(),
        definition: None,
    };
    convert(&wanted, column, whence).map_err(|error| error.in_file(file))
}

/// Converts a column to the unit of the column with the same name, and returns a note if the values
/// change.
fn convert(first: &Column, other: &mut Column, path: &str) -> Result<Option<String>, RecordError> {
    if first.unit == other.unit {
        return Ok(None);
    }
    let shown = |unit: &Option<String>| match unit {
        Some(unit) => format!("unit {unit}"),
        None => "no unit".to_owned(),
    };
    let (from, to) = (shown(&other.unit), shown(&first.unit));
    let known = match (&other.unit, &first.unit) {
        (Some(own), Some(unit)) => factor(own, unit),
        _ => None,
    };
    let Some(factor) = known else {
        let message = format!("the column has {from}, but it must have {to}, as in {path}");
        return Err(RecordError::new(message).on(&other.name));
    };
    other.unit.clone_from(&first.unit);
    if factor == 1.0 {
        return Ok(None);
    }
    other.values.iter_mut().for_each(|value| *value *= factor);
    Ok(Some(format!(
        "`{}` converted from {from} to {to}",
        other.name
    )))
}
