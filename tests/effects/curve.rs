//! The curve: the line through its points, constant beyond its ends, and what an adaptive law
//! learns of it.

use super::*;
use bowden::control::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Form};
use bowden::model::{Model, ModelState, Sample, Source, Term};

/// The output of a curve over the position or the velocity of the input.
fn value_at<T: Real>(over: Quantity, points: [(T, T); 5], value: T) -> Result<T, Error> {
    let terms = Term::curve(over, Source::Input, points)?;
    let model = Model::<T, 5>::try_new(None, &terms)?;
    let other = T::from_f64(0.3);
    let (position, velocity) = match over {
        Quantity::Velocity => (other, value),
        _ => (value, other),
    };
    let sample = Sample {
        dt: T::from_f64(1e-3),
        input: moving(position, velocity, other),
        load: other,
        channels: &[],
    };
    Ok(model.step(&mut ModelState::new(), &sample))
}

/// The line through the points, by its definition.
fn line(points: &[(f64, f64); 5], x: f64) -> f64 {
    let [first, .., last] = points;
    if x <= first.0 {
        return first.1;
    }
    let between = points.windows(2).find(|pair| x < pair[1].0);
    between.map_or(last.1, |pair| {
        let share = (x - pair[0].0) / (pair[1].0 - pair[0].0);
        pair[0].1 + share * (pair[1].1 - pair[0].1)
    })
}

fn points() -> impl Strategy<Value = [(f64, f64); 5]> {
    let widths = prop::array::uniform5(1e-3..3.0_f64);
    (-5.0..0.0_f64, widths, prop::array::uniform5(-9.0..9.0_f64)).prop_map(|(from, widths, f)| {
        let mut x = from;
        std::array::from_fn(|k| {
            x += widths[k];
            (x, f[k])
        })
    })
}

proptest! {
    #[test]
    fn a_curve_is_the_line_through_its_points_and_constant_beyond(points in points(), x in -12.0..12.0_f64) {
        for over in [Quantity::Position, Quantity::Velocity] {
            let value = value_at(over, points, x).unwrap();
            // Sums of five terms of at most 18, of which the steepest rises by 18 in 1e-3.
            prop_assert!((value - line(&points, x)).abs() < 1e-10, "{value}");
            for (x, f) in points {
                prop_assert!((value_at(over, points, x).unwrap() - f).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn a_curve_stays_between_its_least_and_its_largest_point_for_any_finite_sample(
        points in points(),
        x in prop::num::f32::NORMAL | prop::num::f32::SUBNORMAL | prop::num::f32::ZERO,
    ) {
        let narrow = points.map(|(x, f)| (x as f32, f as f32));
        let value = value_at(Quantity::Velocity, narrow, x).unwrap();
        let least = narrow.iter().fold(f32::MAX, |least, point| least.min(point.1));
        let most = narrow.iter().fold(f32::MIN, |most, point| most.max(point.1));
        // Five sums of numbers below 18 in single precision.
        prop_assert!((least - 1e-5..=most + 1e-5).contains(&value), "{value}");
    }
}

#[test]
fn points_that_make_no_curve_are_refused() {
    let good = [
        (-2.0, 1.0),
        (-1.0, 0.0),
        (0.0, 2.0),
        (1.0, 2.0),
        (3.0, -1.0),
    ];
    let refused = |index: usize, point| {
        let points = with(good, |points| points[index] = point);
        value_at(Quantity::Position, points, 0.0).err()
    };
    for (index, point, error) in [
        (2, (0.0, 7.0), None),
        (2, (-1.0, 7.0), Some(Error::OutOfRange("width"))),
        (2, (-1.5, 7.0), Some(Error::OutOfRange("width"))),
        (0, (f64::NAN, 1.0), Some(Error::NonFinite("x"))),
        (4, (f64::INFINITY, 1.0), Some(Error::NonFinite("width"))),
        (1, (-1.0, f64::NAN), Some(Error::NonFinite("f"))),
    ] {
        assert_eq!(refused(index, point), error);
    }
    let apart = [(0.0, f64::MIN), (1.0, f64::MAX)];
    let terms = Term::curve(Quantity::Velocity, Source::Input, apart);
    assert_eq!(terms, Err(Error::NonFinite("f")));
    let over = Term::curve(Quantity::Eta, Source::Input, good);
    assert_eq!(over, Err(Error::OutOfRange("over")));
    let none = Term::<f64>::curve(Quantity::Velocity, Source::Input, []);
    assert_eq!(none, Ok([]));
}

/// Friction with a bell at low speed, which no pair of viscous and Coulomb friction has.
const FRICTION: [(f64, f64); 8] = [
    (-1.5, -2.5),
    (-0.7, -1.8),
    (-0.3, -2.0),
    (-0.05, -3.0),
    (0.05, 3.0),
    (0.3, 2.0),
    (0.7, 1.8),
    (1.5, 2.5),
];

/// Root mean square of the torque error over the last 100 of 240 s, and whether all estimates stayed
/// within their box, with estimators of this gain.
fn error_with(gain: f64) -> (f64, bool) {
    let (step, plant_gain) = (1e-3, 1.0);
    let form = Form::FirstOrder { step, plant_gain };
    let law = Adaptive::try_new(AdaptiveSettings {
        beta: Estimator::fixed(1.0),
        theta: [Estimator::fixed(0.0).within(-8.0, 8.0).adapting(gain, 0.0); 8],
        ..AdaptiveSettings::unlimited(form, 2.0, 20.0, 0.2)
    })
    .unwrap();
    let terms = Term::curve(Quantity::Velocity, Source::Input, FRICTION).unwrap();
    let (mut state, mut command) = (AdaptiveState::new(&law), 0.0);
    let (mut sum, mut within) = (0.0, true);
    for k in 0..240_000 {
        let t = f64::from(k) * 1e-3;
        let velocity = 1.3 * (0.3 * t).sin() * (0.053 * t).cos();
        let at = spoilt(&Inputs::default(), Quantity::Velocity, velocity);
        let regressors = terms.map(|term| term.effect.regressor(&mut EffectState::new(), &at));
        // A stiff drive: the torque answers the command of the sample before.
        let each = terms.iter().zip(&regressors);
        let lost: f64 = each.map(|(term, x)| term.gain * x).sum();
        let (measured, reference) = (command - lost, 5.0);
        let input = AdaptiveInput::new(1e-3, reference, measured, regressors);
        command = law.step(&mut state, &input).command;
        within &= state.theta_hat().iter().all(|theta| theta.abs() <= 8.0);
        if k >= 140_000 {
            sum += (measured - reference).powi(2);
        }
    }
    ((sum / 1e5).sqrt(), within)
}

#[test]
fn an_adaptive_law_learns_a_curve_segment_by_segment() {
    let (fixed, _) = error_with(0.0);
    let (learnt, within) = error_with(0.2);
    // What remains is the lag of the law at each reversal.
    assert!(within && learnt < 0.5 * fixed, "{learnt} of {fixed}");
}
