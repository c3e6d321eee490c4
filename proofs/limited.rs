//! What `slew_limit_any_rate` proves of `Limits::apply`, for the rows of the controllers.
//!
//! Their solver would not see that two products of slew rate and dt are the same one. So
//! `apply` returns any command of the range here and keeps what it was asked, and the
//! property's [`follows`](super::properties::control::follows) is whether it was asked for the
//! command before and the dt of the sample, and its answer went out.

use crate::control::Limits;
use crate::Real;
use core::sync::atomic::{AtomicU64, Ordering};

/// Last call: the command before, dt, and the answer; the bits, for a stub has no other memory.
static LAST: AtomicU64 = AtomicU64::new(0);
static DT: AtomicU64 = AtomicU64::new(0);
static COMMAND: AtomicU64 = AtomicU64::new(0);

/// Any command of the range, or of no range where what is wanted is NaN.
///
/// That the command before and dt do not matter for it is `slew_limit_from_any_command`.
pub(crate) fn apply<T: Real>(limits: &Limits<T>, last: T, wanted: T, dt: T) -> T {
    let command: f32 = kani::any();
    let there = T::from_f64(command.into());
    kani::assume(wanted.is_nan() || limits.contains(there));
    LAST.store(last.as_f64().to_bits(), Ordering::Relaxed);
    DT.store(dt.as_f64().to_bits(), Ordering::Relaxed);
    COMMAND.store(there.as_f64().to_bits(), Ordering::Relaxed);
    there
}

/// Whether the command is the answer to this question, or keeps any slew rate: it stays where
/// it was, the one before it was outside of the range, or there is none.
pub(crate) fn follows(limits: &Limits<f32>, last: f32, command: f32, dt: f32) -> bool {
    let is = |cell: &AtomicU64, x: f32| cell.load(Ordering::Relaxed) == f64::from(x).to_bits();
    let asked = is(&LAST, last) && is(&DT, dt) && is(&COMMAND, command);
    let free = limits.slew().is_none() || command == last || !limits.contains(last);
    asked || (free && limits.contains(command))
}
