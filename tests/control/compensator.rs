//! The model turned round gives what the model then gives back.

use bowden::control::{BenchRange, Compensator, CompensatorInput, CompensatorState, Fault, Status};
use bowden::effect::{Effect, Motion};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, ModelState, Sample, Source, Term};
use bowden::transmission::Transmission;
use bowden::Error;

fn cable(sigma: f64) -> Transmission<f64> {
    let shape = BoucWen::try_new(0.095_82, sigma, 3.871).unwrap();
    Transmission::torque(0.9978, 7.004, 0.051_74, shape).unwrap()
}

fn term(name: &str, shapes: &[f64], channel: u8, gain: f64) -> Term<f64> {
    Term {
        effect: Effect::try_from_name(name, shapes).unwrap(),
        source: Source::Channel(channel),
        origin: 0.1,
        gain,
    }
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
    Model::try_new(Some(cable(0.6)), &terms).unwrap()
}

fn motion(t: f64, rate: f64) -> Motion<f64> {
    Motion {
        position: (rate * t).sin(),
        velocity: rate * (rate * t).cos(),
        acceleration: -rate * rate * (rate * t).sin(),
    }
}

fn wish(desired: f64, channels: &[Motion<f64>]) -> CompensatorInput<'_, f64> {
    CompensatorInput {
        channels,
        ..CompensatorInput::new(1e-3, desired)
    }
}

/// The output of the model after a command.
fn answer<const N: usize>(
    model: &Model<f64, N>,
    plant: &mut ModelState<f64, N>,
    command: f64,
    channels: &[Motion<f64>],
) -> f64 {
    let input = Motion {
        position: command,
        ..Motion::default()
    };
    let sample = Sample {
        dt: 1e-3,
        input,
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
        let t = 1e-3 * f64::from(k);
        let channels = [motion(t, 3.0), motion(t, 5.0)];
        let desired = 25.0 + 10.0 * (1.57 * t).sin() + 3.0 * (2.18 * t).sin();
        let out = compensator.step(&mut state, &wish(desired, &channels));
        assert_eq!(out.status, Status::Good);

        let got = answer(&model, &mut plant, out.command, &channels);
        // 16 epsilons of all magnitudes in the equation (Inverse::step), which are < 150.
        assert!(
            (got - desired).abs() < 16.0 * f64::EPSILON * 150.0,
            "{k}: {got} {desired}"
        );
        assert_eq!(state.eta(), plant.eta());
    }
}

#[test]
fn models_that_cannot_be_turned_round_are_refused() {
    let inadmissible =
        |model: Model<f64, 2>| matches!(Compensator::try_new(&model), Err(Error::Inadmissible(_)));
    assert!(inadmissible(Model::try_new(None, &[]).unwrap()));
    assert!(inadmissible(
        Model::try_new(Some(cable(98.36)), &[]).unwrap()
    ));
    for (stage, shapes) in [("delay", &[][..]), ("lag", &[0.01])] {
        let stage = term(stage, shapes, 0, 0.1);
        assert!(stage.effect.is_output_stage());
        assert!(inadmissible(
            Model::try_new(Some(cable(0.6)), &[stage]).unwrap()
        ));
    }
    let slack = term("play-in-series", &[0.2], 0, 1.0);
    assert!(inadmissible(
        Model::try_new(Some(cable(0.6)), &[slack]).unwrap()
    ));
}

#[test]
fn the_nearest_model_is_the_model_itself_where_that_can_be_turned_round() {
    let (compensator, changed) = Compensator::try_nearest(&model()).unwrap();
    assert_eq!(compensator, Compensator::try_new(&model()).unwrap());
    assert!(changed.is_nothing());
}

