//! `effect/`
//!
//! The constructors of the forty-odd effects are written by one macro: `try_from_name` reaches every
//! one of them, that of `Coulomb` stands for their own.

use crate::{any, never_panics};
use bowden::effect::*;
use bowden::Real;
use std::hint::black_box;

/// Any motion.
pub fn motion<T: Real>() -> Motion<T> {
    black_box(Motion::default())
}

pub fn all<T: Real>() -> Option<()> {
    let situation = Inputs::<T> {
        dt: any(),
        time: any(),
        motion: motion(),
        input: motion(),
        load: any(),
        eta: any(),
        output: any(),
    };
    let reads = black_box(&[Quantity::Dt, Quantity::Eta][..]);
    never_panics!(effect_inputs_get, situation.get(black_box(Quantity::Dt)));
    never_panics!(effect_inputs_is_usable, situation.is_usable(reads));
    never_panics!(effect_inputs_new, EffectState::<T>::new());

    never_panics!(effect_declare_try_new, Coulomb::<T>::try_new(any()));

    let shapes = [T::one(), T::zero()];
    let shapes = black_box(&shapes[..]);
    never_panics!(
        effect_try_from_name,
        Effect::try_from_name(black_box("viscous"), shapes)
    );
    let effect = black_box(Effect::<T>::from(Viscous));
    let mut state = black_box(EffectState::<T>::new());
    never_panics!(effect_info, effect.info());
    never_panics!(effect_shape, effect.shape(black_box(0)));
    never_panics!(effect_with_shape, effect.with_shape(black_box(0), any()));
    never_panics!(effect_regressor, effect.regressor(&mut state, &situation));
    never_panics!(
        effect_contribution,
        effect.contribution(any(), &mut state, &situation)
    );
    never_panics!(effect_regressors, {
        let record = core::iter::once(situation);
        effect.regressors(&mut state, record, |value| _ = black_box(value));
    });
    never_panics!(effect_contributions, {
        let record = core::iter::once(situation);
        effect.contributions(any(), &mut state, record, |value| _ = black_box(value));
    });
    never_panics!(effect_name, effect.name());
    never_panics!(effect_reads_eta, effect.reads_eta());
    never_panics!(effect_is_output_stage, effect.is_output_stage());
    never_panics!(effect_is_input_stage, effect.is_input_stage());
    Some(())
}
