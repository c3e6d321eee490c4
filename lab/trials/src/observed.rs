//! A disturbance observer together with a law, with the inverse of its nominal plant along the
//! reference.

use bowden::control::{DisturbanceObserver, ObserverInput, ObserverState};
use bowden::effect::Motion;

/// An observer while it runs.
pub(crate) struct Observing<'a> {
    observer: &'a DisturbanceObserver<f64>,
    state: ObserverState<f64>,
}

impl<'a> Observing<'a> {
    pub(crate) fn new(observer: &'a DisturbanceObserver<f64>) -> Self {
        let state = ObserverState::new();
        Self { observer, state }
    }

    /// What is added to the next command \[units\]; `sent` is what went out at the last sample. The
    /// reference is read as far `ahead` \[s\] as a command takes to show in what is measured.
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
        seen.estimate + self.observer.plant().feed_forward(&wanted)
    }
}
