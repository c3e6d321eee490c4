//! The disturbance observer: estimates and compensates friction and load.

use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core_bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};

/// Size of a bowden_observer_f32 in 64-bit words.
pub const BOWDEN_OBSERVER_F32_WORDS: usize = 14;
/// Size of a bowden_observer_f64 in 64-bit words.
pub const BOWDEN_OBSERVER_F64_WORDS: usize = 25;

macro_rules! observer {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// An observer with its state; initialised by bowden_observer_init.
            #[repr(C)]
            pub struct [<bowden_observer_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_OBSERVER_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_observer_ $f>] {
                type Inner = (DisturbanceObserver<$f>, ObserverState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of a disturbance observer. The nominal plant from command to output is
            ///
            ///     P(s) = gain/(s^2/wn^2 + 2*zeta*s/wn + 1)
            ///
            /// for a motor with inertia J and damping c that works against a stiffness K: wn =
            /// sqrt(K/J), zeta = c/(2*sqrt(K*J)). If wn and gain are uncertain, choose low values.
            ///
            /// Start from NAME_INIT. By default the latency is 0; all other fields must be set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Gain of the nominal plant, not zero [output unit/command unit].
                pub gain: $f,
                /// wn of the nominal plant, above zero [rad/s].
                pub natural_frequency: $f,
                /// zeta of the nominal plant, zero or above.
                pub damping_ratio: $f,
                /// tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
                pub time_constant: $f,
                /// Largest magnitude of the estimate, above zero [command unit].
                pub limit: $f,
                /// Longest dt of a good sample, above zero [s].
                pub longest_dt: $f,
                /// Time from a command to its effect in the measured output, without the response
                /// of the nominal plant; zero or above [s].
                pub latency: $f,
            }

            marked!([<bowden_observer_settings_ $f>]);

            impl [<bowden_observer_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        gain: 0.0,
                        natural_frequency: 0.0,
                        damping_ratio: -1.0,
                        time_constant: 0.0,
                        limit: 0.0,
                        longest_dt: 0.0,
                        latency: 0.0,
                    }
                }
            }

            /// Output of a step of an observer.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_output_ $f>] {
                /// Value to add to the command through the feed_forward of a controller [command
                /// unit]: always finite and within the limit.
                pub estimate: $f,
                /// Status of the step, equal to its return value.
                pub result: bowden_result,
                /// The bad input, if there is one.
                pub fault: bowden_fault,
            }

            /// Starts an observer. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_observer_init_ $f>](
                observer: *mut [<bowden_observer_ $f>],
                settings: *const [<bowden_observer_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    // SAFETY: the caller's rule of pointers.
                    let s = unsafe { read_settings(settings)? };
                    let plant =
                        NominalPlant::try_new(s.gain, s.natural_frequency, s.damping_ratio)?;
                    let own =
                        DisturbanceObserver::try_new(plant, s.time_constant, s.limit, s.longest_dt)?
                            .with_latency(s.latency)?;
                    Ok((own, ObserverState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(observer, inner)?)), about) }
            }

            /// Processes one sample; call it before the controller's step, with `dt` since the last
            /// call [s], the applied command of the last call after all limits [command unit], and
            /// the measured output [output unit].
            ///
            /// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written if the result
            /// is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_observer_step_ $f>](
                observer: *mut [<bowden_observer_ $f>],
                dt: $f,
                sent: $f,
                measured: $f,
                out: *mut [<bowden_observer_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(observer)?;
                    let output = own.step(state, &ObserverInput { dt, sent, measured });
                    let (result, fault, _) = of_status(output.status);
                    let estimate = output.command;
                    write(out, [<bowden_observer_output_ $f>] { estimate, result, fault })?;
                    Ok(result)
                })())
            }

            /// The command [command unit] for which the nominal plant follows the desired output,
            /// given with its rates and ahead of time by the latency.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_observer_feed_forward_ $f>](
                observer: *const [<bowden_observer_ $f>],
                wanted: *const [<bowden_motion_ $f>],
                command: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let wanted = read(wanted)?.motion();
                    let (own, _) = seen(observer)?;
                    write(command, own.plant().feed_forward(&wanted))?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Resets the state to the start. Call this function after the drive was off, because a
            /// command that did not reach the motor must not count.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_observer_reset_ $f>](
                observer: *mut [<bowden_observer_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(observer)?.1 = ObserverState::new();
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
observer!(f32, 0x6f62_7365_6633_3220);
observer!(f64, 0x6f62_7365_6636_3420);
