//! PID, PI and PIV.

use crate::numbers::Numbers;
use crate::properties::control::{
    limits_are_kept, pid_commands_within_its_limits, the_integral_makes_progress,
};
use bowden::control::{AntiWindup, DerivativeSource, Pid, PidInput, PidSettings, PidState, Status};

/// Whatever the settings, the samples and the order of hand-overs: a finite command within
/// the limits, and a bad sample leaves the state.
pub fn check(data: &[u8]) {
    let _ = run(&mut Numbers::new(data));
}

/// Any settings, accepted or not.
pub fn settings(from: &mut Numbers) -> Option<PidSettings<f32>> {
    let anti_windup = match from.byte()? % 4 {
        0 => AntiWindup::None,
        1 => AntiWindup::Clamp,
        2 => AntiWindup::Conditional,
        _ => AntiWindup::BackCalculation {
            tracking_time: from.any()?,
        },
    };
    let damping = match from.byte()? % 4 {
        0 => DerivativeSource::Velocity,
        1 => DerivativeSource::on_error(),
        2 => DerivativeSource::on_measurement(),
        _ => DerivativeSource::Rate {
            weight: from.any()?,
        },
    };
    Some(PidSettings {
        k_p: from.any()?,
        k_i: from.any()?,
        k_d: from.any()?,
        damping,
        derivative_time: from.any()?,
        setpoint_weight: from.any()?,
        anti_windup,
        integral_limit: from.any_or_none()?,
        deadband: from.any_or_none()?.unwrap_or(0.0),
        period: from.any_or_none()?,
        limits: from.limits()?,
        longest_dt: from.any()?,
        fallback: from.fallback()?,
    })
}

/// A controller that its constructor accepts.
pub fn pid(from: &mut Numbers) -> Option<Pid<f32>> {
    Pid::try_new(settings(from)?).ok()
}

/// Any sample.
pub fn sample(from: &mut Numbers) -> Option<PidInput<f32>> {
    Some(PidInput {
        dt: from.dt()?,
        reference: from.any()?,
        measured: from.any()?,
        velocity: from.any()?,
        feed_forward: from.any()?,
    })
}

fn run(from: &mut Numbers) -> Option<()> {
    let pids = [pid(from)?, pid(from)?];
    let mut active = 0;
    let mut state = PidState::new();
    // Whether the last step closed the loop, and nothing was told since.
    let mut undisturbed = true;
    loop {
        let pid = &pids[active];
        match from.byte()? {
            0..=15 => state.reset(),
            16..=31 => {
                active = 1 - active;
                pids[active].bumpless_transfer(&mut state);
            }
            32..=35 => {
                undisturbed = false;
                state.acknowledge();
            }
            36..=39 => {
                undisturbed = false;
                pid.applied(&mut state, from.applied()?);
            }
            40..=63 => {
                let output = from.any()?;
                let before = state;
                if state.resume_from(pid, output, &sample(from)?) == Status::Good {
                    assert!(pid.settings().limits.contains(state.command()));
                } else {
                    assert!(state.integral() == before.integral());
                }
            }
            _ => {
                let (at, last) = (sample(from)?, state.command());
                assert!(!undisturbed || the_integral_makes_progress(pid, &state, &at));
                assert!(pid_commands_within_its_limits(pid, &mut state, &at));
                undisturbed |= state.command() != last;
                assert!(pid.terms(&state).unlimited.is_finite());
                if at.dt > 0.0 && at.dt.is_finite() && at.measured.is_finite() {
                    let limits = &pid.settings().limits;
                    assert!(limits_are_kept(limits, last, at.measured, at.dt));
                }
            }
        }
    }
}
