//! One controller on one rig: the errors, and the data for the figures.

use super::feed::FeedForward;
use super::learned::{Learned, Running as Learns};
use super::limited::{AtLimit, Counted};
use super::observed::Observing;
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveState, DisturbanceObserver, Limits, Pid, PidInput, PidState,
};
use bowden::{model::Term, Error};
use bowden_rig::{Reference, Rig, RigConfig, RigSample};

/// Maximum number of undeclared effects in the rig.
pub const MOST_UNDECLARED: usize = 4;

/// The rate of the paper's experiment, and of the reference rig \[Hz\].
pub const RATE: f64 = 1000.0;

/// Start of the time over which errors are computed \[s\]. The errors to which the rig was
/// calibrated also start at 5 s.
pub const FROM: f64 = 5.0;

/// Start of the steady part \[s\]. Figure 9 of the paper shows the time before.
pub const TRANSIENT: f64 = 12.0;

/// The law of a controller.
// A handful exist at a time: a box would only cost `Copy`.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, Copy)]
pub enum Law {
    /// PI, PID or PIV.
    Pid(Pid<f64>),
    /// The adaptive law. The third regressor is the found effect, if there is one.
    Adaptive(ThreeRegressors),
}

impl Law {
    /// The limits of its command.
    fn limits(&self) -> Limits<f64> {
        match self {
            Self::Pid(pid) => pid.settings().limits,
            Self::Adaptive(law) => law.settings().limits,
        }
    }
}

/// The adaptive law with velocity, acceleration and the found effect as regressors.
pub type ThreeRegressors = Adaptive<f64, 3>;

/// A controller on the rig.
#[derive(Debug, Clone)]
pub struct Controller {
    /// Its name in tables and in JSON.
    pub name: String,
    /// Its law.
    pub law: Law,
    /// Number of steps per second \[Hz\].
    pub rate: f64,
    /// The law is called on every Nth step, where N is this number. Its command is held in between.
    pub every: usize,
    /// Feed-forward, added to the command.
    pub feed: Option<FeedForward>,
    /// A disturbance observer, with the feed-forward of its nominal plant. Both are added to the
    /// command.
    pub observer: Option<DisturbanceObserver<f64>>,
    /// Iterative learning over the cycle of the reference. Its feed-forward is also added to the
    /// command.
    pub learned: Option<Learned>,
    /// Feed-forward of the law itself per torque \[units/(N·m)\]. The adaptive law feeds the
    /// reference forward with the gain beta_hat, and the command of the model must not repeat this
    /// feed-forward.
    pub own_share: f64,
    /// The third regressor, which is the sum of the found effects along the reference.
    pub regressor: Option<FeedForward>,
}

impl Controller {
    /// A law by itself, called on every step.
    #[must_use]
    pub fn alone(name: &str, law: Law, rate: f64) -> Self {
        Self {
            name: name.to_owned(),
            law,
            rate,
            every: 1,
            feed: None,
            observer: None,
            learned: None,
            own_share: 0.0,
            regressor: None,
        }
    }
}

/// The conditions of a trial.
#[derive(Debug, Clone)]
pub struct Conditions {
    /// The parameters of the rig.
    pub rig: RigConfig<f64>,
    /// The undeclared effects of the rig.
    pub undeclared: Vec<Term<f64>>,
    /// The reference.
    pub reference: Reference<f64>,
    /// Duration of the trial \[s\].
    pub seconds: f64,
    /// Start of the time over which errors are computed \[s\].
    pub from: f64,
}

/// Errors of one part of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Rms of the true error \[N·m\].
    pub rmse_true: f64,
    /// Rms of the measured error \[N·m\].
    pub rmse_measured: f64,
    /// Largest true error \[N·m\].
    pub peak: f64,
}

/// The result of one trial.
#[derive(Debug, Clone, Default)]
pub struct Trial {
    /// Errors from `from` to the end.
    pub steady: Errors,
    /// Errors of the first [`TRANSIENT`] seconds, or of a shorter trial.
    pub transient: Errors,
    /// Largest command of the whole trial \[units\].
    pub command: f64,
    /// Total variation of the command per second over the steady part \[units/s\].
    pub effort: f64,
    /// Number of reversals of the command per second over the steady part \[1/s\].
    pub reversals: f64,
    /// Fraction of the steady part in which the command is at a limit.
    pub at_limit: AtLimit,
    /// Time at which the loop diverged \[s\]; `None` if the loop did not diverge.
    pub ran_away: Option<f64>,
    /// One row for each sample, if requested.
    pub trace: Vec<Row>,
}

/// One sample of a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Time \[s\].
    pub time: f64,
    /// Reference \[N·m\].
    pub reference: f64,
    /// Distal torque \[N·m\].
    pub tau_o: f64,
    /// Measured distal torque \[N·m\].
    pub measured: f64,
    /// Proximal torque \[N·m\].
    pub tau_i: f64,
    /// Command \[units\].
    pub command: f64,
    /// beta_hat, delta_hat and theta_hat, for adaptive laws only.
    pub estimates: Option<[f64; 5]>,
}

/// A law with its running state.
enum Running<'a> {
    Pid(&'a Pid<f64>, PidState<f64>),
    Adaptive(&'a ThreeRegressors, Box<AdaptiveState<f64, 3>>),
}

/// The inputs of a controller at one sample.
struct Reading<'a> {
    now: &'a RigSample<f64>,
    dt: f64,
    reference: f64,
    next_reference: f64,
    feed_forward: f64,
    /// The value of the third regressor.
    found: f64,
}

