//! `control/observer.rs`, `control/observer/`

use crate::effect::motion;
use crate::{any, never_panics};
use bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(
        control_observer_plant_try_new,
        NominalPlant::<T>::try_new(any(), any(), any())
    );
    never_panics!(
        control_observer_plant_of_mechanics,
        NominalPlant::<T>::of_mechanics(any(), any(), any(), any())
    );
    let plant = black_box(NominalPlant::<T>::try_new(any(), any(), any())).ok()?;
    never_panics!(control_observer_plant_gain, plant.gain());
    never_panics!(
        control_observer_plant_natural_frequency,
        plant.natural_frequency()
    );
    never_panics!(control_observer_plant_damping_ratio, plant.damping_ratio());
    let wanted = motion();
    never_panics!(
        control_observer_plant_feed_forward,
        plant.feed_forward(&wanted)
    );
    never_panics!(
        control_observer_try_new,
        DisturbanceObserver::try_new(plant, any(), any(), any())
    );
    let observer = black_box(DisturbanceObserver::try_new(plant, any(), any(), any())).ok()?;
    never_panics!(control_observer_with_latency, observer.with_latency(any()));
    let observer = black_box(observer.with_latency(any())).ok()?;
    never_panics!(control_observer_plant, *observer.plant());
    never_panics!(control_observer_time_constant, observer.time_constant());
    never_panics!(control_observer_limit, observer.limit());
    never_panics!(control_observer_longest_dt, observer.longest_dt());
    never_panics!(control_observer_latency, observer.latency());
    never_panics!(control_observer_state_new, ObserverState::<T>::new());
    let mut state = black_box(ObserverState::<T>::new());
    let at = ObserverInput {
        dt: any(),
        sent: any(),
        measured: any(),
    };
    never_panics!(control_observer_step, observer.step(&mut state, &at));
    never_panics!(control_observer_state_estimate, state.estimate());
    Some(())
}
