//! The model turned round gives what the model then gives back.

use super::*;
use bowden::effect::{Effect, Motion};
use bowden::model::{ModelState, Sample, Source, Term};

fn term(name: &str, shapes: &[f64], channel: u8, gain: f64) -> Term<f64> {
    Term {
        effect: Effect::try_from_name(name, shapes).unwrap(),
        source: Source::Channel(channel),
        origin: 0.1,
        gain,
    }
}

fn bent<const N: usize>(sigma: f64, terms: &[Term<f64>]) -> Model<f64, N> {
    Model::try_new(Some(paper(sigma)), terms).unwrap()
}

/// Friction with and without memory, inertia and ripple on two pulleys.
fn model() -> Model<f64, 5> {
    let terms = [
        term("coulomb", &[0.05], 0, -0.8),
        term("backlash", &[0.2], 0, 0.6),
        term("inertia", &[], 1, -0.02),
        term("stiffness-progressive", &[], 1, 1.5),
        term("drift", &[], 1, 0.1),
    ];
    bent(0.6, &terms)
}

fn motion(position: f64, velocity: f64, acceleration: f64) -> Motion<f64> {
    Motion {
        position,
        velocity,
        acceleration,
    }
}

/// The two pulleys at a time.
fn pulleys(t: f64) -> [Motion<f64>; 2] {
    [3.0_f64, 5.0].map(|w| motion((w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin()))
}

fn wish(desired: f64, channels: &[Motion<f64>]) -> CompensatorInput<'_, f64> {
    CompensatorInput {
        channels,
        ..CompensatorInput::new(DT, desired)
    }
}

/// The output of the model after a command.
fn answer<const N: usize>(
    model: &Model<f64, N>,
    plant: &mut ModelState<f64, N>,
    command: f64,
    channels: &[Motion<f64>],
) -> f64 {
    let sample = Sample {
        dt: DT,
        input: motion(command, 0.0, 0.0),
        load: command,
        channels,
    };
    model.step(plant, &sample)
}

#[test]
fn the_model_gives_the_desired_output_after_the_compensators_command() {
    let model = model();
    let compensator = Compensator::try_new(&model).unwrap();
    let (mut state, mut plant) = (CompensatorState::new(), ModelState::new());
    for k in 0..4000 {
        let t = DT * f64::from(k);
        let channels = pulleys(t);
        let desired = 25.0 + 10.0 * (1.57 * t).sin() + 3.0 * (2.18 * t).sin();
        let out = compensator.step(&mut state, &wish(desired, &channels));
        assert_eq!(out.status, Status::Good);
        // 16 epsilons of all magnitudes in the equation (Inverse::step), which are < 150.
        let got = answer(&model, &mut plant, out.command, &channels);
        near(got, desired, 16.0 * f64::EPSILON * 150.0);
        assert_eq!(state.eta(), plant.eta());
    }
}

#[test]
fn models_that_cannot_be_turned_round_are_refused() {
    let stage = |name, shapes: &[f64]| bent(0.6, &[term(name, shapes, 0, 1.0)]);
    let without: Model<f64, 2> = Model::try_new(None, &[]).unwrap();
    let stages = [stage("delay", &[]), stage("lag", &[0.01])];
    assert!(stages
        .iter()
        .all(|model| model.terms()[0].effect.is_output_stage()));
    let slack = stage("play-in-series", &[0.2]);
    for model in stages.into_iter().chain([slack, without, bent(98.36, &[])]) {
        let refused = Compensator::try_new(&model);
        assert!(matches!(refused, Err(Error::Inadmissible(_))));
    }
}