#[test]
fn the_nearest_model_tells_what_it_lowered_and_what_it_left_out() {
    let terms = [
        term("lag", &[0.01], 0, 1.0),
        term("viscous", &[], 1, -0.3),
        term("play-in-series", &[0.2], 0, 1.0),
        term("coulomb", &[0.05], 0, 0.8),
    ];
    let model = Model::<f64, 5>::try_new(Some(cable(98.36)), &terms).unwrap();
    let (compensator, changed) = Compensator::try_nearest(&model).unwrap();
    let most = 0.9978 / (2.0 * 7.004 * 0.095_82);
    let sigma = changed.sigma.unwrap();
    assert_eq!((sigma.0, changed.rho), (98.36, None));
    assert!((sigma.1 - most).abs() < 1e-14, "{sigma:?}"); // rounding
    assert_eq!(changed.left_out().collect::<Vec<_>>(), [0, 2]);
    assert!(!changed.is_nothing());

    // What is left is the model with that sigma and the other two terms.
    let kept = Model::<f64, 2>::try_new(Some(cable(sigma.1)), &[terms[1], terms[3]]).unwrap();
    let by_hand = Compensator::try_new(&kept).unwrap();
    let (mut a, mut b) = (CompensatorState::new(), CompensatorState::new());
    for k in 0..1000 {
        let t = 1e-3 * f64::from(k);
        let channels = [motion(t, 3.0), motion(t, 5.0)];
        let wish = wish(20.0 * (3.0 * t).sin(), &channels);
        let (a, b) = (compensator.step(&mut a, &wish), by_hand.step(&mut b, &wish));
        assert_eq!((a.command, a.effects), (b.command, b.effects));
    }
    // Terms keep their places: the fault's, too.
    let channels = [motion(0.0, 3.0)];
    let status = compensator.step(&mut a, &wish(1.0, &channels)).status;
    assert_eq!(status, Status::Held(Fault::Regressor(1)));
}

#[test]
fn a_knee_that_no_sigma_mends_is_made_rounder() {
    let shape = BoucWen::try_new(2.0_f32, 3.0, 1.5).unwrap();
    let cable = Transmission::displacement(-1.0, 4.0, 0.0, shape).unwrap();
    let model = Model::<f32, 0>::try_new(Some(cable), &[]).unwrap();
    let (compensator, changed) = Compensator::try_nearest(&model).unwrap();
    let (sigma, rho) = (changed.sigma.unwrap(), changed.rho.unwrap());
    assert_eq!([sigma.0, sigma.1, rho.0, rho.1], [3.0, 0.5, 2.0, 0.25]);
    assert_eq!(compensator.transmission().kappa_eta(), 4.0);
    let none = Model::<f32, 0>::try_new(None, &[]).unwrap();
    let flat = Transmission::torque(0.0, 4.0, 0.0, shape).unwrap();
    let flat = Model::<f32, 0>::try_new(Some(flat), &[]).unwrap();
    for model in [none, flat] {
        let refused = Compensator::try_nearest(&model);
        assert!(matches!(refused, Err(Error::Inadmissible(_))));
    }
}

