//! Units in the forms that occur in headers.

use super::error::{shown, RecordError, NAME_LENGTH};
use super::sizes::{is_known, of_time, written};

/// Endings such as `_mm` in `position_mm`, and the units that they mean.
const SUFFIXES: [(&str, &str); 40] = [
    ("nm", "nm"),
    ("um", "µm"),
    ("mm", "mm"),
    ("cm", "cm"),
    ("m", "m"),
    ("ft", "ft"),
    ("in", "in"),
    ("mrad", "mrad"),
    ("rad", "rad"),
    ("deg", "deg"),
    ("uN", "µN"),
    ("mN", "mN"),
    ("N", "N"),
    ("kN", "kN"),
    ("MN", "MN"),
    ("lbf", "lbf"),
    ("kip", "kip"),
    ("mNm", "mN·m"),
    ("Ncm", "N·cm"),
    ("Nmm", "N·mm"),
    ("Nm", "N·m"),
    ("kNm", "kN·m"),
    ("lbfin", "lbf·in"),
    ("lbfft", "lbf·ft"),
    ("mV", "mV"),
    ("V", "V"),
    ("mA", "mA"),
    ("A", "A"),
    ("ns", "ns"),
    ("us", "µs"),
    ("ms", "ms"),
    ("s", "s"),
    ("Pa", "Pa"),
    ("kPa", "kPa"),
    ("MPa", "MPa"),
    ("bar", "bar"),
    ("psi", "psi"),
    ("degC", "°C"),
    ("K", "K"),
    ("uA", "µA"),
];

/// Further units that are recognised in brackets or in a row of units. Their size is not needed
/// here.
const PLAIN: [&str; 23] = [
    "°C", "C", "°F", "K", "rad/s²", "1/min", "rpm", "Hz", "kHz", "kg", "g", "%", "1", "-", "–",
    "W", "counts", "count", "pulses", "ticks", "steps", "LSB", "a.u.",
];

/// Whether a text is a unit that the reader knows, spelt out or in any case.
pub(super) fn is_unit(text: &str) -> bool {
    let own = written(text);
    let is_plain =
        |plain: &&str| *plain == own || own.chars().count() > 2 && plain.eq_ignore_ascii_case(&own);
    PLAIN.iter().any(is_plain)
        || is_known(&own)
        || SUFFIXES
            .iter()
            .any(|(suffix, unit)| *suffix == own || *unit == own)
        || of_time(&own).is_some()
        || is_ratio(&own)
}

/// Whether a text is a quotient of two units, such as `mm/mm`, `N/mm` or `m/s²`. `N/A` is not a
/// quotient.
fn is_ratio(text: &str) -> bool {
    let of = |part: &str| {
        let power = part.trim().trim_end_matches(['²', '³', '^', '2', '3']);
        power.split(['·', '*']).all(is_unit)
    };
    let parts = text.rsplit_once('/');
    parts.is_some_and(|(above, below)| text != "N/A" && of(above) && of(below))
}

/// The error for a unit that is not a unit of time, on a line of the file.
pub(super) fn not_of_time(line: usize, name: &str, unit: &str) -> RecordError {
    let (own, unit) = (shown(name, NAME_LENGTH), shown(unit, NAME_LENGTH));
    let message = format!(
        "`{unit}` is not a unit of time; allowed are s, ms, us, ns, min, h and d, in the file or with --time '{own} [ms]'"
    );
    RecordError::at(line, message).on(name)
}

/// Whether a cell of a row of units states that there is no unit.
pub(super) fn is_none(unit: &str) -> bool {
    ["-", "–", "1"].contains(&unit)
}

/// Whether a cell of a row of units only marks the row as such.
pub(super) fn is_label(cell: &str) -> bool {
    let own = cell.trim_end_matches([':', ' ']).to_lowercase();
    ["unit", "units", "einheit", "einheiten", "unité", "unités"].contains(&own.as_str())
}

