//! Robust adaptive torque control with regressors, equations (17) to (26).
//!
//! The plant is `y = alpha·u - theta'x - D` (11). The errors are `e = y - y_r`, `z = ∫e` and
//! `s = e + lambda·z`. The virtual command (23) is
//! `ubar = -k·s + y_r - (z + e')/lambda + theta_hat'x - delta_hat·T(s/eps)`. Equation (19)
//! multiplies ubar by beta_hat, the estimate of 1/alpha. The estimates follow (24) to (26). The
//! regressors of Nguyen et al. (2018) are velocity and acceleration. **Any identified effect can be
//! an additional regressor.** Use its identified coefficient as the prior.
//!
//! **Two forms for two kinds of plant.** In discrete time, e' in (23) creates an algebraic loop.
//! The two forms treat this loop differently:
//! - The form [as published](Form::AsPublished) is for plants with inertia. It computes e' as a
//!   filtered difference.
//! - The [first-order](Form::FirstOrder) form is for plants that respond within a sample. It solves
//!   the algebraic loop for e'.
//!
//! **Bounds on the estimates.** The adaptive law clamps each estimate to its bounds (projection).
//! If the true value lies within the bounds, the clamp cannot increase the Lyapunov function. The
//! first-order form requires positive bounds for beta_hat, and non-negative bounds for delta_hat.

mod estimator;
#[cfg(kani)]
#[path = "../../../proofs/adaptive/mod.rs"]
mod proofs;
mod recursion;
mod resume;
mod settings;
mod smooth_sign;
mod state;
mod step;

pub use estimator::{Estimator, Leakage};
pub use recursion::{Disturbance, ErrorState, LagRecursion};
pub use settings::{AdaptiveSettings, Form, OnMissing};
pub use smooth_sign::SmoothSign;
pub(crate) use state::End;
pub use state::{AdaptiveInput, AdaptiveState, AdaptiveTerms};

use crate::Real;

/// Robust adaptive torque control with `N` regressors, equations (17) to (26).
///
/// ```
/// use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState};
/// let law = Adaptive::<f32, 2>::paper();
/// let mut state = AdaptiveState::new(&law);
/// // dt [s], reference and measured torque [N·m], velocity and acceleration.
/// let input = AdaptiveInput::new(0.001, 25.0, 24.7, [0.1, -0.3]);
/// let output = law.step(&mut state, &input);
/// assert_eq!(output.command, 0.0); // beta_hat starts at zero
/// assert!(state.beta_hat() > 0.0); // and grows, as the torque is too low
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Adaptive<T, const N: usize> {
    settings: AdaptiveSettings<T, N>,
    /// The longest step that is accepted \[s\].
    longest: T,
}

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// The settings of this law.
    pub fn settings(&self) -> &AdaptiveSettings<T, N> {
        &self.settings
    }

    /// Longest `dt` \[s\] that a step accepts.
    ///
    /// This is `longest_dt` of the settings or, in the first-order form, the smaller of
    /// `longest_dt` and [`largest_step`](AdaptiveSettings::largest_step).
    pub fn longest_dt(&self) -> T {
        self.longest
    }

    /// Whether the state is valid for this law: its numbers are finite, and z, the estimates and
    /// the command are within their limits.
    ///
    /// Call this method before the first use of a stored state. For any input, a step from a valid
    /// state leads to a valid state.
    ///
    /// ```
    /// use bowden::control::{Adaptive, AdaptiveState};
    /// let law = Adaptive::<f32, 2>::paper();
    /// assert!(law.is_valid(&AdaptiveState::new(&law)));
    /// ```
    #[must_use]
    pub fn is_valid(&self, state: &AdaptiveState<T, N>) -> bool {
        let settings = &self.settings;
        let mut theta = settings.theta.iter().zip(&state.theta);
        state.z.value.abs() <= settings.z_limit
            && state.z.carry.is_finite()
            && settings.beta.holds(&state.beta)
            && settings.delta.holds(&state.delta)
            && theta.all(|(theta, estimate)| theta.holds(estimate))
            && state.lag.value.is_finite()
            && state.lag.carry.is_finite()
            && state.error_rate.is_finite()
            && state.gap.is_finite()
            && state.gap >= T::ZERO
            && settings.limits.contains(state.held.command)
    }
}

impl<T: Real> Adaptive<T, 2> {
    /// The adaptive law with the settings in Table 2 of Nguyen et al. (2018), without bounds on the
    /// estimates.
    ///
    /// The form is as published. The filter of e', with a time constant of 5 ms, is not from the
    /// paper. The regressors are velocity \[rad/s\] and acceleration \[rad/s²\] of the proximal
    /// pulley. beta_hat starts at zero, where the loop gain is zero, so the output overshoots at
    /// start-up (Figure 9). To avoid this overshoot, set bounds and `beta.initial = 0.8/alpha`.
    ///
    /// ```
    /// use bowden::control::Adaptive;
    /// let table_2 = *Adaptive::<f64, 2>::paper().settings();
    /// assert_eq!(table_2.lambda * table_2.delta.gain, 0.05); // lambda·mu
    /// assert_eq!((table_2.beta.initial, table_2.delta.initial), (0.0, 7.0));
    /// ```
    pub fn paper() -> Self {
        let (of, leakage) = (T::from_f64, T::from_f64(0.01));
        let velocity = Estimator::free(T::zero()).adapting(of(0.004 / 8.0), leakage);
        let literal = Form::AsPublished {
            time_constant: of(0.005),
        };
        let settings = AdaptiveSettings {
            beta: Estimator::free(T::zero()).adapting(of(0.002 / 8.0), leakage),
            delta: Estimator::free(of(7.0)).adapting(of(0.05 / 8.0), leakage),
            theta: [velocity; 2],
            ..AdaptiveSettings::unlimited(literal, of(24.0), of(8.0), of(0.05))
        };
        Self {
            // Of the form as published.
            longest: settings.longest_dt,
            settings,
        }
    }
}

crate::checked::stored_as! { Adaptive<T, N> as AdaptiveSettings<T, N>: |law| law.settings, Adaptive::try_new }
