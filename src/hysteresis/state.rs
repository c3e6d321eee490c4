//! The state of the hysteresis, without and with its derivatives.

use crate::error::finite;
use crate::{Error, Real};

/// State of the hysteresis: eta in [-1, 1], and the corresponding input.
///
/// [`BoucWen::step`](super::BoucWen::step) advances the state. The state is `Copy`, so it can be
/// saved and restored.
///
/// ```
/// use bowden::hysteresis::BoucWenState;
/// assert_eq!(BoucWenState::<f32>::new().eta(), 0.0);
/// assert_eq!(BoucWenState::with_eta(-0.5).map(|s| s.eta()), Ok(-0.5));
/// assert!(BoucWenState::with_eta(1.5).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BoucWenState<T> {
    pub(super) eta: T,
    /// Infinite before the first sample. The change to the first sample is then not finite, so a
    /// step needs no separate test for the first sample.
    pub(super) input: T,
}

impl<T: Real> BoucWenState<T> {
    /// The initial state: eta is zero, and the first sample only sets the input.
    #[inline]
    pub fn new() -> Self {
        Self {
            eta: T::zero(),
            input: T::infinity(),
        }
    }

    /// A state that starts at `eta`; the first sample only sets the input.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"eta"` if `eta` is not a number in [-1,
    /// 1].
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        if finite(eta, "eta")?.abs() > T::one() {
            return Err(Error::OutOfRange("eta"));
        }
        Ok(Self { eta, ..Self::new() })
    }

    /// The hysteresis state, in [-1, 1].
    pub fn eta(&self) -> T {
        self.eta
    }

    /// Sets the input and eta, unless the path overflows. Returns the stored input.
    #[inline]
    pub(crate) fn arrive(&mut self, input: T, eta: T) -> T {
        if (input - self.input).is_finite() {
            self.input = input;
            self.eta = eta;
        }
        self.input
    }

    /// The last good input, or `None` before the first good sample.
    pub fn input(&self) -> Option<T> {
        self.input.is_finite().then_some(self.input)
    }
}

impl<T: Real> Default for BoucWenState<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// The stored form of the state.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Stored<T> {
    eta: T,
    input: T,
    primed: bool,
}

crate::checked::stored_as! {
    BoucWenState<T> as Stored<T>: |state| Stored {
        eta: state.eta,
        input: state.input().unwrap_or(T::ZERO),
        primed: state.input().is_some(),
    }, |stored: Stored<T>| {
        let input = finite(stored.input, "input")?;
        let mut state = BoucWenState::with_eta(stored.eta)?;
        if stored.primed {
            state.input = input;
        }
        Ok::<_, Error>(state)
    }
}

crate::data! {
    /// The state eta, and its derivatives with respect to the parameters and the initial state.
    ///
    /// [`BoucWen::advance_with_sensitivity`](super::BoucWen::advance_with_sensitivity) advances
    /// this state.
    #[derive(Default)]
    pub struct Sensitivity<T> {
        /// The state, in [-1, 1].
        pub eta: T,
        /// Derivative with respect to rho [input unit].
        pub d_rho: T,
        /// Derivative with respect to sigma.
        pub d_sigma: T,
        /// Derivative with respect to n.
        pub d_n: T,
        /// Derivative with respect to the initial state.
        pub d_eta0: T,
    }
}

impl<T: Real> Sensitivity<T> {
    /// The initial state `eta0`. Its derivatives with respect to the parameters are zero.
    #[inline]
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
