//! A disturbance observer in combination with a control law and the inverse of the nominal plant
//! along the reference.

use bowden::control::{DisturbanceObserver, ObserverInput, ObserverState};
use bowden::effect::Motion;

/// An observer with its running state.
pub(crate) struct Observing<'a> {
    observer: &'a DisturbanceObserver<f64>,
    state: ObserverState<f64>,
}

impl<'a> Observing<'a> {
    pub(crate) fn new(observer: &'a DisturbanceObserver<f64>) -> Self {
        let state = ObserverState::new();
        Self { observer, state }
    }

    /// The value to add to the next command \[units\]; `sent` is the applied command of the last
    /// sample. The reference is read `ahead` \[s\] by the time from a command to its effect in the
    /// measurement.
    pub(crate) fn step(
        &mut self,
        dt: f64,
        sent: f64,
        measured: f64,
        ahead: impl Fn(f64) -> Motion<f64>,
    ) -> f64 {
        let at = ObserverInput { dt, sent, measured };
        let seen = self.observer.step(&mut self.state, &at);
        let wanted = ahead(self.observer.latency());
        seen.command + self.observer.plant().feed_forward(&wanted)
    }
}
