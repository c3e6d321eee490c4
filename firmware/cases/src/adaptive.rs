//! The adaptive law, in both forms, with both smooth signs, over two and three regressors.

use crate::{Case, Output, Sample};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Form, Limits,
    SmoothSign,
};
use bowden::Error;
use core::hint::black_box;

/// The form for plants that answer within a sample, at 1 kHz.
const LAG: Form<f32> = Form::Lag {
    step: 0.001,
    plant_gain: 1.0,
};

/// The form for plants with inertia; the error's rate is filtered over 5 ms.
const LITERAL: Form<f32> = Form::Literal {
    time_constant: 0.005,
};

/// Table 2 with boxes: velocity and acceleration, then the pulley's angle.
fn settings<const N: usize>(
    form: Form<f32>,
    smooth_sign: SmoothSign,
) -> Result<AdaptiveSettings<f32, N>, Error> {
    let leakage = 0.01;
    let friction = Estimator::fixed(0.0).within(-6.0, 6.0);
    Ok(AdaptiveSettings {
        smooth_sign,
        beta: Estimator::fixed(1.0)
            .within(0.8, 1.2)
            .adapting(2.5e-4, leakage),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6e-3, leakage),
        theta: [friction.adapting(5e-4, leakage); N],
        ..AdaptiveSettings::new(
            form,
            24.0,
            8.0,
            0.1,
            Limits::try_new(-20.0, 60.0)?,
            0.005,
            Fallback::try_new(20, 0.0)?,
        )
    })
}

#[derive(Debug)]
struct Law<const N: usize> {
    law: Adaptive<f32, N>,
    state: AdaptiveState<f32, N>,
}

impl<const N: usize> Law<N> {
    fn try_new(form: Form<f32>, smooth_sign: SmoothSign) -> Result<Self, Error> {
        let law = Adaptive::try_new(black_box(settings(form, smooth_sign)?))?;
        let state = AdaptiveState::new(&law);
        Ok(Self { law, state })
    }

    #[inline]
    fn step(&mut self, at: &Sample, regressors: [f32; N]) -> Output {
        let sample = AdaptiveInput {
            next_reference: at.next_reference,
            ..AdaptiveInput::new(at.dt, at.reference, at.measured, regressors)
        };
        let out = self.law.step(&mut self.state, &sample);
        Output::commanded(out.command, out.status)
    }
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
    ($($(#[$doc:meta])+ $name:ident: $n:literal, $form:expr, $sign:ident;)+) => {
        $(
            $(#[$doc])+
            #[derive(Debug)]
            pub struct $name(Law<$n>);

            impl Case for $name {
                fn try_new() -> Result<Self, Error> {
                    Law::try_new($form, SmoothSign::$sign).map(Self)
                }

                #[inline]
                fn step(&mut self, at: &Sample) -> Output {
                    self.0.step(at, at.regressors())
                }
            }
        )+
    };
}

laws! {
    /// Two regressors, lag form, clamp.
    LagClamp2: 2, LAG, Clamp;
    /// Two regressors, literal form, clamp.
    LiteralClamp2: 2, LITERAL, Clamp;
    /// Two regressors, lag form, tanh.
    LagTanh2: 2, LAG, Tanh;
    /// Two regressors, literal form, tanh.
    LiteralTanh2: 2, LITERAL, Tanh;
    /// Three regressors, lag form, clamp.
    LagClamp3: 3, LAG, Clamp;
    /// Three regressors, literal form, clamp.
    LiteralClamp3: 3, LITERAL, Clamp;
    /// Three regressors, lag form, tanh.
    LagTanh3: 3, LAG, Tanh;
    /// Three regressors, literal form, tanh.
    LiteralTanh3: 3, LITERAL, Tanh;
}
