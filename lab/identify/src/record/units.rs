//! Units as headers state them.

use super::sizes::{is_known, written};

/// Endings such as `_mm` in `position_mm`, and the unit that they stand for.
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

/// Units of no size that is needed here, in brackets or in a row of units.
const PLAIN: [&str; 26] = [
    "N/m", "N/mm", "°C", "C", "degC", "°F", "deg/s", "°/s", "rad/s", "rad/s²", "1/min", "rpm",
    "Hz", "kHz", "m/s", "mm/s", "m/s²", "kg", "g", "%", "1", "-", "–", "sec", "min", "W",
];

/// Whether a text is a unit that the reader knows.
pub(super) fn is_unit(text: &str) -> bool {
    PLAIN.contains(&text)
        || is_known(&written(text))
        || SUFFIXES
            .iter()
            .any(|(suffix, unit)| *suffix == text || *unit == text)
        || seconds(Some(text)).is_some()
}

/// The unit in a cell of a row of units, where it is one that the reader knows; brackets may
/// stand round it.
pub(super) fn alone(cell: &str) -> Option<String> {
    let inner = [('[', ']'), ('(', ')')].iter().find_map(|(open, close)| {
        let inner = cell.strip_prefix(*open)?.strip_suffix(*close)?;
        Some(inner.trim())
    });
    let unit = inner.unwrap_or(cell);
    is_unit(unit).then(|| written(unit))
}

/// Names of lengths, of which `_in` is the unit; `torque_in` is an input.
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

/// Names that measure no length, time, current or temperature: behind them `_m`, `_s`, `_A` and `_K` are
/// indices, as in `tau_m`, the motor's torque.
const OTHERS: [&str; 10] = [
    "tau", "torque", "moment", "force", "f", "phi", "theta", "angle", "alpha", "omega",
];

/// Splits the ending such as `_mm` off a name, with the unit that it stands for.
pub(super) fn ending(name: &str) -> Option<(&str, &'static str)> {
    // `velocity_mm_per_s` ends in a denominator, which is not its unit.
    let (stem, ending) = name
        .rsplit_once('_')
        .filter(|(stem, _)| !stem.ends_with("_per"))?;
    let lower = stem.to_lowercase();
    let is_of = |names: &[&str]| names.iter().any(|name| lower.contains(name));
    let is_axis = ["x", "y", "z", "d", "u"].contains(&lower.as_str());
    if ending == "in" && !is_of(&LENGTHS) && !is_axis {
        return None;
    }
    if ["m", "s", "A", "K"].contains(&ending) && OTHERS.contains(&lower.as_str()) {
        return None;
    }
    let known = SUFFIXES.iter().find(|(suffix, _)| *suffix == ending);
    known.map(|(_, unit)| (stem, *unit))
}

/// Splits `name [unit]`; a unit that the reader knows may stand as `name (unit)` or `name / unit`
/// too.
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
    stated(cell).unwrap_or_else(|| (cell, ending(cell).map(|(_, unit)| unit.to_owned())))
}

/// Units of velocities.
const VELOCITIES: [&str; 14] = [
    "m/s", "mm/s", "cm/s", "µm/s", "um/s", "in/s", "rad/s", "mrad/s", "deg/s", "°/s", "rev/s",
    "rpm", "1/min", "km/h",
];

/// Names that velocities have where no unit is stated.
const VELOCITY_NAMES: [&str; 11] = [
    "v", "vel", "speed", "omega", "dx", "xd", "xdot", "x_dot", "dq", "qd", "qdot",
];

/// Whether a column is a velocity, by its unit, or by its name where it states none.
pub(crate) fn is_velocity(name: &str, unit: Option<&str>) -> bool {
    let lower = name.to_lowercase();
    match unit {
        Some(unit) => VELOCITIES.contains(&unit),
        None => VELOCITY_NAMES.contains(&lower.as_str()) || lower.contains("veloc"),
    }
}

/// Units of time, each with its seconds and the other words for it in small letters.
const TIMES: [(&str, f64, &[&str]); 7] = [
    ("s", 1.0, &["sec", "secs", "second", "seconds"]),
    (
        "ms",
        1e-3,
        &["msec", "msecs", "millis", "millisecond", "milliseconds"],
    ),
    (
        "µs",
        1e-6,
        &[
            "us",
            "usec",
            "usecs",
            "µsec",
            "micros",
            "microsecond",
            "microseconds",
        ],
    ),
    (
        "ns",
        1e-9,
        &["nsec", "nsecs", "nanos", "nanosecond", "nanoseconds"],
    ),
    ("min", 60.0, &["mins", "minute", "minutes"]),
    ("h", 3600.0, &["hr", "hrs", "hour", "hours"]),
    ("d", 86_400.0, &["day", "days"]),
];

/// A unit of time with its seconds; in any case and spelt out, but for a letter alone: `H` is no
/// hour.
fn of_time(unit: &str) -> Option<(&'static str, f64)> {
    let lower = unit.to_lowercase().replace('μ', "µ");
    let is_letter = unit.chars().count() < 2;
    let found = TIMES.iter().find(|(sign, _, words)| match is_letter {
        true => *sign == unit || unit == "S" && *sign == "s",
        false => *sign == lower || words.contains(&lower.as_str()),
    });
    found.map(|(sign, seconds, _)| (*sign, *seconds))
}

/// Seconds in one unit of time, if it is one that the reader knows.
pub(super) fn seconds(unit: Option<&str>) -> Option<f64> {
    match unit {
        None => Some(1.0),
        Some(unit) => of_time(unit).map(|(_, seconds)| seconds),
    }
}

/// The unit of time that a name is or ends in: `millis`, `elapsed_us`, `timeMs`.
pub(super) fn time_in_name(name: &str) -> Option<&'static str> {
    let name = name.trim_matches(|c: char| !c.is_alphanumeric());
    let last = name.rsplit(|c: char| !c.is_alphanumeric()).next()?;
    let capital = last.char_indices().zip(last.chars().skip(1));
    let capital = capital.filter(|((_, c), next)| c.is_lowercase() && next.is_uppercase());
    let own = match capital.last() {
        Some(((at, c), _)) => &last[at + c.len_utf8()..],
        None => last,
    };
    let (unit, _) = of_time(own)?;
    // `t_d` may be a delay.
    (own == name || unit != "d").then_some(unit)
}

/// Whether a name can be nothing but that of a time: `ms` and `millis` are, `s` and `min` are not.
pub(super) fn is_time_alone(name: &str) -> bool {
    let name = name.trim_matches(|c: char| !c.is_alphanumeric());
    name.chars().count() > 1 && !name.eq_ignore_ascii_case("min") && of_time(name).is_some()
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
        for name in ["ms", "micros", "Seconds", "minutes"] {
            assert!(is_time_alone(name), "{name}");
        }
        for name in ["s", "d", "min", "time_ms", "h"] {
            assert!(!is_time_alone(name), "{name}");
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
        for plain in [
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
