//! The model: sums, output stages, samples that cannot be used, and its clock.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod fixed;
#[path = "../shared/mod.rs"]
mod shared;

use approx::assert_relative_eq;
use bowden::effect::*;
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::model::{FixedModel, Model, ModelState, Sample, Source, Term, Terms};
use bowden::signal::{Play, PlayState};
use bowden::transmission::Transmission;
use bowden::{Error, Real};
use proptest::prelude::*;
use proptest::sample::select;
use shared::*;

/// With a gain above one the output of a huge input overflows before any effect is added.
fn cable_of_gain<T: Real>(gain: f64) -> Transmission<T> {
    let of = T::from_f64;
    let shape = BoucWen::try_new(of(0.6), of(2.0), of(1.5)).unwrap();
    Transmission::torque(of(gain), of(1.2), of(0.05), shape).unwrap()
}

fn cable<T: Real>() -> Transmission<T> {
    cable_of_gain(0.9)
}

fn term<T: Real>(name: &str, shapes: &[f64], source: Source, gain: f64) -> Term<T> {
    let shapes: Vec<T> = shapes.iter().map(|&shape| T::from_f64(shape)).collect();
    let effect = Effect::try_from_name(name, &shapes).unwrap();
    Term {
        effect,
        source,
        origin: T::zero(),
        gain: T::from_f64(gain),
    }
}

const TIP: Source = Source::Channel(1);

/// Effects with and without memory, on the input and on channels, stages in between.
fn several<T: Real>() -> [Term<T>; 7] {
    [
        term("viscous", &[], Source::Input, 0.3),
        term("lag", &[0.05], Source::Input, 0.8),
        term("load-friction", &[0.1], Source::Input, 0.2),
        term("backlash", &[0.2], TIP, -1.5),
        term("delay", &[], Source::Input, 0.004),
        term("pinching", &[0.4], Source::Input, 0.7),
        term("drift", &[], Source::Input, -0.01),
    ]
}

fn motion(position: f64, velocity: f64) -> Motion<f64> {
    Motion {
        position,
        velocity,
        acceleration: 0.0,
    }
}

/// A sample of an input alone.
fn alone<T: Real>(dt: f64, position: T, velocity: T) -> Sample<'static, T> {
    let input = with(Motion::default(), |at| {
        (at.position, at.velocity) = (position, velocity)
    });
    Sample {
        dt: T::from_f64(dt),
        input,
        load: position,
        channels: &[],
    }
}

type Row = (f64, Motion<f64>, [Motion<f64>; 2]);
type Record = Vec<Row>;

prop_compose! {
    fn record()(rows in prop::collection::vec([0.001..0.02_f64, -2.0..2.0, -2.0..2.0, -2.0..2.0], 1..40)) -> Record {
        rows.into_iter().map(|[dt, x, v, tip]| (dt, motion(x, v), [motion(0.0, 0.0), motion(tip, 0.0)])).collect()
    }
}

fn sample<'a>(row: &'a Row) -> Sample<'a, f64> {
    Sample {
        dt: row.0,
        input: row.1,
        load: row.1.position,
        channels: &row.2,
    }
}

/// Output, eta and time at each row: everything by hand, in the order of the equations.
fn by_hand(record: &Record, advance: impl Fn(f64, f64) -> f64) -> Vec<(f64, f64, f64)> {
    let (mut eta, mut last, mut play) = (0.0, None, EffectState::new());
    let (mut time, mut low, mut before) = (0.0, None, None);
    let mut rows = Vec::new();
    for row in record {
        let at = sample(row);
        time += if rows.is_empty() { 0.0 } else { at.dt };
        let (x, v) = (at.input.position, at.input.velocity);
        eta = last.map_or(eta, |last: f64| advance(eta, x - last));
        last = Some(x);
        let situation = with(Inputs::default(), |it| {
            (it.dt, it.motion) = (at.dt, at.channels[1])
        });
        let backlash = several::<f64>()[3].effect.regressor(&mut play, &situation);
        let sum = 0.9 * x - 1.2 * eta - 0.05 + 0.3 * v + 0.2 * at.load.abs() * (v / 0.1).tanh()
            - 1.5 * backlash
            + 0.7 * eta * (-(eta / 0.4).powi(2)).exp()
            - 0.01 * time;
        let share = 1.0 - (-at.dt / 0.05).exp();
        let level = low.map_or(sum, |low: f64| low + (sum - low) * share);
        low = Some(level);
        let lagged = sum + 0.8 * (level - sum);
        let c = (at.dt - 0.004) / (at.dt + 0.004);
        let late = before.map_or(lagged, |(before, late): (f64, f64)| {
            before + c * (lagged - late)
        });
        before = Some((lagged, late));
        rows.push((late, eta, time));
    }
    rows
}

