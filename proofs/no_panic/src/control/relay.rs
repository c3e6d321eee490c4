//! `control/relay.rs`, `control/relay/`

use crate::{any, never_panics};
use bowden::control::{Fallback, Limits, PiRule, Relay, RelaySettings, RelayState, Ultimate};
use bowden::Real;
use std::hint::black_box;

fn settings<T: Real>() -> RelaySettings<T> {
    RelaySettings {
        reference: any(),
        centre: any(),
        amplitude: any(),
        hysteresis: any(),
        most_deviation: any(),
        cycles: black_box(3),
        agreement: any(),
        longest_time: any(),
        longest_dt: any(),
        limits: black_box(Limits::unlimited()),
        fallback: black_box(Fallback::hold_indefinitely()),
    }
}

pub fn all<T: Real>() -> Option<()> {
    never_panics!(
        control_relay_settings_try_new,
        Relay::<T>::try_new(settings())
    );
    never_panics!(control_relay_state_new, RelayState::<T>::new());
    let relay = black_box(Relay::<T>::try_new(settings())).ok()?;
    let mut state = black_box(RelayState::new());
    never_panics!(control_relay_settings, *relay.settings());
    never_panics!(control_relay_step, relay.step(&mut state, any(), any()));
    never_panics!(
        control_relay_state_acknowledge,
        black_box(&mut state).acknowledge()
    );
    never_panics!(control_relay_state_command, state.command());
    never_panics!(control_relay_state_result, state.result());
    never_panics!(control_relay_state_is_running, state.is_running());
    never_panics!(control_relay_state_cycles, state.cycles());
    never_panics!(control_relay_state_remaining, state.remaining());
    never_panics!(control_relay_state_fault_counter, state.fault_counter());
    never_panics!(control_relay_state_is_latched, state.is_latched());
    let ultimate = black_box(Ultimate::<T> {
        gain: any(),
        period: any(),
        amplitude: any(),
        duty: any(),
    });
    never_panics!(control_relay_ultimate_pi, ultimate.pi(PiRule::TyreusLuyben));
    Some(())
}