impl<'a> Running<'a> {
    fn new(law: &'a Law) -> Self {
        match law {
            Law::Pid(pid) => Self::Pid(pid, PidState::new()),
            Law::Adaptive(law) => Self::Adaptive(law, Box::new(AdaptiveState::new(law))),
        }
    }

    /// The command, and the estimates of an adaptive law.
    fn step(&mut self, at: &Reading<'_>) -> (f64, Option<[f64; 5]>) {
        let (now, feed_forward) = (at.now, at.feed_forward);
        match self {
            Self::Pid(pid, state) => {
                let input = PidInput {
                    velocity: now.distal.velocity,
                    feed_forward,
                    ..PidInput::new(at.dt, at.reference, now.measured)
                };
                (pid.step(state, &input).command, None)
            }
            Self::Adaptive(law, state) => {
                let x = [now.proximal.velocity, now.proximal.acceleration, at.found];
                let input = AdaptiveInput {
                    next_reference: at.next_reference,
                    feed_forward,
                    ..AdaptiveInput::new(at.dt, at.reference, now.measured, x)
                };
                let command = law.step(state, &input).command;
                let [a, b, c] = state.theta_hat();
                let estimates = [state.beta_hat(), state.delta_hat(), a, b, c];
                (command, Some(estimates))
            }
        }
    }
}

/// Sums over a part of a trial.
#[derive(Default)]
struct Sums {
    of_true: f64,
    of_measured: f64,
    peak: f64,
    count: f64,
}

impl Sums {
    fn add(&mut self, now: &RigSample<f64>, reference: f64) {
        self.of_true += (now.tau_o - reference).powi(2);
        self.of_measured += (now.measured - reference).powi(2);
        self.peak = self.peak.max((now.tau_o - reference).abs());
        self.count += 1.0;
    }

    fn errors(&self) -> Errors {
        let n = self.count.max(1.0);
        Errors {
            rmse_true: (self.of_true / n).sqrt(),
            rmse_measured: (self.of_measured / n).sqrt(),
            peak: self.peak,
        }
    }
}

/// Error beyond which a loop has diverged \[N·m\]. The range of the sensor ends at 100 N·m.
const RUNAWAY: f64 = 1000.0;

/// Runs one controller.
///
/// # Errors
/// The error of the core for an invalid parameter of the rig.
pub fn run(
    controller: &Controller,
    conditions: &Conditions,
    seed: u64,
    traced: bool,
) -> Result<Trial, Error> {
    let rig = Rig::<f64, MOST_UNDECLARED>::try_new(conditions.rig, &conditions.undeclared)?;
    let mut state = rig.start(seed);
    let mut running = Running::new(&controller.law);
    let (mut feed, mut regressor) = (controller.feed.clone(), controller.regressor.clone());
    let mut observing = controller.observer.as_ref().map(Observing::new);
    let mut learning = controller.learned.as_ref().map(Learns::new).transpose()?;
    let dt = 1.0 / controller.rate;
    let own_dt = dt * controller.every.max(1) as f64;
    let (mut command, mut estimates) = (0.0, None);
    let steps = (conditions.seconds * controller.rate).round() as usize;
    let (mut steady, mut transient) = (Sums::default(), Sums::default());
    let mut trial = Trial::default();
    let mut counted = Counted::new(controller.law.limits());
    let (mut last, mut before, mut turns) = (0.0_f64, 0.0_f64, 0.0);
    for step in 0..steps {
        let now = state.sample();
        let t = step as f64 * dt;
        let reference = conditions.reference.at(t);
        let feed_forward = feed.as_mut().map_or(0.0, |feed| {
            feed.step(&conditions.reference, t, dt).command - controller.own_share * reference
        });
        let found = regressor.as_mut().map_or(0.0, |found| {
            found.step(&conditions.reference, t, dt).effects
        });
        if step % controller.every.max(1) == 0 {
            let ahead = |lead| conditions.reference.motion(t + lead);
            let observed = observing.as_mut().map_or(0.0, |observing| {
                observing.step(own_dt, command, now.measured, ahead)
            });
            let learned = learning.as_mut().map_or(0.0, |learning| {
                learning.step(t, (reference, now.measured), ahead)
            });
            (command, estimates) = running.step(&Reading {
                now: &now,
                dt: own_dt,
                reference,
                next_reference: conditions.reference.at(t + own_dt),
                feed_forward: feed_forward + observed + learned,
                found,
            });
            if t > conditions.from {
                counted.add(last, command, own_dt);
            }
        }
        if traced {
            trial.trace.push(Row {
                time: t,
                reference,
                tau_o: now.tau_o,
                measured: now.measured,
                tau_i: now.tau_i,
                command,
                estimates,
            });
        }
        trial.command = trial.command.max(command.abs());
        if t < TRANSIENT {
            transient.add(&now, reference);
        }
        if t > conditions.from {
            steady.add(&now, reference);
            trial.effort += (command - last).abs();
            if (command - last) * (last - before) < 0.0 {
                turns += 1.0;
            }
        }
        (before, last) = (last, command);
        let next = rig.step(&mut state, command, dt);
        if next.diverged || (next.tau_o - reference).abs() > RUNAWAY {
            trial.ran_away = Some(t + dt);
            break;
        }
    }
    let span = (conditions.seconds - conditions.from).max(dt);
    trial.steady = steady.errors();
    trial.transient = transient.errors();
    trial.at_limit = counted.shares();
    trial.effort /= span;
    trial.reversals = turns / span;
    Ok(trial)
}
