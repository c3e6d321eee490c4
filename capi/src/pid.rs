//! PI, PID and PIV.

use crate::object::{kept, read, seen, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::{bowden_fallback_f32, bowden_fallback_f64, bowden_limits_f32, bowden_limits_f64};
use crate::{bowden_output_f32, bowden_output_f64};
use core_bowden::control::{
    AntiWindup, Damping, Output, Pid, PidInput, PidSettings, PidState, PidTerms,
};

/// What the gain `k_d` multiplies.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_damping {
    /// The filtered derivative of y - c*y_r, PID (14).
    Rate = 0,
    /// The measured distal velocity as it is, PIV (16); nothing is filtered.
    Velocity = 1,
}

/// What keeps the integral from growing while the command is limited.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_anti_windup {
    /// The integral does not grow in the direction in which the limit is passed.
    Conditional = 0,
    /// Nothing: the integral winds up.
    None = 1,
    /// The integral term stays within the range of the command, widened to hold zero.
    Clamp = 2,
    /// What the limits cut off flows back into the integral, over `tracking_time`.
    BackCalculation = 3,
}

/// Room of a bowden_pid_f32, in words of 64 bits.
pub const BOWDEN_PID_F32_WORDS: usize = 24;
/// Room of a bowden_pid_f64, in words of 64 bits.
pub const BOWDEN_PID_F64_WORDS: usize = 40;

