//! Extreme numbers, bad numbers, and both precisions.

use super::*;

proptest! {
    #[test]
    fn every_effect_is_finite_for_finite_input(path in prop::collection::vec(prop::array::uniform11(extreme()), 1..8), shapes in prop::array::uniform2(extreme())) {
        for name in names() {
            let mut effect = make::<f32>(name);
            for (index, shape) in shapes.into_iter().enumerate().take(effect.info().shapes.len()) {
                effect = effect.with_shape(index, shape).unwrap_or(effect);
            }
            let mut state = EffectState::default();
            for &numbers in &path {
                let value = effect.regressor(&mut state, &situation(numbers));
                prop_assert!(value.is_finite(), "{name}: {value} at {numbers:?}");
            }
            // The memory is private, but tells what it holds.
            let memory = format!("{state:?}");
            prop_assert!(!memory.contains("inf") && !memory.contains("NaN"), "{name}: {memory}");
        }
    }

    /// Two samples of each dt: what depends on dt alone is computed anew where it changes. No time
    /// backwards is not no time forwards: the share of a low-pass is zero for both, of either sign.
    #[test]
    fn a_whole_record_gives_the_numbers_of_its_samples_to_the_bit(
        path in prop::collection::vec(prop::array::uniform11(extreme()), 1..8),
        gain in extreme(),
        position in select(vec![0.0, -0.0, 1.0]),
    ) {
        let path = path.into_iter().map(situation).flat_map(|at| [at, at]);
        let still = [-0.0, -0.0, 0.0, 0.0].map(|dt| with(at(position, dt), |at| at.output = position));
        for path in [path.collect::<Vec<Inputs<f32>>>(), still.to_vec()] {
            for name in names() {
                let (effect, mut whole) = (make::<f32>(name), Vec::new());
                let take = |value: f32| whole.push(value.to_bits());
                effect.regressors(&mut EffectState::default(), path.iter().copied(), take);
                let each: Vec<u32> = along(&effect, &path).into_iter().map(f32::to_bits).collect();
                prop_assert_eq!(whole, each, "{}", name);
                let (mut state, mut whole) = (EffectState::default(), Vec::new());
                let take = |value: f32| whole.push(value.to_bits());
                effect.contributions(gain, &mut state, path.iter().copied(), take);
                let mut state = EffectState::default();
                let one = |at| effect.contribution(gain, &mut state, at).to_bits();
                let each: Vec<u32> = path.iter().map(one).collect();
                prop_assert_eq!(whole, each, "{}", name);
            }
        }
    }

    #[test]
    fn a_bad_number_that_is_read_gives_0_and_leaves_the_state(
        path in prop::collection::vec(plausible(), 0..5),
        at in plausible(),
        bad in select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
    ) {
        for name in names() {
            let effect = make(name);
            let mut state = EffectState::default();
            for at in &path {
                effect.regressor(&mut state, at);
            }
            for &quantity in effect.info().reads {
                let mut after = state;
                let value = effect.regressor(&mut after, &spoilt(&at, quantity, bad));
                prop_assert_eq!((value, after), (0.0, state), "{} {:?}", name, quantity);
            }
        }
    }

    #[test]
    fn a_bad_number_that_is_not_read_does_not_matter(at in plausible()) {
        let all = [
            Quantity::Dt, Quantity::Time, Quantity::Position, Quantity::Velocity,
            Quantity::Acceleration, Quantity::Input, Quantity::Load, Quantity::Eta, Quantity::Output,
        ];
        for name in names() {
            let effect = make(name);
            let unread = all.iter().filter(|quantity| !effect.info().reads.contains(quantity));
            let other = unread.fold(at, |at, &quantity| spoilt(&at, quantity, f64::NAN));
            prop_assert_eq!(along(&effect, &[other]), along(&effect, &[at]), "{}", name);
        }
    }

    #[test]
    fn single_and_double_precision_agree(path in prop::collection::vec(plausible(), 20)) {
        let single: Vec<_> = path.iter().map(convert::<f64, f32>).collect();
        let double: Vec<_> = single.iter().map(convert::<f32, f64>).collect();
        for name in names().filter(|&name| name != "delay") { // a quotient by dt, checked by itself
            for (a, b) in along::<f32>(&make(name), &single).iter().zip(along::<f64>(&make(name), &double)) {
                // Arguments of sines reach 120, whose f32 ulp is 8e-6; sums of 20 steps the rest.
                assert_relative_eq!(f64::from(*a), b, max_relative = 1e-5, epsilon = 3e-5);
            }
        }
    }
}

/// Any finite f32, the extreme ones more often.
fn extreme() -> impl Strategy<Value = f32> {
    use proptest::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let (tiny, least) = (f32::MIN_POSITIVE, f32::from_bits(1));
    let corners = vec![f32::MAX, f32::MIN, tiny, least, 0.0, -0.0, 1e-3, -1.0];
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        select(corners)
    ]
}

fn convert<A: Real, B: Real>(at: &Inputs<A>) -> Inputs<B> {
    let (m, i) = (at.motion, at.input);
    let (x, v, a) = (m.position, m.velocity, m.acceleration);
    let (y, w, b) = (i.position, i.velocity, i.acceleration);
    let all = [at.dt, at.time, x, v, a, y, w, b, at.load, at.eta, at.output];
    situation(all.map(|value| B::from_f64(value.as_f64())))
}