#[test]
fn the_nearest_model_tells_what_it_lowered_and_what_it_left_out() {
    let (own, changed) = Compensator::try_nearest(&model()).unwrap();
    assert_eq!(own, Compensator::try_new(&model()).unwrap());
    assert!(changed.is_nothing());
    let terms = [
        term("lag", &[0.01], 0, 1.0),
        term("viscous", &[], 1, -0.3),
        term("play-in-series", &[0.2], 0, 1.0),
        term("coulomb", &[0.05], 0, 0.8),
    ];
    let (compensator, changed) = Compensator::try_nearest(&bent::<5>(98.36, &terms)).unwrap();
    let sigma = changed.sigma.unwrap();
    assert_eq!((sigma.0, changed.rho), (98.36, None));
    near(sigma.1, 0.9978 / (2.0 * 7.004 * 0.095_82), 1e-14); // rounding
    assert_eq!(changed.left_out().collect::<Vec<_>>(), [0, 2]);
    assert!(!changed.is_nothing());

    // What is left is the model with that sigma and the other two terms.
    let by_hand = Compensator::try_new(&bent::<2>(sigma.1, &[terms[1], terms[3]])).unwrap();
    let (mut a, mut b) = (CompensatorState::new(), CompensatorState::new());
    for k in 0..1000 {
        let t = DT * f64::from(k);
        let channels = pulleys(t);
        let wish = wish(20.0 * (3.0 * t).sin(), &channels);
        let (a, b) = (compensator.step(&mut a, &wish), by_hand.step(&mut b, &wish));
        assert_eq!((a.command, a.effects), (b.command, b.effects));
    }
    // Terms keep their places: the fault's, too.
    let status = compensator
        .step(&mut a, &wish(1.0, &pulleys(0.0)[..1]))
        .status;
    assert_eq!(status, Status::Held(Fault::Regressor(1)));
}

#[test]
fn a_knee_that_no_sigma_mends_is_made_rounder() {
    let shape = BoucWen::try_new(2.0_f32, 3.0, 1.5).unwrap();
    let cable = Transmission::displacement(-1.0, 4.0, 0.0, shape).unwrap();
    let of = |cable| Compensator::try_nearest(&Model::<f32, 0>::try_new(cable, &[]).unwrap());
    let (compensator, changed) = of(Some(cable)).unwrap();
    let (sigma, rho) = (changed.sigma.unwrap(), changed.rho.unwrap());
    assert_eq!([sigma.0, sigma.1, rho.0, rho.1], [3.0, 0.5, 2.0, 0.25]);
    assert_eq!(compensator.transmission().kappa_eta(), 4.0);
    let flat = Transmission::torque(0.0, 4.0, 0.0, shape).unwrap();
    for cable in [None, Some(flat)] {
        assert!(matches!(of(cable), Err(Error::Inadmissible(_))));
    }
}

#[test]
fn a_bad_sample_holds_the_command_and_the_state() {
    let compensator = Compensator::try_new(&model()).unwrap();
    let channels = pulleys(0.3);
    let good = wish(12.0, &channels);
    let mut state = CompensatorState::new();
    compensator.step(&mut state, &good);
    let before = compensator.step(&mut state, &wish(13.0, &channels));
    let (eta, mut reference) = (state.eta(), state);

    let lost = with(channels, |it| it[1].acceleration = f64::NAN);
    for (bad, fault) in [
        (with(good, |at| at.dt = f64::NAN), Fault::Dt),
        (with(good, |at| at.dt = 0.0), Fault::DtNotPositive),
        (wish(f64::NAN, &channels), Fault::Reference),
        (wish(f64::MAX, &channels), Fault::Overflow),
        (wish(12.0, &lost), Fault::Regressor(2)),
        (wish(12.0, &channels[..1]), Fault::Regressor(2)),
    ] {
        let out = compensator.step(&mut state, &bad);
        assert_eq!(out.status, Status::Held(fault));
        assert_eq!((out.command, state.eta()), (before.command, eta));
    }
    assert_eq!(state.consecutive_bad(), 6);
    // What follows is as if they had not been.
    let after = compensator.step(&mut state, &good);
    assert_eq!(after, compensator.step(&mut reference, &good));
    assert_eq!(state, reference);
}

#[test]
fn beyond_the_benchs_range_an_effect_is_what_it_is_at_the_range() {
    let compensator = Compensator::try_new(&model()).unwrap();
    let (low, high) = (motion(-0.5, -1.0, -9.0), motion(0.5, 1.0, 9.0));
    let source = Source::Channel(1);
    let bound = compensator.with_ranges(&[BenchRange { source, low, high }]);
    let bound = bound.unwrap();
    let share = |compensator: &Compensator<f64, 5>, position, acceleration| {
        let channels = [Motion::default(), motion(position, 0.0, acceleration)];
        let mut state = CompensatorState::new();
        compensator.step(&mut state, &wish(5.0, &channels)).effects
    };
    assert_eq!(share(&bound, 7.0, -80.0), share(&compensator, 0.5, -9.0));
    assert_eq!(share(&bound, 0.2, 4.0), share(&compensator, 0.2, 4.0));
    assert_ne!(share(&compensator, 7.0, 0.0), share(&compensator, 0.5, 0.0));
}

