//! Plausibility of a finite reading from a sensor.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{Implausible, Plausible, PlausibleState};

/// Size of a bowden_plausible_f32 in 64-bit words.
pub const BOWDEN_PLAUSIBLE_F32_WORDS: usize = 8;
/// Size of a bowden_plausible_f64 in 64-bit words.
pub const BOWDEN_PLAUSIBLE_F64_WORDS: usize = 14;

/// Why a sample is implausible.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_implausible {
    /// The sample is plausible.
    None = 0,
    /// It is NaN or infinite.
    NotFinite = 1,
    /// It lies outside the range.
    OutOfRange = 2,
    /// It is further from the last plausible sample than the rate allows.
    TooFast = 3,
    /// It has kept the same value for too long while the machine moved.
    Stuck = 4,
    /// A reason from a later version.
    Other = 5,
}

impl From<Implausible> for bowden_implausible {
    fn from(reason: Implausible) -> Self {
        match reason {
            Implausible::NotFinite => Self::NotFinite,
            Implausible::OutOfRange => Self::OutOfRange,
            Implausible::TooFast => Self::TooFast,
            Implausible::Stuck => Self::Stuck,
            _ => Self::Other,
        }
    }
}

macro_rules! plausible {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// A check of samples with its state; initialised by bowden_plausible_init.
            #[repr(C)]
            pub struct [<bowden_plausible_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_PLAUSIBLE_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_plausible_ $f>] {
                type Inner = (Plausible<$f>, PlausibleState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of a check of samples.
            ///
            /// Start from NAME_INIT. By default only the range is checked; low and high must be
            /// set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_plausible_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Lower end of the plausible range [signal unit].
                pub low: $f,
                /// Upper end of the plausible range [signal unit]; above `low`.
                pub high: $f,
                /// Largest rate of the signal, above zero [signal unit/s]; 0 for none. Do not use
                /// it for an angle that wraps.
                pub rate: $f,
                /// Longest time of the sensor from one reading to the next, including jitter, above
                /// zero [s]; 0 if unknown. If it is set, a repeated reading is taken to be at most
                /// this old. Without a rate this setting has no effect.
                pub sample_period: $f,
                /// Number of equal samples in a row that mean a stuck sensor, counted while the
                /// machine moves; 0 for never.
                pub stuck_after: u32,
                /// A longer or unusable dt counts as this dt, above zero [s]; with 0, such a time
                /// is unknown.
                pub longest_dt: $f,
            }

            marked!([<bowden_plausible_settings_ $f>]);

            impl [<bowden_plausible_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        low: $f::MAX,
                        high: $f::MIN,
                        rate: 0.0,
                        sample_period: 0.0,
                        stuck_after: 0,
                        longest_dt: 0.0,
                    }
                }
            }

            /// Output of a check of a sample.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_plausible_output_ $f>] {
                /// The sample, or NaN if it is not plausible; for a controller, NaN is a bad
                /// sample.
                pub value: $f,
                /// Status of the step, equal to its return value.
                pub result: bowden_result,
                /// Why the sample is implausible.
                pub reason: bowden_implausible,
            }

            /// Checks the settings and starts a check of samples. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_plausible_init_ $f>](
                plausible: *mut [<bowden_plausible_ $f>],
                settings: *const [<bowden_plausible_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    // SAFETY: the caller's rule of pointers.
                    let s = unsafe { read_settings(settings)? };
                    let mut own = Plausible::try_new(s.low, s.high)?.with_stuck_after(s.stuck_after);
                    if s.rate != 0.0 {
                        own = own.with_rate(s.rate)?;
                    }
                    if s.sample_period != 0.0 {
                        own = own.with_sample_period(s.sample_period)?;
                    }
                    if s.longest_dt != 0.0 {
                        own = own.with_longest_dt(s.longest_dt)?;
                    }
                    Ok((own, PlausibleState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(plausible, inner)?)), about) }
            }

            /// Checks a sample [signal unit], `dt` [s] after the last call. Set `moves` to 1 while
            /// the machine moves, so that the signal must change.
            ///
            /// BOWDEN_RESULT_IMPLAUSIBLE: the sample is implausible, and the value is NaN. `out` is
            /// written if the result is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_plausible_step_ $f>](
                plausible: *mut [<bowden_plausible_ $f>],
                sample: $f,
                dt: $f,
                moves: u32,
                out: *mut [<bowden_plausible_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(plausible)?;
                    let output = own.step(state, sample, dt, moves != 0);
                    let (result, reason) = match output.fault {
                        None => (bowden_result::Ok, bowden_implausible::None),
                        Some(reason) => (bowden_result::Implausible, reason.into()),
                    };
                    let value = output.value;
                    write(out, [<bowden_plausible_output_ $f>] { value, result, reason })?;
                    Ok(result)
                })())
            }
        }
    };
}
plausible!(f32, 0x706c_6175_6633_3220);
plausible!(f64, 0x706c_6175_6636_3420);
