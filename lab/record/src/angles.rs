//! Converts angles to radians from any unit in the file, because effects such as gravity (sin q)
//! and ripple (cos(k·q)) require radians.

use super::sizes::factor;
use super::{Column, Mode};

/// The unit of every angle that an effect may be a function of.
const UNIT: &str = "rad";

/// Whether a unit is a unit of angle.
pub(super) fn is_angle(unit: &str) -> bool {
    factor(unit, UNIT).is_some()
}

/// Converts channels, and an input that is a displacement, from another unit of angle to radians,
/// and returns notes. The output is unchanged, because no effect is a function of it.
pub(super) fn in_radians(mode: Mode, input: &mut Column, channels: &mut [Column]) -> Vec<String> {
    let input = Some(input).filter(|_| mode == Mode::Displacement);
    let all = input.into_iter().chain(channels);
    all.filter_map(converted).collect()
}

fn converted(column: &mut Column) -> Option<String> {
    let factor = factor(column.unit.as_deref()?, UNIT)?;
    let unit = column.unit.replace(UNIT.to_owned())?;
    if factor == 1.0 {
        return None;
    }
    column.values.iter_mut().for_each(|value| *value *= factor);
    Some(format!(
        "`{}` converted from {unit} to {UNIT}, the angle unit of the effects `gravity` and `ripple`",
        column.name
    ))
}