/// The model's outputs in `f32`.
#[allow(clippy::cast_possible_truncation)]
fn in_single_precision(record: &Record) -> Vec<f64> {
    let model = Model::<f32, 7>::try_new(Some(cable()), &several()).unwrap();
    let mut state = ModelState::new();
    let to = |m: Motion<f64>| Motion {
        position: m.position as f32,
        velocity: m.velocity as f32,
        acceleration: m.acceleration as f32,
    };
    let step = |row: &Row| {
        let (channels, input) = (row.2.map(to), to(row.1));
        let at = Sample {
            dt: row.0 as f32,
            input,
            load: input.position,
            channels: &channels,
        };
        f64::from(model.step(&mut state, &at))
    };
    record.iter().map(step).collect()
}

/// Any sample but a good one.
fn spoil<'a>(good: Sample<'a, f64>, how: usize, bad: f64) -> Sample<'a, f64> {
    let mut at = good;
    match how {
        0 => at.dt = bad,
        1 => at.dt = 0.0,
        2 => at.dt = -0.01,
        3 => at.input.position = bad,
        4 => at.input.velocity = bad,
        5 => at.load = bad,
        _ => at.channels = &good.channels[..1],
    }
    at
}

proptest! {
    #[test]
    fn the_output_is_the_transmission_plus_the_terms_and_then_the_stages_and_the_shares_add_up(record in record()) {
        let model = Model::<f64, 8>::try_new(Some(cable()), &several()).unwrap();
        let (mut state, mut silent, mut own) = (ModelState::new(), ModelState::new(), BoucWenState::new());
        let shape = *cable::<f64>().shape();
        let by_hand = by_hand(&record, |eta, change| shape.advance(eta, change));
        for (row, (late, eta, time)) in record.iter().zip(by_hand) {
            let (mut shares, mut order) = ([f64::NAN; 7], vec![]);
            let output = model.step_with(&mut state, &sample(row), |index, share| {
                shares[index] = share;
                order.push(index);
            });
            assert_relative_eq!(output, late, epsilon = 1e-12);
            assert_relative_eq!(state.eta(), eta);
            assert_relative_eq!(state.time(), time, epsilon = 1e-12);
            prop_assert!(state.output() == late || (state.output() - late).abs() < 1e-12);
            let force = cable().step(&mut own, row.1.position);
            assert_relative_eq!(force + shares.iter().sum::<f64>(), output, epsilon = 1e-12);
            prop_assert_eq!(order, [0, 2, 3, 5, 6, 1, 4]); // output stages last, in their order
            prop_assert_eq!(output, model.step(&mut silent, &sample(row)));
            prop_assert_eq!(state, silent);
        }
    }

    #[test]
    fn a_play_in_series_stands_before_the_transmission_and_the_terms_read_past_it(
        record in record(),
        half in 0.01..2.0_f64,
    ) {
        let terms = [term("viscous", &[], Source::Input, 0.3), term("play-in-series", &[half], Source::Input, 1.0)];
        let model = Model::<f64, 2>::try_new(Some(cable()), &terms).unwrap();
        let (play, mut at_play) = (Play::try_new(half).unwrap(), PlayState::new());
        let (mut state, mut eta) = (ModelState::new(), BoucWenState::new());
        for row in &record {
            let at = sample(row);
            let force = cable().step(&mut eta, play.step(&mut at_play, at.input.position));
            let mut order = vec![];
            let output = model.step_with(&mut state, &at, |index, _| order.push(index));
            // x + (play − x) is the play but for one rounding.
            assert_relative_eq!(output, force + 0.3 * at.input.velocity, epsilon = 1e-12);
            prop_assert_eq!(order, [0]); // what the play does belongs to the transmission
        }
    }

    #[test]
    fn a_bad_sample_leaves_the_state_and_holds_the_last_good_output(
        record in record(),
        at in any::<prop::sample::Index>(),
        how in 0..7_usize,
        bad in select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
    ) {
        let model = Model::<f64, 7>::try_new(Some(cable()), &several()).unwrap();
        let mut state = ModelState::new();
        let stop = at.index(record.len());
        let mut last = 0.0;
        for row in &record[..stop] {
            last = model.step(&mut state, &sample(row));
        }
        let spoilt = spoil(sample(&record[stop]), how, bad);
        prop_assert!(!model.accepts(&spoilt) && model.accepts(&sample(&record[stop])));
        let before = state;
        let held = model.step_with(&mut state, &spoilt, |_, _| panic!("a share of a bad sample"));
        prop_assert_eq!(held, last);
        prop_assert_eq!(state, before);
    }

    #[test]
    fn the_output_is_finite_for_any_finite_sample(
        numbers in prop::collection::vec(prop::array::uniform8(prop::num::f32::NORMAL | prop::num::f32::ZERO), 1..10),
        gain in prop::num::f32::NORMAL,
        origin in prop::num::f32::NORMAL | prop::num::f32::ZERO,
    ) {
        let terms: Vec<Term<f32>> = every_effect()
            .into_iter()
            .map(|effect| Term { effect, source: Source::Channel(0), origin, gain })
            .collect();
        let model = Model::<f32, 64>::try_new(Some(cable()), &terms).unwrap();
        let mut state = ModelState::new();
        for [dt, a, b, c, d, e, f, load] in numbers {
            let input = Motion { position: a, velocity: b, acceleration: c };
            let channels = [Motion { position: d, velocity: e, acceleration: f }];
            let at = Sample { dt: dt.abs(), input, load, channels: &channels };
            prop_assert_eq!(model.accepts(&at), dt != 0.0);
            let output = model.step(&mut state, &at);
            prop_assert!(output.is_finite() && state.time().is_finite());
            prop_assert!(state.eta().abs() <= 1.0);
        }
    }

    #[test]
    fn single_precision_is_double_precision_but_for_rounding(record in record()) {
        let shape = *cable::<f64>().shape();
        // The hysteresis by the step that `f32` takes, in `f64`.
        let wide = by_hand(&record, |eta, change| shape.advance_bounded(eta, change));
        for (a, (b, ..)) in in_single_precision(&record).into_iter().zip(wide) {
            // eta loses 1e-6 a step where its branch is steep, and keeps some of it for 40.
            assert_relative_eq!(a, b, max_relative = 1e-4, epsilon = 1e-4);
        }
    }

    #[test]
    fn on_a_sampled_motion_single_precision_is_what_was_fitted_in_double(record in record()) {
        // An input that moves by 0.05 a sample at most, as 4 N·m at 2 Hz and 1 kHz do.
        let mut x = 0.0;
        let slow: Record = record
            .into_iter()
            .map(|(_, input, channels)| {
                x += 0.025 * input.position;
                (0.02, motion(x, input.velocity), channels)
            })
            .collect();
        let model = Model::<f64, 7>::try_new(Some(cable()), &several()).unwrap();
        let mut state = ModelState::new();
        for (a, row) in in_single_precision(&slow).into_iter().zip(&slow) {
            let b = model.step(&mut state, &sample(row));
            // The step in bounded time is off by 1.3e-4 of eta at most on such a path (table of
            // `hysteresis`), three samples at a reversal add up; kappa_eta is 1.2.
            assert_relative_eq!(a, b, epsilon = 5e-4);
        }
    }
}

