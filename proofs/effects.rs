//! K14: regressors are finite, and so are their memories, for any sample.

use super::*;
use crate::proofs::properties::effect::a_regressor_is_finite;
use crate::proofs::stubs;

/// All bit patterns.
fn situation() -> Situation<f32> {
    let motion = || Motion {
        position: kani::any(),
        velocity: kani::any(),
        acceleration: kani::any(),
    };
    Situation {
        dt: kani::any(),
        time: kani::any(),
        motion: motion(),
        input: motion(),
        load: kani::any(),
        eta: kani::any(),
        output: kani::any(),
    }
}

/// No sample yet, or a memory of any finite numbers.
fn state() -> EffectState<f32> {
    let memory: Option<[f32; 4]> =
        kani::any::<bool>().then(|| core::array::from_fn(|_| kani::any()));
    kani::assume(memory.iter().flatten().all(|value| value.is_finite()));
    EffectState { memory }
}

/// One sample of an effect with any shapes that its constructor accepts.
fn any_sample(effect: Result<Effect<f32>, Error>) {
    kani::assume(effect.is_ok());
    if let Ok(effect) = effect {
        let (mut state, at) = (state(), situation());
        let finite = a_regressor_is_finite(&effect, &mut state, &at);
        kani::cover!(at.motion.position > 1.0 && state.memory.is_some());
        assert!(finite && state.memory.iter().flatten().all(|value| value.is_finite()));
    }
}

/// K14. Play and stop: backlash, presliding.
#[kani::proof]
#[kani::unwind(10)]
fn play_effects_are_finite() {
    any_sample(if kani::any() {
        backlash::Backlash::try_new(kani::any()).map(Effect::Backlash)
    } else {
        presliding::Presliding::try_new(kani::any()).map(Effect::Presliding)
    });
}

/// K14. Followers: creep, lag, Dahl's curve.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn followers_are_finite() {
    any_sample(match kani::any::<u8>() {
        0 => creep::Creep::try_new(kani::any()).map(Effect::Creep),
        1 => lag::Lag::try_new(kani::any()).map(Effect::Lag),
        _ => presliding::PreslidingDahl::try_new(kani::any()).map(Effect::PreslidingDahl),
    });
}

/// K14. Degradation over the work done, delay over the output's change.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn degradation_and_delay_are_finite() {
    any_sample(if kani::any() {
        degradation::Degradation::try_new(kani::any()).map(Effect::Degradation)
    } else {
        Ok(Effect::Delay)
    });
}

/// K14. Effects without memory and without shapes, all of them.
#[kani::proof]
#[kani::unwind(10)]
fn plain_effects_are_finite() {
    let (mut state, at) = (state(), situation());
    let effect = match kani::any::<u8>() {
        0 => Effect::Offset,
        1 => Effect::Gain,
        2 => Effect::Viscous,
        3 => Effect::DragQuadratic,
        4 => Effect::DragCubic,
        5 => Effect::AsymmetryViscous,
        6 => Effect::AsymmetryDrag,
        7 => Effect::AsymmetryEta,
        8 => Effect::AsymmetryEtaSquared,
        9 => Effect::Inertia,
        10 => Effect::StiffnessLinear,
        11 => Effect::StiffnessQuadratic,
        12 => Effect::StiffnessCubic,
        13 => Effect::StiffnessProgressive,
        14 => Effect::PositionHysteresis,
        15 => Effect::Rate,
        16 => Effect::RateSymmetric,
        17 => Effect::Drift,
        _ => Effect::Crosstalk,
    };
    kani::cover!(matches!(effect, Effect::DragCubic) && at.motion.velocity > 1e20);
    assert!(a_regressor_is_finite(&effect, &mut state, &at));
}

/// K14. Effects with shapes and without memory, all of them.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::expm1f, stubs::garbage)]
#[kani::stub(libm::sinf, stubs::garbage)]
#[kani::stub(libm::tanhf, stubs::garbage)]
#[kani::stub(libm::powf, stubs::garbage_of_two)]
fn shaped_effects_are_finite() {
    let (a, b, mut state, at) = (kani::any(), kani::any(), state(), situation());
    let effect = match kani::any::<u8>() {
        0 => stribeck::Stribeck::try_new(a, b).map(Effect::Stribeck),
        1 => load_friction::LoadFriction::try_new(a).map(Effect::LoadFriction),
        2 => direction::DriveFriction::try_new(a).map(Effect::DriveFriction),
        3 => direction::BackDriveFriction::try_new(a).map(Effect::BackDriveFriction),
        4 => stiffness::Hinge::try_new(a).map(Effect::Hinge),
        5 => gravity::Gravity::try_new(a).map(Effect::Gravity),
        6 => ripple::Ripple::try_new(a, b).map(Effect::Ripple),
        7 => position_friction::PositionFriction::try_new(a).map(Effect::PositionFriction),
        8 => backlash::DeadZone::try_new(a).map(Effect::DeadZone),
        9 => saturation::SaturationUpper::try_new(a).map(Effect::SaturationUpper),
        10 => saturation::SaturationLower::try_new(a).map(Effect::SaturationLower),
        11 => tone::Tone::try_new(a, b).map(Effect::Tone),
        _ => coulomb::Coulomb::try_new(a).map(Effect::Coulomb),
    };
    kani::assume(effect.is_ok());
    if let Ok(effect) = effect {
        kani::cover!(matches!(effect, Effect::Stribeck(_)) && at.motion.velocity > 1e20);
        assert!(a_regressor_is_finite(&effect, &mut state, &at));
    }
}
