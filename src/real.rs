//! Floating-point functions for `f32` and `f64`.
//!
//! Arithmetic, comparison, `abs`, `is_finite` and similar functions come from
//! [`num_traits::float::FloatCore`]. The elementary functions come from `libm` or from this crate
//! on every target, so host and firmware compute the same bits.

use core::fmt::{Debug, Display};
use num_traits::float::FloatCore;
use num_traits::NumAssign;

mod angle;
mod short;

/// Methods of a float, each of which calls one function.
macro_rules! calls {
    ($($name:ident($($more:ident)?) = $function:path;)+) => {
        $(
            #[inline]
            fn $name(self $(, $more: Self)?) -> Self {
                $function(self $(, $more)?)
            }
        )+
    };
}
pub(crate) use calls;

/// [`Real::from_f64`] under the name of the `const fn` in the compile-time constructors.
#[inline]
pub(crate) fn of<T: Real>(x: f64) -> T {
    T::from_f64(x)
}

/// [`Real::as_f64`], for the same reason.
#[inline]
pub(crate) fn as_f64<T: Real>(x: T) -> f64 {
    x.as_f64()
}

/// Further floating-point functions for the hysteresis, not part of the public interface.
pub(crate) mod sealed {
    use super::short;

    pub trait Sealed: Sized {
        /// Whether a step must be short (firmware) rather than exact for any jump
        /// (identification).
        const SHORT: bool;
        fn log2(self) -> Self;
        fn exp2(self) -> Self;
        /// The functions of the effects: short if a step must be short, otherwise from libm. The
        /// base of a power is not negative, and the exponent is positive.
        fn short_exp(self) -> Self;
        fn short_pow(self, exponent: Self) -> Self;
        fn short_tanh(self) -> Self;
        /// tanh with the sign of its argument x and a magnitude of at most min(|x|, 1).
        fn confined_tanh(self) -> Self;
        /// Base-2 logarithm, linear between the powers of 2.
        fn coarse_log2(self) -> Self;
        /// A power, computed with the same linear interpolation.
        fn coarse_power(self, exponent: Self) -> Self;
        /// The largest power of 2 that does not exceed a positive number.
        fn binade(self) -> Self;
        /// Whether the number is positive and at most `longest`, which is positive. One comparison
        /// of bits excludes negative numbers, infinities and NaN.
        fn positive_up_to(self, longest: Self) -> bool;
        /// Whether the number is positive and below the highest float, also by one comparison.
        fn positive_below_highest(self) -> bool;
    }

    /// The functions that read the bits of a float, from the mask of its sign and exponent.
    macro_rules! bits {
        ($sign_and_exponent:literal) => {
            #[inline]
            fn binade(self) -> Self {
                Self::from_bits(self.to_bits() & $sign_and_exponent)
            }
            #[inline]
            fn positive_up_to(self, longest: Self) -> bool {
                self.to_bits().wrapping_sub(1) < longest.to_bits()
            }
            #[inline]
            fn positive_below_highest(self) -> bool {
                self.to_bits().wrapping_sub(1) < Self::MAX.to_bits() - 1
            }
        };
    }

    impl Sealed for f32 {
        const SHORT: bool = true;
        calls! {
            log2() = short::log2;
            exp2() = short::exp2;
            short_exp() = short::exp;
            short_pow(exponent) = short::pow;
            short_tanh() = short::tanh;
            // libm satisfies this at all 2^32 arguments, to a unit in the last place, which the
            // bounds allow for: `tests/exhaustive.rs`.
            confined_tanh() = libm::tanhf;
            coarse_log2() = short::coarse_log2;
            coarse_power(exponent) = short::coarse_power;
        }
        bits!(0xff80_0000);
    }

