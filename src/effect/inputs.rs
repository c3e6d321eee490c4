//! The inputs of an effect at one sample, and its memory.

use super::Quantity;
use crate::Real;

crate::data! {
    /// Position, velocity and acceleration of one channel.
    #[derive(Default)]
    pub struct Motion<T> {
        /// x \[channel unit\]
        pub position: T,
        /// v \[channel unit/s\]
        pub velocity: T,
        /// a \[channel unit/s²\]
        pub acceleration: T,
    }

    /// The inputs of an effect at one sample.
    ///
    /// ```
    /// use bowden::effect::{Effect, EffectState, Inputs, Motion, Viscous};
    /// let at = Inputs {
    ///     motion: Motion { velocity: 2.0, ..Motion::default() },
    ///     ..Inputs::default()
    /// };
    /// let mut state = EffectState::default();
    /// assert_eq!(Effect::from(Viscous).regressor(&mut state, &at), 2.0);
    /// ```
    #[derive(Default)]
    pub struct Inputs<T> {
        /// Time since the previous sample \[s\].
        pub dt: T,
        /// Time since the start of the record \[s\].
        pub time: T,
        /// Motion of the channel that the effect reads.
        pub motion: Motion<T>,
        /// The transmission's input (x or `tau_i`), with its velocity and acceleration.
        pub input: Motion<T>,
        /// The transmitted load: `tau_i` in torque mode, otherwise a load channel.
        pub load: T,
        /// The hysteresis state eta; 0 without a transmission.
        pub eta: T,
        /// The sum of all terms before this effect, which only output stages read.
        pub output: T,
    }
}

impl<T: Real> Inputs<T> {
    /// The value of one quantity.
    #[inline]
    #[must_use]
    pub fn get(&self, quantity: Quantity) -> T {
        match quantity {
            Quantity::Dt => self.dt,
            Quantity::Time => self.time,
            Quantity::Position => self.motion.position,
            Quantity::Velocity => self.motion.velocity,
            Quantity::Acceleration => self.motion.acceleration,
            Quantity::Input => self.input.position,
            Quantity::Load => self.load,
            Quantity::Eta => self.eta,
            Quantity::Output => self.output,
        }
    }

    /// Whether all `quantities` are finite, and `dt`, if it is one of them, is not negative.
    #[inline]
    #[must_use]
    pub fn is_usable(&self, quantities: &[Quantity]) -> bool {
        quantities.iter().all(|&quantity| {
            let value = self.get(quantity);
            value.is_finite() && (quantity != Quantity::Dt || value >= T::zero())
        })
    }
}

crate::checked::stored! {
    /// The internal state of one effect, empty before the first sample.
    ///
    /// Use each state with only one effect, because the meaning of its numbers depends on the
    /// effect.
    #[derive(Default)]
    pub struct EffectState<T> {
        pub(super) memory: Option<[T; 4]>,
    }
}

impl<T> EffectState<T> {
    /// Initial state, before the first sample.
    pub const fn new() -> Self {
        Self { memory: None }
    }
}
