//! `model.rs`

use crate::effect::motion;
use crate::transmission::transmission;
use crate::{any, never_panics};
use bowden::effect::{Backlash, Coulomb, Lag, Motion, PlayInSeries};
use bowden::effect::{Quantity, Ripple, Stribeck, Viscous};
use bowden::model::{FixedModel, Model, ModelState, Sample, Source, Term};
use bowden::Real;
use std::hint::black_box;

/// Any term.
pub fn term<T: Real>() -> Term<T> {
    black_box(Term {
        effect: Viscous.into(),
        source: Source::Input,
        origin: T::zero(),
        gain: T::zero(),
    })
}

/// Any model of at most two terms.
pub fn model<T: Real>() -> Option<Model<T, 2>> {
    let transmission = black_box(Some(transmission()?));
    black_box(Model::try_new(
        transmission,
        black_box(&[term(), term()][..]),
    ))
    .ok()
}

pub fn all<T: Real>() -> Option<()> {
    let transmission = black_box(Some(transmission::<T>()?));
    let terms = [term::<T>(), term()];
    let terms = black_box(&terms[..]);
    never_panics!(model_try_new, Model::<T, 2>::try_new(transmission, terms));
    let model = model::<T>()?;
    never_panics!(model_transmission, model.transmission());
    never_panics!(model_terms, model.terms());
    never_panics!(model_state_new, ModelState::<T, 2>::new());
    never_panics!(model_state_with_eta, ModelState::<T, 2>::with_eta(any()));
    let mut state = black_box(ModelState::new());
    let channels: [Motion<T>; 2] = [motion(), motion()];
    let sample = Sample {
        dt: any(),
        input: motion(),
        load: any(),
        channels: black_box(&channels[..]),
    };
    never_panics!(model_accepts, model.accepts(&sample));
    never_panics!(model_step, model.step(&mut state, &sample));
    never_panics!(model_step_with, {
        model.step_with(&mut state, &sample, |term, share| {
            black_box((term, share));
        })
    });
    fixed(&sample)?;
    let points: [(T, T); 3] = black_box([(any(), any()), (any(), any()), (any(), any())]);
    let over = black_box(Quantity::Velocity);
    never_panics!(model_curve_curve, Term::curve(over, Source::Input, points));
    never_panics!(model_state_eta, state.eta());
    never_panics!(model_state_time, state.time());
    never_panics!(model_state_output, state.output());
    Some(())
}

/// A model whose effects are types, of each stage and of each kind of function.
fn fixed<T: Real>(sample: &Sample<T>) -> Option<()> {
    fn of<T: Real, E>(effect: E) -> Term<T, E> {
        black_box(Term {
            effect,
            source: Source::Channel(black_box(0)),
            origin: any(),
            gain: any(),
        })
    }
    let terms = (
        of(Coulomb::try_new(any()).ok()?),
        of(Lag::try_new(any()).ok()?),
        of(PlayInSeries::try_new(any()).ok()?),
        of(Ripple::try_new(any(), any()).ok()?),
        of(Stribeck::try_new(any(), any()).ok()?),
        of(Backlash::try_new(any()).ok()?),
    );
    let transmission = black_box(Some(transmission::<T>()?));
    never_panics!(
        model_fixed_try_new,
        FixedModel::try_new(transmission, black_box(terms))
    );
    let model = black_box(FixedModel::try_new(transmission, terms).ok()?);
    let mut state = black_box(ModelState::new());
    never_panics!(model_fixed_transmission, model.transmission());
    never_panics!(model_fixed_terms, model.terms());
    never_panics!(model_fixed_to_model, model.to_model());
    never_panics!(model_fixed_accepts, model.accepts(sample));
    never_panics!(model_fixed_step, model.step(&mut state, sample));
    never_panics!(model_fixed_step_with, {
        model.step_with(&mut state, sample, |term, share| {
            black_box((term, share));
        })
    });
    Some(())
}
