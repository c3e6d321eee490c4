//! An undeclared effect is identified on the bench and removed from the tracking error by a
//! feed-forward.

use super::bench::{identify, record, Identified};
use super::data_sheet::latency;
use super::lineup::{adaptive, Laws};
use super::setup::{AdaptiveGains, Setup};
use super::table::{run_all, Line};
use super::trial::{Conditions, Controller, Law, RATE};
use super::undeclared::Undeclared;
use bowden::control::{Pid, PidSettings};
use std::cmp::Ordering;

/// Rate of the slow loops \[Hz\].
pub const SLOW: f64 = 250.0;

/// Gains of the quiet loops, as a fraction of the paper's gains.
pub const QUIET: f64 = 0.2;

/// One controller with the baseline model and with the found terms.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Name of the controller, and the use of the model.
    pub controller: String,
    /// The result without any model.
    pub plain: Line,
    /// The result with the baseline model, which is fitted to the bench record.
    pub declared: Line,
    /// The result with the found terms in addition.
    pub found: Line,
}

impl Pair {
    /// Compares the error with the found terms and the error with the baseline model. A loop that
    /// diverges counts as the worst.
    #[must_use]
    pub fn against_before(&self) -> Ordering {
        let error = |line: &Line| line.mean_error().unwrap_or(f64::INFINITY);
        error(&self.found).total_cmp(&error(&self.declared))
    }

    /// The relative increase of the error with the found terms; `None` if a law diverged.
    #[must_use]
    pub fn change(&self) -> Option<f64> {
        Some(self.found.mean_error()? / self.declared.mean_error()? - 1.0)
    }
}

/// One seed, with its own bench record, identification and trials.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The seed.
    pub seed: u64,
    /// The changes that made the found model invertible, if any.
    pub fed_with: Option<String>,
    /// The identified model.
    pub identified: Identified,
    /// Every controller.
    pub pairs: Vec<Pair>,
}

/// A kind of loop, and its use of the model.
struct Kind {
    name: &'static str,
    rate: f64,
    law: fn(&Setup, &Laws, f64) -> Result<Law, bowden::Error>,
    /// Whether the model is the third regressor instead of a feed-forward.
    regressor: bool,
}

fn quiet(pid: &Pid<f64>) -> Result<Law, bowden::Error> {
    let settings = *pid.settings();
    let quiet = PidSettings {
        k_p: QUIET * settings.k_p,
        k_i: QUIET * settings.k_i,
        ..settings
    };
    Pid::try_new(quiet).map(Law::Pid)
}

/// The adaptive law with a tenth of the gain k, an initial delta_hat of zero, and ten times the
/// epsilon and the filter time.
fn quiet_adaptive(gains: &AdaptiveGains) -> AdaptiveGains {
    AdaptiveGains {
        k: 0.5 * QUIET * gains.k,
        // From zero, a quiet law would take minutes to find its beta_hat.
        beta: if gains.beta == 0.0 { 1.6 } else { gains.beta },
        delta: 0.0,
        epsilon: 10.0 * gains.epsilon,
        derivative_time: 10.0 * gains.derivative_time,
        ..*gains
    }
}

const KINDS: [Kind; 7] = [
    Kind {
        name: "pi",
        rate: RATE,
        law: |_, laws, _| Ok(Law::Pid(laws.pi)),
        regressor: false,
    },
    Kind {
        name: "pid",
        rate: RATE,
        law: |_, laws, _| Ok(Law::Pid(laws.pid)),
        regressor: false,
    },
    Kind {
        name: "pi-quiet",
        rate: RATE,
        law: |_, laws, _| quiet(&laws.pi),
        regressor: false,
    },
    Kind {
        name: "pi-250hz-quiet",
        rate: SLOW,
        law: |_, laws, _| quiet(&laws.pi),
        regressor: false,
    },
    Kind {
        name: "adaptive",
        rate: RATE,
        law: |setup, _, prior| adaptive(&setup.adaptive, prior).map(Law::Adaptive),
        regressor: true,
    },
    Kind {
        name: "adaptive-quiet",
        rate: RATE,
        law: |setup, _, prior| adaptive(&quiet_adaptive(&setup.adaptive), prior).map(Law::Adaptive),
        regressor: true,
    },
    Kind {
        name: "adaptive-250hz-quiet",
        rate: SLOW,
        law: |setup, _, prior| adaptive(&quiet_adaptive(&setup.adaptive), prior).map(Law::Adaptive),
        regressor: true,
    },
];

/// Runs one seed from the bench record to the tracking errors.
///
/// # Errors
/// A message from the rig, the identification or the feed-forward.
pub fn outcome(
    setup: &Setup,
    undeclared: &Undeclared,
    conditions: &Conditions,
    seed: u64,
    traced: bool,
) -> Result<Outcome, String> {
    let term = undeclared.term(&setup.rig, &conditions.reference)?;
    let conditions = Conditions {
        undeclared: vec![term],
        // A start that overshoots would decide what the adaptive law has learnt, instead of the
        // effect: the reference rises from zero over two seconds.
        reference: conditions.reference.with_ramp(2.0),
        ..conditions.clone()
    };
    let identified = identify(&record(&setup.rig, &conditions.undeclared, seed)?)?;
    let laws = Laws::new(setup).map_err(|(what, e)| format!("[{what}]: {e}"))?;
    let found = identified.feed(&identified.found, 0.0)?;
    let fed_with = found.changed_words().map(str::to_owned);
    let mut controllers = Vec::new();
    for kind in &KINDS {
        let refused = |e: bowden::Error| format!("{}: {e}", kind.name);
        let delay = latency(&setup.rig, kind.rate);
        let declared = identified.feed(&identified.declared, delay)?;
        let found = identified.feed(&identified.found, delay)?;
        let controller = |prior: f64| -> Result<Controller, String> {
            let law = (kind.law)(setup, &laws, prior).map_err(refused)?;
            Ok(Controller::alone(kind.name, law, kind.rate))
        };
        let plain = controller(0.0)?;
        controllers.push(plain.clone());
        if kind.regressor {
            // The law compensates what it knows by itself; the baseline model adds none.
            controllers.push(plain);
            controllers.push(Controller {
                regressor: Some(found),
                // In (11) the disturbance is subtracted: theta is minus the bench's gain.
                ..controller(-1.0)?
            });
        } else {
            controllers.push(Controller {
                feed: Some(declared),
                ..plain.clone()
            });
            controllers.push(Controller {
                feed: Some(found),
                ..plain
            });
        }
    }
    let lines = run_all(&controllers, &conditions, &[seed], traced)?;
    let mut lines = lines.into_iter();
    let mut pairs = Vec::new();
    for kind in &KINDS {
        if let (Some(plain), Some(declared), Some(found)) =
            (lines.next(), lines.next(), lines.next())
        {
            let how = match kind.regressor {
                true => "third regressor",
                false => "feed-forward",
            };
            pairs.push(Pair {
                controller: format!("{} ({how})", kind.name),
                plain,
                declared,
                found,
            });
        }
    }
    Ok(Outcome {
        seed,
        fed_with,
        identified,
        pairs,
    })
}
