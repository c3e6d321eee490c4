//! The model, its effects and its transmission.

use crate::numbers::Numbers;
use crate::properties::effect::{a_late_output_is_finite, a_regressor_is_finite};
use bowden::effect::{Delay, Effect, EffectState, Inputs};
use bowden::model::{Model, ModelState, Sample, Term};
use bowden::Real;

const TERMS: usize = 4;

/// Whatever the terms and the samples: a finite output, one finite share a term that is no
/// input stage, eta within ±1, and a sample that is not accepted leaves the state.
pub fn check(data: &[u8]) {
    let mut from = Numbers::new(data);
    let _ = match from.byte().map(|byte| byte % 3) {
        Some(0) => run::<f32>(&mut from),
        Some(1) => run::<f64>(&mut from),
        _ => alone(&mut from),
    };
}

fn run<T: Real>(from: &mut Numbers) -> Option<()> {
    let transmission = if from.flag()? {
        Some(from.transmission::<T>()?)
    } else {
        None
    };
    let mut terms = Vec::new();
    for _ in 0..usize::from(from.byte()?) % (TERMS + 2) {
        terms.push(from.term()?);
    }
    let model = Model::<T, TERMS>::try_new(transmission, &terms).ok()?;
    assert!(model.terms() == terms);
    let has_share = |term: &Term<T>| !term.effect.is_input_stage();
    let sharing = terms.iter().filter(|term| has_share(term)).count();
    let mut state = ModelState::new();
    loop {
        let channel = [from.motion()?];
        let at = Sample {
            dt: from.dt()?,
            input: from.motion()?,
            load: from.any()?,
            channels: if from.flag()? { &channel } else { &[] },
        };
        let before = state;
        let mut shares = 0;
        let output = model.step_with(&mut state, &at, |term, share| {
            assert!(share.is_finite() && has_share(&terms[term]));
            shares += 1;
        });
        assert!(output.is_finite() && output == state.output());
        assert!(state.eta().abs() <= T::one());
        assert!(state.time().is_finite() && state.time() >= before.time());
        if model.accepts(&at) {
            assert!(shares == sharing);
        } else {
            assert!(state == before && shares == 0);
        }
    }
}

/// Anything that an effect may read.
pub fn situation(from: &mut Numbers) -> Option<Inputs<f32>> {
    Some(Inputs {
        dt: from.dt()?,
        time: from.any()?,
        motion: from.motion()?,
        input: from.motion()?,
        load: from.any()?,
        eta: from.any()?,
        output: from.any()?,
    })
}

/// One effect without the model's check in front of it.
fn alone(from: &mut Numbers) -> Option<()> {
    let effect = from.effect::<f32>()?;
    let mut state = EffectState::new();
    loop {
        let at = situation(from)?;
        assert!(
            a_regressor_is_finite(&effect, &mut state, &at),
            "{}",
            effect.name()
        );
        // A model takes finite gains only.
        let gain = at.load;
        if effect == Effect::from(Delay) && gain.is_finite() {
            assert!(a_late_output_is_finite(gain, &mut state, &at));
        }
    }
}
