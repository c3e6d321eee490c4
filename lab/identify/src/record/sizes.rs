//! Units of known size, and how they are written.

use std::f64::consts::{PI, TAU};

/// One pound-force \[N\], exactly: 0.45359237 kg under 9.80665 m/s².
const POUND: f64 = 4.448_221_615_260_5;
const POUND_INCH: f64 = 0.0254 * POUND;
const POUND_FOOT: f64 = 0.3048 * POUND;

/// One kilogram-force \[N\], exactly.
const KILOPOND: f64 = 9.806_65;

/// One degree \[rad\]. In German it is `Grad`; a hundredth of a right angle is `gon` there and here.
const DEGREE: f64 = PI / 180.0;

/// Units of one kind, each with its size in the first one.
const SIZES: [&[(&str, f64)]; 7] = [
    &[
        ("m", 1.0),
        ("cm", 1e-2),
        ("mm", 1e-3),
        ("µm", 1e-6),
        ("um", 1e-6),
        ("nm", 1e-9),
        ("in", 0.0254),
        ("ft", 0.3048),
    ],
    &[
        ("rad", 1.0),
        ("mrad", 1e-3),
        ("µrad", 1e-6),
        ("urad", 1e-6),
        ("deg", DEGREE),
        ("°", DEGREE),
        ("degree", DEGREE),
        ("degrees", DEGREE),
        ("Grad", DEGREE),
        ("gon", 0.9 * DEGREE),
        ("rev", TAU),
        ("revs", TAU),
        ("revolution", TAU),
        ("revolutions", TAU),
        ("turn", TAU),
        ("turns", TAU),
    ],
    &[
        ("N", 1.0),
        ("kN", 1e3),
        ("MN", 1e6),
        ("mN", 1e-3),
        ("µN", 1e-6),
        ("kgf", KILOPOND),
        ("lbf", POUND),
        ("kip", 1e3 * POUND),
    ],
    &[
        ("N·m", 1.0),
        ("Nm", 1.0),
        ("µN·m", 1e-6),
        ("µNm", 1e-6),
        ("mN·m", 1e-3),
        ("mNm", 1e-3),
        ("kN·m", 1e3),
        ("kNm", 1e3),
        ("N·cm", 1e-2),
        ("Ncm", 1e-2),
        ("N·mm", 1e-3),
        ("Nmm", 1e-3),
        ("kgf·m", KILOPOND),
        ("kgf·cm", 1e-2 * KILOPOND),
        ("gf·cm", 1e-5 * KILOPOND),
        ("lbf·in", POUND_INCH),
        ("lb·in", POUND_INCH),
        ("in·lbf", POUND_INCH),
        ("in·lb", POUND_INCH),
        ("lbf·ft", POUND_FOOT),
        ("lb·ft", POUND_FOOT),
        ("ft·lbf", POUND_FOOT),
        ("ft·lb", POUND_FOOT),
        ("ozf·in", POUND_INCH / 16.0),
        ("oz·in", POUND_INCH / 16.0),
    ],
    &[("V", 1.0), ("mV", 1e-3)],
    &[("A", 1.0), ("mA", 1e-3)],
    &[
        ("Pa", 1.0),
        ("kPa", 1e3),
        ("MPa", 1e6),
        ("bar", 1e5),
        ("psi", POUND / (0.0254 * 0.0254)),
    ],
];

/// Signs that stand between the factors of a unit.
const BETWEEN: [char; 8] = ['·', '⋅', '∙', '•', '*', '.', '-', ' '];

/// A unit with `·` between its factors, `N·mm` for `N*mm`, `N-mm`, `N.mm` and `N mm`, where that is
/// one of known size; else as it is.
pub(super) fn written(unit: &str) -> String {
    // The letter of the Greek alphabet, in place of the sign.
    let unit = unit.replace('μ', "µ");
    let factors: Vec<&str> = unit.split(BETWEEN).filter(|own| !own.is_empty()).collect();
    let whole = factors.join("·");
    let inside = !unit.starts_with(BETWEEN) && !unit.ends_with(BETWEEN);
    match inside && factors.len() > 1 && is_known(&whole) {
        true => whole,
        false => unit,
    }
}

/// Whether the size of a unit is known, as it is written here.
pub(super) fn is_known(unit: &str) -> bool {
    SIZES
        .iter()
        .any(|kind| kind.iter().any(|(name, _)| *name == unit))
}

/// By what a value is to be multiplied to go from one unit to the other.
pub(super) fn factor(from: &str, to: &str) -> Option<f64> {
    let size = |kind: &[(&str, f64)], unit: &str| {
        let named = kind.iter().find(|(name, _)| *name == unit);
        named.map(|(_, size)| *size)
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
    fn the_sign_between_the_factors_of_a_unit_does_not_count() {
        for unit in ["N·mm", "N*mm", "N mm", "N-mm", "N.mm", "N⋅mm", "N * mm"] {
            assert_eq!(written(unit), "N·mm");
        }
        for unit in ["Nmm", "N", "-", "N-", "m/s", "1/min", "N·x", "a.u.", ""] {
            assert_eq!(written(unit), unit);
        }
        assert_eq!(written("\u{3bc}m"), "µm");
    }
}
