//! The relay experiment, which starts again after it has ended.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::control::{Fallback, Limits, Relay as Experiment, RelaySettings, RelayState, Status};
use bowden::Error;
use core::hint::black_box;

/// About the mean of the signals. The agreement is wide, so that cycles of jumps are averaged:
/// the longest step is the step that computes the result.
const RELAY: RelaySettings<f32> = RelaySettings {
    reference: 25.0,
    centre: 10.0,
    amplitude: 8.0,
    hysteresis: 0.5,
    most_deviation: 30.0,
    cycles: 2,
    agreement: 0.5,
    longest_time: 20.0,
    longest_dt: 0.005,
    limits: constant!(Limits::<f32>::try_new(-20.0, 60.0)),
    fallback: constant!(Fallback::<f32>::try_new(20, 0.0)),
};

/// The compiler knows none of its settings.
#[derive(Debug)]
pub struct Relay {
    relay: Experiment<f32>,
    state: RelayState<f32>,
}

impl Case for Relay {
    fn try_new() -> Result<Self, Error> {
        Ok(Self {
            relay: Experiment::try_new(black_box(RELAY))?,
            state: RelayState::new(),
        })
    }

    /// The command, or the ultimate gain at the end of an experiment.
    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        if !self.state.is_running() {
            self.state = RelayState::new();
        }
        let out = self.relay.step(&mut self.state, at.dt, at.measured);
        let (value, status) = match (out.status, self.state.result()) {
            (Status::Good, Some(ultimate)) => (ultimate.gain, 4),
            (Status::Good, None) => (out.command, 0),
            (Status::Held(_), _) => (out.command, 1),
            (Status::Safe(_) | Status::Degraded(_), _) => (out.command, 2),
        };
        Output { value, status }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Signal;

    fn statuses(signal: Signal) -> [usize; 5] {
        let mut count = [0; 5];
        let mut case = Relay::try_new().unwrap();
        for sample in signal.samples() {
            count[case.step(sample).status as usize] += 1;
        }
        count
    }

    #[test]
    fn the_signals_lead_to_results_and_to_failures() {
        let [running, held, failed, _, done] = statuses(Signal::Jumps);
        assert!(running > 1000 && done > 10, "{running} {done}");
        assert_eq!((held, failed), (0, 0));
        assert!(statuses(Signal::Faults)[1] > 100);
        assert!(statuses(Signal::Faults)[2] > 0);
    }
}
