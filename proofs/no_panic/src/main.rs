//! Links only if no public function of the core can panic, in `f32` and `f64`.
//!
//! Each call stands between a guard and its `forget`. Only a panic drops the guard, and
//! dropping it calls an external function that nobody defines. So the linker refuses the
//! program, with the name of the function that can panic, unless the optimiser has shown
//! that no path to a panic is left. Arguments go through `black_box`: any value of their
//! type that was constructed, not the one that is written here.
//!
//! Names are file and function, `signal/play.rs` and `step`: `check` compares them with the
//! sources, so that a new function cannot be forgotten. Nothing here is meant to be run.

mod bound;
mod control;
mod effect;
mod hysteresis;
mod model;
mod rig;
mod signal;
mod transmission;

use bowden::Real;
use std::hint::black_box;

/// The call, between a guard and its `forget`.
#[macro_export]
macro_rules! never_panics {
    ($name:ident, $call:expr) => {{
        struct Panics;
        impl Drop for Panics {
            fn drop(&mut self) {
                extern "C" {
                    fn $name() -> !;
                }
                // SAFETY: never run; a program with this call does not link.
                unsafe { $name() }
            }
        }
        let guard = Panics;
        let value = $call;
        core::mem::forget(guard);
        let _ = core::hint::black_box(value);
    }};
}

/// Any number, as far as the optimiser knows.
fn any<T: Real>() -> T {
    black_box(T::zero())
}

fn all<T: Real>() -> Option<()> {
    signal::all::<T>()?;
    hysteresis::all::<T>()?;
    transmission::all::<T>()?;
    effect::all::<T>()?;
    model::all::<T>()?;
    control::all::<T>()?;
    bound::all::<T>()?;
    rig::all::<T>()
}

fn main() {
    black_box((all::<f32>(), all::<f64>()));
    #[cfg(feature = "broken")]
    never_panics!(broken, black_box([1, 2, 3])[black_box(3_usize)]);
}
