//! Effects with memory, each against what is known of its path.

use super::*;

#[test]
fn backlash_is_flat_over_the_gap_after_each_reversal() {
    let r = 0.7;
    let up = (0..=300).map(|k| 0.01 * f64::from(k));
    let down = (0..=300).map(|k| 3.0 - 0.01 * f64::from(k));
    let strokes: Vec<f64> = up.clone().chain(down).chain(up).collect();
    let found = along(&make("backlash"), &stroke(strokes.iter().copied(), 0.01));
    let play: Vec<f64> = found.iter().zip(&strokes).map(|(own, x)| own + x).collect();
    // Mid-gap at the start, then up to 3 − r; flat for 2r = 140 samples; down to r; flat again.
    for (index, (value, x)) in play.iter().zip(&strokes).enumerate() {
        let expected = match index {
            0..=300 => (x - r).max(0.0),
            301..=601 => (x + r).min(3.0 - r),
            _ => (x - r).max(r),
        };
        near(*value, expected, 1e-12);
    }
    assert!(play[301..=441]
        .iter()
        .all(|value| (value - (3.0 - r)).abs() < 1e-12));
}

proptest! {
    /// `play(x) − x = −stop(x)`: what the search calls presliding is backlash of the opposite sign.
    #[test]
    fn backlash_is_presliding_with_the_opposite_sign(
        path in prop::collection::vec(-3.0..3.0_f64, 2..60),
        r in 0.05..2.0_f64,
    ) {
        let at = stroke(path.iter().copied(), 0.01);
        let of = |effect: Effect<f64>| along(&effect, &at);
        let backlash = of(Backlash::try_new(r).unwrap().into());
        let presliding = of(Presliding::try_new(r).unwrap().into());
        for (a, b) in backlash.iter().zip(presliding) {
            // The stop adds up differences of positions, the play does not: rounding.
            prop_assert!((a + r * b).abs() <= 1e-13);
        }
    }
}

#[test]
fn backlash_within_the_gap_holds_its_play_to_the_bit() {
    let wiggle = (0..10_000).map(|k| 0.1 + 0.6 * f64::from(k).sin());
    let path = stroke(wiggle, 0.01);
    let regressors = along(&make("backlash"), &path);
    let start = path[0].motion.position;
    for (at, regressor) in path.iter().zip(regressors) {
        assert_eq!(regressor, start - at.motion.position);
    }
}

#[test]
fn creep_follows_a_step_as_the_exponential_at_any_dt() {
    let (effect, mut state) = (make("creep"), EffectState::default());
    assert_eq!(effect.regressor(&mut state, &at(2.0, 0.01)), 2.0); // it starts at the first x
    let mut elapsed = 0.0;
    for k in 1..200 {
        let dt = 0.001 * f64::from(1 + k % 17);
        elapsed += dt;
        let expected = 5.0 - 3.0 * (-elapsed / 0.7_f64).exp();
        let found = effect.regressor(&mut state, &at(5.0, dt));
        assert_relative_eq!(found, expected, max_relative = 1e-13);
    }
}

#[test]
fn lag_lacks_the_exponential_after_a_step() {
    let path: Vec<_> = (0..101)
        .map(|k| out(if k == 0 { 1.0 } else { 4.0 }, 0.02))
        .collect();
    for (k, lack) in along(&make("lag"), &path).into_iter().enumerate() {
        let left = (-0.02 * k as f64 / 0.7_f64).exp();
        let expected = if k == 0 { 0.0 } else { -3.0 * left };
        assert_relative_eq!(lack, expected, max_relative = 1e-12, epsilon = 1e-14);
    }
}

#[test]
fn delay_shifts_a_ramp_exactly() {
    let ramp = |t: f64| 2.0 - 1.5 * t;
    let (dt, late) = (0.01, 0.25);
    let path: Vec<_> = (0..50).map(|k| out(ramp(dt * f64::from(k)), dt)).collect();
    let regressors = along(&make("delay"), &path);
    assert_eq!(regressors[0], 0.0);
    for k in 1..50 {
        let shifted = ramp(dt * k as f64 - late);
        // Differences of values near 2 over 0.01 s: 2e-16 / 0.01.
        near(path[k].output + late * regressors[k], shifted, 1e-13);
    }
}

#[test]
fn a_dt_of_zero_moves_no_memory_and_a_negative_one_is_bad() {
    for name in ["delay", "lag", "creep"] {
        let (effect, mut state) = (make::<f64>(name), EffectState::default());
        let at = |dt, x| with(at(x, dt), |at| at.output = x);
        effect.regressor(&mut state, &at(0.0, 1.0)); // the first sample may have dt = 0
        let before = state;
        assert_ne!(before, EffectState::default(), "{name}");
        effect.regressor(&mut state, &at(0.0, 9.0));
        assert_eq!(state, before, "{name}");
        assert_eq!(effect.regressor(&mut state, &at(-0.1, 9.0)), 0.0, "{name}");
        assert_eq!(state, before, "{name}");
    }
}

