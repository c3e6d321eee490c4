//! The equations of motion for one sub-step.

use super::checked::{finite, saturate};
use super::RigConfig;
use bowden::effect::{EffectState, Inputs, Motion, Offset, Quantity};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::model::{Source, Term};
use bowden::{Error, Real};

/// The mechanics, checked.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Plant<T, const N: usize> {
    config: RigConfig<T>,
    shape: BoucWen<T>,
    /// Only the first `len` effects are used.
    undeclared: [Term<T>; N],
    len: usize,
}

/// The moving state.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: Real + serde::Serialize, [EffectState<T>; N]: serde::Serialize",
        deserialize = "T: Real + serde::Deserialize<'de>, [EffectState<T>; N]: serde::Deserialize<'de>"
    ))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct PlantState<T, const N: usize> {
    pub(super) tau_m: T,
    pub(super) tau_i: T,
    pub(super) tau_o: T,
    proximal: Motion<T>,
    distal: Motion<T>,
    input_rate: T,
    hysteresis: BoucWenState<T>,
    effects: [EffectState<T>; N],
    configuration: (T, T, T),
    time: T,
}

impl<T: Real, const N: usize> PlantState<T, N> {
    pub(super) fn new() -> Self {
        let rest = Motion {
            position: T::zero(),
            velocity: T::zero(),
            acceleration: T::zero(),
        };
        Self {
            tau_m: T::zero(),
            tau_i: T::zero(),
            tau_o: T::zero(),
            proximal: rest,
            distal: rest,
            input_rate: T::zero(),
            hysteresis: BoucWenState::new(),
            effects: [EffectState::new(); N],
            configuration: (T::zero(), T::zero(), T::zero()),
            time: T::zero(),
        }
    }

    pub(super) fn proximal(&self) -> Motion<T> {
        self.proximal
    }

    pub(super) fn distal(&self) -> Motion<T> {
        self.distal
    }

    pub(super) fn eta(&self) -> T {
        self.hysteresis.eta()
    }

    /// Sets B, kappa_eta and T0 for the following sub-steps.
    pub(super) fn configure(&mut self, b: T, kappa_eta: T, t0: T) {
        self.configuration = (b, kappa_eta, t0);
    }

    fn is_finite(&self) -> bool {
        [self.tau_m, self.tau_i, self.tau_o, self.input_rate]
            .iter()
            .chain(
                [self.proximal, self.distal]
                    .map(|m| m.position + m.velocity + m.acceleration)
                    .iter(),
            )
            .all(|value| value.is_finite())
    }
}

impl<T: Real, const N: usize> Plant<T, N> {
    pub(super) fn try_new(config: &RigConfig<T>, undeclared: &[Term<T>]) -> Result<Self, Error> {
        let nothing = Term {
            effect: Offset.into(),
            source: Source::Input,
            origin: T::zero(),
            gain: T::zero(),
        };
        let mut own = [nothing; N];
        own.get_mut(..undeclared.len())
            .ok_or(Error::Capacity("undeclared effects"))?
            .copy_from_slice(undeclared);
        for term in undeclared {
            finite(term.origin, "origin")?;
            finite(term.gain, "gain")?;
            if !matches!(
                term.source,
                Source::Input | Source::Channel(0) | Source::Channel(1)
            ) {
                return Err(Error::OutOfRange("channel"));
            }
        }
        Ok(Self {
            config: *config,
            shape: BoucWen::try_new(config.rho, config.sigma, config.n)?,
            undeclared: own,
            len: undeclared.len(),
        })
    }

    pub(super) fn undeclared(&self) -> &[Term<T>] {
        self.undeclared.get(..self.len).unwrap_or(&self.undeclared)
    }

    /// Computes one sub-step of length `h`, and returns whether all values stayed finite.
    #[inline]
    pub(super) fn step(&self, state: &mut PlantState<T, N>, command: T, load: T, h: T) -> bool {
        let c = &self.config;
        let (p, d) = (state.proximal, state.distal);
        // Exact for a command that is held: the loop may be faster than the sub-step.
        let share = -(-h / c.drive_lag).exp_m1();
        state.tau_m += share * (c.drive_gain * command - state.tau_m);
        let stretch = p.position - d.position;
        let stretching = p.velocity - d.velocity;
        let tau_i = c.cable_stiffness * stretch + c.cable_damping * stretching;
        let input = Motion {
            position: tau_i,
            velocity: c.cable_stiffness * stretching
                + c.cable_damping * (p.acceleration - d.acceleration),
            acceleration: T::zero(),
        };
        let tau_o = self.output(state, input, h);

        let accelerate = |motion: Motion<T>, acceleration: T| {
            let velocity = motion.velocity + h * acceleration;
            Motion {
                position: motion.position + h * velocity,
                velocity,
                acceleration,
            }
        };
        state.proximal = accelerate(
            p,
            (state.tau_m - c.motor_damping * p.velocity - tau_i) / c.motor_inertia,
        );
        state.distal = accelerate(
            d,
            (tau_o + load - c.load_stiffness * d.position - c.joint_damping * d.velocity)
                / c.joint_inertia,
        );
        (state.tau_i, state.tau_o, state.input_rate) = (tau_i, tau_o, input.velocity);
        state.time += h;
        state.is_finite()
    }

    /// The torque at the transmission, after the input stages.
    #[inline]
    fn staged_input(&self, state: &mut PlantState<T, N>, input: Motion<T>, h: T) -> T {
        let mut moved = input.position;
        for (term, memory) in self.undeclared().iter().zip(&mut state.effects) {
            if term.effect.is_input_stage() {
                let at = Inputs {
                    dt: h,
                    time: state.time,
                    motion: match term.source {
                        Source::Input => input,
                        Source::Channel(0) => state.proximal,
                        Source::Channel(_) => state.distal,
                    },
                    input,
                    load: input.position,
                    ..Inputs::default()
                };
                moved = saturate(moved + term.gain * term.effect.regressor(memory, &at));
            }
        }
        moved
    }

    /// The distal torque: the transmission, then the effects as in a model.
    #[inline]
    fn output(&self, state: &mut PlantState<T, N>, input: Motion<T>, h: T) -> T {
        let (b, kappa_eta, t0) = state.configuration;
        let moved = self.staged_input(state, input, h);
        let eta = self.shape.step(&mut state.hysteresis, moved);
        let mut output = b * moved - kappa_eta * eta - t0;
        if self.len == 0 {
            return output;
        }
        let input = Motion {
            acceleration: (input.velocity - state.input_rate) / h,
            ..input
        };
        for stage in [false, true] {
            for (term, memory) in self.undeclared().iter().zip(&mut state.effects) {
                if term.effect.is_output_stage() != stage || term.effect.is_input_stage() {
                    continue;
                }
                let mut motion = match term.source {
                    Source::Input => input,
                    Source::Channel(0) => state.proximal,
                    Source::Channel(_) => state.distal,
                };
                if term.effect.info().reads.contains(&Quantity::Position) {
                    motion.position -= term.origin;
                }
                let at = Inputs {
                    dt: h,
                    time: state.time,
                    motion,
                    input,
                    load: input.position,
                    eta,
                    output,
                };
                output = saturate(output + term.effect.contribution(term.gain, memory, &at));
            }
        }
        output
    }
}
