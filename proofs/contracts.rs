//! What a proof may assume of libm's functions, and no more.
//!
//! Each is a predicate on argument and value. A stub returns any value that satisfies it;
//! `tests/exhaustive.rs` asks it of the shipped function at all 2³² arguments. One
//! definition, so that a proof cannot assume what was not checked.

/// tanh: within [-1, 1], the sign of x, and never further from zero than x by an ulp.
pub fn tanhf(x: f32, y: f32) -> bool {
    if x.is_nan() {
        return y.is_nan();
    }
    let grown = x.abs() * (1.0 + f32::EPSILON);
    y.abs() <= 1.0 && y.abs() <= grown && y.is_sign_negative() == x.is_sign_negative()
}

/// e^x - 1: at or below zero within [-1, 0], above zero not negative.
pub fn expm1f(x: f32, y: f32) -> bool {
    if x.is_nan() {
        y.is_nan()
    } else if x <= 0.0 {
        (-1.0..=0.0).contains(&y)
    } else {
        y >= 0.0
    }
}

/// ln(1 + x): for x ≥ 0 from 0 to x, so finite where x is.
pub fn log1pf(x: f32, y: f32) -> bool {
    x.is_nan() || x < 0.0 || (0.0 <= y && y <= x)
}

/// Square root: for x ≥ 0 between x and 1, so finite where x is.
pub fn sqrtf(x: f32, y: f32) -> bool {
    x.is_nan() || x < 0.0 || (x <= y && y <= 1.0) || (1.0 <= y && y <= x)
}

/// Arc tangent: within ±1.571 with the sign of x.
pub fn atanf(x: f32, y: f32) -> bool {
    x.is_nan() || (y.abs() <= 1.571 && y.is_sign_negative() == x.is_sign_negative())
}

/// Tangent: finite for every finite x.
pub fn tanf(x: f32, y: f32) -> bool {
    !x.is_finite() || y.is_finite()
}