#[test]
fn presliding_dissipates_the_area_that_its_docs_state() {
    let r = 0.7;
    for amplitude in [0.5, 2.0] {
        let triangle = |k: i32| {
            let phase = f64::from(k.rem_euclid(4000)) / 1000.0;
            amplitude * phase.min(2.0 - phase).max(phase - 4.0)
        };
        let path = stroke((0..=8000).map(triangle), 0.001);
        let stop = along(&make("presliding"), &path);
        assert!(stop.iter().all(|height| height.abs() <= 1.0));
        let area: f64 = (4001..=8000)
            .map(|k| {
                let dx = path[k].motion.position - path[k - 1].motion.position;
                0.5 * (stop[k] + stop[k - 1]) * dx
            })
            .sum();
        // Trapezoids miss at most one step of dx = 2e-3 at each of two corners a half cycle.
        near(area, 4.0 * (amplitude - r).max(0.0), 5e-3);
    }
}

/// Dahl's curve at the given positions, with `r` = 0.7.
fn dahl(positions: impl IntoIterator<Item = f64>) -> Vec<f64> {
    along(&make("presliding-dahl"), &stroke(positions, 0.01))
}

#[test]
fn dahls_branches_are_exponentials_at_any_step() {
    let r = 0.7_f64;
    // Up from 0.4 to 1.9, down to −1, up to 3: steps of many widths, one of them none.
    let step = |k: usize| [0.03, 0.001, 0.0, 0.08, 0.014][k % 5];
    let way: Vec<f64> = (0..60).map(|k| (0..=k).map(step).sum()).collect();
    let pairs = [(0.4, 1.9), (1.9, -1.0), (-1.0, 3.0)];
    let stroke = |(from, to)| way.iter().map(move |s| from + (to - from) * s / 1.5);
    let path: Vec<f64> = [0.4]
        .into_iter()
        .chain(pairs.into_iter().flat_map(stroke))
        .collect();
    let (mut expected, mut last) = (0.0, path[0]);
    for (x, z) in path.iter().zip(dahl(path.iter().copied())) {
        // From the value before towards the end of this way.
        let end = (x - last).signum();
        expected = end + (expected - end) * (-(x - last).abs() / r).exp();
        assert_relative_eq!(z, expected, max_relative = 1e-13, epsilon = 1e-14);
        last = *x;
    }
}

#[test]
fn dahls_loop_has_the_area_and_the_height_that_its_docs_state() {
    let r = 0.7_f64;
    for amplitude in [0.1, 0.5, 2.0, 9.0] {
        let cycle =
            |k: i32| amplitude * (1.0 - f64::from((k.rem_euclid(4000) - 2000).abs()) / 1000.0);
        let path: Vec<f64> = (0..=200_000).map(cycle).collect();
        let curve = dahl(path.iter().copied());
        assert!(curve.iter().all(|z| z.abs() <= 1.0));
        // Each cycle forgets its start by exp(−4·X/r): 50 of them, 1e-12 at worst.
        let height = (amplitude / r).tanh();
        assert_relative_eq!(curve[198_000], height, max_relative = 1e-11);
        assert_relative_eq!(curve[200_000], -height, max_relative = 1e-11);
        let area: f64 = (196_001..=200_000)
            .map(|k| 0.5 * (curve[k] + curve[k - 1]) * (path[k] - path[k - 1]))
            .sum();
        let expected = 4.0 * (amplitude - r * height);
        // Trapezoids: dx²/12·(z' at the end − at the start) on each branch, z' ≤ 2/r.
        let missed = 2.0 * (amplitude / 1000.0_f64).powi(2) / 12.0 * 2.0 / r;
        near(area, expected, missed);
    }
}

#[test]
fn dahls_curve_starts_as_the_stops_spring_and_ends_at_one() {
    let start = dahl([5.0, 5.0 + 7e-9]);
    assert_eq!(start[0], 0.0);
    assert_relative_eq!(start[1], 1e-8, max_relative = 1e-7); // 5 + 7e-9 is rounded to 9e-16
    assert_eq!(dahl([0.0, 1e3]), [0.0, 1.0]);
    let back = 1.0 - 2.0 * (-1000.7_f64 / 0.7).exp();
    assert_eq!(dahl([0.0, -1e3, -1e3, 0.7]), [0.0, -1.0, -1.0, back]);
}

#[test]
fn dahls_curve_in_single_precision_does_not_stall_on_small_steps() {
    let effect = make::<f32>("presliding-dahl").with_shape(0, 1.0).unwrap();
    let mut state = EffectState::default();
    let mut z = 0.0;
    // Steps of 2^-20·r, exact in f32: without compensation z halts 3 % below 1.
    for k in 0_u16..=5 * 1024 {
        for fine in 0_u16..1024 {
            let position = f32::from(k) / 1024.0 + f32::from(fine) / 1_048_576.0;
            z = effect.regressor(&mut state, &at(position, 0.0));
        }
    }
    let way = 5.0 + 1023.0 / 1_048_576.0_f64;
    assert_relative_eq!(f64::from(z), 1.0 - (-way).exp(), epsilon = 2e-7);
}

