//! Units of known size, and their spellings.

use std::f64::consts::TAU;

/// Units of one kind: each size, in multiples of the first unit, with all symbols of this size. The
/// pound (0.453 592 37 kg) and standard gravity (9.806 65 m/s²) are exact. `Grad` is German for a
/// degree. A hundredth of a right angle is `gon`.
const SIZES: [&[(f64, &[&str])]; 7] = [
    &[
        (1.0, &["m"]),
        (1e-2, &["cm"]),
        (1e-3, &["mm"]),
        (1e-6, &["µm", "um"]),
        (1e-9, &["nm"]),
        (0.0254, &["in"]),
        (0.3048, &["ft"]),
    ],
    &[
        (1.0, &["rad"]),
        (1e-3, &["mrad"]),
        (1e-6, &["µrad", "urad"]),
        (TAU / 360.0, &["deg", "°", "degree", "degrees", "Grad"]),
        (TAU / 400.0, &["gon"]),
        (
            TAU,
            &["rev", "revs", "revolution", "revolutions", "turn", "turns"],
        ),
    ],
    &[
        (1.0, &["N"]),
        (1e3, &["kN"]),
        (1e6, &["MN"]),
        (1e-3, &["mN"]),
        (1e-6, &["µN"]),
        (9.806_65, &["kgf"]),
        (4.448_221_615_260_5, &["lbf"]),
        (4_448.221_615_260_5, &["kip"]),
    ],
    &[
        (1.0, &["N·m", "Nm"]),
        (1e-6, &["µN·m", "µNm"]),
        (1e-3, &["mN·m", "mNm", "N·mm", "Nmm"]),
        (1e3, &["kN·m", "kNm"]),
        (1e-2, &["N·cm", "Ncm"]),
        (9.806_65, &["kgf·m"]),
        (0.098_066_5, &["kgf·cm"]),
        (9.806_65e-5, &["gf·cm"]),
        (
            0.0254 * 4.448_221_615_260_5,
            &["lbf·in", "lb·in", "in·lbf", "in·lb"],
        ),
        (
            0.3048 * 4.448_221_615_260_5,
            &["lbf·ft", "lb·ft", "ft·lbf", "ft·lb"],
        ),
        (0.0254 * 4.448_221_615_260_5 / 16.0, &["ozf·in", "oz·in"]),
    ],
    &[(1.0, &["V"]), (1e-3, &["mV"])],
    &[(1.0, &["A"]), (1e-3, &["mA"])],
    &[
        (1.0, &["Pa"]),
        (1e3, &["kPa"]),
        (1e6, &["MPa"]),
        (1e5, &["bar"]),
        (4.448_221_615_260_5 / (0.0254 * 0.0254), &["psi"]),
    ],
];

/// Signs that may separate the factors of a unit.
const BETWEEN: [char; 8] = ['·', '⋅', '∙', '•', '*', '.', '-', ' '];

/// Units of time, each with its size in seconds and its other names in small letters.
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

/// A unit of time and its size in seconds. The unit may be spelt out and in any case, except for a
/// single letter: `H` is not an hour.
pub(super) fn of_time(unit: &str) -> Option<(&'static str, f64)> {
    let lower = unit.to_lowercase().replace('μ', "µ");
    let is_letter = unit.chars().count() < 2;
    let found = TIMES.iter().find(|(sign, _, words)| match is_letter {
        true => *sign == unit || unit == "S" && *sign == "s",
        false => *sign == lower || words.contains(&lower.as_str()),
    });
    found.map(|(sign, seconds, _)| (*sign, *seconds))
}

