//! Low-pass filters and a notch.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{Biquad, BiquadState, LowPass, LowPassState};
use core_bowden::{Error, Real};

/// Size of a bowden_low_pass_f32 in 64-bit words.
pub const BOWDEN_LOW_PASS_F32_WORDS: usize = 4;
/// Size of a bowden_low_pass_f64 in 64-bit words.
pub const BOWDEN_LOW_PASS_F64_WORDS: usize = 6;
/// Size of a bowden_biquad_f32 in 64-bit words.
pub const BOWDEN_BIQUAD_F32_WORDS: usize = 8;
/// Size of a bowden_biquad_f64 in 64-bit words.
pub const BOWDEN_BIQUAD_F64_WORDS: usize = 14;

/// Whether a filter steps, or holds its output.
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
            /// A first-order low-pass with its state; initialised by bowden_low_pass_init.
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

            /// Starts a low-pass with a `time_constant` of at least zero [s], see
            /// bowden_low_pass_step. At zero the output is the sample. `about` may be null.
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

            /// Processes a sample taken `dt` [s] after the last call; `output` receives
            ///
            ///     y+ = y + dt/(time_constant + dt)*(x - y)
            ///
            /// The corner frequency is 1/(2*pi*time_constant) [Hz]. The first good sample starts
            /// the filter at rest. If the sample is not finite, or dt is not positive and finite,
            /// the last output is held (zero before the first sample): BOWDEN_RESULT_HELD.
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

            /// Settings of a second-order low-pass or notch, with s in units of 2*pi*frequency:
            ///
            ///     low-pass  1/(s^2 + s/q + 1)
            ///     notch     (s^2 + 1)/(s^2 + s/q + 1)
            ///
            /// Start from NAME_INIT; all fields must be set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_biquad_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Corner of the low-pass or centre of the notch, above zero and below
                /// 1/(2*sample_time) [Hz].
                pub frequency: $f,
                /// Quality factor, above zero. Low-pass: 0.7071 for Butterworth, 0.5 for critical
                /// damping. Notch: its width at -3 dB is frequency/q [Hz].
                pub q: $f,
                /// Nominal sample time, above zero [s].
                pub sample_time: $f,
            }

            marked!([<bowden_biquad_settings_ $f>]);

            impl [<bowden_biquad_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
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

            /// A second-order filter with its state; initialised by bowden_biquad_init_low_pass or
            /// bowden_biquad_init_notch.
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

            /// Checks the settings and starts a low-pass. `about` may be null.
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

            /// Checks the settings and starts a notch. `about` may be null.
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

            /// Filters a sample that was taken `dt` [s] after the last call; `output` receives the
            /// result.
            ///
            /// The first good sample starts the filter at rest. If the sample is not finite, or dt
            /// is not positive and finite, the last output is held (zero before the first sample):
            /// BOWDEN_RESULT_HELD.
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
