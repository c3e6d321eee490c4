//! Intervals of dyadic numbers against exact rationals.

use super::*;
use num_bigint::BigInt;
use num_rational::BigRational;

fn exact(x: Dyadic) -> BigRational {
    let (mantissa, exponent) = x.parts();
    let power = BigInt::from(1) << exponent.unsigned_abs();
    let mantissa = BigInt::from(mantissa);
    if exponent < 0 {
        BigRational::new(mantissa, power)
    } else {
        BigRational::from(mantissa * power)
    }
}

fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

/// Whether an interval holds a number.
fn holds(interval: Enclosure, number: &BigRational) -> bool {
    exact(interval.low) <= *number && *number <= exact(interval.high)
}

fn is_narrow(interval: Enclosure, number: &BigRational) -> bool {
    let width = exact(interval.high) - exact(interval.low);
    let size = number.clone().max(-number.clone());
    width * BigInt::from(1_u64 << 58) <= size
}

/// Any float, of any size, subnormal ones and zero included.
fn any_float() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        -1e3..1e3_f64
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_float_is_itself(x in any_float(), single in any::<f32>()) {
        prop_assert_eq!(exact(Dyadic::of(x)), rational(x));
        prop_assert_eq!(Dyadic::of(x).as_f64(), x);
        if single.is_finite() {
            prop_assert_eq!(exact(Dyadic::of(single)), rational(single.into()));
        }
    }

    #[test]
    fn numbers_are_ordered_as_they_are(x in any_float(), y in any_float()) {
        prop_assert_eq!(Dyadic::of(x).cmp(&Dyadic::of(y)), rational(x).cmp(&rational(y)));
        let (a, b) = (Enclosure::of(x), Enclosure::of(y));
        prop_assert_eq!(a.is_at_most(b), x <= y);
        prop_assert_eq!(exact(a.max(b).high), rational(x.max(y)));
        prop_assert_eq!(exact(a.abs().low), rational(x.abs()));
    }

    #[test]
    fn each_operation_holds_the_exact_result_and_little_else(x in any_float(), y in any_float()) {
        let (a, b, p, q) = (Enclosure::of(x), Enclosure::of(y), rational(x), rational(y));
        for (computed, number) in [(a + b, &p + &q), (a - b, &p - &q), (a * b, &p * &q)] {
            prop_assert!(holds(computed, &number), "{computed:?} {number}");
        }
        prop_assert!(is_narrow(a * b, &(&p * &q)));
        if y != 0.0 {
            let number = &p / &q;
            prop_assert!(holds(a / b, &number), "{:?} {number}", a / b);
            prop_assert!(is_narrow(a / b, &number));
        }
    }

    /// Where the operands are intervals themselves, of either sign.
    #[test]
    fn a_long_computation_holds_its_exact_result(
        numbers in prop::collection::vec((-1e6..1e6_f64, 0_u8..4), 1..40)
    ) {
        let (mut computed, mut number) = (Enclosure::of(1.0), rational(1.0));
        for (x, operation) in numbers {
            let (interval, next) = (Enclosure::of(x) / Enclosure::of(3.0), rational(x) / BigInt::from(3));
            match operation {
                0 => (computed, number) = (computed + interval, number + next),
                1 => (computed, number) = (computed - interval, number - next),
                2 => (computed, number) = (computed * interval, number * next),
                _ if x != 0.0 => (computed, number) = (computed / interval, number / next),
                _ => {}
            }
            prop_assert!(holds(computed, &number), "{computed:?} {number}");
        }
    }
}

#[test]
fn a_quotient_by_what_may_be_zero_is_every_number() {
    let (one, zero) = (Enclosure::of(1.0), Enclosure::of(0.0));
    let third = one / Enclosure::of(3.0);
    for divisor in [zero, third - third] {
        let quotient = one / divisor;
        assert!(quotient.low < Dyadic::of(f64::MIN) && quotient.high > Dyadic::of(f64::MAX));
        assert!(!quotient.is_at_most(Enclosure::of(f64::MAX)));
    }
}

#[test]
fn a_number_is_written_exactly() {
    assert_eq!(Dyadic::of(0.1_f32).to_string(), "13421773*2^-27");
    assert_eq!(Dyadic::of(-96.0).to_string(), "-3*2^5");
    assert_eq!(Dyadic::of(f64::NAN).to_string(), "0*2^0");
}

#[test]
fn numbers_that_differ_in_their_last_bit_alone_are_told_apart() {
    let one = Enclosure::of(1.0);
    for exponent in 1..=61 {
        let half = Enclosure::of(2.0_f64.powi(exponent - 1));
        let (power, before) = (half + half, half - one + half);
        assert_eq!(before.low, before.high, "2^{exponent} - 1 is exact");
        assert!(before.high < power.low, "2^{exponent}");
        assert!(!power.is_at_most(before), "2^{exponent}");
        let (below, above) = (Enclosure::of(0.0) - power, Enclosure::of(0.0) - before);
        assert!(below.high < above.low, "-2^{exponent}");
    }
    // Far apart, of either sign, and zero.
    let (huge, tiny) = (Dyadic::of(1e300), Dyadic::of(1e-300));
    assert!(huge > tiny && Dyadic::of(-1e300) < tiny && Dyadic::of(-1e-300) > Dyadic::of(-1e300));
    assert!(Dyadic::of(0.0) < tiny && Dyadic::of(0.0) > Dyadic::of(-1e300));
}
