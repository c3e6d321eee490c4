//! Plausibility check of sensor samples.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{Implausible, Plausible, PlausibleState};

/// Size of bowden_plausible_f32 in 64-bit words.
pub const BOWDEN_PLAUSIBLE_F32_WORDS: usize = 8;
/// Size of bowden_plausible_f64 in 64-bit words.
pub const BOWDEN_PLAUSIBLE_F64_WORDS: usize = 14;

/// Reason why a sample is implausible.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_implausible {
    /// The sample is plausible.
    None = 0,
    /// The sample is NaN or infinite.
    NotFinite = 1,
    /// The sample lies outside the range.
    OutOfRange = 2,
    /// The sample is further from the last plausible sample than `rate` allows.
    TooFast = 3,
    /// The sample has kept the same value for too long while the machine moved.
    Stuck = 4,
    /// Reserved for reasons that a later version adds.
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
            /// Plausibility check with its state.
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

            /// Settings of a plausibility check.
            ///
            /// By default the check covers only the range. You must set `low` and `high`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_plausible_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Lower end of the plausible range [signal unit].
                pub low: $f,
                /// Upper end of the plausible range [signal unit], above `low`.
                pub high: $f,
                /// Largest plausible rate of change [signal unit/s], at least 0; 0 disables this
                /// check. Do not check the rate of an angle that wraps.
                pub rate: $f,
                /// Longest time between two readings of the sensor [s], including jitter; 0 if
                /// unknown. If it is known, a repeated reading is assumed to be at most this old.
                /// This setting has no effect without `rate`.
                pub sample_period: $f,
                /// Number of repetitions of a reading that indicate a stuck sensor; 0 disables this
                /// check. The check counts repetitions only while the machine moves.
                pub stuck_after: u32,
                /// This dt [s], at least 0, replaces a dt that is longer, negative or not finite.
                /// With 0, no dt is replaced, and the time after a negative or non-finite dt is
                /// unknown.
                pub longest_dt: $f,
            }

            marked!([<bowden_plausible_settings_ $f>]);

            impl [<bowden_plausible_settings_ $f>] {
                /// Returns the defaults.
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

            /// Output of bowden_plausible_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_plausible_output_ $f>] {
                /// The sample, or NaN if it is implausible. A controller treats NaN as a bad
                /// sample.
                pub value: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Reason why the sample is implausible, or BOWDEN_IMPLAUSIBLE_NONE.
                pub reason: bowden_implausible,
            }

            /// Checks the settings and initialises a plausibility check. `about` may be null.
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

            /// Checks a sample [signal unit] taken `dt` [s] after the previous call. Set `moves` to
            /// 1 while the machine moves and the signal must therefore change.
            ///
            /// The value of an implausible sample is NaN (BOWDEN_RESULT_IMPLAUSIBLE).
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