fn every_effect<T: Real>() -> Vec<Effect<T>> {
    CATALOGUE.iter().map(|info| make(info.name)).collect()
}

proptest! {
    #[test]
    fn every_effect_reads_its_position_from_its_origin_and_nothing_else_of_it(
        record in record(),
        origin in -2.0..2.0_f64,
    ) {
        let stage = |effect: &Effect<f64>| effect.is_output_stage() || effect.is_input_stage();
        for effect in every_effect::<f64>().into_iter().filter(|effect| !stage(effect)) {
            for source in [Source::Input, TIP] {
                let term = Term { effect, source, origin, gain: 1.0 };
                let model = Model::<f64, 1>::try_new(Some(cable()), &[term]).unwrap();
                let (mut state, mut memory) = (ModelState::new(), EffectState::new());
                let mut eta = BoucWenState::new();
                for row in &record {
                    let at = sample(row);
                    let mut seen = [0.0];
                    model.step_with(&mut state, &at, |index, share| seen[index] = share);
                    cable().step(&mut eta, at.input.position); // from the sensor's own zero
                    let read = if source == TIP { at.channels[1] } else { at.input };
                    let motion = Motion { position: read.position - origin, ..read };
                    let (dt, input, load, time) = (at.dt, at.input, at.load, state.time());
                    let eta = eta.eta();
                    let situation = Inputs { dt, time, motion, input, load, eta, output: 0.0 };
                    prop_assert_eq!(seen[0], effect.regressor(&mut memory, &situation), "{}", effect.name());
                }
            }
        }
    }
}

