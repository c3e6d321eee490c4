//! Decimals that are rounded up or down. `format!` rounds to the nearest decimal.

/// The side on which a decimal may differ from its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Towards {
    /// Not above the number.
    Below,
    /// Not below the number.
    Above,
}

/// More decimals than any `f64` has.
const ALL: usize = 1080;

/// The number of decimals that shows three digits of a number, but at least `least`.
#[must_use]
pub fn places(x: f64, least: usize) -> usize {
    if !(x.is_finite() && x != 0.0) {
        return least;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let needed = (2.0 - x.abs().log10().floor()).clamp(0.0, 15.0) as usize;
    needed.max(least)
}

/// The number with at most `digits` digits, but at least one. [`f64::floor`] or [`f64::ceil`]
/// selects the side. A number that is not positive stays unchanged.
#[must_use]
pub fn digits(x: f64, digits: u8, round: fn(f64) -> f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return x;
    }
    #[allow(clippy::cast_possible_truncation)]
    let places = i32::from(digits) - 1 - x.log10().floor() as i32;
    match places >= 0 {
        true => round(x * 10_f64.powi(places)) / 10_f64.powi(places),
        false => round(x / 10_f64.powi(-places)) * 10_f64.powi(-places),
    }
}

/// Four decimals, or three digits of a small number, rounded up: for a bound.
#[must_use]
pub fn above(x: f64) -> String {
    fixed(x, places(x, 4), Towards::Above)
}

/// The number with `places` decimals.
#[must_use]
pub fn fixed(x: f64, places: usize, to: Towards) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    let (cut, _) = cut(&format!("{:.ALL$}", x.abs()), places, grows(x, to));
    signed(x, cut)
}

/// The number in the form `1.5e-3`, with `places` decimals.
#[must_use]
pub fn scientific(x: f64, places: usize, to: Towards) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    let exact = format!("{:.ALL$e}", x.abs());
    let (mantissa, exponent) = exact.split_once('e').unwrap_or((&exact, "0"));
    let (cut, carried) = cut(mantissa, places, grows(x, to));
    let exponent = exponent.parse::<i32>().unwrap_or_default();
    match carried {
        // 9.99 became 10.00.
        true => signed(x, format!("1.{:0<places$}e{}", "", exponent + 1)),
        false => signed(x, format!("{cut}e{exponent}")),
    }
}

fn grows(x: f64, to: Towards) -> bool {
    (to == Towards::Above) != (x < 0.0)
}

fn signed(x: f64, text: String) -> String {
    if x < 0.0 {
        format!("-{text}")
    } else {
        text
    }
}

/// A decimal that is cut after `places`, and whether rounding added a digit. The last place is
/// increased by one if `up` is set and the rest is not zero.
fn cut(exact: &str, places: usize, up: bool) -> (String, bool) {
    let (whole, behind) = exact.split_once('.').unwrap_or((exact, ""));
    let (kept, rest) = behind.split_at(places.min(behind.len()));
    let mut digits: Vec<u8> = whole.bytes().chain(kept.bytes()).collect();
    let mut carry = up && rest.bytes().any(|digit| digit != b'0');
    for digit in digits.iter_mut().rev() {
        if !carry {
            break;
        }
        carry = *digit == b'9';
        *digit = if carry { b'0' } else { *digit + 1 };
    }
    if carry {
        digits.insert(0, b'1');
    }
    let mut text: String = digits.into_iter().map(char::from).collect();
    if !kept.is_empty() {
        text.insert(text.len() - kept.len(), '.');
    }
    (text, carry)
}

#[cfg(test)]
mod tests {
    use super::Towards::{Above, Below};
    use super::*;

    #[test]
    fn a_number_of_few_digits_lies_on_its_side() {
        assert_eq!(digits(0.123_45, 3, f64::floor), 0.123);
        assert_eq!(digits(0.123_45, 3, f64::ceil), 0.124);
        assert_eq!(digits(12_345.0, 4, f64::floor), 12_340.0);
        assert_eq!(digits(12_345.0, 4, f64::ceil), 12_350.0);
        assert_eq!(digits(9.999_6, 4, f64::ceil), 10.0);
        assert_eq!(digits(-1.5, 1, f64::ceil), -1.5);
        assert_eq!(digits(f64::INFINITY, 1, f64::ceil), f64::INFINITY);
    }

    #[test]
    fn decimals_lie_on_their_side_of_the_number() {
        assert_eq!(fixed(0.264_222_85, 4, Above), "0.2643");
        assert_eq!(fixed(0.264_222_85, 4, Below), "0.2642");
        assert_eq!(fixed(9.999_96, 4, Above), "10.0000");
        assert_eq!(fixed(0.5, 4, Above), "0.5000");
        assert_eq!(fixed(-1.23, 1, Above), "-1.2");
        assert_eq!(fixed(-1.23, 1, Below), "-1.3");
        assert_eq!(fixed(2.5, 0, Above), "3");
        // The double beside 0.1 is above it.
        assert_eq!(fixed(0.1, 1, Above), "0.2");
        assert_eq!(fixed(0.1, 1, Below), "0.1");
        assert_eq!(scientific(0.264_222_85, 6, Above), "2.642229e-1");
        assert_eq!(scientific(0.264_222_85, 6, Below), "2.642228e-1");
        assert_eq!(scientific(9.99e5, 1, Above), "1.0e6");
        assert_eq!(scientific(0.0, 6, Above), "0.000000e0");
        assert_eq!(scientific(1.0, 6, Above), "1.000000e0");
        assert_eq!(scientific(5e-324, 1, Below), "4.9e-324");
        assert_eq!(scientific(f64::INFINITY, 1, Below), "inf");
    }
}
