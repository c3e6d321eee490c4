//! State of a model between samples.

use crate::effect::EffectState;
use crate::hysteresis::BoucWenState;
use crate::signal::Compensated;
use crate::{Error, Real};

crate::checked::stored! {
    /// State of a [`Model`](super::Model) between samples.
    ///
    /// ```
    /// use bowden::model::ModelState;
    /// let fresh = ModelState::<f32, 4>::new();
    /// assert_eq!((fresh.eta(), fresh.time(), fresh.output()), (0.0, 0.0, 0.0));
    /// assert!(ModelState::<f32, 4>::with_eta(1.5).is_err());
    /// ```
    pub struct ModelState<T, const N: usize> {
        pub(super) hysteresis: BoucWenState<T>,
        /// If the stored list is shorter, the omitted memories start as new.
        #[serde(serialize_with = "crate::list::serialize", deserialize_with = "crate::list::padded")]
        pub(crate) effects: [EffectState<T>; N],
        pub(super) started: bool,
        /// A compensated sum, because dt is much smaller than the time.
        pub(super) time: Compensated<T>,
        pub(super) output: T,
    }
}

impl<T: Real, const N: usize> ModelState<T, N> {
    /// Initial state, before the first sample.
    pub fn new() -> Self {
        Self::from_hysteresis(BoucWenState::new())
    }

    /// Initial state with the hysteresis state `eta`.
    ///
    /// # Errors
    /// The same as [`BoucWenState::with_eta`], if `eta` is not a number in [-1, 1].
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        BoucWenState::with_eta(eta).map(Self::from_hysteresis)
    }

    fn from_hysteresis(hysteresis: BoucWenState<T>) -> Self {
        Self {
            hysteresis,
            effects: [EffectState::new(); N],
            started: false,
            time: Compensated::new(T::zero()),
            output: T::zero(),
        }
    }

    /// The hysteresis state, in [-1, 1].
    pub fn eta(&self) -> T {
        self.hysteresis.eta()
    }

    /// Time since the first good sample \[s\], without the time of bad samples.
    pub fn time(&self) -> T {
        self.time.value
    }

    /// The last good output, or 0 before the first good sample.
    pub fn output(&self) -> T {
        self.output
    }

    /// Adds dt to a compensated sum. At 1 kHz, a plain `f32` clock would stop after hours.
    pub(super) fn tick(&mut self, dt: T) {
        if !self.started {
            self.started = true;
            return;
        }
        let time = self.time.plus(dt);
        // If the sum overflows, its rounding error is NaN.
        if time.carry.is_finite() {
            self.time = time;
        }
    }

    /// The clock after a [`tick`](Self::tick).
    #[inline]
    pub(crate) fn ticked(&self, dt: T) -> Compensated<T> {
        let mut clock = *self;
        clock.tick(dt);
        clock.time
    }

    /// Sets the clock to the result of [`ticked`](Self::ticked).
    #[inline]
    pub(crate) fn set_clock(&mut self, time: Compensated<T>) {
        self.time = time;
        self.started = true;
    }
}

impl<T: Real, const N: usize> Default for ModelState<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