#[test]
fn an_origin_moves_the_zero_of_a_progressive_spring_and_of_friction_along_the_stroke() {
    let spring = term("stiffness-progressive", &[], TIP, 2.0);
    let friction = term("position-friction", &[0.001], TIP, 1.0);
    let [spring, friction] = [spring, friction].map(|term| Term {
        origin: 1.5,
        ..term
    });
    let model = Model::<f64, 2>::try_new(None, &[spring, friction]).unwrap();
    for (x, v, expected) in [
        (1.5, 4.0, [0.0, 0.0]),
        (2.0, 4.0, [0.5, 0.5]),
        (2.0, -4.0, [0.5, -0.5]),
        (0.5, 4.0, [-2.0, -1.0]),
    ] {
        let channels = [motion(9.0, 9.0), motion(x, v)];
        let at = Sample {
            channels: &channels,
            ..alone(0.01, 7.0, 7.0)
        };
        let mut shares = [f64::NAN; 2];
        model.step_with(&mut ModelState::new(), &at, |k, share| shares[k] = share);
        assert_eq!(shares, expected);
    }
}

#[test]
fn an_origin_far_off_saturates_and_hides_no_bad_position() {
    let far = Term {
        origin: f32::MIN,
        ..term("stiffness-linear", &[], Source::Input, 1.0)
    };
    let model = Model::<f32, 1>::try_new(None, &[far]).unwrap();
    let at = |position| with(alone(0.01, position, 0.0), |at| at.load = 0.0);
    let mut state = ModelState::new();
    assert!(model.accepts(&at(f32::MAX)));
    assert_eq!(model.step(&mut state, &at(f32::MAX)), f32::MAX);
    assert_eq!(model.step(&mut state, &at(f32::MIN)), 0.0);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(!model.accepts(&at(bad)));
        assert_eq!(model.step(&mut state, &at(bad)), 0.0); // held
    }
}

