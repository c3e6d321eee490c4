//! The actual input of the transmission.

use super::{Compensator, CompensatorState};
use crate::control::Applied;
use crate::Real;

impl<T: Real, const N: usize> Compensator<T, N> {
    /// Reports the actual input of the transmission, if it differs from the command.
    ///
    /// Call this method between two steps if the drive was off, if a limit was active, or if the
    /// output of another controller was added. The hysteresis then moves from its state before the
    /// last sample to the reported input, and the next step continues from this state.
    ///
    /// With [`Applied::AtUpperLimit`], the actual input is unknown, and the last rise of the
    /// model's input is reversed. [`Applied::AtLowerLimit`] reverses a fall.
    ///
    /// ```
    /// use bowden::control::{Applied, Compensator, CompensatorInput, CompensatorState};
    /// use bowden::hysteresis::BoucWen;
    /// use bowden::model::Model;
    /// use bowden::transmission::Transmission;
    /// let shape = BoucWen::try_new(0.09582, 0.6, 3.871)?;
    /// let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?; // [N·m]
    /// let compensator = Compensator::try_new(&Model::<f64, 0>::try_new(Some(cable), &[])?)?;
    /// let mut state = CompensatorState::new();
    /// compensator.step(&mut state, &CompensatorInput::new(0.001, 0.0));
    /// let rest = (state.command(), state.eta());
    /// compensator.step(&mut state, &CompensatorInput::new(0.001, 30.0));
    /// assert!(state.eta() > 0.9); // The model's cable has slipped.
    /// compensator.applied(&mut state, Applied::Command(rest.0)); // The drive was off.
    /// assert_eq!((state.command(), state.eta()), rest);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn applied(&self, state: &mut CompensatorState<T, N>, applied: Applied<T>) {
        let last = state.before.input();
        let rises = last.is_some_and(|last| state.command() > last);
        let falls = last.is_some_and(|last| state.command() < last);
        match applied {
            Applied::Command(input) if input.is_finite() => {
                state.hysteresis = state.before;
                self.transmission.shape().step(&mut state.hysteresis, input);
            }
            Applied::AtUpperLimit if rises => state.hysteresis = state.before,
            Applied::AtLowerLimit if falls => state.hysteresis = state.before,
            _ => {}
        }
    }
}