/// The unit in a cell of a row of units, if the reader knows this unit. The unit may be in
/// brackets.
pub(super) fn alone(cell: &str) -> Option<String> {
    let inner = [('[', ']'), ('(', ')')].iter().find_map(|(open, close)| {
        let inner = cell.strip_prefix(*open)?.strip_suffix(*close)?;
        Some(inner.trim())
    });
    let unit = inner.unwrap_or(cell);
    is_unit(unit).then(|| written(unit))
}

/// Names of lengths, for which `_in` means inches; `torque_in` is an input.
const LENGTHS: [&str; 8] = [
    "displacement",
    "position",
    "stroke",
    "travel",
    "deflection",
    "elongation",
    "stretch",
    "length",
];

/// Names of quantities other than length, time, current and temperature. After these names, `_m`,
/// `_s`, `_A` and `_K` are indices, as in `tau_m`, the torque of the motor.
const OTHERS: [&str; 10] = [
    "tau", "torque", "moment", "force", "f", "phi", "theta", "angle", "alpha", "omega",
];

/// Endings that may be words instead of units, such as `in` for an input or `foot` for a lever.
const WORDS: [&str; 6] = ["in", "amp", "foot", "turn", "rad", "bar"];

/// Splits the ending such as `_mm`, `_inches` or ` deg` off a name, with the unit that it means.
pub(super) fn ending(name: &str) -> Option<(&str, String)> {
    // `velocity_mm_per_s` ends in a denominator, which is not its unit.
    let (stem, ending) = name
        .rsplit_once(['_', ' '])
        .filter(|(stem, _)| !stem.ends_with("_per") && !stem.ends_with(" per"))?;
    let is_blank = name[stem.len()..].starts_with(' ');
    // `Channel A` and `left foot` are names.
    if is_blank && (ending.chars().count() < 2 || is_any(&WORDS, ending)) {
        return None;
    }
    let lower = stem.to_lowercase();
    let is_of = |names: &[&str]| names.iter().any(|name| lower.contains(name));
    let is_axis = ["x", "y", "z", "d", "u"].contains(&lower.as_str());
    if ending == "in" && !is_of(&LENGTHS) && !is_axis {
        return None;
    }
    if ["m", "s", "A", "K"].contains(&ending) && OTHERS.contains(&lower.as_str()) {
        return None;
    }
    if let Some((_, unit)) = SUFFIXES.iter().find(|(suffix, _)| *suffix == ending) {
        return Some((stem, (*unit).to_owned()));
    }
    let unit = written(ending);
    // `degrees` and `turns` are written as they are, and a letter or two are in the table above.
    let is_word = unit != ending || ending.len() > 3;
    let is_spelt = is_word && is_known(&unit) && !is_any(&WORDS, ending);
    // `x_sec` may be the second one.
    let is_time =
        of_time(ending).is_some() && (lower == "t" || is_of(&["time", "stamp", "elapsed"]));
    (is_spelt || is_time && ending.len() > 1 || unit == "counts").then_some((stem, unit))
}

fn is_any(words: &[&str], own: &str) -> bool {
    words.iter().any(|word| word.eq_ignore_ascii_case(own))
}

/// Splits `name [unit]`. If the reader knows the unit, `name (unit)` and `name / unit` are also
/// split.
pub(super) fn stated(cell: &str) -> Option<(&str, Option<String>)> {
    let cell = cell.trim();
    if let Some((name, unit)) = cell
        .strip_suffix(']')
        .and_then(|cell| cell.rsplit_once('['))
    {
        let (name, unit) = (name.trim(), unit.trim());
        if !name.is_empty() {
            return Some((name, (!unit.is_empty()).then(|| written(unit))));
        }
    }
    let round = cell
        .strip_suffix(')')
        .and_then(|cell| cell.rsplit_once('('))
        .or_else(|| cell.rsplit_once(" / "));
    let (name, unit) = round.map(|(name, unit)| (name.trim(), unit.trim()))?;
    (!name.is_empty() && is_unit(unit)).then(|| (name, Some(written(unit))))
}

/// Splits the unit off a cell as [`stated`] does, or reads it from an ending such as `_mm`.
pub(super) fn split(cell: &str) -> (&str, Option<String>) {
    stated(cell).unwrap_or_else(|| (cell, ending(cell).map(|(_, unit)| unit)))
}