    impl Sealed for f64 {
        const SHORT: bool = false;
        calls! {
            log2() = libm::log2;
            exp2() = libm::exp2;
            short_exp() = libm::exp;
            short_pow(exponent) = libm::pow;
            short_tanh() = libm::tanh;
        }
        /// The range is enforced for any result of libm, because there are too many arguments to
        /// test.
        #[inline]
        fn confined_tanh(self) -> Self {
            confined(self, libm::tanh(self))
        }
        #[inline]
        fn coarse_log2(self) -> Self {
            (self.to_bits() as i64).wrapping_sub(ONE) as f64 / 4_503_599_627_370_496.0
        }
        #[inline]
        fn coarse_power(self, exponent: Self) -> Self {
            let log = (self.to_bits() as i64).wrapping_sub(ONE) as f64;
            Self::from_bits(((exponent * log) as i64).wrapping_add(ONE) as u64)
        }
        bits!(0xfff0_0000_0000_0000);
    }

    /// A value of tanh at `x` with the sign of `x` and a magnitude of at most min(|x|, 1). NaN
    /// stays NaN.
    #[inline]
    pub(crate) fn confined(x: f64, value: f64) -> f64 {
        let (reach, size) = (libm::fabs(x), libm::fabs(value));
        let most = if reach < 1.0 { reach } else { 1.0 };
        // NaN from an argument that is not NaN becomes the greatest permitted value.
        let size = if size <= most || x.is_nan() {
            size
        } else {
            most
        };
        libm::copysign(size, x)
    }

    /// The bits of 1.
    const ONE: i64 = 0x3ff0_0000_0000_0000;
}

/// A float that the crate can compute with: `f32` or `f64`.
///
/// ```
/// use bowden::Real;
/// fn circumference<T: Real>(radius: T) -> T {
///     T::from_f64(2.0 * core::f64::consts::PI) * radius
/// }
/// assert!((circumference(1.0_f32) - 6.283_185_5).abs() < 1e-6);
/// ```
pub trait Real:
    FloatCore + NumAssign + Debug + Display + Default + Send + Sync + 'static + sealed::Sealed
{
    /// Zero; a constant, so configurations can be built at compile time.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// The lowest finite value.
    const LOWEST: Self;
    /// The highest finite value.
    const HIGHEST: Self;
    /// The value nearest to `x`.
    fn from_f64(x: f64) -> Self;
    /// The value as `f64`, exact.
    fn as_f64(self) -> f64;
    /// e to the power of `self`.
    fn exp(self) -> Self;
    /// e to the power of `self`, minus one; accurate near zero.
    fn exp_m1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Natural logarithm of one plus `self`; accurate near zero.
    fn ln_1p(self) -> Self;
    /// `self` to the power of `exponent`.
    fn pow(self, exponent: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Arc tangent in radians.
    fn atan(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
}

macro_rules! real {
    ($float:ty, $($functions:tt)+) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const LOWEST: Self = <$float>::MIN;
            const HIGHEST: Self = <$float>::MAX;
            #[inline]
            #[allow(clippy::cast_possible_truncation)]
            fn from_f64(x: f64) -> Self {
                x as $float
            }
            #[inline]
            fn as_f64(self) -> f64 {
                self.into()
            }
            calls! { $($functions)+ }
        }
    };
}

real! {
    f32,
    exp() = libm::expf;
    exp_m1() = libm::expm1f;
    ln() = libm::logf;
    ln_1p() = libm::log1pf;
    pow(exponent) = libm::powf;
    sqrt() = libm::sqrtf;
    sin() = angle::sin;
    cos() = angle::cos;
    tan() = libm::tanf;
    atan() = libm::atanf;
    tanh() = libm::tanhf;
}
real! {
    f64,
    exp() = libm::exp;
    exp_m1() = libm::expm1;
    ln() = libm::log;
    ln_1p() = libm::log1p;
    pow(exponent) = libm::pow;
    sqrt() = libm::sqrt;
    sin() = libm::sin;
    cos() = libm::cos;
    tan() = libm::tan;
    atan() = libm::atan;
    tanh() = libm::tanh;
}

