//! A conduit that moves during operation, so B, kappa_eta and T0 drift.

use super::{Noise, RigConfig};
use bowden::signal::clamp;
use bowden::Real;

/// Size and speed of the drift of B, kappa_eta and T0.
///
/// The drift consists of three Ornstein-Uhlenbeck processes with unit variance. Each process
/// advances exactly over a sample: `o⁺ = a·o + sqrt(1 − a²)·N(0, 1)` with `a = e^(−dt/time)`. B
/// becomes `B − b·|o1|`, clamped to [0.85, 1]. kappa_eta changes by the fraction `kappa_eta·o2`,
/// clamped to ±50 %. T0 becomes `T0 + t0·o3`. All processes start at zero.
///
/// ```
/// let drift = bowden_rig::Drift::<f64>::reference();
/// assert_eq!((drift.b, drift.kappa_eta, drift.t0), (0.02, 0.10, 0.2));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Drift<T> {
    /// Correlation time \[s\].
    pub time: T,
    /// Size of the drift of B: the standard deviation of `b·o1`.
    pub b: T,
    /// Standard deviation of kappa_eta, as a fraction of kappa_eta.
    pub kappa_eta: T,
    /// Standard deviation of T0 \[N·m\].
    pub t0: T,
}

impl<T: Real> Drift<T> {
    /// The reference drift: 2 s, 0.02, 10 % and 0.2 N·m.
    #[must_use]
    pub fn reference() -> Self {
        Self {
            time: T::from_f64(2.0),
            b: T::from_f64(0.02),
            kappa_eta: T::from_f64(0.10),
            t0: T::from_f64(0.2),
        }
    }
}

/// The three processes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct DriftState<T> {
    processes: [T; 3],
}

impl<T: Real> DriftState<T> {
    pub(super) fn new() -> Self {
        Self {
            processes: [T::zero(); 3],
        }
    }

    /// B, kappa_eta and T0 for the next `dt` \[s\].
    pub(super) fn step(
        &mut self,
        drift: Option<&Drift<T>>,
        config: &RigConfig<T>,
        noise: &mut Noise,
        dt: T,
    ) -> (T, T, T) {
        let Some(drift) = drift else {
            return (config.b, config.kappa_eta, config.t0);
        };
        let keep = (-dt / drift.time).exp();
        let push = (-(-T::from_f64(2.0) * dt / drift.time).exp_m1()).sqrt();
        for process in &mut self.processes {
            *process = keep * *process + push * noise.normal();
        }
        let [first, second, third] = self.processes;
        let half = T::from_f64(0.5);
        (
            clamp(
                config.b - drift.b * first.abs(),
                T::from_f64(0.85),
                T::one(),
            ),
            config.kappa_eta * (T::one() + clamp(drift.kappa_eta * second, -half, half)),
            config.t0 + drift.t0 * third,
        )
    }
}