#[test]
fn the_load_is_confined_with_the_input() {
    let model = bent::<1>(0.6, &[term("load-friction", &[0.05], 0, -0.1)]);
    let compensator = Compensator::try_new(&model).unwrap();
    let (low, high) = (motion(-40.0, 0.0, 0.0), motion(40.0, 0.0, 0.0));
    let source = Source::Input;
    let bound = compensator.with_ranges(&[BenchRange { source, low, high }]);
    let bound = bound.unwrap();
    let share = |compensator: &Compensator<f64, 1>, load| {
        let channels = [motion(0.0, 2.0, 0.0)];
        let at = with(wish(5.0, &channels), |at| at.load = load);
        compensator.step(&mut CompensatorState::new(), &at).effects
    };
    assert_eq!(share(&bound, 400.0), share(&compensator, 40.0));
    assert_ne!(share(&compensator, 400.0), share(&compensator, 40.0));
}

/// What the command travels, and the greatest error of the output, where the wish wobbles.
fn travel(model: &Model<f64, 1>, compensator: &Compensator<f64, 1>) -> (f64, f64) {
    let (mut state, mut plant) = (CompensatorState::new(), ModelState::new());
    let (mut travel, mut last, mut worst) = (0.0, None, 0.0_f64);
    for k in 0..4000 {
        let wobble = if k % 2 == 0 { 0.04 } else { -0.04 };
        let desired = 25.0 + 10.0 * (1.57e-3 * f64::from(k)).sin() + wobble;
        let out = compensator.step(&mut state, &wish(desired, &[]));
        assert_eq!(out.status, Status::Good);
        let got = answer(model, &mut plant, out.command, &[]);
        worst = worst.max((got - desired).abs());
        travel += last.map_or(0.0, |last: f64| (out.command - last).abs());
        last = Some(out.command);
    }
    (travel, worst)
}

#[test]
fn a_play_passes_over_small_reversals_and_the_output_stays_within_it() {
    let model = bent(0.6, &[]);
    let plain = Compensator::try_new(&model).unwrap();
    let played = plain.with_play(0.05).unwrap();
    let (without, exact) = travel(&model, &plain);
    let (with, error) = travel(&model, &played);
    // To rounding; within the half-width.
    assert!(exact < 1e-9 && error < 0.05 + 1e-9, "{exact} {error}");
    // 25 at the start, 40 N·m of a whole sine, and two reversals of the friction: less than 90.
    assert!(with < 90.0 && without > 300.0, "{with} {without}");
    // Zero is none, and what cannot be a number is told and moves nothing.
    let none = plain.with_play(0.0).unwrap();
    assert_eq!(travel(&model, &none), (without, exact));
    let mut state = CompensatorState::<f64, 1>::new();
    played.step(&mut state, &wish(5.0, &[]));
    let before = (state.command(), state.eta());
    let huge = played.step(&mut state, &wish(f64::MAX, &[]));
    assert_eq!(huge.status, Status::Held(Fault::Overflow));
    assert_eq!((state.command(), state.eta()), before);
    let next = played.step(&mut state, &wish(5.03, &[]));
    assert_eq!(next.command, before.0);
    let refused = |half_width| plain.with_play(half_width).err();
    assert_eq!(refused(-0.1), Some(Error::OutOfRange("half_width")));
    assert_eq!(refused(f64::NAN), Some(Error::NonFinite("half_width")));
}

#[test]
fn ranges_are_checked() {
    let compensator = Compensator::try_new(&model()).unwrap();
    let (none, some) = (Motion::default(), pulleys(0.1)[0]);
    let refused = |channel, low, high| {
        let source = Source::Channel(channel);
        compensator
            .with_ranges(&[BenchRange { source, low, high }])
            .unwrap_err()
    };
    refused(0, some, none);
    assert!(matches!(refused(7, none, none), Error::Inadmissible(_)));
    let lost = motion(0.0, f64::NAN, 0.0);
    assert!(matches!(refused(7, lost, none), Error::NonFinite(_)));
}