/// Units that are spelt out, in small letters and singular, and their symbols.
const WORDS: [(&str, &str); 27] = [
    ("metre", "m"),
    ("micron", "µm"),
    ("inch", "in"),
    ("inches", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("radian", "rad"),
    ("newton", "N"),
    ("newtonmetre", "N·m"),
    ("lb", "lbf"),
    ("pound", "lbf"),
    ("kip", "kip"),
    ("ounce", "ozf"),
    ("volt", "V"),
    ("amp", "A"),
    ("ampere", "A"),
    ("pascal", "Pa"),
    ("celsius", "°C"),
    ("degc", "°C"),
    ("deg c", "°C"),
    ("degrees c", "°C"),
    ("kelvin", "K"),
    ("percent", "%"),
    ("hertz", "Hz"),
    ("hz", "Hz"),
    ("khz", "kHz"),
    ("rpm", "rpm"),
];

/// Prefixes of such words, and their symbols.
const PREFIXES: [(&str, &str); 6] = [
    ("mega", "M"),
    ("kilo", "k"),
    ("centi", "c"),
    ("milli", "m"),
    ("micro", "µ"),
    ("nano", "n"),
];

/// The symbol of a unit that is spelt out (`Kilonewtons`) or has letters of the wrong case (`KN`).
/// `None` if the text is not a unit, if it is ambiguous (`NM`), or if a capital letter would change
/// its size (`MV`).
fn spelt(unit: &str) -> Option<String> {
    // An abbreviation: `sec.`, `in.`
    let unit = unit.strip_suffix('.').unwrap_or(unit);
    if unit.chars().count() < 2 {
        return None;
    }
    if let Some((sign, _)) = of_time(unit) {
        return Some(sign.to_owned());
    }
    let lower = unit.to_lowercase().replace("meter", "metre");
    let one = lower.strip_suffix('s').unwrap_or(&lower);
    let sign = |own: &str| {
        let named = WORDS.iter().find(|(word, _)| *word == own);
        named.map(|(_, sign)| (*sign).to_owned())
    };
    let prefixed = |(prefix, letter): &(&str, &str)| {
        let whole = format!("{letter}{}", sign(one.strip_prefix(prefix)?)?);
        is_known(&whole).then_some(whole)
    };
    let word = sign(&lower).or_else(|| sign(one));
    word.or_else(|| PREFIXES.iter().find_map(prefixed))
        .or_else(|| in_other_letters(unit, &lower))
}

/// The only unit of known size with these letters in any case.
fn in_other_letters(unit: &str, lower: &str) -> Option<String> {
    // Nobody measures in megametres or megaradians; a megavolt is no millivolt.
    let is_size = |kind: usize, own: &str| {
        let letters = [unit, own].map(|text| text.chars().next().filter(|c| "mM".contains(*c)));
        kind < 2 || letters[0] == letters[1]
    };
    // Of 400 to the turn there are `grad`, and 360 `Grad`.
    let mut alike = SIZES.iter().enumerate().flat_map(|(kind, all)| {
        let own = all.iter().flat_map(|(_, signs)| signs.iter().copied());
        own.filter(move |own| *own != "Grad" && own.to_lowercase() == lower)
            .map(move |own| (kind, own))
    });
    let (kind, own) = alike.next()?;
    match alike.next() {
        None => is_size(kind, own).then(|| own.to_owned()),
        // `mn` may be two by its letters and is one by its first.
        Some((other, second)) => match (is_size(kind, own), is_size(other, second)) {
            (true, false) => Some(own.to_owned()),
            (false, true) => Some(second.to_owned()),
            _ => None,
        },
    }
}

/// The standard spelling of a unit, such as `N·mm` for `N*mm`, `N-mm`, `N.mm` and `N mm`. Units
/// that are spelt out or have letters of the wrong case become symbols, such as `kN/mm` for
/// `KN/millimetre`. An unknown unit is unchanged.
pub(super) fn written(unit: &str) -> String {
    // The Greek letter instead of the sign.
    let unit = unit.replace('μ', "µ");
    if is_known(&unit) {
        return unit;
    }
    if let Some((above, below)) = unit.split_once('/') {
        let parts = [above.trim(), below.trim()];
        let signs = parts.map(written);
        return match signs == parts {
            true => unit,
            false => signs.join("/"),
        };
    }
    spelt(&unit).or_else(|| product(&unit)).unwrap_or(unit)
}

/// A unit with `·` between its factors, if its size is known.
fn product(unit: &str) -> Option<String> {
    let factors: Vec<&str> = unit.split(BETWEEN).filter(|own| !own.is_empty()).collect();
    if unit.starts_with(BETWEEN) || unit.ends_with(BETWEEN) || factors.len() < 2 {
        return None;
    }
    let whole = factors.join("·");
    if is_known(&whole) {
        return Some(whole);
    }
    let signs = factors
        .iter()
        .map(|own| spelt(own).unwrap_or_else(|| (*own).to_owned()));
    let signs = signs.collect::<Vec<_>>().join("·");
    spelt(&whole).or_else(|| is_known(&signs).then_some(signs))
}

/// Whether the size of a unit in standard spelling is known.
pub(super) fn is_known(unit: &str) -> bool {
    SIZES
        .iter()
        .any(|kind| kind.iter().any(|(_, signs)| signs.contains(&unit)))
}

/// The factor from one unit to the other.
pub(super) fn factor(from: &str, to: &str) -> Option<f64> {
    let size = |kind: &[(f64, &[&str])], unit: &str| {
        let named = kind.iter().find(|(_, signs)| signs.contains(&unit));
        named.map(|(size, _)| *size)
    };
    let (from, to) = (written(from), written(to));
    SIZES
        .iter()
        .find_map(|kind| Some(size(kind, &from)? / size(kind, &to)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_one_kind_convert_and_others_do_not() {
        assert_eq!(factor("mm", "mm"), Some(1.0));
        // One rounding of the quotient.
        assert!((factor("mm", "µm").unwrap() / 1000.0 - 1.0).abs() < 1e-15);
        assert!((factor("deg", "rad").unwrap() * 180.0 / std::f64::consts::PI - 1.0).abs() < 1e-15);
        assert!((factor("kip", "kN").unwrap() / 4.448_221_615_260_5 - 1.0).abs() < 1e-15);
        assert!((factor("in", "mm").unwrap() / 25.4 - 1.0).abs() < 1e-15);
        for (torque, newton_metres) in [
            ("N*mm", 1e-3),
            ("Nmm", 1e-3),
            ("mN·m", 1e-3),
            ("kgf·cm", 0.098_066_5),
            ("in-lb", 0.112_984_829_027_616_7),
            ("lbf.ft", 1.355_817_948_331_400_4),
            ("oz-in", 0.007_061_551_814_226),
        ] {
            let factor = factor(torque, "N m").unwrap();
            assert!((factor / newton_metres - 1.0).abs() < 1e-12, "{torque}");
        }
        assert_eq!(factor("mm", "N"), None);
        assert_eq!(factor("K", "°C"), None);
    }

    #[test]
    fn a_unit_in_other_letters_or_spelt_out_has_its_sign() {
        for (unit, sign) in [
            ("KN", "kN"),
            ("kn", "kN"),
            ("MM", "mm"),
            ("mn", "mN"),
            ("mpa", "mpa"),
            ("MPA", "MPa"),
            ("LBF", "lbf"),
            ("Lbs", "lbf"),
            ("Inches", "in"),
            ("Kilonewtons", "kN"),
            ("millimeters", "mm"),
            ("Newton meters", "N·m"),
            ("NEWTON-METRE", "N·m"),
            ("in-lbs", "in·lbf"),
            ("foot-pounds", "ft·lbf"),
            ("KN-M", "kN·m"),
            ("Sec", "s"),
            ("sec.", "s"),
            ("in.", "in"),
            ("mm/Sec", "mm/s"),
            ("KN/MM", "kN/mm"),
            ("DEG", "deg"),
            ("deg C", "°C"),
            // Two units, or one of another size.
            ("NM", "NM"),
            ("MV", "MV"),
            ("M", "M"),
            ("kilometers", "kilometers"),
        ] {
            assert_eq!(written(unit), sign, "{unit}");
        }
    }

    #[test]
    fn the_sign_between_the_factors_of_a_unit_does_not_count() {
        for unit in ["N·mm", "N*mm", "N mm", "N-mm", "N.mm", "N⋅mm", "N * mm"] {
            assert_eq!(written(unit), "N·mm");
        }
        for unit in [
            "Nmm", "N", "-", "N-", "m/s", "1/min", "N·x", "a.u.", "N/A", "grad", "",
        ] {
            assert_eq!(written(unit), unit);
        }
        assert_eq!(written("\u{3bc}m"), "µm");
    }
}
