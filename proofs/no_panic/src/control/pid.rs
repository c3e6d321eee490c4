//! `control/pid.rs`, `control/pid/`

use crate::{any, never_panics};
use bowden::control::{
    Applied, DerivativeSource, Fallback, Limits, Pid, PidInput, PidSettings, PidState,
};
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(
        control_pid_settings_on_error,
        DerivativeSource::<T>::on_error()
    );
    never_panics!(
        control_pid_settings_on_measurement,
        DerivativeSource::<T>::on_measurement()
    );
    let limits = black_box(Limits::unlimited());
    let fallback = black_box(Fallback::hold_indefinitely());
    never_panics!(
        control_pid_settings_new,
        PidSettings::<T>::new(any(), any(), limits, any(), fallback)
    );
    never_panics!(
        control_pid_settings_unlimited,
        PidSettings::<T>::unlimited(any(), any())
    );
    never_panics!(
        control_pid_signals_new,
        PidInput::<T>::new(any(), any(), any())
    );
    never_panics!(control_pid_paper_pi, Pid::<T>::paper_pi());
    never_panics!(control_pid_paper_pid, Pid::<T>::paper_pid());
    never_panics!(control_pid_paper_piv, Pid::<T>::paper_piv());

    let settings = black_box(PidSettings::<T>::unlimited(any(), any()));
    never_panics!(control_pid_settings_try_new, Pid::try_new(settings));
    let pid = black_box(Pid::try_new(settings)).ok()?;
    let at = black_box(PidInput::new(any(), any(), any()));
    never_panics!(control_pid_state_new, PidState::<T>::new());
    let mut state = black_box(PidState::new());
    never_panics!(control_pid_settings, *pid.settings());
    never_panics!(control_pid_step, pid.step(&mut state, &at));
    never_panics!(
        control_pid_step_with_terms,
        pid.step_with_terms(&mut state, &at)
    );
    never_panics!(control_pid_terms, pid.terms(black_box(&state)));
    never_panics!(control_pid_saturation, pid.saturation(black_box(&state)));
    never_panics!(
        control_pid_applied,
        pid.applied(&mut state, black_box(Applied::Command(any())))
    );
    never_panics!(
        control_pid_bumpless_transfer,
        pid.bumpless_transfer(black_box(&mut state))
    );
    never_panics!(
        control_pid_state_resume_from,
        state.resume_from(&pid, any(), &at)
    );
    never_panics!(control_pid_state_reset, black_box(&mut state).reset());
    never_panics!(control_pid_state_command, state.command());
    never_panics!(control_pid_state_integral, state.integral());
    never_panics!(control_pid_state_rate, state.rate());
    never_panics!(control_pid_state_fault_counter, state.fault_counter());
    never_panics!(control_pid_state_is_latched, state.is_latched());
    never_panics!(
        control_pid_state_restore,
        black_box(&mut state).restore(&pid)
    );
    never_panics!(
        control_pid_state_acknowledge,
        black_box(&mut state).acknowledge()
    );
    Some(())
}
