//! Disturbance observer: an estimate of friction and load as a feed-forward.

use crate::object::{kept, read, read_settings, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use crate::{bowden_motion_f32, bowden_motion_f64};
use core_bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};

/// Size of bowden_observer_f32 in 64-bit words.
pub const BOWDEN_OBSERVER_F32_WORDS: usize = 14;
/// Size of bowden_observer_f64 in 64-bit words.
pub const BOWDEN_OBSERVER_F64_WORDS: usize = 25;

macro_rules! observer {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Disturbance observer with its state.
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
            /// For a motor with inertia J and damping c that drives a stiffness K, wn = sqrt(K/J)
            /// and zeta = c/(2*sqrt(K*J)). If wn and the gain are uncertain, choose low values.
            ///
            /// By default `latency` is 0. You must set all other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Gain of the nominal plant [output unit/command unit], nonzero.
                pub gain: $f,
                /// wn of the nominal plant [rad/s], positive.
                pub natural_frequency: $f,
                /// zeta of the nominal plant, at least 0.
                pub damping_ratio: $f,
                /// Time constant tau of the filter Q = 1/(tau*s + 1)^2 [s], positive.
                pub time_constant: $f,
                /// Largest magnitude of the estimate [command unit], positive.
                pub limit: $f,
                /// Longest dt of a good sample [s], positive.
                pub longest_dt: $f,
                /// Delay [s] from a command to the measured output, excluding the response of the
                /// nominal plant; at least 0.
                pub latency: $f,
            }

            marked!([<bowden_observer_settings_ $f>]);

            impl [<bowden_observer_settings_ $f>] {
                /// Returns the defaults.
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

            /// Output of bowden_observer_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_observer_output_ $f>] {
                /// Feed-forward for a controller [command unit], finite and within the limit.
                pub estimate: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
            }

            /// Checks the settings and initialises an observer. `about` may be null.
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

            /// Processes one sample. Call this function before the step of the controller. `dt` [s]
            /// is the time since the previous call. `sent` [command unit] is the command applied
            /// since that call, after all limits. `measured` is in [output unit].
            ///
            /// A bad sample holds the estimate (BOWDEN_RESULT_HELD).
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

            /// Computes the command [command unit] for which the output of the nominal plant
            /// follows a desired motion. `wanted` is the motion desired one latency later.
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

            /// Resets the state. Call this function after the drive was off. Otherwise the estimate
            /// includes commands that did not reach the motor.
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
