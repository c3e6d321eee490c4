//! The smoothed sign functions of the adaptive law.

use crate::control::law;
use crate::Real;

crate::data! {
    /// The smoothed sign function `T(x)` in (23) and (25), with `x = s/epsilon`.
    ///
    /// Both functions are odd and non-decreasing, with a slope of at most one and values within
    /// `[-1, 1]`. The theorems use only these properties. `Clamp` requires only two comparisons,
    /// and has a smaller [`residue`](Self::residue): 1/4 instead of 0.2785.
    ///
    /// ```
    /// use bowden::control::SmoothSign;
    /// assert_eq!(SmoothSign::Clamp.of(0.5), 0.5);
    /// assert_eq!(SmoothSign::Clamp.of(-7.0), -1.0);
    /// assert!((SmoothSign::Tanh.of(0.5_f64) - 0.462_117).abs() < 1e-6);
    /// ```
    #[derive(Eq, Hash, Default)]
    pub enum SmoothSign {
        /// `tanh(x)`, as in Nguyen et al. (2018).
        #[default]
        Tanh,
        /// `x`, clamped to `[-1, 1]`.
        Clamp,
    }
}

/// Largest `x·(1 - tanh x)`: Lambert's W(1/e), at x = 0.639232; 0.2785 in the paper.
const TANH_RESIDUE: f64 = 0.278_464_542_761_073_8;

impl SmoothSign {
    /// `T(x)` within `[-1, 1]`; NaN stays NaN.
    #[inline]
    #[must_use]
    pub fn of<T: Real>(self, x: T) -> T {
        match self {
            Self::Tanh => law::smooth_sign(x),
            Self::Clamp => law::clamped_sign(x),
        }
    }

    /// Largest `|x|·(1 - |T(x)|)`: the contribution of the smoothed sign function to the error
    /// bounds.
    ///
    /// The value is W(1/e) = 0.27846 for `tanh` (Lemma 1 of reference 50 in Nguyen et al., 2018),
    /// and 1/4 for `Clamp`.
    ///
    /// ```
    /// use bowden::control::SmoothSign;
    /// assert_eq!(SmoothSign::Clamp.residue::<f32>(), 0.25);
    /// ```
    #[must_use]
    pub fn residue<T: Real>(self) -> T {
        match self {
            Self::Tanh => T::from_f64(TANH_RESIDUE),
            Self::Clamp => T::from_f64(0.25),
        }
    }
}
