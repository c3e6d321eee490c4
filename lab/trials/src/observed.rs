//! A disturbance observer beside a law, with its nominal plant turned round along the reference.

use bowden::control::{DisturbanceObserver, ObserverInput, ObserverState};
use bowden::effect::Motion;

/// An observer, and how far ahead its feed-forward reads the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observed {
    /// The observer, with the nominal plant.
    pub observer: DisturbanceObserver<f64>,
    /// How long a command takes to show in what is measured \[s\].
    pub lead: f64,
}

/// The same while it runs.
pub(crate) struct Observing<'a> {
    observed: &'a Observed,
    state: ObserverState<f64>,
}

impl<'a> Observing<'a> {
    pub(crate) fn new(observed: &'a Observed) -> Self {
        let state = ObserverState::new();
        Self { observed, state }
    }

    /// What is added to the next command \[units\]; `sent` is what went out at the last sample.
    pub(crate) fn step(
        &mut self,
        dt: f64,
        sent: f64,
        measured: f64,
        ahead: impl Fn(f64) -> Motion<f64>,
    ) -> f64 {
        let Observed { observer, lead } = self.observed;
        let at = ObserverInput { dt, sent, measured };
        let seen = observer.step(&mut self.state, &at);
        seen.estimate + observer.plant().feed_forward(&ahead(*lead))
    }
}