#[test]
fn output_stages_read_the_whole_sum_wherever_they_are_listed() {
    let drift = term("drift", &[], Source::Input, 1.0);
    let delay = term("delay", &[], Source::Input, 0.5);
    let lag = term("lag", &[1.0 / std::f64::consts::LN_2], Source::Input, 1.0);
    let at = alone(1.0, 0.0, 0.0);
    // Ramp 0, 1, 2. Half a sample late, c = 1/3: 0, 1/3, 14/9; then low-passed half-way, in any
    // order, as both stages are linear.
    let expected = [0.0, 1.0 / 6.0, 31.0 / 36.0];
    for terms in [
        [delay, drift, lag],
        [lag, delay, drift],
        [drift, lag, delay],
    ] {
        let model = Model::<f64, 3>::try_new(None, &terms).unwrap();
        let mut state = ModelState::new();
        for value in expected {
            assert_relative_eq!(model.step(&mut state, &at), value, epsilon = 1e-15);
        }
    }
}

#[test]
fn numbers_that_no_term_reads_may_be_anything() {
    let nan = with(motion(f64::NAN, f64::NAN), |at| at.acceleration = f64::NAN);
    let terms = [term("viscous", &[], TIP, 2.0)];
    let model = Model::<f64, 1>::try_new(None, &terms).unwrap();
    let tip = with(nan, |at| at.velocity = 3.0);
    let at = Sample {
        dt: 0.01,
        input: nan,
        load: f64::NAN,
        channels: &[nan, tip],
    };
    assert_eq!(model.step(&mut ModelState::new(), &at), 6.0);
}

#[test]
fn a_model_without_terms_is_its_transmission_and_one_without_both_is_zero() {
    let at = |x| alone(0.01, x, 0.0);
    let bare = Model::<f64, 0>::try_new(Some(cable()), &[]).unwrap();
    let (mut state, mut eta) = (ModelState::new(), BoucWenState::new());
    for x in [0.0, 1.0, -3.0, 2.0] {
        assert_eq!(bare.step(&mut state, &at(x)), cable().step(&mut eta, x));
    }
    let nothing = Model::<f64, 0>::try_new(None, &[]).unwrap();
    assert_eq!(nothing.step(&mut ModelState::new(), &at(1.0)), 0.0);
    assert_eq!(nothing.transmission(), None);
}

#[test]
fn the_hysteresis_starts_where_it_is_told() {
    let model = Model::<f64, 1>::try_new(Some(cable()), &[]).unwrap();
    let mut state = ModelState::with_eta(0.5).unwrap();
    let output = model.step(&mut state, &alone(0.01, 1.0, 0.0));
    assert_relative_eq!(output, 0.9 - 1.2 * 0.5 - 0.05);
    let refused = ModelState::<f64, 1>::with_eta(f64::NAN);
    assert_eq!(refused, Err(Error::NonFinite("eta")));
}

#[test]
fn what_cannot_be_a_model_is_refused() {
    let viscous: Term<f64> = term("viscous", &[], Source::Input, 1.0);
    let two = Model::<f64, 1>::try_new(None, &[viscous, viscous]);
    assert_eq!(two, Err(Error::Capacity("terms")));
    for gain in [f64::NAN, f64::INFINITY] {
        let model = Model::<f64, 1>::try_new(None, &[Term { gain, ..viscous }]);
        assert_eq!(model, Err(Error::NonFinite("gain")));
    }
    for origin in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let terms = [viscous, Term { origin, ..viscous }];
        let model = Model::<f64, 2>::try_new(None, &terms);
        assert_eq!(model, Err(Error::NonFinite("origin")));
    }
    let model = Model::<f64, 3>::try_new(None, &[viscous]).unwrap();
    assert_eq!(model.terms(), [viscous]);
}

#[test]
fn the_clock_of_an_f32_runs_true_for_hours() {
    let drift: Term<f32> = term("drift", &[], Source::Input, 1.0);
    let model = Model::<f32, 1>::try_new(None, &[drift]).unwrap();
    let at = alone(0.001, 0.0, 0.0);
    let mut state = ModelState::new();
    let steps = 10_000_000;
    for _ in 0..steps {
        model.step(&mut state, &at);
    }
    // 2.8 h; a plain sum is 2.2 % behind by now. One ulp of 1e4 is 1e-3.
    let expected = f64::from(steps - 1) * f64::from(0.001_f32);
    assert_relative_eq!(f64::from(state.time()), expected, epsilon = 2e-3);
}
