//! `control/adaptive/`

use crate::{any, never_panics};
use bowden::control::*;
use bowden::Real;
use std::hint::black_box;

fn settings<T: Real>() -> AdaptiveSettings<T, 2> {
    *black_box(Adaptive::paper()).settings()
}

/// Any law of two regressors.
pub fn law<T: Real>() -> Option<Adaptive<T, 2>> {
    black_box(Adaptive::try_new(settings())).ok()
}

pub fn all<T: Real>() -> Option<()> {
    parts::<T>();
    never_panics!(control_adaptive_paper, Adaptive::<T, 2>::paper());
    let form = black_box(Form::AsPublished {
        time_constant: any(),
    });
    let limits = black_box(Limits::unlimited());
    let fallback = black_box(Fallback::hold_indefinitely());
    never_panics!(
        control_adaptive_settings_new,
        AdaptiveSettings::<T, 2>::new(form, any(), any(), any(), limits, any(), fallback)
    );
    never_panics!(
        control_adaptive_settings_unlimited,
        AdaptiveSettings::<T, 2>::unlimited(form, any(), any(), any())
    );
    never_panics!(
        control_adaptive_settings_largest_step,
        settings::<T>().largest_step()
    );
    never_panics!(
        control_adaptive_settings_try_new,
        Adaptive::try_new(settings::<T>())
    );

    let law = law::<T>()?;
    let at = black_box(AdaptiveInput::new(any(), any(), any(), [any(), any()]));
    never_panics!(
        control_adaptive_state_new,
        AdaptiveInput::<T, 2>::new(any(), any(), any(), [any(), any()])
    );
    never_panics!(control_adaptive_state_new, AdaptiveState::new(&law));
    let mut state = black_box(AdaptiveState::new(&law));
    never_panics!(control_adaptive_settings, *law.settings());
    never_panics!(control_adaptive_is_valid, law.is_valid(&state));
    never_panics!(control_adaptive_longest_dt, law.longest_dt());
    never_panics!(control_adaptive_step_step, law.step(&mut state, &at));
    never_panics!(
        control_adaptive_step_step_with_terms,
        law.step_with_terms(&mut state, &at)
    );
    never_panics!(control_adaptive_step_terms, law.terms(&state, &at));
    never_panics!(
        control_adaptive_resume_resume,
        law.resume(black_box(&mut state), any(), &at)
    );
    never_panics!(
        control_adaptive_state_acknowledge,
        black_box(&mut state).acknowledge()
    );
    never_panics!(control_adaptive_state_is_latched, state.is_latched());
    never_panics!(
        control_adaptive_state_applied,
        state.applied(black_box(Applied::Command(any())))
    );
    never_panics!(
        control_adaptive_state_restore,
        black_box(&mut state).restore(&law)
    );
    never_panics!(
        control_adaptive_resume_resume_from,
        AdaptiveState::resume_from(&law, any(), &at)
    );
    never_panics!(
        control_adaptive_resume_bumpless_transfer,
        law.bumpless_transfer(black_box(&mut state), &at)
    );
    never_panics!(
        control_adaptive_state_reset,
        black_box(&mut state).reset(&law)
    );
    never_panics!(
        control_adaptive_state_accumulated_error,
        state.accumulated_error()
    );
    never_panics!(control_adaptive_state_beta_hat, state.beta_hat());
    never_panics!(control_adaptive_state_delta_hat, state.delta_hat());
    never_panics!(control_adaptive_state_theta_hat, state.theta_hat());
    never_panics!(control_adaptive_state_command, state.command());
    never_panics!(control_adaptive_state_fault_counter, state.fault_counter());
    Some(())
}

fn parts<T: Real>() {
    let leakage = black_box(Leakage::<T>::None);
    never_panics!(control_adaptive_estimator_rate_at, leakage.rate_at(any()));
    never_panics!(control_adaptive_estimator_rate, leakage.rate());
    never_panics!(
        control_adaptive_estimator_fixed,
        Estimator::<T>::fixed(any())
    );
    never_panics!(control_adaptive_estimator_free, Estimator::<T>::free(any()));
    let estimator = black_box(Estimator::<T>::fixed(any()));
    never_panics!(
        control_adaptive_estimator_within,
        estimator.within(any(), any())
    );
    never_panics!(
        control_adaptive_estimator_adapting,
        estimator.adapting(any(), any())
    );
    never_panics!(
        control_adaptive_estimator_contains,
        estimator.contains(any())
    );

    let sign = black_box(SmoothSign::Tanh);
    never_panics!(control_adaptive_smooth_sign_of, sign.of::<T>(any()));
    never_panics!(control_adaptive_smooth_sign_residue, sign.residue::<T>());
    let recursion = LagRecursion::<T> {
        gain: any(),
        lambda: any(),
        epsilon: any(),
        smooth_sign: sign,
    };
    let by = Disturbance {
        g: any(),
        delta_hat: any(),
        w: any(),
        xi: any(),
    };
    let at = black_box(ErrorState::default());
    never_panics!(
        control_adaptive_recursion_step,
        recursion.step(at, any(), &by)
    );
}
