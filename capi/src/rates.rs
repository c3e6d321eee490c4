//! Velocity and acceleration from position samples.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_rates, told, Refused};
use crate::settings::{marked, Marked};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core_bowden::signal::{Rates, RatesState};

/// Size of bowden_rates_f32 in 64-bit words.
pub const BOWDEN_RATES_F32_WORDS: usize = 10;
/// Size of bowden_rates_f64 in 64-bit words.
pub const BOWDEN_RATES_F64_WORDS: usize = 16;

macro_rules! rates {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Velocity and acceleration estimator with its state.
            #[repr(C)]
            pub struct [<bowden_rates_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_RATES_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_rates_ $f>] {
                type Inner = (Rates<$f>, RatesState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of the velocity and acceleration estimates. Velocity and acceleration are
            /// filtered by two first-order lags with the same time constant (see
            /// bowden_rates_step).
            ///
            /// By default the position does not wrap, and `longest_gap` is ten time constants. You
            /// must set `time_constant`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_rates_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Time constant of both lags [s], positive.
                pub time_constant: $f,
                /// Period [channel unit] of a position that wraps, such as a counter reading; 0 if
                /// the position does not wrap.
                pub period: $f,
                /// Longest gap between two good samples that the estimates bridge [s]; 0 means ten
                /// time constants.
                pub longest_gap: $f,
            }

            marked!([<bowden_rates_settings_ $f>]);

            impl [<bowden_rates_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        time_constant: 0.0,
                        period: 0.0,
                        longest_gap: 0.0,
                    }
                }
            }

            /// Output of bowden_rates_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_rates_output_ $f>] {
                /// Position (unwrapped), velocity and acceleration: finite, and zero before the
                /// first good sample.
                pub motion: [<bowden_motion_ $f>],
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
            }

            /// Checks the settings and initialises the estimator. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_rates_init_ $f>](
                rates: *mut [<bowden_rates_ $f>],
                settings: *const [<bowden_rates_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    // SAFETY: the caller's rule of pointers.
                    let s = unsafe { read_settings(settings)? };
                    let mut own = Rates::try_new(s.time_constant)?;
                    if s.period != 0.0 {
                        own = own.with_period(s.period)?;
                    }
                    if s.longest_gap != 0.0 {
                        own = own.with_longest_gap(s.longest_gap)?;
                    }
                    Ok((own, RatesState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(rates, inner)?)), about) }
            }

            /// Computes the motion at `position` [channel unit]. `dt` [s] is the time since the
            /// previous call, even if the sample of that call was bad.
            ///
            ///     s  = 1 - exp(-h/time_constant),  h = time since the last good sample
            ///     v+ = v + s*((x - x_last)/h - v)
            ///     a+ = a + s*((v+ - v)/h - a)
            ///
            /// A bad sample holds the last good motion (BOWDEN_RESULT_HELD).
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
