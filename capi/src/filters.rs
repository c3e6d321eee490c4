//! Low-pass filters and a notch filter.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{Biquad, BiquadState, LowPass, LowPassState};
use core_bowden::{Error, Real};

/// Size of bowden_low_pass_f32 in 64-bit words.
pub const BOWDEN_LOW_PASS_F32_WORDS: usize = 4;
/// Size of bowden_low_pass_f64 in 64-bit words.
pub const BOWDEN_LOW_PASS_F64_WORDS: usize = 6;
/// Size of bowden_biquad_f32 in 64-bit words.
pub const BOWDEN_BIQUAD_F32_WORDS: usize = 8;
/// Size of bowden_biquad_f64 in 64-bit words.
pub const BOWDEN_BIQUAD_F64_WORDS: usize = 14;

/// The result of a filter step: good, or held because of a bad sample or dt.
fn stepped<T: Real>(sample: T, dt: T) -> bowden_result {
    if sample.is_finite() && dt.is_finite() && dt > T::ZERO {
        bowden_result::Ok
    } else {
        bowden_result::Held
    }
}

macro_rules! filters {
    ($f:ident, $low_pass:literal, $biquad:literal) => {
        pastey::paste! {
            /// First-order low-pass filter with its state.
            #[repr(C)]
            pub struct [<bowden_low_pass_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_LOW_PASS_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_low_pass_ $f>] {
                type Inner = (LowPass<$f>, LowPassState<$f>);
                const MAGIC: u64 = $low_pass;
            }

            /// Initialises a low-pass filter; see bowden_low_pass_step. `time_constant` [s] must be
            /// at least 0; with 0 the output equals the sample. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_low_pass_init_ $f>](
                filter: *mut [<bowden_low_pass_ $f>],
                time_constant: $f,
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    Ok((LowPass::try_new(time_constant)?, LowPassState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(filter, inner)?)), about) }
            }

            /// Processes a sample x taken `dt` [s] after the previous call. The output y is
            ///
            ///     y+ = y + dt/(time_constant + dt)*(x - y)
            ///
            /// The corner frequency is 1/(2*pi*time_constant) [Hz]. At the first good sample, the
            /// filter starts in steady state. If the sample is not finite, or dt is not positive
            /// and finite, the last output is held (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_low_pass_step_ $f>](
                filter: *mut [<bowden_low_pass_ $f>],
                sample: $f,
                dt: $f,
                output: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(output)?;
                    let (own, state) = kept(filter)?;
                    let value = own.step(state, sample, dt);
                    write(output, value)?;
                    Ok(stepped(sample, dt))
                })())
            }

            /// Settings of a second-order low-pass or notch filter, with s in units of
            /// 2*pi*frequency:
            ///
            ///     low-pass  1/(s^2 + s/q + 1)
            ///     notch     (s^2 + 1)/(s^2 + s/q + 1)
            ///
            /// You must set all fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_biquad_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Corner frequency of the low-pass filter or centre frequency of the notch filter
                /// [Hz], positive and below 1/(2*sample_time).
                pub frequency: $f,
                /// Quality factor, positive. Low-pass: 0.7071 for Butterworth, 0.5 for critical
                /// damping. Notch: the width at -3 dB is frequency/q [Hz].
                pub q: $f,
                /// Nominal sampling period [s], positive.
                pub sample_time: $f,
            }

            marked!([<bowden_biquad_settings_ $f>]);

            impl [<bowden_biquad_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        frequency: 0.0,
                        q: 0.0,
                        sample_time: 0.0,
                    }
                }

                fn filter(
                    &self,
                    design: fn($f, $f, $f) -> Result<Biquad<$f>, Error>,
                ) -> Result<(Biquad<$f>, BiquadState<$f>), Refused> {
                    let own = design(self.frequency, self.q, self.sample_time)?;
                    Ok((own, BiquadState::new()))
                }
            }

            /// Second-order filter with its state. Initialise it with bowden_biquad_init_low_pass
            /// or bowden_biquad_init_notch.
            #[repr(C)]
            pub struct [<bowden_biquad_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_BIQUAD_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_biquad_ $f>] {
                type Inner = (Biquad<$f>, BiquadState<$f>);
                const MAGIC: u64 = $biquad;
            }

            /// Checks the settings and initialises a low-pass filter. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_biquad_init_low_pass_ $f>](
                filter: *mut [<bowden_biquad_ $f>],
                settings: *const [<bowden_biquad_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.filter(Biquad::low_pass))
                        .and_then(|parts| Ok(start(filter, parts)?));
                    told(tried, about)
                }
            }

            /// Checks the settings and initialises a notch filter. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_biquad_init_notch_ $f>](
                filter: *mut [<bowden_biquad_ $f>],
                settings: *const [<bowden_biquad_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.filter(Biquad::notch))
                        .and_then(|parts| Ok(start(filter, parts)?));
                    told(tried, about)
                }
            }

            /// Filters a sample taken `dt` [s] after the previous call. `output` receives the
            /// filtered value.
            ///
            /// At the first good sample, the filter starts in steady state. If the sample is not
            /// finite, or dt is not positive and finite, the last output is held
            /// (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_biquad_step_ $f>](
                filter: *mut [<bowden_biquad_ $f>],
                sample: $f,
                dt: $f,
                output: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(output)?;
                    let (own, state) = kept(filter)?;
                    let value = own.step(state, sample, dt);
                    write(output, value)?;
                    Ok(stepped(sample, dt))
                })())
            }
        }
    };
}
filters!(f32, 0x6c6f_7770_6633_3220, 0x6269_7175_6633_3220);
filters!(f64, 0x6c6f_7770_6636_3420, 0x6269_7175_6636_3420);
