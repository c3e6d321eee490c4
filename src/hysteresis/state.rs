//! The state of the hysteresis, and the state with its derivatives.

use crate::error::finite;
use crate::{Error, Real};

/// State of the hysteresis: eta in [-1, 1], and the input it was reached at.
///
/// The configuration is [`Shape`](super::Shape); [`Shape::step`](super::Shape::step)
/// advances the state. `Copy`, so it can be saved, compared and restored.
///
/// ```
/// use bowden::hysteresis::BoucWen;
/// assert_eq!(BoucWen::<f32>::new().eta(), 0.0);
/// assert_eq!(BoucWen::with_eta(-0.5).map(|s| s.eta()), Ok(-0.5));
/// assert!(BoucWen::with_eta(1.5).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Stored<T>",
        into = "Stored<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct BoucWen<T> {
    pub(super) eta: T,
    /// Infinite before the first sample: the change to that is no number, and a step need not
    /// look for a sign that it is the first.
    pub(super) input: T,
}

impl<T: Real> BoucWen<T> {
    /// The virgin state: eta is zero, the first sample only sets the input.
    #[inline]
    #[must_use]
    pub fn new() -> Self {
        Self {
            eta: T::zero(),
            input: T::infinity(),
        }
    }

    /// A state that starts at `eta`; the first sample only sets the input.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"eta"` outside [-1, 1].
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        if finite(eta, "eta")?.abs() > T::one() {
            return Err(Error::OutOfRange("eta"));
        }
        Ok(Self { eta, ..Self::new() })
    }

    /// The hysteresis state, in [-1, 1].
    #[inline]
    #[must_use]
    pub fn eta(&self) -> T {
        self.eta
    }

    /// Goes to an input and eta of the model's, from one that it has seen, unless the way overflows,
    /// which the model takes for the longest one; the input that is known then.
    #[inline]
    pub(crate) fn arrive(&mut self, input: T, eta: T) -> T {
        if (input - self.input).is_finite() {
            self.input = input;
            self.eta = eta;
        }
        self.input
    }

    /// The last good input, `None` before the first sample.
    #[inline]
    #[must_use]
    pub fn input(&self) -> Option<T> {
        self.input.is_finite().then_some(self.input)
    }
}

impl<T: Real> Default for BoucWen<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// The state as it is stored.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Stored<T> {
    eta: T,
    input: T,
    primed: bool,
}

#[cfg(feature = "serde")]
impl<T: Real> From<BoucWen<T>> for Stored<T> {
    fn from(state: BoucWen<T>) -> Self {
        Self {
            eta: state.eta,
            input: state.input().unwrap_or_else(T::zero),
            primed: state.input().is_some(),
        }
    }
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Stored<T>> for BoucWen<T> {
    type Error = Error;
    fn try_from(stored: Stored<T>) -> Result<Self, Error> {
        let input = finite(stored.input, "input")?;
        let mut state = Self::with_eta(stored.eta)?;
        if stored.primed {
            state.input = input;
        }
        Ok(state)
    }
}

/// The state eta with its derivatives by the parameters and the start.
///
/// Advanced by [`Shape::advance_with_sensitivity`](super::Shape::advance_with_sensitivity).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sensitivity<T> {
    /// The state, in [-1, 1].
    pub eta: T,
    /// Derivative by rho [input unit].
    pub d_rho: T,
    /// Derivative by sigma.
    pub d_sigma: T,
    /// Derivative by n.
    pub d_n: T,
    /// Derivative by the state at the start.
    pub d_eta0: T,
}

impl<T: Real> Sensitivity<T> {
    /// The start of a record at `eta0`: nothing depends on the parameters yet.
    #[inline]
    #[must_use]
    pub fn start(eta0: T) -> Self {
        let zero = T::zero();
        Self {
            eta: eta0,
            d_rho: zero,
            d_sigma: zero,
            d_n: zero,
            d_eta0: T::one(),
        }
    }
}
