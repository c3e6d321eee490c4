//! Models that are loaded: any effect of the catalogue may be in them.

use crate::cable::{transmission, INVERTIBLE};
use crate::{Case, Output, Sample};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::effect::{Backlash, Coulomb, Effect, Gravity, Motion, Ripple, Stribeck};
use bowden::model::{Model, ModelState, Sample as Measured, Source, Term};
use bowden::Error;
use core::hint::black_box;

fn term(effect: Effect<f32>, gain: f32) -> Term<f32> {
    Term {
        effect,
        source: Source::Channel(0),
        origin: 0.0,
        gain,
    }
}

/// Viscous and Coulomb friction of the pulley.
fn two() -> Result<[Term<f32>; 2], Error> {
    Ok([
        term(Effect::Viscous, -0.4),
        term(Effect::Coulomb(Coulomb::try_new(0.05)?), -0.8),
    ])
}

/// What a bench may find on one joint, one effect with memory among them.
fn eight() -> Result<[Term<f32>; 8], Error> {
    let [viscous, coulomb] = two()?;
    Ok([
        viscous,
        coulomb,
        term(Effect::Stribeck(Stribeck::try_new(0.05, 0.2)?), -0.3),
        term(Effect::Inertia, -0.02),
        term(Effect::StiffnessCubic, 1.5),
        term(Effect::Gravity(Gravity::try_new(0.1)?), 0.6),
        term(Effect::Ripple(Ripple::try_new(6.0, 0.3)?), 0.1),
        term(Effect::Backlash(Backlash::try_new(0.02)?), 0.5),
    ])
}

fn pulley(at: &Sample) -> [Motion<f32>; 1] {
    [Motion {
        position: at.position,
        velocity: at.velocity,
        acceleration: at.acceleration,
    }]
}

/// A model of at most `N` terms on the paper's first set, at sigma = 0.6.
#[derive(Debug)]
struct Loaded<const N: usize> {
    model: Model<f32, N>,
    state: ModelState<f32, N>,
}

impl<const N: usize> Loaded<N> {
    fn try_new(terms: [Term<f32>; N]) -> Result<Self, Error> {
        Ok(Self {
            model: Model::try_new(Some(transmission(INVERTIBLE)?), &black_box(terms))?,
            state: ModelState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        let input = Motion {
            position: at.input,
            ..Motion::default()
        };
        let sample = Measured {
            dt: at.dt,
            input,
            load: at.input,
            channels: &pulley(at),
        };
        Output::of(self.model.step(&mut self.state, &sample))
    }
}

/// A model with two effects; the value is tau_o.
#[derive(Debug)]
pub struct TwoEffects(Loaded<2>);

impl Case for TwoEffects {
    fn try_new() -> Result<Self, Error> {
        Loaded::try_new(two()?).map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(at)
    }
}

/// A model with eight effects; the value is tau_o.
#[derive(Debug)]
pub struct EightEffects(Loaded<8>);

impl Case for EightEffects {
    /// The sine of a ripple needs 700 bytes where it reduces a large argument.
    const STACK: usize = 2048;

    fn try_new() -> Result<Self, Error> {
        Loaded::try_new(eight()?).map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(at)
    }
}

/// The model of two effects turned round; the value is tau_i.
#[derive(Debug)]
pub struct Compensated {
    compensator: Compensator<f32, 2>,
    state: CompensatorState<f32, 2>,
}

impl Case for Compensated {
    fn try_new() -> Result<Self, Error> {
        let model = Model::try_new(Some(transmission(INVERTIBLE)?), &black_box(two()?))?;
        Ok(Self {
            compensator: Compensator::try_new(&model)?,
            state: CompensatorState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        let sample = CompensatorInput {
            channels: &pulley(at),
            ..CompensatorInput::new(at.dt, at.input)
        };
        let out = self.compensator.step(&mut self.state, &sample);
        Output::commanded(out.command, out.status)
    }
}
