//! Gains, model and rig in one TOML form.
//!
//! Every entry is optional. The defaults are those of the paper or of the reference rig. An unknown
//! key is an error with line and column.
//!
//! ```toml
//! [rig]                    # any field of `RigConfig`
//! noise = 0.02             # [N·m rms]
//! [rig.drift]              # the conduit is moved; leave the table out for a fixed one
//! time = 2.0
//! b = 0.02
//! kappa_eta = 0.1
//! t0 = 0.2
//!
//! [pi]                     # Table 1; also [pid], [piv] and [matched_pi]
//! k_p = 30.0
//! k_i = 18.0
//! [pid]
//! k_d = 2.0
//! derivative_time = 0.1    # [s]
//!
//! [observer]               # a PI with a disturbance observer, on the rig's own drive
//! k_p = 12.0
//! k_i = 60.0
//! frequency = 10.0         # of the filter Q [Hz]
//! limit = 60.0             # of what it adds [units]
//! gain = 0.6               # the nominal plant [N·m/unit], [rad/s]; from the rig if left out
//! natural_frequency = 25.5
//! damping_ratio = 0.265
//!
//! [learning]               # a PI with learning over the cycle of --gait, on the rig's own drive
//! k_p = 30.0
//! k_i = 18.0
//! gain = 4.0               # [units/(N·m)]
//! lead = 0.012             # [s]
//! frequency = 16.0         # of the filter Q [Hz]
//! cells = 250              # of a cycle
//! limit = 30.0             # of what is learned [units]
//!
//! [adaptive]               # Table 2, in its own terms
//! k = 24.0
//! lambda = 8.0
//! lambda_mu = 0.05
//! lambda_gamma = 0.002
//! lambda_mu_i = 0.004
//! sigma = 0.01
//! sigma_alpha = 0.01
//! sigma_i = 0.01
//! epsilon = 0.05
//! derivative_time = 0.005  # [s]; 5 ms is not in the paper
//! beta = 0.0               # initial estimates
//! delta = 7.0
//!
//! [model]                  # what `bowden identify --model-out` writes
//! schema = "bowden.model/1"
//! mode = "torque"
//! channels = []
//! [model.transmission]
//! gain = 0.9978
//! kappa_eta = 7.004
//! offset = 0.05174
//! rho = 0.09582
//! sigma = 0.5
//! n = 3.871
//! ```
//!
//! A file that contains only such a model is accepted too. Together with gains,
//! `bowden compare --model` gives the rig the transmission and the effects of this model
//! ([`own_rig`](super::own_rig)).

use bowden::control::{AdaptiveSettings, DerivativeSource, Estimator, Form, Leakage, PidSettings};
use bowden_lab::export::ModelFile;
use bowden_rig::RigConfig;
use serde::{Deserialize, Serialize};

/// The whole form.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Setup {
    /// The rig.
    pub rig: RigConfig<f64>,
    /// PI (15).
    pub pi: PidGains,
    /// PID (14).
    pub pid: PidGains,
    /// PIV (16).
    pub piv: PidGains,
    /// The PI with the integral gain of the adaptive law.
    pub matched_pi: PidGains,
    /// The PI with a disturbance observer.
    pub observer: ObserverGains,
    /// The PI with iterative learning, if the reference repeats.
    pub learning: IterativeLearningGains,
    /// The adaptive law.
    pub adaptive: AdaptiveGains,
    /// The model of the feed-forward; default: the rig's own transmission.
    pub model: Option<ModelFile>,
}

/// Gains of PI, PID or PIV; default: the paper's.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PidGains {
    /// Proportional gain \[units/(N·m)\].
    pub k_p: Option<f64>,
    /// Integral gain \[units/(N·m·s)\].
    pub k_i: Option<f64>,
    /// Derivative gain \[units·s/(N·m)\]; velocity gain of PIV \[units·s/rad\].
    pub k_d: Option<f64>,
    /// Time constant of the derivative filter \[s\].
    pub derivative_time: Option<f64>,
}

impl PidGains {
    /// The paper's settings with these gains.
    #[must_use]
    pub fn over(&self, paper: &PidSettings<f64>) -> PidSettings<f64> {
        PidSettings {
            k_p: self.k_p.unwrap_or(paper.k_p),
            k_i: self.k_i.unwrap_or(paper.k_i),
            k_d: self.k_d.unwrap_or(paper.k_d),
            derivative_time: self.derivative_time.unwrap_or(paper.derivative_time),
            ..*paper
        }
    }

    /// The paper's PIV, whose damping term reads the joint velocity, with these gains.
    #[must_use]
    pub fn over_piv(&self, paper: &PidSettings<f64>) -> PidSettings<f64> {
        PidSettings {
            damping: DerivativeSource::Velocity,
            ..self.over(paper)
        }
    }
}

