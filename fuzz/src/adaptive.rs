//! The robust adaptive law.

use crate::numbers::Numbers;
use crate::properties::control::{
    adaptive_commands_within_its_limits, adaptive_commands_within_its_limits_from_any_state,
    the_lag_does_not_pass_its_target,
};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Form, Leakage, Limits,
    OnMissing, SmoothSign, Status,
};

/// Whatever the gains, the samples and the order of hand-overs: a finite command within the
/// limits, every estimate in its box, and a bad sample leaves the state.
pub fn check(data: &[u8]) {
    let _ = run(&mut Numbers::new(data));
}

fn estimator(from: &mut Numbers) -> Option<Estimator<f32>> {
    let leakage = match from.byte()? % 3 {
        0 => Leakage::None,
        1 => Leakage::Constant { rate: from.any()? },
        _ => Leakage::Switching {
            rate: from.any()?,
            bound: from.any()?,
        },
    };
    let value = Estimator {
        gain: from.any()?,
        prior: from.any()?,
        leakage,
        ..Estimator::free(from.any()?)
    };
    Some(if from.flag()? {
        value.within(from.any()?, from.any()?)
    } else {
        value
    })
}

/// Any settings, accepted or not.
pub fn settings(from: &mut Numbers) -> Option<AdaptiveSettings<f32, 2>> {
    let form = if from.flag()? {
        Form::AsPublished {
            time_constant: from.any()?,
        }
    } else {
        Form::FirstOrder {
            step: from.dt()?,
            plant_gain: from.any()?,
        }
    };
    let smooth_sign = if from.flag()? {
        SmoothSign::Tanh
    } else {
        SmoothSign::Clamp
    };
    Some(AdaptiveSettings {
        smooth_sign,
        beta: estimator(from)?,
        delta: estimator(from)?,
        theta: [estimator(from)?, estimator(from)?],
        z_limit: from.any()?,
        frozen: from.flag()?,
        missing: [
            [OnMissing::Hold, OnMissing::DropRegressor][usize::from(from.byte()? % 2)],
            [OnMissing::Hold, OnMissing::DropRegressor][usize::from(from.byte()? % 2)],
        ],
        limits: from.limits()?,
        longest_dt: from.any()?,
        fallback: from.fallback()?,
        ..AdaptiveSettings::unlimited(form, from.any()?, from.any()?, from.any()?)
    })
}

/// A law that its constructor accepts.
pub fn law(from: &mut Numbers) -> Option<Adaptive<f32, 2>> {
    Adaptive::try_new(settings(from)?).ok()
}

/// Any sample.
pub fn sample(from: &mut Numbers) -> Option<AdaptiveInput<f32, 2>> {
    Some(AdaptiveInput {
        dt: from.dt()?,
        reference: from.any()?,
        next_reference: from.any()?,
        measured: from.any()?,
        regressors: [from.any()?, from.any()?],
        feed_forward: from.any()?,
    })
}

fn run(from: &mut Numbers) -> Option<()> {
    let law = if from.flag()? {
        law(from)?
    } else {
        Adaptive::paper()
    };
    let free = law.settings().limits == Limits::unlimited();
    let lags = matches!(law.settings().form, Form::FirstOrder { .. });
    let mut state = AdaptiveState::new(&law);
    // Of a law without limits: its share of the command, where it is known.
    let mut lag = Some(0.0_f32);
    let mut acknowledged = false;
    loop {
        match from.byte()? {
            0..=15 => {
                let out = state.command();
                state.reset(&law);
                assert!(state.command() == out, "a reset leaves what is out");
                lag = (!acknowledged).then_some(out);
            }
            16..=31 => {
                state = AdaptiveState::resume_from(&law, from.any()?, &sample(from)?);
                (lag, acknowledged) = (None, false);
            }
            48..=55 => {
                if state.is_latched() {
                    (lag, acknowledged) = (None, true);
                }
                state.acknowledge();
            }
            56..=59 => {
                state.applied(from.applied()?);
                lag = None;
            }
            32..=47 => {
                law.bumpless_transfer(&mut state, &sample(from)?);
                lag = None;
            }
            _ => {
                let at = sample(from)?;
                let mut again = state;
                // A drive may have exceeded the limits of the law.
                let steps = if law.settings().limits.contains(state.command()) {
                    adaptive_commands_within_its_limits
                } else {
                    adaptive_commands_within_its_limits_from_any_state
                };
                assert!(steps(&law, &mut state, &at));
                let out = law.step_with_terms(&mut again, &at);
                assert!(again == state, "the same sample gives the same state");
                if let (Some(before), true, true) = (lag, free, lags) {
                    // Half an ulp is owed, and half an ulp is rounded.
                    let owed = f32::EPSILON * before.abs().max(out.terms.law.abs());
                    assert!(the_lag_does_not_pass_its_target(before, owed, &out));
                }
                match out.status {
                    Status::Good => (lag, acknowledged) = (Some(out.terms.law), false),
                    Status::Degraded(_) => (lag, acknowledged) = (None, false),
                    // The next good sample starts from the safe command, once it was seen.
                    Status::Safe(_) => lag = None,
                    Status::Held(_) => {}
                }
            }
        }
        // A drive may exceed the limits of the law, until the next good sample.
        assert!(law.is_valid(&state) || !law.settings().limits.contains(state.command()));
    }
}
