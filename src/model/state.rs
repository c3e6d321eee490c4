//! What a model remembers between samples.

use crate::effect::EffectState;
use crate::hysteresis::BoucWen;
use crate::signal::Compensated;
use crate::{Error, Real};

/// What a [`Model`](super::Model) remembers between samples.
///
/// ```
/// use bowden::model::ModelState;
/// let fresh = ModelState::<f32, 4>::new();
/// assert_eq!((fresh.eta(), fresh.time(), fresh.output()), (0.0, 0.0, 0.0));
/// assert!(ModelState::<f32, 4>::with_eta(1.5).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ModelState<T, const N: usize> {
    pub(super) hysteresis: BoucWen<T>,
    pub(super) effects: [EffectState<T>; N],
    pub(super) started: bool,
    /// Compensated: dt is far below it.
    pub(super) time: Compensated<T>,
    pub(super) output: T,
}

impl<T: Real, const N: usize> ModelState<T, N> {
    /// A state that has seen no sample.
    #[must_use]
    pub fn new() -> Self {
        Self::from_hysteresis(BoucWen::new())
    }

    /// The same, with the hysteresis state as it was found at the start.
    ///
    /// # Errors
    /// As [`BoucWen::with_eta`], where `eta` is not finite or beyond ±1.
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        BoucWen::with_eta(eta).map(Self::from_hysteresis)
    }

    fn from_hysteresis(hysteresis: BoucWen<T>) -> Self {
        Self {
            hysteresis,
            effects: [EffectState::new(); N],
            started: false,
            time: Compensated::new(T::zero()),
            output: T::zero(),
        }
    }

    /// The hysteresis state, within ±1.
    #[must_use]
    pub fn eta(&self) -> T {
        self.hysteresis.eta()
    }

    /// Time since the first good sample \[s\]; bad ones do not count.
    #[must_use]
    pub fn time(&self) -> T {
        self.time.value
    }

    /// The last good output, 0 before the first one.
    #[must_use]
    pub fn output(&self) -> T {
        self.output
    }

    /// Adds dt, compensated: at 1 kHz a plain `f32` clock would stop after hours.
    pub(super) fn tick(&mut self, dt: T) {
        if !self.started {
            self.started = true;
            return;
        }
        let time = self.time.plus(dt);
        // Where the sum overflows, what it lost is no number.
        if time.carry.is_finite() {
            self.time = time;
        }
    }

    /// The clock as [`tick`](Self::tick) would leave it.
    #[inline]
    pub(crate) fn ticked(&self, dt: T) -> Compensated<T> {
        let mut clock = *self;
        clock.tick(dt);
        clock.time
    }

    /// Sets the clock to what [`ticked`](Self::ticked) said.
    #[inline]
    pub(crate) fn set_clock(&mut self, time: Compensated<T>) {
        self.time = time;
        self.started = true;
    }

    /// What the effects remember, apart from the clock.
    #[inline]
    pub(crate) fn memories(&self) -> [EffectState<T>; N] {
        self.effects
    }

    /// Takes the memories back to what they were.
    #[inline]
    pub(crate) fn restore(&mut self, memories: [EffectState<T>; N]) {
        self.effects = memories;
    }
}

impl<T: Real, const N: usize> Default for ModelState<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
