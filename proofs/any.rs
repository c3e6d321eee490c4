//! Arbitrary values: the solver's, not a generator's.

use bowden::control::{Fallback, Limits};

/// Any float of a range, subnormals included.
pub(crate) fn within(low: f32, high: f32) -> f32 {
    kani::any_where(|x: &f32| low <= *x && *x <= high)
}

/// Any float that is neither NaN nor infinite.
pub(crate) fn finite() -> f32 {
    kani::any_where(|x: &f32| x.is_finite())
}

/// Any limits that their constructors accept, with or without a slew rate.
pub(crate) fn limits() -> Limits<f32> {
    let range = Limits::try_new(kani::any(), kani::any());
    let slewed = range.and_then(|range| range.with_slew(kani::any()));
    let chosen = if kani::any() { range } else { slewed };
    kani::assume(chosen.is_ok());
    chosen.unwrap_or(Limits::unlimited())
}

/// Any fallback that its constructors accept.
pub(crate) fn fallback() -> Fallback<f32> {
    if kani::any() {
        return Fallback::hold_indefinitely();
    }
    let safe =
        Fallback::try_new(kani::any(), kani::any()).and_then(|safe| safe.with_weight(kani::any()));
    kani::assume(safe.is_ok());
    safe.unwrap_or(Fallback::hold_indefinitely())
}
