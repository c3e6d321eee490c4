//! Robust adaptive torque control, (17)-(26), with any number of regressors.
//!
//! The plant is `y = alpha·u - theta'x - D` (11). The errors are `e = y - y_r`, `z = ∫e` and
//! `s = e + lambda·z`. The virtual command (23) is `ubar = -k·s + y_r - (z + e')/lambda +
//! theta_hat'x - delta_hat·T(s/eps)`. The law multiplies ubar by beta_hat, the estimate of 1/alpha
//! (19). The estimates follow (24)-(26). The regressors of Nguyen et al. (2018) are velocity and
//! acceleration; **each effect that the bench identifies is a further regressor**, with its value
//! from the bench as prior.
//!
//! **Two forms for two kinds of plant.** In sampled time e' creates an algebraic loop:
//! - The form [as published](Form::AsPublished), for plants with inertia, closes the loop through a
//!   filtered difference.
//! - The [first-order](Form::FirstOrder) form, for plants that respond within a sample, solves the
//!   loop.
//!
//! On the plant of the other form, each form diverges (tests `control_adaptive`).
//!
//! **Bounds on the estimates.** The law clamps each estimate to its bounds (projection). If the
//! true value lies within the bounds, the clamp cannot raise the Lyapunov function, and every
//! invariant holds for any measurement. The paper uses no bounds: [`Adaptive::paper`] has
//! bounds as wide as the range of the float. The first-order form requires bounds above zero for
//! beta_hat, and bounds not below zero for delta_hat.

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

/// Robust adaptive torque control with `N` regressors, (17)-(26).
///
/// ```
/// use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState};
/// let law = Adaptive::<f32, 2>::paper();
/// let mut state = AdaptiveState::new(&law);
/// // dt \[s\], reference and measured torque [N·m], velocity and acceleration.
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
    /// This is `longest_dt` of the settings or, in the first-order form, the [largest
    /// step](AdaptiveSettings::largest_step), whichever is shorter.
    pub fn longest_dt(&self) -> T {
        self.longest
    }

    /// Whether the state is valid for this law: its numbers are finite and every estimate is within
    /// its bounds.
    ///
    /// Check a stored state before its first use. A step maps a valid state to a valid state,
    /// for any input.
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
    /// Table 2 of Nguyen et al. (2018), with the paper's initial estimates and no projection.
    ///
    /// The form is as published. The filter of the error's rate, 5 ms, is not in the paper. The
    /// regressors are velocity \[rad/s\] and acceleration \[rad/s²\] of the proximal pulley.
    /// The estimate beta_hat starts at zero, the singular point of the loop, so the start-up
    /// overshoots (Figure 9). Bounds and `beta.initial = 0.8/alpha` avoid this overshoot.
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