#[cfg(test)]
mod tests {
    use super::sealed::{confined, Sealed};
    use proptest::prelude::*;

    proptest! {
        /// Any result that libm might return.
        #[test]
        fn any_value_is_confined_to_its_argument(x in any::<f64>(), value in any::<f64>()) {
            let t = confined(x, value);
            prop_assert!(t.abs() <= 1.0 && t.abs() <= x.abs());
            prop_assert_eq!(t.is_sign_negative(), x.is_sign_negative());
        }

        /// The comparison of bits is the two comparisons of numbers.
        #[test]
        fn a_step_is_above_zero_and_at_most_the_longest(
            dt in any::<f32>(), bits in any::<u32>(), longest in 1e-30_f32..1e30, like: bool
        ) {
            for x in [dt, f32::from_bits(bits), if like { longest } else { longest.next_up() }] {
                prop_assert_eq!(x.positive_up_to(longest), x > 0.0 && x <= longest);
                let (wide, most) = (f64::from(x), f64::from(longest));
                prop_assert_eq!(wide.positive_up_to(most), wide > 0.0 && wide <= most);
            }
            for x in [0.0, -0.0, f32::INFINITY, f32::NAN, -f32::NAN, f32::NEG_INFINITY] {
                prop_assert!(!x.positive_up_to(f32::MAX) && !f64::from(x).positive_up_to(f64::MAX));
            }
            for x in [dt, f32::from_bits(bits), f32::MAX, f32::MAX.next_down(), 0.0, -0.0] {
                let is_one = x > 0.0 && x < f32::MAX;
                prop_assert_eq!(x.positive_below_highest(), is_one);
            }
            for x in [f64::MAX, f64::MAX.next_down(), f64::INFINITY, f64::NAN, -1.0, 1.0] {
                prop_assert_eq!(x.positive_below_highest(), x > 0.0 && x < f64::MAX);
            }
            prop_assert!(f32::from_bits(1).positive_up_to(longest) && f64::from_bits(1).positive_up_to(1.0));
        }

        /// A correct result of libm stays the same to the bit.
        #[test]
        fn a_right_value_keeps_its_bits(x in any::<f64>()) {
            let value = libm::tanh(x);
            if value.abs() <= x.abs() || x.is_nan() {
                prop_assert_eq!(x.confined_tanh().to_bits(), value.to_bits());
            }
        }
    }

    /// libm's value is further from zero than its argument by a unit in the last place at
    /// some arguments near 1e-8: those become the argument itself, and nothing else changes.
    #[test]
    fn on_a_grid_only_what_is_beyond_its_argument_changes() {
        let (mut kept, mut mended) = (0, 0);
        for step in -400_000..=400_000_i32 {
            let x = f64::from(step) * 1e-4;
            for x in [x, x * 1e-8, x * 1e-300] {
                let (value, t) = (libm::tanh(x), x.confined_tanh());
                if value.abs() <= x.abs() {
                    assert_eq!(t.to_bits(), value.to_bits(), "{x:e}");
                    kept += 1;
                } else {
                    assert_eq!(t.to_bits(), x.to_bits(), "{x:e}");
                    assert!((value - x).abs() <= 2.0 * f64::EPSILON * x.abs(), "{x:e}");
                    mended += 1;
                }
            }
        }
        assert!(mended > 0 && kept > 100 * mended, "{kept} {mended}");
    }

    #[test]
    fn zeros_keep_their_sign_and_nan_stays_nan() {
        assert_eq!(confined(-0.0, 0.5).to_bits(), (-0.0_f64).to_bits());
        assert_eq!(confined(0.0, -0.5).to_bits(), 0.0_f64.to_bits());
        assert!(confined(f64::NAN, f64::NAN).is_nan());
        assert_eq!(confined(-2.0, f64::NAN), -1.0);
        assert_eq!(confined(f64::INFINITY, 1.0 + f64::EPSILON), 1.0);
    }
}
