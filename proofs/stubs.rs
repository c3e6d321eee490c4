//! Stand-ins for libm's functions, which the solver could not follow or has wrong.

use super::contracts;

/// Any value that `contract` admits at `x`.
fn any_of(contract: fn(f32, f32) -> bool, x: f32) -> f32 {
    kani::any_where(|y: &f32| contract(x, *y))
}

/// Any value within the contract of tanh.
pub(crate) fn tanhf(x: f32) -> f32 {
    any_of(contracts::tanhf, x)
}

/// Any value within the contract of e^x - 1.
pub(crate) fn expm1f(x: f32) -> f32 {
    any_of(contracts::expm1f, x)
}

/// Any value within the contract of ln(1 + x).
pub(crate) fn log1pf(x: f32) -> f32 {
    any_of(contracts::log1pf, x)
}

/// Any value within the contract of the square root.
pub(crate) fn sqrtf(x: f32) -> f32 {
    any_of(contracts::sqrtf, x)
}

/// Any value within the contract of the arc tangent.
pub(crate) fn atanf(x: f32) -> f32 {
    any_of(contracts::atanf, x)
}

/// Any value within the contract of the tangent.
pub(crate) fn tanf(x: f32) -> f32 {
    any_of(contracts::tanf, x)
}

/// Any float at all, NaN included: nothing is assumed.
pub(crate) fn garbage(_: f32) -> f32 {
    kani::any()
}

/// The same of two arguments.
pub(crate) fn garbage_of_two(_: f32, _: f32) -> f32 {
    kani::any()
}

/// The same for any float.
pub(crate) fn garbage_of_two_real<T: crate::Real>(_: T, _: T) -> T {
    T::from_f64(kani::any::<f32>().into())
}

/// Any float for `wrapped`, and none for a difference that is none:
/// `wrapped_of_no_number_is_none` proves it of the real one.
pub(crate) fn any_turn<T: crate::Real>(difference: T, _: T) -> T {
    if difference.is_finite() {
        T::from_f64(kani::any::<f32>().into())
    } else {
        T::nan()
    }
}