proptest! {
    #[test]
    fn dahls_curve_stays_within_one(
        path in prop::collection::vec(prop_oneof![-3.0..3.0_f32, prop::num::f32::NORMAL], 1..200),
        r in prop_oneof![0.01..3.0_f32, prop::num::f32::POSITIVE | prop::num::f32::NORMAL | prop::num::f32::SUBNORMAL],
    ) {
        let effect = make::<f32>("presliding-dahl").with_shape(0, r).unwrap();
        let mut state = EffectState::default();
        for position in path {
            let z = effect.regressor(&mut state, &at(position, 0.0));
            prop_assert!(z.abs() <= 1.0, "{z}");
        }
    }

    #[test]
    fn degradation_stays_within_eta_and_has_its_sign(
        path in prop::collection::vec((prop_oneof![-3.0..3.0_f32, prop::num::f32::NORMAL], -1.0..=1.0_f32), 1..200),
        w_c in prop_oneof![0.01..30.0_f32, prop::num::f32::POSITIVE | prop::num::f32::NORMAL],
    ) {
        let effect = make::<f32>("degradation").with_shape(0, w_c).unwrap();
        let path: Vec<_> = path.iter().map(|&(x, eta)| worked(x, eta)).collect();
        for (at, value) in path.iter().zip(along(&effect, &path)) {
            prop_assert!(value.abs() <= at.eta.abs() && value * at.eta >= 0.0, "{value} of {}", at.eta);
        }
    }
}

/// The transmission at an input and a hysteresis state.
fn worked<T: Real>(position: T, eta: T) -> Inputs<T> {
    with(Inputs::default(), |at| {
        (at.input.position, at.eta) = (position, eta)
    })
}

#[test]
fn degradation_accumulates_the_path_weighted_with_eta() {
    let path = [
        (1.0, 0.5),
        (3.0, 0.5),
        (2.0, -0.5),
        (2.0, -1.0),
        (6.0, 0.0),
        (6.0, 1.0),
    ]
    .map(|(x, eta)| worked(x, eta));
    // W = 0, then 0.5·2 = 1, then + 0.5·1, then + nothing, then + (1 + 0)/2·4, + nothing.
    let work = [0.0, 1.0, 1.5, 1.5, 3.5, 3.5];
    for w_c in [0.7, 5.0] {
        let effect = make::<f64>("degradation").with_shape(0, w_c).unwrap();
        let values = along(&effect, &path);
        for ((at, w), value) in path.iter().zip(work).zip(values) {
            let expected = at.eta * (1.0 - (-w / w_c).exp());
            assert_relative_eq!(value, expected, max_relative = 1e-15, epsilon = 1e-16);
        }
    }
    // At little work it is eta·W/w_c, to the part W/w_c/2: here to the last bit.
    let slow = 2.0_f64.powi(60);
    let effect = make::<f64>("degradation").with_shape(0, slow).unwrap();
    let linear: Vec<f64> = along(&effect, &path).iter().map(|v| v * slow).collect();
    assert_eq!(linear, [0.0, 0.5, -0.75, -1.5, 0.0, 3.5]);
}

#[test]
fn degradation_ends_at_eta() {
    let long = [worked(0.0, -0.8), worked(1e3, -0.8)];
    assert_eq!(along(&make("degradation"), &long), [0.0, -0.8]);
    let endless =
        [(f32::MIN, 1.0), (f32::MAX, 1.0), (f32::MIN, 0.5)].map(|(x, eta)| worked(x, eta));
    assert_eq!(along(&make("degradation"), &endless), [0.0, 1.0, 0.5]);
}

#[test]
fn degradation_in_single_precision_counts_steps_far_below_the_work() {
    let effect = make::<f32>("degradation").with_shape(0, 1e6).unwrap();
    let mut state = EffectState::default();
    let mut value = 0.0;
    // 1e6 at once, then a million times 2^-6, a quarter of its ulp: a plain sum stands still.
    let small = (0..1_000_000).map(|k| 1e6 + if k % 2 == 0 { 0.0 } else { 0.0625 });
    for x in [0.0].into_iter().chain(small) {
        value = effect.regressor(&mut state, &worked(x, 0.25));
    }
    // W = 0.25·(1e6 + 999 999·0.0625).
    let work = 0.25 * (1e6 + 999_999.0 * 0.0625_f64);
    let expected = 0.25 * (1.0 - (-work / 1e6).exp());
    assert_relative_eq!(f64::from(value), expected, max_relative = 3e-7);
}

#[test]
fn a_low_pass_stays_between_its_inputs_where_their_difference_overflows() {
    let (effect, mut state) = (make::<f32>("creep"), EffectState::default());
    let mut step = |position, dt| effect.regressor(&mut state, &at(position, dt));
    assert_eq!(step(f32::MIN, 0.1), f32::MIN);
    assert_eq!(step(f32::MAX, 0.0), f32::MIN);
    let between = step(f32::MAX, 0.1);
    assert!(f32::MIN < between && between < f32::MAX);
}