/// Units of velocities.
const VELOCITIES: [&str; 14] = [
    "m/s", "mm/s", "cm/s", "µm/s", "um/s", "in/s", "rad/s", "mrad/s", "deg/s", "°/s", "rev/s",
    "rpm", "1/min", "km/h",
];

/// Names of velocities without a unit.
const VELOCITY_NAMES: [&str; 11] = [
    "v", "vel", "speed", "omega", "dx", "xd", "xdot", "x_dot", "dq", "qd", "qdot",
];

/// Whether a column is a velocity, by its unit, or by its name if it states no unit.
#[must_use]
pub fn is_velocity(name: &str, unit: Option<&str>) -> bool {
    let lower = name.to_lowercase();
    match unit {
        Some(unit) => VELOCITIES.contains(&unit),
        None => VELOCITY_NAMES.contains(&lower.as_str()) || lower.contains("veloc"),
    }
}

/// Number of seconds in a unit of time, if the reader knows the unit.
pub(super) fn seconds(unit: Option<&str>) -> Option<f64> {
    match unit {
        None => Some(1.0),
        Some(unit) => of_time(unit).map(|(_, seconds)| seconds),
    }
}

/// Splits a unit of time off a name that is such a unit or ends in one: `millis`, `elapsed_us`,
/// `timeMs`.
fn split_time(name: &str) -> Option<(&str, &'static str)> {
    let name = without_signs(name);
    let last = name.rsplit(|c: char| !c.is_alphanumeric()).next()?;
    let capital = last.char_indices().zip(last.chars().skip(1));
    let capital = capital.filter(|((_, c), next)| c.is_lowercase() && next.is_uppercase());
    let own = match capital.last() {
        Some(((at, c), _)) => &last[at + c.len_utf8()..],
        None => last,
    };
    let (unit, _) = of_time(own)?;
    let stem = without_signs(name.strip_suffix(own)?);
    // `t_d` may be a delay.
    (stem.is_empty() || unit != "d").then_some((stem, unit))
}

/// A name without the characters at its ends that are neither letters nor digits.
fn without_signs(name: &str) -> &str {
    name.trim_matches(|c: char| !c.is_alphanumeric())
}

/// The unit of time that a name is or ends in.
pub(super) fn time_in_name(name: &str) -> Option<&'static str> {
    split_time(name).map(|(_, unit)| unit)
}

