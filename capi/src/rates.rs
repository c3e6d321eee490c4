//! Velocity and acceleration from position samples.

use crate::object::{kept, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_rates, told, Refused};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core_bowden::signal::{Rates, RatesState};

/// Room of a bowden_rates_f32, in words of 64 bits.
pub const BOWDEN_RATES_F32_WORDS: usize = 10;
/// Room of a bowden_rates_f64, in words of 64 bits.
pub const BOWDEN_RATES_F64_WORDS: usize = 16;

macro_rules! rates {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Rates with their state; made by bowden_rates_init.
            #[repr(C)]
            pub struct [<bowden_rates_ $f>] {
                /// Not for use.
                pub opaque: [u64; [<BOWDEN_RATES_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_rates_ $f>] {
                type Inner = (Rates<$f>, RatesState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// What a step of the rates gives.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_rates_output_ $f>] {
                /// Position (unwrapped), velocity and acceleration; finite, zero before the
                /// first good sample.
                pub motion: [<bowden_motion_ $f>],
                /// What the step did: the same as it returns.
                pub result: bowden_result,
                /// What was wrong.
                pub fault: bowden_fault,
            }

            /// Starts rates: two lags of `time_constant` above zero [s], see
            /// bowden_rates_step.
            ///
            /// `period` [channel unit] where the position wraps around, as a counter does; 0
            /// where it does not. `longest_gap` [s] is the longest time between two good samples
            /// that is bridged; 0 for ten time constants. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_rates_init_ $f>](
                rates: *mut [<bowden_rates_ $f>],
                time_constant: $f,
                period: $f,
                longest_gap: $f,
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    let mut own = Rates::try_new(time_constant)?;
                    if period != 0.0 {
                        own = own.with_period(period)?;
                    }
                    if longest_gap != 0.0 {
                        own = own.with_longest_gap(longest_gap)?;
                    }
                    Ok((own, RatesState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(rates, inner)?)), about) }
            }

            /// The motion at a position [channel unit] that came `dt` [s] after the last call,
            /// good or bad:
            ///
            ///     s  = 1 - exp(-h/tau),  h = time since the last good sample
            ///     v+ = v + s*((x - x_last)/h - v)
            ///     a+ = a + s*((v+ - v)/h - a)
            ///
            /// A bad sample holds the last good motion: BOWDEN_RESULT_HELD. `out` is written with
            /// every result that is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_rates_step_ $f>](
                rates: *mut [<bowden_rates_ $f>],
                position: $f,
                dt: $f,
                out: *mut [<bowden_rates_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(rates)?;
                    let output = own.step(state, position, dt);
                    let (result, fault) = of_rates(output.status);
                    let motion = [<bowden_motion_ $f>]::of(output.motion);
                    write(out, [<bowden_rates_output_ $f>] { motion, result, fault })?;
                    Ok(result)
                })())
            }
        }
    };
}
rates!(f32, 0x7261_7465_6633_3220);
rates!(f64, 0x7261_7465_6636_3420);