macro_rules! pid {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Settings of a PI (15), PID (14) or PIV (16):
            ///
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
            ///     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
            ///     command = u within the range and the slew rate;  e = y - y_r
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_settings_ $f>] {
                /// Proportional gain [command unit/output unit].
                pub k_p: $f,
                /// Integral gain [command unit/(output unit*s)], of the sign of k_p.
                pub k_i: $f,
                /// Derivative gain [command unit*s/output unit], of the sign of k_p; for PIV
                /// [command unit*s/rad]. 0 for a PI.
                pub k_d: $f,
                /// One of bowden_damping: what k_d multiplies.
                pub damping: u32,
                /// Set-point weight c of the derivative, 0 to 1.
                pub derivative_weight: $f,
                /// Time constant of the derivative's filter, from 0 (none) up [s].
                pub derivative_time: $f,
                /// Set-point weight b of the proportional term, 0 to 1.
                pub setpoint_weight: $f,
                /// One of bowden_anti_windup.
                pub anti_windup: u32,
                /// Of BOWDEN_ANTI_WINDUP_BACK_CALCULATION alone, above zero [s].
                pub tracking_time: $f,
                /// Range and slew rate of the command.
                pub limits: [<bowden_limits_ $f>],
                /// Longest dt that is a sample, above zero [s]: five nominal steps, say.
                pub longest_dt: $f,
                /// What goes out when samples stay bad.
                pub fallback: [<bowden_fallback_ $f>],
            }

            impl [<bowden_pid_settings_ $f>] {
                fn of(s: &PidSettings<$f>) -> Self {
                    // As `PidSettings::new` and `unlimited` have them.
                    Self {
                        k_p: s.k_p,
                        k_i: s.k_i,
                        k_d: s.k_d,
                        damping: bowden_damping::Rate as u32,
                        derivative_weight: 1.0,
                        derivative_time: s.derivative_time,
                        setpoint_weight: s.setpoint_weight,
                        anti_windup: bowden_anti_windup::Conditional as u32,
                        tracking_time: 0.0,
                        limits: [<bowden_limits_ $f>]::of(&s.limits),
                        longest_dt: s.longest_dt,
                        fallback: [<bowden_fallback_ $f>]::of(&s.fallback),
                    }
                }

                fn pid(&self) -> Result<Pid<$f>, Refused> {
                    let damping = match self.damping {
                        d if d == bowden_damping::Rate as u32 => {
                            Damping::Rate { weight: self.derivative_weight }
                        }
                        d if d == bowden_damping::Velocity as u32 => Damping::Velocity,
                        _ => return Err(Refused::choice("damping")),
                    };
                    let anti_windup = match self.anti_windup {
                        w if w == bowden_anti_windup::Conditional as u32 => AntiWindup::Conditional,
                        w if w == bowden_anti_windup::None as u32 => AntiWindup::None,
                        w if w == bowden_anti_windup::Clamp as u32 => AntiWindup::Clamp,
                        w if w == bowden_anti_windup::BackCalculation as u32 => {
                            AntiWindup::BackCalculation { tracking_time: self.tracking_time }
                        }
                        _ => return Err(Refused::choice("anti_windup")),
                    };
                    Ok(Pid::try_new(PidSettings {
                        k_p: self.k_p,
                        k_i: self.k_i,
                        k_d: self.k_d,
                        damping,
                        derivative_time: self.derivative_time,
                        setpoint_weight: self.setpoint_weight,
                        anti_windup,
                        limits: self.limits.limits()?,
                        longest_dt: self.longest_dt,
                        fallback: self.fallback.fallback()?,
                    })?)
                }
            }

            /// One sample for a PI, PID or PIV.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_sample_ $f>] {
                /// Since the last call, also where that was a bad sample [s].
                pub dt: $f,
                /// y_r [output unit], such as [N*m].
                pub reference: $f,
                /// y [output unit], such as [N*m].
                pub measured: $f,
                /// Measured distal velocity [rad/s]; only PIV (16) reads it.
                pub velocity: $f,
                /// Added to the command before the limits [command unit]; 0 for none.
                pub feed_forward: $f,
            }

            impl [<bowden_pid_sample_ $f>] {
                fn input(&self) -> PidInput<$f> {
                    PidInput {
                        dt: self.dt,
                        reference: self.reference,
                        measured: self.measured,
                        velocity: self.velocity,
                        feed_forward: self.feed_forward,
                    }
                }
            }

            /// Every term of the last good sample; they add up to `unlimited`.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_pid_terms_ $f>] {
                /// e = y - y_r [output unit].
                pub error: $f,
                /// -k_p*(y - b*y_r) [command unit].
                pub proportional: $f,
                /// -k_i*integral(e), with what the anti-windup did to it [command unit].
                pub integral: $f,
                /// -k_d*d/dt(y - c*y_r), filtered [command unit]; zero with PIV.
                pub derivative: $f,
                /// -k_d*v_d of PIV [command unit]; zero with PI and PID.
                pub velocity: $f,
                /// As it was given [command unit].
                pub feed_forward: $f,
                /// The sum before range and slew rate [command unit].
                pub unlimited: $f,
                /// 1 where range or slew rate changed the command, else 0.
                pub saturated: u32,
            }

            impl [<bowden_pid_terms_ $f>] {
                fn of(terms: PidTerms<$f>) -> Self {
                    Self {
                        error: terms.error,
                        proportional: terms.proportional,
                        integral: terms.integral,
                        derivative: terms.derivative,
                        velocity: terms.velocity,
                        feed_forward: terms.feed_forward,
                        unlimited: terms.unlimited,
                        saturated: u32::from(terms.saturated),
                    }
                }
            }

            /// A PI, PID or PIV with its state; the caller's memory, made by bowden_pid_init.
            /// It may be copied and moved as a whole.
            #[repr(C)]
            pub struct [<bowden_pid_ $f>] {
                /// Not for use.
                pub opaque: [u64; [<BOWDEN_PID_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_pid_ $f>] {
                type Inner = (Pid<$f>, PidState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of a plain PI (15): full set-point weight, conditional anti-windup, no
            /// slew rate, 4 good samples for a bad one.
            ///
            /// `low` and `high` [command unit] are what the drive may get, `longest_dt` [s] the
            /// longest sample time, `safe` [command unit] what goes out from the `after`-th bad
            /// sample in a row on. Numbers are checked by bowden_pid_init.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_settings_pi_ $f>](
                settings: *mut [<bowden_pid_settings_ $f>],
                k_p: $f,
                k_i: $f,
                low: $f,
                high: $f,
                longest_dt: $f,
                after: u32,
                safe: $f,
            ) -> bowden_result {
                let value = [<bowden_pid_settings_ $f>] {
                    limits: [<bowden_limits_ $f>] { low, high, slew: 0.0 },
                    longest_dt,
                    fallback: [<bowden_fallback_ $f>] { after, weight: 4, command: safe },
                    ..[<bowden_pid_settings_ $f>]::of(&PidSettings::unlimited(k_p, k_i))
                };
                // SAFETY: the caller's rule of pointers.
                code(unsafe { write(settings, value) }.map(|()| bowden_result::Ok).map_err(Refused::from))
            }

            /// Checks the settings and starts with a state that has seen no sample.
            ///
            /// `about` may be null; else it gets the name of what is refused. On an error the
            /// object is as it was.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_init_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                settings: *const [<bowden_pid_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read(settings)
                        .map_err(Refused::from)
                        .and_then(|settings| settings.pid())
                        .and_then(|law| Ok(start(pid, (law, PidState::new()))?));
                    told(tried, about)
                }
            }

            /// One sample: the command, and what happened.
            ///
            /// A bad sample (NaN, an infinity, a dt that is not positive or too long) leaves the
            /// state as it was and holds the last good command: BOWDEN_RESULT_HELD. After too
            /// many the safe command is out, good samples or not, until bowden_pid_acknowledge:
            /// BOWDEN_RESULT_SAFE. `out` is written with every result that is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_step_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                sample: *const [<bowden_pid_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let input = read(sample)?.input();
                    writable(out)?;
                    let (law, state) = kept(pid)?;
                    let output = [<bowden_output_ $f>]::of(law.step(state, &input));
                    write(out, output)?;
                    Ok(output.result)
                })())
            }

            /// Every term of the last good sample, for telemetry; all zero before the first one.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_get_terms_ $f>](
                pid: *const [<bowden_pid_ $f>],
                out: *mut [<bowden_pid_terms_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = seen(pid)?;
                    write(out, [<bowden_pid_terms_ $f>]::of(law.terms(state)))?;
                    Ok(bowden_result::Ok)
                })())
            }

            /// Takes note that somebody has seen the fault: the next good sample closes the loop
            /// again, from the safe command on. Nothing where no safe command is latched.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_acknowledge_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(pid)?.1.acknowledge();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Forgets integral, rate and samples; the command that is out stays known, and a
            /// safe command that is latched stays so.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_reset_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    kept(pid)?.1.reset();
                    Ok(bowden_result::Ok)
                })())
            }

            /// Makes an object that was stored fit for a start, before its first step: the power was
            /// off, and the command is the one nearest to zero that the limits allow. Integral, rate
            /// and samples are forgotten; a safe command that was latched stays so. The first good
            /// sample starts from there, without a jump. A step without this goes on with the command
            /// of then.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_power_up_ $f>](
                pid: *mut [<bowden_pid_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (law, state) = kept(pid)?;
                    state.power_up(law);
                    Ok(bowden_result::Ok)
                })())
            }

            /// Starts anew so that the command goes on from `command` [command unit] without a
            /// jump. A number that is not finite counts as a bad sample; a latched safe command
            /// stays. `out` has the command that is out then, and may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_resume_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                command: $f,
                sample: *const [<bowden_pid_sample_ $f>],
                out: *mut [<bowden_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let input = read(sample)?.input();
                    if !out.is_null() {
                        writable(out)?;
                    }
                    let (law, state) = kept(pid)?;
                    let status = state.resume_from(law, command, &input);
                    let command = law.settings().limits.confine(state.command());
                    let output = [<bowden_output_ $f>]::of(Output { command, status });
                    if !out.is_null() {
                        write(out, output)?;
                    }
                    Ok(output.result)
                })())
            }

            /// Other settings for a loop that runs, without a jump of the command; but where the new
            /// range excludes what is out, the next command is the nearest in it, past any slew rate:
            /// narrow a range step by step. On an error the loop goes on with the old ones.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_change_ $f>](
                pid: *mut [<bowden_pid_ $f>],
                settings: *const [<bowden_pid_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read(settings)
                        .map_err(Refused::from)
                        .and_then(|settings| settings.pid())
                        .and_then(|new| {
                            let (law, state) = kept(pid)?;
                            new.take_over(state);
                            *law = new;
                            Ok(())
                        });
                    told(tried, about)
                }
            }

            /// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_pid_is_latched_ $f>](
                pid: *const [<bowden_pid_ $f>],
                latched: *mut u32,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    let (_, state) = seen(pid)?;
                    write(latched, u32::from(state.is_latched()))?;
                    Ok(bowden_result::Ok)
                })())
            }
        }
    };
}
pid!(f32, 0x7069_645f_6633_3201);
pid!(f64, 0x7069_645f_6636_3401);
