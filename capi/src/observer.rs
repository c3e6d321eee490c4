//! The disturbance observer: what friction and load take from a command.

use crate::object::{kept, read, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core_bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};

/// Room of a bowden_observer_f32, in words of 64 bits.
pub const BOWDEN_OBSERVER_F32_WORDS: usize = 14;
/// Room of a bowden_observer_f64, in words of 64 bits.
pub const BOWDEN_OBSERVER_F64_WORDS: usize = 25;

macro_rules! observer {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// An observer with its state; made by bowden_observer_init.
            #[repr(C)]
            pub struct [<bowden_observer_ $f>] {
                /// Not for use.
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
            /// of a motor with inertia J and damping c that works against a stiffness K:
            /// wn = sqrt(K/J), zeta = c/(2*sqrt(K*J)). Where they are uncertain, err low with wn and gain.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_settings_ $f>] {
                /// Of the nominal plant, not zero [output unit/command unit].
                pub gain: $f,
                /// wn of the nominal plant, above zero [rad/s].
                pub natural_frequency: $f,
                /// zeta of the nominal plant, not below zero.
                pub damping_ratio: $f,
                /// tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
                pub time_constant: $f,
                /// Greatest magnitude of the estimate, above zero [command unit].
                pub limit: $f,
                /// Longest dt that is a sample, above zero [s].
                pub longest_dt: $f,
                /// How long a command takes to show in the measured output, beside what the nominal
                /// plant takes; not below zero [s].
                pub latency: $f,
            }

            /// What a step of an observer gives.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_output_ $f>] {
                /// To be added to the command, as feed_forward of a controller [command unit];
                /// finite and within the limit in any case.
                pub estimate: $f,
                /// What the step did: the same as it returns.
                pub result: bowden_result,
                /// What was wrong.
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
                    let s = unsafe { read(settings)? };
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

            /// One sample, before the controller's own: `dt` since the last call [s], the command
            /// that went out at the last call behind all limits [command unit], the measured
            /// output [output unit].
            ///
            /// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written with every
            /// result that is not negative.
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
                    let estimate = output.estimate;
                    write(out, [<bowden_observer_output_ $f>] { estimate, result, fault })?;
                    Ok(result)
                })())
            }

            /// The command that makes the nominal plant follow, [command unit]: of the output that
            /// is wanted with its rates, taken as far ahead as the latency.
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

            /// The state of the start again: where the drive was off, for a command that did not
            /// reach the motor is no command.
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
