//! Units as headers state them.

/// Endings such as `_mm` in `position_mm`, and the unit that they stand for.
const SUFFIXES: [(&str, &str); 27] = [
    ("nm", "nm"),
    ("um", "µm"),
    ("mm", "mm"),
    ("cm", "cm"),
    ("m", "m"),
    ("mrad", "mrad"),
    ("rad", "rad"),
    ("deg", "deg"),
    ("uN", "µN"),
    ("mN", "mN"),
    ("N", "N"),
    ("kN", "kN"),
    ("mNm", "mN·m"),
    ("Nm", "N·m"),
    ("mV", "mV"),
    ("V", "V"),
    ("mA", "mA"),
    ("A", "A"),
    ("us", "µs"),
    ("ms", "ms"),
    ("s", "s"),
    ("Pa", "Pa"),
    ("kPa", "kPa"),
    ("MPa", "MPa"),
    ("bar", "bar"),
    ("degC", "°C"),
    ("K", "K"),
];

/// Splits `name [unit]`, or reads the unit from an ending such as `_mm`.
pub(super) fn split(cell: &str) -> (&str, Option<String>) {
    if let Some((name, unit)) = cell
        .strip_suffix(']')
        .and_then(|cell| cell.rsplit_once('['))
    {
        let (name, unit) = (name.trim(), unit.trim());
        if !name.is_empty() {
            return (name, (!unit.is_empty()).then(|| unit.to_owned()));
        }
    }
    // `velocity_mm_per_s` ends in a denominator, which is not its unit.
    let ending = cell
        .rsplit_once('_')
        .filter(|(name, _)| !name.ends_with("_per"));
    let unit = ending.and_then(|(_, ending)| SUFFIXES.iter().find(|(suffix, _)| *suffix == ending));
    (cell, unit.map(|(_, unit)| (*unit).to_owned()))
}

/// Seconds in one unit of time, if it is one that the reader knows.
pub(super) fn seconds(unit: Option<&str>) -> Option<f64> {
    match unit {
        None | Some("s" | "sec" | "S") => Some(1.0),
        Some("ms") => Some(1e-3),
        Some("us" | "µs" | "μs") => Some(1e-6),
        Some("ns") => Some(1e-9),
        Some("min") => Some(60.0),
        Some(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_stands_in_brackets_or_at_the_end_of_the_name() {
        let unit = |cell| split(cell).1;
        assert_eq!(split("tau_i [N·m]"), ("tau_i", Some("N·m".to_owned())));
        assert_eq!(split("x[ mm ]"), ("x", Some("mm".to_owned())));
        assert_eq!(
            split("jaw_torque_Nm"),
            ("jaw_torque_Nm", Some("N·m".to_owned()))
        );
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
        ] {
            assert_eq!(unit(plain), None, "{plain}");
        }
    }
}