#[test]
fn a_bad_sample_holds_the_command_and_the_state() {
    let compensator = Compensator::try_new(&model()).unwrap();
    let channels = [motion(0.3, 3.0), motion(0.3, 5.0)];
    let good = wish(12.0, &channels);
    let mut state = CompensatorState::new();
    compensator.step(&mut state, &good);
    let before = compensator.step(&mut state, &wish(13.0, &channels));
    let eta = state.eta();
    let mut reference = state;

    let mut lost = channels;
    lost[1].acceleration = f64::NAN;
    let dt = |dt| CompensatorInput { dt, ..good };
    for (bad, fault) in [
        (dt(f64::NAN), Fault::Dt),
        (dt(0.0), Fault::DtNotPositive),
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
    let low = Motion {
        position: -0.5,
        velocity: -1.0,
        acceleration: -9.0,
    };
    let high = Motion {
        position: 0.5,
        velocity: 1.0,
        acceleration: 9.0,
    };
    let source = Source::Channel(1);
    let bound = compensator
        .with_ranges(&[BenchRange { source, low, high }])
        .unwrap();
    let share = |compensator: &Compensator<f64, 5>, position, acceleration| {
        let far = Motion {
            position,
            acceleration,
            velocity: 0.0,
        };
        let channels = [Motion::default(), far];
        let mut state = CompensatorState::new();
        compensator.step(&mut state, &wish(5.0, &channels)).effects
    };
    assert_eq!(share(&bound, 7.0, -80.0), share(&compensator, 0.5, -9.0));
    assert_eq!(share(&bound, 0.2, 4.0), share(&compensator, 0.2, 4.0));
    assert_ne!(share(&compensator, 7.0, 0.0), share(&compensator, 0.5, 0.0));
}

#[test]
fn the_load_is_confined_with_the_input() {
    let friction = Term {
        source: Source::Channel(0),
        ..term("load-friction", &[0.05], 0, -0.1)
    };
    let model = Model::<f64, 1>::try_new(Some(cable(0.6)), &[friction]).unwrap();
    let compensator = Compensator::try_new(&model).unwrap();
    let low = Motion {
        position: -40.0,
        ..Motion::default()
    };
    let high = Motion {
        position: 40.0,
        ..Motion::default()
    };
    let source = Source::Input;
    let bound = compensator
        .with_ranges(&[BenchRange { source, low, high }])
        .unwrap();
    let share = |compensator: &Compensator<f64, 1>, load| {
        let channels = [Motion {
            velocity: 2.0,
            ..Motion::default()
        }];
        let at = CompensatorInput {
            load,
            channels: &channels,
            ..CompensatorInput::new(1e-3, 5.0)
        };
        compensator.step(&mut CompensatorState::new(), &at).effects
    };
    assert_eq!(share(&bound, 400.0), share(&compensator, 40.0));
    assert_ne!(share(&compensator, 400.0), share(&compensator, 40.0));
}

#[test]
fn a_play_passes_over_small_reversals_and_the_output_stays_within_it() {
    let model = Model::<f64, 1>::try_new(Some(cable(0.6)), &[]).unwrap();
    let plain = Compensator::try_new(&model).unwrap();
    let played = plain.with_play(0.05).unwrap();
    let travel = |compensator: &Compensator<f64, 1>| {
        let (mut state, mut plant) = (CompensatorState::new(), ModelState::new());
        let (mut travel, mut last, mut worst) = (0.0, 0.0, 0.0_f64);
        for k in 0..4000 {
            let wobble = if k % 2 == 0 { 0.04 } else { -0.04 };
            let desired = 25.0 + 10.0 * (1.57e-3 * f64::from(k)).sin() + wobble;
            let out = compensator.step(&mut state, &wish(desired, &[]));
            assert_eq!(out.status, Status::Good);
            let got = answer(&model, &mut plant, out.command, &[]);
            worst = worst.max((got - desired).abs());
            travel += if k > 0 {
                (out.command - last).abs()
            } else {
                0.0
            };
            last = out.command;
        }
        (travel, worst)
    };
    let (without, exact) = travel(&plain);
    let (with, error) = travel(&played);
    // To rounding; within the half-width.
    assert!(exact < 1e-9 && error < 0.05 + 1e-9, "{exact} {error}");
    // 25 at the start, 40 N·m of a whole sine, and two reversals of the friction: less than 90.
    assert!(with < 90.0 && without > 300.0, "{with} {without}");
    // Zero is none, and what cannot be a number is told and moves nothing.
    assert_eq!(travel(&plain.with_play(0.0).unwrap()), (without, exact));
    let mut state = CompensatorState::<f64, 1>::new();
    played.step(&mut state, &CompensatorInput::new(1e-3, 5.0));
    let before = state;
    let huge = CompensatorInput::new(1e-3, f64::MAX);
    assert_eq!(
        played.step(&mut state, &huge).status,
        Status::Held(Fault::Overflow)
    );
    assert_eq!(
        (state.command(), state.eta()),
        (before.command(), before.eta())
    );
    let next = played.step(&mut state, &CompensatorInput::new(1e-3, 5.03));
    assert_eq!(next.command, before.command());
    assert_eq!(
        plain.with_play(-0.1).err(),
        Some(Error::OutOfRange("half_width"))
    );
    assert_eq!(
        plain.with_play(f64::NAN).err(),
        Some(Error::NonFinite("half_width"))
    );
}

#[test]
fn ranges_are_checked() {
    let compensator = Compensator::try_new(&model()).unwrap();
    let (low, high) = (Motion::default(), motion(0.1, 1.0));
    let source = Source::Channel(0);
    assert!(compensator
        .with_ranges(&[BenchRange {
            source,
            low: high,
            high: low
        }])
        .is_err());
    let source = Source::Channel(7);
    let high = Motion::default();
    let nobody = compensator.with_ranges(&[BenchRange { source, low, high }]);
    assert!(matches!(nobody, Err(Error::Inadmissible(_))));
    let low = Motion {
        velocity: f64::NAN,
        ..low
    };
    let refused = compensator.with_ranges(&[BenchRange { source, low, high }]);
    assert!(matches!(refused, Err(Error::NonFinite(_))));
}
