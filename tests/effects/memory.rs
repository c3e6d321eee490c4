//! Effects with memory, each against what is known of its path.

use crate::{along, make};
use approx::assert_relative_eq;
use bowden::effect::{EffectState, Motion, Situation};

/// Samples of one channel, all other numbers quiet.
fn stroke(positions: impl IntoIterator<Item = f64>, dt: f64) -> Vec<Situation<f64>> {
    let motion = |position| Motion {
        position,
        ..Motion::default()
    };
    let at = |position| Situation {
        dt,
        motion: motion(position),
        ..Situation::default()
    };
    positions.into_iter().map(at).collect()
}

#[test]
fn backlash_is_flat_over_the_gap_after_each_reversal() {
    let r = 0.7;
    let up = (0..=300).map(|k| 0.01 * f64::from(k));
    let down = (0..=300).map(|k| 3.0 - 0.01 * f64::from(k));
    let strokes: Vec<f64> = up.clone().chain(down).chain(up).collect();
    let play: Vec<f64> = along(&make("backlash"), &stroke(strokes.iter().copied(), 0.01))
        .iter()
        .zip(&strokes)
        .map(|(regressor, x)| regressor + x)
        .collect();
    // Mid-gap at the start, then up to 3 − r; flat for 2r = 140 samples; down to r; flat again.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
    for (index, value) in play.iter().enumerate() {
        let expected = match index {
            0..=300 => (strokes[index] - r).max(0.0),
            301..=601 => (strokes[index] + r).min(3.0 - r),
            _ => (strokes[index] - r).max(r),
        };
        assert!(
            close(*value, expected),
            "sample {index}: {value}, not {expected}"
        );
    }
    assert!(play[301..=441].iter().all(|&value| close(value, 3.0 - r)));
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
    let mut state = EffectState::default();
    let effect = make("creep");
    let step = |state: &mut _, x, dt| effect.regressor(state, &stroke([x], dt)[0]);
    assert_eq!(step(&mut state, 2.0, 0.01), 2.0); // it starts at the first x
    let mut elapsed = 0.0;
    for k in 1..200 {
        let dt = 0.001 * f64::from(1 + k % 17);
        elapsed += dt;
        let expected = 5.0 - 3.0 * (-elapsed / 0.7_f64).exp();
        assert_relative_eq!(step(&mut state, 5.0, dt), expected, max_relative = 1e-13);
    }
}

#[test]
fn lag_lacks_the_exponential_after_a_step() {
    let at = |output| Situation {
        dt: 0.02,
        output,
        ..Situation::default()
    };
    let path: Vec<_> = [1.0].into_iter().chain([4.0; 100]).map(at).collect();
    for (k, lack) in along(&make("lag"), &path).into_iter().enumerate() {
        let elapsed = 0.02 * f64::from(u8::try_from(k).unwrap());
        let expected = if k == 0 {
            0.0
        } else {
            -3.0 * (-elapsed / 0.7_f64).exp()
        };
        assert_relative_eq!(lack, expected, max_relative = 1e-12, epsilon = 1e-14);
    }
}

#[test]
fn delay_shifts_a_ramp_exactly() {
    let ramp = |t: f64| 2.0 - 1.5 * t;
    let (dt, late) = (0.01, 0.25);
    let path: Vec<_> = (0..50)
        .map(|k| Situation {
            dt,
            output: ramp(dt * f64::from(k)),
            ..Situation::default()
        })
        .collect();
    let regressors = along(&make("delay"), &path);
    assert_eq!(regressors[0], 0.0);
    for k in 1..50 {
        let shifted = ramp(path[1].dt * f64::from(u8::try_from(k).unwrap()) - late);
        // Differences of values near 2 over 0.01 s: 2e-16 / 0.01.
        assert_relative_eq!(
            path[k].output + late * regressors[k],
            shifted,
            epsilon = 1e-13
        );
    }
}

#[test]
fn a_dt_of_zero_moves_no_memory_and_a_negative_one_is_bad() {
    for name in ["delay", "lag", "creep"] {
        let effect = make::<f64>(name);
        let mut state = EffectState::default();
        let at = |dt, x: f64| Situation {
            dt,
            output: x,
            ..stroke([x], dt)[0]
        };
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
            amplitude
                * if phase < 1.0 {
                    phase
                } else if phase < 3.0 {
                    2.0 - phase
                } else {
                    phase - 4.0
                }
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
        let expected = 4.0 * (amplitude - r).max(0.0);
        // Trapezoids miss at most one step of dx = 2e-3 at each of two corners a half cycle.
        assert!((area - expected).abs() < 5e-3, "{area}, not {expected}");
    }
}

#[test]
fn degradation_accumulates_the_path_weighted_with_eta() {
    let at = |position: f64, eta: f64| Situation {
        eta,
        input: Motion {
            position,
            ..Motion::default()
        },
        ..Situation::default()
    };
    let path = [
        at(1.0, 0.5),
        at(3.0, 0.5),
        at(2.0, -0.5),
        at(2.0, -1.0),
        at(6.0, 0.0),
    ];
    // W = 0, then 0.5·2 = 1, then + 0.5·1, then + nothing, then + (1 + 0)/2·4.
    assert_eq!(
        along(&make("degradation"), &path),
        [0.0, 0.5, -0.75, -1.5, 0.0]
    );
    let again = [path.as_slice(), &[at(6.0, 1.0)]].concat();
    assert_eq!(along(&make("degradation"), &again).last(), Some(&3.5));
}

#[test]
fn a_low_pass_stays_between_its_inputs_where_their_difference_overflows() {
    let effect = make::<f32>("creep");
    let mut state = EffectState::default();
    let mut step = |position, dt| {
        let motion = Motion {
            position,
            ..Motion::default()
        };
        let at = Situation {
            dt,
            motion,
            ..Situation::default()
        };
        effect.regressor(&mut state, &at)
    };
    assert_eq!(step(f32::MIN, 0.1), f32::MIN);
    assert_eq!(step(f32::MAX, 0.0), f32::MIN);
    let between = step(f32::MAX, 0.1);
    assert!(f32::MIN < between && between < f32::MAX);
}