/// A PI with a disturbance observer; the nominal plant defaults to the rig's values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObserverGains {
    /// Proportional gain \[units/(N·m)\].
    pub k_p: f64,
    /// Integral gain \[units/(N·m·s)\].
    pub k_i: f64,
    /// Corner frequency of Q \[Hz\].
    pub frequency: f64,
    /// Largest magnitude of the observer's estimate \[units\].
    pub limit: f64,
    /// Gain of the nominal plant \[N·m/unit\].
    pub gain: Option<f64>,
    /// wn of the nominal plant \[rad/s\].
    pub natural_frequency: Option<f64>,
    /// zeta of the nominal plant.
    pub damping_ratio: Option<f64>,
}

impl Default for ObserverGains {
    /// A PI with two fifths of the paper's proportional gain.
    fn default() -> Self {
        Self {
            k_p: 12.0,
            k_i: 60.0,
            frequency: 10.0,
            limit: 60.0,
            gain: None,
            natural_frequency: None,
            damping_ratio: None,
        }
    }
}

/// A PI with iterative learning over the cycle of a reference that repeats.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct IterativeLearningGains {
    /// Proportional gain \[units/(N·m)\].
    pub k_p: f64,
    /// Integral gain \[units/(N·m·s)\].
    pub k_i: f64,
    /// Learning gain \[units/(N·m)\].
    pub gain: f64,
    /// Time from a command to its effect \[s\].
    pub lead: f64,
    /// Corner frequency of Q \[Hz\].
    pub frequency: f64,
    /// Number of cells in a cycle.
    pub cells: usize,
    /// Largest magnitude of the learned values \[units\].
    pub limit: f64,
}

impl Default for IterativeLearningGains {
    /// The paper's PI.
    fn default() -> Self {
        Self {
            k_p: 30.0,
            k_i: 18.0,
            gain: 4.0,
            lead: 0.012,
            frequency: 16.0,
            cells: 250,
            limit: 30.0,
        }
    }
}

/// Gains of the adaptive law in the terms of Table 2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptiveGains {
    /// k of (23).
    pub k: f64,
    /// lambda of (18) \[1/s\].
    pub lambda: f64,
    /// lambda·mu of (25).
    pub lambda_mu: f64,
    /// lambda·gamma of (24).
    pub lambda_gamma: f64,
    /// lambda·mu_i of (26).
    pub lambda_mu_i: f64,
    /// Leakage of delta_hat \[1/s\].
    pub sigma: f64,
    /// Leakage of beta_hat \[1/s\].
    pub sigma_alpha: f64,
    /// Leakage of theta_hat \[1/s\].
    pub sigma_i: f64,
    /// Width of the smoothed sign function \[N·m\].
    pub epsilon: f64,
    /// Time constant of the filter of the error rate \[s\].
    pub derivative_time: f64,
    /// Initial beta_hat \[units/(N·m)\].
    pub beta: f64,
    /// Initial delta_hat \[N·m\].
    pub delta: f64,
}

impl Default for AdaptiveGains {
    /// Table 2.
    fn default() -> Self {
        Self {
            k: 24.0,
            lambda: 8.0,
            lambda_mu: 0.05,
            lambda_gamma: 0.002,
            lambda_mu_i: 0.004,
            sigma: 0.01,
            sigma_alpha: 0.01,
            sigma_i: 0.01,
            epsilon: 0.05,
            derivative_time: 0.005,
            beta: 0.0,
            delta: 7.0,
        }
    }
}

impl AdaptiveGains {
    /// The settings of the core with velocity and acceleration as regressors, (19)-(26).
    #[must_use]
    pub fn paper_settings(&self) -> AdaptiveSettings<f64, 2> {
        let AdaptiveSettings {
            form,
            gain,
            lambda,
            epsilon,
            beta,
            delta,
            theta: [velocity, acceleration, _],
            ..
        } = self.settings(0.0);
        AdaptiveSettings {
            beta,
            delta,
            theta: [velocity, acceleration],
            ..AdaptiveSettings::unlimited(form, gain, lambda, epsilon)
        }
    }

    /// The settings of the core, with a third regressor that starts at `prior` and leaks to it.
    #[must_use]
    pub fn settings(&self, prior: f64) -> AdaptiveSettings<f64, 3> {
        let theta = Estimator::free(0.0).adapting(self.lambda_mu_i / self.lambda, self.sigma_i);
        let third = Estimator {
            prior,
            gain: if prior == 0.0 { 0.0 } else { theta.gain },
            leakage: if prior == 0.0 {
                Leakage::None
            } else {
                theta.leakage
            },
            ..Estimator::free(prior)
        };
        let literal = Form::AsPublished {
            time_constant: self.derivative_time,
        };
        AdaptiveSettings {
            beta: Estimator::free(self.beta)
                .adapting(self.lambda_gamma / self.lambda, self.sigma_alpha),
            delta: Estimator::free(self.delta).adapting(self.lambda_mu / self.lambda, self.sigma),
            theta: [theta, theta, third],
            ..AdaptiveSettings::unlimited(literal, self.k, self.lambda, self.epsilon)
        }
    }
}
