//! Models: of effects that are types, as an export writes them, and one that is loaded, in
//! which any effect of the catalogue may be.

use crate::cable::{fixed, transmission, INVERTIBLE};
use crate::{Case, Output, Sample};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::effect::{Backlash, Coulomb, CurveVelocity, Gravity, Inertia, Motion, Offset};
use bowden::effect::{Ripple, StiffnessCubic, Stribeck, Viscous};
use bowden::model::{FixedModel, Model, ModelState, Sample as Measured, Source, Term};
use bowden::Error;
use core::hint::black_box;

fn term<E>(effect: E, gain: f32) -> Term<f32, E> {
    Term {
        effect,
        source: Source::Channel(0),
        origin: 0.0,
        gain,
    }
}

type Of<E> = Term<f32, E>;

type Two = (Of<Viscous>, Of<Coulomb<f32>>);

/// Viscous and Coulomb friction of the pulley.
#[inline]
fn two_terms() -> Result<Two, Error> {
    Ok((term(Viscous, -0.4), term(Coulomb::try_new(0.05)?, -0.8)))
}

/// The two effects, of which the compiler knows no number.
fn two() -> Result<FixedModel<f32, 2, Two>, Error> {
    FixedModel::try_new(Some(transmission(INVERTIBLE)?), black_box(two_terms()?))
}

/// The same with the numbers in the function.
#[inline]
fn two_constant() -> Result<FixedModel<f32, 2, Two>, Error> {
    FixedModel::try_new(Some(fixed(INVERTIBLE)?), two_terms()?)
}

type Eight = (
    Of<Viscous>,
    Of<Coulomb<f32>>,
    Of<Stribeck<f32>>,
    Of<Inertia>,
    Of<StiffnessCubic>,
    Of<Gravity<f32>>,
    Of<Ripple<f32>>,
    Of<Backlash<f32>>,
);

/// What a bench may find on one joint, one effect with memory among them.
#[inline]
fn eight_terms() -> Result<Eight, Error> {
    Ok((
        term(Viscous, -0.4),
        term(Coulomb::try_new(0.05)?, -0.8),
        term(Stribeck::try_new(0.05, 0.2)?, -0.3),
        term(Inertia, -0.02),
        term(StiffnessCubic, 1.5),
        term(Gravity::try_new(0.1)?, 0.6),
        term(Ripple::try_new(6.0, 0.3)?, 0.1),
        term(Backlash::try_new(0.02)?, 0.5),
    ))
}

/// The eight effects, of which the compiler knows no number.
fn eight() -> Result<FixedModel<f32, 8, Eight>, Error> {
    FixedModel::try_new(Some(transmission(INVERTIBLE)?), black_box(eight_terms()?))
}

/// The same with the numbers in the function.
#[inline]
fn eight_constant() -> Result<FixedModel<f32, 8, Eight>, Error> {
    FixedModel::try_new(Some(fixed(INVERTIBLE)?), eight_terms()?)
}

type Segment = Of<CurveVelocity<f32>>;
type Curve = (
    Of<Offset>,
    Segment,
    Segment,
    Segment,
    Segment,
    Segment,
    Segment,
    Segment,
);

/// A friction curve through eight points, each segment as an export writes it.
#[inline]
fn curve_terms() -> Result<Curve, Error> {
    let segment = |from: f32, width: f32, rise: f32| {
        CurveVelocity::try_new(from, width).map(|effect| term(effect, rise))
    };
    Ok((
        term(Offset, 1.2),
        segment(-2.0, 1.2, -0.3)?,
        segment(-0.8, 0.5, 0.2)?,
        segment(-0.3, 0.25, 0.1)?,
        segment(-0.05, 0.1, -2.4)?,
        segment(0.05, 0.25, 0.1)?,
        segment(0.3, 0.5, 0.2)?,
        segment(0.8, 1.2, -0.3)?,
    ))
}

/// The curve, its numbers in the function.
#[inline]
fn curve_constant() -> Result<FixedModel<f32, 8, Curve>, Error> {
    FixedModel::try_new(Some(fixed(INVERTIBLE)?), curve_terms()?)
}

fn pulley(at: &Sample) -> [Motion<f32>; 1] {
    [Motion {
        position: at.position,
        velocity: at.velocity,
        acceleration: at.acceleration,
    }]
}

fn measured<'a>(at: &Sample, channels: &'a [Motion<f32>; 1]) -> Measured<'a, f32> {
    let input = Motion {
        position: at.input,
        ..Motion::default()
    };
    Measured {
        dt: at.dt,
        input,
        load: at.input,
        channels,
    }
}

/// A model on the paper's first set at sigma = 0.6; the value is tau_o.
macro_rules! case {
    ($(#[$doc:meta])* $name:ident, $n:literal: $model:ty = $build:expr;) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub struct $name {
            model: $model,
            state: ModelState<f32, $n>,
        }

        impl Case for $name {
            fn try_new() -> Result<Self, Error> {
                Ok(Self {
                    model: $build,
                    state: ModelState::new(),
                })
            }

            #[inline]
            fn step(&mut self, at: &Sample) -> Output {
                let channels = pulley(at);
                Output::of(self.model.step(&mut self.state, &measured(at, &channels)))
            }
        }
    };
}

case! {
    /// A model with two effects.
    TwoEffects, 2: FixedModel<f32, 2, Two> = two()?;
}

case! {
    /// A model with eight effects.
    EightEffects, 8: FixedModel<f32, 8, Eight> = eight()?;
}

case! {
    /// The same model, loaded: the image does not know which effects are in it.
    EightLoaded, 8: Model<f32, 8> = black_box(eight()?.to_model());
}

/// A model whose numbers stand in the source, as in the `model.rs` of an export: where the
/// constructor is called beside the step, the compiler computes it.
macro_rules! constant {
    ($(#[$doc:meta])* $name:ident, $n:literal: $build:ident;) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub struct $name(ModelState<f32, $n>);

        impl Case for $name {
            fn try_new() -> Result<Self, Error> {
                $build().map(|_| Self(ModelState::new()))
            }

            #[inline]
            fn step(&mut self, at: &Sample) -> Output {
                let channels = pulley(at);
                match $build() {
                    Ok(model) => Output::of(model.step(&mut self.0, &measured(at, &channels))),
                    Err(_) => Output::default(),
                }
            }
        }
    };
}

constant! {
    /// A model with two effects, as an export writes it.
    TwoConstant, 2: two_constant;
}

constant! {
    /// A model with eight effects, as an export writes it.
    EightConstant, 8: eight_constant;
}

constant! {
    /// A model with a curve through eight points, as an export writes it.
    CurveConstant, 8: curve_constant;
}

/// The model of two effects turned round; the value is tau_i.
#[derive(Debug)]
pub struct Compensated {
    compensator: Compensator<f32, 2>,
    state: CompensatorState<f32, 2>,
}

impl Case for Compensated {
    fn try_new() -> Result<Self, Error> {
        let model = black_box(two()?.to_model());
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