/// Whether a name can only be the name of a time. This is true for `ms`, `timeMs` and `__time`, but
/// not for `s` and `min`.
pub(super) fn is_time_alone(name: &str) -> bool {
    let name = without_signs(name);
    let is_time = |own: &str| is_any(&["time", "timestamp"], own);
    let is_unit = match split_time(name) {
        Some(("", _)) => name.chars().count() > 1 && !is_any(&["min"], name),
        Some((stem, _)) => stem == "t" || is_time(stem),
        None => false,
    };
    is_unit || is_time(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_is_told_by_its_unit_or_else_by_its_name() {
        for (name, unit) in [
            ("way", Some("mm/s")),
            ("n", Some("rpm")),
            ("v", None),
            ("Velocity", None),
            ("motor_velocity", None),
        ] {
            assert!(is_velocity(name, unit), "{name} {unit:?}");
        }
        for (name, unit) in [
            ("v", Some("V")),
            ("velocity", Some("mm")),
            ("x", None),
            ("valve", None),
        ] {
            assert!(!is_velocity(name, unit), "{name} {unit:?}");
        }
    }

    #[test]
    fn a_name_may_be_a_unit_of_time_or_end_in_one() {
        for (name, unit) in [
            ("ms", "ms"),
            ("MS", "ms"),
            ("millis", "ms"),
            ("millis()", "ms"),
            ("Seconds", "s"),
            ("micros", "µs"),
            ("elapsed_us", "µs"),
            ("timeMs", "ms"),
            ("Run time min", "min"),
            ("time.ns", "ns"),
            ("d", "d"),
        ] {
            assert_eq!(time_in_name(name), Some(unit), "{name}");
        }
        for name in ["t", "time", "Items", "t_d", "H", "timestamp", "", "()"] {
            assert_eq!(time_in_name(name), None, "{name}");
        }
        for name in [
            "ms", "micros", "Seconds", "minutes", "__time", "timeMs", "Time ms", "t.us",
        ] {
            assert!(is_time_alone(name), "{name}");
        }
        for name in ["s", "d", "min", "x_ms", "h", "t_d", "rise time"] {
            assert!(!is_time_alone(name), "{name}");
        }
    }

    #[test]
    fn known_units_are_known_in_any_case_spelt_out_and_over_each_other() {
        for unit in [
            "Sec",
            "SECONDS",
            "mm/mm",
            "in/in",
            "N/mm",
            "KN/MM",
            "mm/sec",
            "deg/s",
            "m/s^2",
            "m/s²",
            "N*s/m",
            "counts",
            "Counts",
            "LSB",
            "HZ",
            "lbs",
            "Inch",
            "Newtons",
            "kilonewtons",
            "N-M",
            "in-lbs",
            "degC",
            "deg C",
            "MPA",
        ] {
            assert!(is_unit(unit), "{unit}");
        }
        for word in [
            "wide", "N·x", "NM", "MV", "T", "B", "D", "raw", "N/A", "a/t", "and/or", "/", "",
        ] {
            assert!(!is_unit(word), "{word}");
        }
    }

    #[test]
    fn a_unit_stands_in_brackets_or_at_the_end_of_the_name() {
        let unit = |cell| split(cell).1;
        assert_eq!(split("tau_i [N·m]"), ("tau_i", Some("N·m".to_owned())));
        assert_eq!(split("x[ mm ]"), ("x", Some("mm".to_owned())));
        assert_eq!(
            split("jaw_torque_Nm"),
            ("jaw_torque_Nm", Some("N·m".to_owned()))
        );
        assert_eq!(split("Weg (mm)"), ("Weg", Some("mm".to_owned())));
        assert_eq!(split("Kraft / N"), ("Kraft", Some("N".to_owned())));
        assert_eq!(split("tau (N mm)"), ("tau", Some("N·mm".to_owned())));
        assert_eq!(unit("tau [wide-ish]").as_deref(), Some("wide-ish"));
        assert_eq!(unit("force_kip").as_deref(), Some("kip"));
        assert_eq!(unit("displacement_in").as_deref(), Some("in"));
        assert_eq!(unit("x_mm").as_deref(), Some("mm"));
        assert_eq!(unit("q_m").as_deref(), Some("m"));
        assert_eq!(unit("F_N").as_deref(), Some("N"));
        assert_eq!(unit("velocity_mm_per_s"), None);
        assert_eq!(unit("F_kN").as_deref(), Some("kN"));
        assert_eq!(unit("F_KN").as_deref(), Some("kN"));
        assert_eq!(unit("x_inches").as_deref(), Some("in"));
        assert_eq!(unit("phi_p_degrees").as_deref(), Some("degrees"));
        assert_eq!(unit("motor angle deg").as_deref(), Some("deg"));
        assert_eq!(unit("Force KN").as_deref(), Some("kN"));
        assert_eq!(unit("load_Newtons").as_deref(), Some("N"));
        assert_eq!(unit("time_seconds").as_deref(), Some("s"));
        assert_eq!(unit("encoder_counts").as_deref(), Some("counts"));
        assert_eq!(unit("Kraft (Newtons)").as_deref(), Some("N"));
        for plain in [
            "Channel A",
            "left foot",
            "motor angle",
            "speed mm per s",
            "tau_MV",
            "tau_NM",
            "x_sec",
            "x_min",
            "x_amp",
            "torque_IN",
            "x (N/A)",
            "t",
            "tau_i",
            "tau_o",
            "phi_p",
            "phi_d",
            "force_norm",
            "[mm]",
            "x []",
            "torque_in",
            "tau_m",
            "F_s",
            "phi_m",
            "x (raw)",
        ] {
            assert_eq!(unit(plain), None, "{plain}");
        }
    }
}
