//! The adaptive law, in both forms, with both smooth signs, over two and three regressors.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Form, Limits,
    SmoothSign,
};
use bowden::Error;
use core::hint::black_box;

/// The form for plants that answer within a sample, at 1 kHz.
const LAG: Form<f32> = Form::FirstOrder {
    step: 0.001,
    plant_gain: 1.0,
};

/// The form for plants with inertia; the error's rate is filtered over 5 ms.
const LITERAL: Form<f32> = Form::AsPublished {
    time_constant: 0.005,
};

const LEAKAGE: f32 = 0.01;

/// Table 2 with boxes: velocity and acceleration, then the pulley's angle.
const fn settings<const N: usize>(
    form: Form<f32>,
    smooth_sign: SmoothSign,
) -> AdaptiveSettings<f32, N> {
    let friction = Estimator::fixed(0.0).within(-6.0, 6.0);
    AdaptiveSettings {
        smooth_sign,
        beta: Estimator::fixed(1.0)
            .within(0.8, 1.2)
            .adapting(2.5e-4, LEAKAGE),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6e-3, LEAKAGE),
        theta: [friction.adapting(5e-4, LEAKAGE); N],
        ..AdaptiveSettings::new(
            form,
            24.0,
            8.0,
            0.1,
            constant!(Limits::<f32>::try_new(-20.0, 60.0)),
            0.005,
            constant!(Fallback::<f32>::try_new(20, 0.0)),
        )
    }
}

fn step<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    at: &Sample,
) -> Output
where
    Sample: Regressors<N>,
{
    let sample = AdaptiveInput {
        next_reference: at.next_reference,
        ..AdaptiveInput::new(at.dt, at.reference, at.measured, at.regressors())
    };
    let out = law.step(state, &sample);
    Output::commanded(out.command, out.status)
}

/// What the law reads of a sample, for each number of regressors.
trait Regressors<const N: usize> {
    fn regressors(&self) -> [f32; N];
}

impl Regressors<2> for Sample {
    #[inline]
    fn regressors(&self) -> [f32; 2] {
        [self.velocity, self.acceleration]
    }
}

impl Regressors<3> for Sample {
    #[inline]
    fn regressors(&self) -> [f32; 3] {
        [self.velocity, self.acceleration, self.position]
    }
}

macro_rules! laws {
    ($($loaded:ident, $constant:ident: $n:literal, $form:expr, $sign:ident, $text:literal;)+) => {
        $(
            #[doc = concat!($text, "; the compiler knows none of its settings.")]
            #[derive(Debug)]
            pub struct $loaded {
                law: Adaptive<f32, $n>,
                state: AdaptiveState<f32, $n>,
            }

            impl Case for $loaded {
                fn try_new() -> Result<Self, Error> {
                    let law = Adaptive::try_new(black_box(settings($form, SmoothSign::$sign)))?;
                    let state = AdaptiveState::new(&law);
                    Ok(Self { law, state })
                }

                #[inline]
                fn step(&mut self, at: &Sample) -> Output {
                    step(&self.law, &mut self.state, at)
                }
            }

            #[doc = concat!($text, "; a constant, which the compiler has checked.")]
            #[derive(Debug)]
            pub struct $constant(AdaptiveState<f32, $n>);

            impl $constant {
                const LAW: Adaptive<f32, $n> =
                    constant!(Adaptive::<f32, $n>::try_new(settings($form, SmoothSign::$sign)));
            }

            impl Case for $constant {
                fn try_new() -> Result<Self, Error> {
                    Ok(Self(AdaptiveState::new(&Self::LAW)))
                }

                #[inline]
                fn step(&mut self, at: &Sample) -> Output {
                    step(&Self::LAW, &mut self.0, at)
                }
            }
        )+
    };
}

laws! {
    LagClamp2, LagClamp2Constant: 2, LAG, Clamp, "Two regressors, lag form, clamp";
    LiteralClamp2, LiteralClamp2Constant: 2, LITERAL, Clamp, "Two regressors, literal form, clamp";
    LagTanh2, LagTanh2Constant: 2, LAG, Tanh, "Two regressors, lag form, tanh";
    LiteralTanh2, LiteralTanh2Constant: 2, LITERAL, Tanh, "Two regressors, literal form, tanh";
    LagClamp3, LagClamp3Constant: 3, LAG, Clamp, "Three regressors, lag form, clamp";
    LiteralClamp3, LiteralClamp3Constant: 3, LITERAL, Clamp, "Three regressors, literal form, clamp";
    LagTanh3, LagTanh3Constant: 3, LAG, Tanh, "Three regressors, lag form, tanh";
    LiteralTanh3, LiteralTanh3Constant: 3, LITERAL, Tanh, "Three regressors, literal form, tanh";
}
