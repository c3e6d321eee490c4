//! The rig: its motions and its measurements.

use super::excitation::{Motion, Pace, Tones};
use super::recipe::{Base, Mode, Recipe};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Everything on the rig at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moment {
    /// Time \[s\]; negative before the record starts.
    pub(super) t: f64,
    /// Time since the moment before.
    pub(super) dt: f64,
    pub(super) input: Motion,
    pub(super) proximal: Motion,
    pub(super) distal: Motion,
    pub(super) load: Motion,
    pub(super) temperature: Motion,
    pub(super) auxiliary: Motion,
    pub(super) eta: f64,
}

/// A quantity that an effect may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    Input,
    Proximal,
    Distal,
    /// The lead of the pulley over the joint.
    Stretch,
    Load,
    Temperature,
    Auxiliary,
}

impl Channel {
    const ALL: [Self; 7] = [
        Self::Input,
        Self::Proximal,
        Self::Distal,
        Self::Stretch,
        Self::Load,
        Self::Temperature,
        Self::Auxiliary,
    ];

    /// Name and unit in the header; `None` if the mode has no such channel.
    pub(super) fn label(self, mode: Mode) -> Option<(&'static str, &'static str)> {
        match (self, mode) {
            (Self::Input, Mode::Torque) => Some(("tau_i", "N·m")),
            (Self::Input, Mode::Displacement) => Some(("x", "mm")),
            (Self::Proximal, Mode::Torque) => Some(("phi_p", "rad")),
            (Self::Distal, Mode::Torque) => Some(("phi_d", "rad")),
            (Self::Stretch, Mode::Torque) => Some(("stretch", "rad")),
            (Self::Load, Mode::Displacement) => Some(("load", "N")),
            (Self::Temperature, _) => Some(("temperature", "°C")),
            (Self::Auxiliary, _) => Some(("aux", "V")),
            _ => None,
        }
    }

    pub(super) fn named(name: &str, mode: Mode) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|channel| channel.label(mode).is_some_and(|label| label.0 == name))
    }

    pub(super) fn of(self, moment: &Moment) -> Motion {
        match self {
            Self::Input => moment.input,
            Self::Proximal => moment.proximal,
            Self::Distal => moment.distal,
            Self::Stretch => moment.proximal.plus(moment.distal, -1.0),
            Self::Load => moment.load,
            Self::Temperature => moment.temperature,
            Self::Auxiliary => moment.auxiliary,
        }
    }
}

pub(super) struct Rig {
    mode: Mode,
    pace: Pace,
    input: Tones,
    joint: Tones,
    routing: Tones,
    load: Tones,
    auxiliary: Tones,
    /// Stiffness of the cable \[N·m/rad\].
    cable: f64,
    /// Stiffness that the joint works against \[N·m/rad\].
    environment: f64,
    seconds: f64,
    warming: f64,
    weather: f64,
}

impl Rig {
    pub(super) fn draw(rng: &mut ChaCha8Rng, recipe: &Recipe) -> Self {
        let seconds = recipe.seconds;
        // Low tones that a short record could not hold would only be a drift.
        let low = 0.15_f64.max(2.0 / seconds);
        Self {
            mode: recipe.mode,
            pace: Pace {
                holds: recipe.holds,
            },
            input: Tones::draw(
                rng,
                (low, 8.0 * low),
                4,
                (recipe.amplitude, recipe.bias),
                seconds,
            ),
            joint: Tones::draw(rng, (1.3 * low, 5.0 * low), 3, (0.45, 0.1), seconds),
            routing: Tones::draw(rng, (low, 4.0 * low), 2, (0.12, 0.0), seconds),
            load: Tones::draw(rng, (0.7 * low, 4.0 * low), 3, (14.0, 20.0), seconds),
            auxiliary: Tones::draw(rng, (low, 6.0 * low), 3, (1.0, 0.0), seconds),
            cable: recipe.amplitude / rng.random_range(0.2..0.35),
            environment: recipe.amplitude / rng.random_range(0.1..0.2),
            seconds,
            warming: rng.random_range(3.0..6.0),
            weather: rng.random_range(0.0..TAU),
        }
    }

    /// Everything but the hysteresis.
    pub(super) fn at(&self, t: f64, dt: f64) -> Moment {
        let own = self.pace.at(t);
        let paced = |tones: &Tones| Pace::of(own, tones.at(own.x));
        let input = paced(&self.input);
        let mut moment = Moment {
            t,
            dt,
            input,
            load: input,
            ..Moment::default()
        };
        moment.auxiliary = self.auxiliary.at(t);
        moment.temperature = self.temperature(t);
        match self.mode {
            // The joint moves on its own and yields to the torque; the proximal
            // pulley leads it by the stretch of the cable and its routing.
            Mode::Torque => {
                moment.distal = paced(&self.joint).plus(input, 1.0 / self.environment);
                let stretched = moment.distal.plus(input, 1.0 / self.cable);
                moment.proximal = stretched.plus(paced(&self.routing), 1.0);
            }
            Mode::Displacement => moment.load = paced(&self.load),
        }
        moment
    }

    /// Rate of the input alone.
    pub(super) fn input_rate(&self, t: f64) -> f64 {
        let own = self.pace.at(t);
        Pace::of(own, self.input.at(own.x)).v
    }

    /// A rig that warms up in a room that is not steady.
    fn temperature(&self, t: f64) -> Motion {
        let decay = (-3.0 * t / self.seconds).exp();
        let w = TAU * 1.7 / self.seconds;
        let (s, c) = (w * t + self.weather).sin_cos();
        Motion {
            x: 23.0 + self.warming * (1.0 - decay) + 1.2 * s,
            v: self.warming * 3.0 / self.seconds * decay + 1.2 * w * c,
            a: 0.0,
        }
    }
}

/// A transmission in the paper's range, with a loop that a record can identify.
pub(super) fn base(rng: &mut ChaCha8Rng, recipe: &Recipe) -> Base {
    let sigma = rng.random_range(0.6..3.0);
    let n = rng.random_range(1.0..3.0);
    let reach = rng.random_range(2.5..7.5);
    let rho = reach / recipe.amplitude;
    let drawn = match recipe.mode {
        Mode::Torque => Base {
            gain: rng.random_range(0.92..0.98),
            kappa_eta: rng.random_range(2.0..7.0),
            offset: 0.05,
            rho,
            sigma,
            n,
        },
        Mode::Displacement => Base {
            gain: rng.random_range(1.0..3.0),
            kappa_eta: rng.random_range(4.0..12.0),
            offset: 0.3,
            rho,
            sigma,
            n,
        },
    };
    recipe.base.unwrap_or(drawn)
}
