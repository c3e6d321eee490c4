//! Bad samples, refused numbers, single precision.

use bowden::effect::{Effect, Viscous, CATALOGUE};
use bowden::model::{Source, Term};
use bowden::{Error, Real};
use bowden_rig::{Reference, Rig, RigConfig};
use proptest::prelude::*;

/// PI on the rig; the error at the end.
fn pi<T: Real, const N: usize>(rig: &Rig<T, N>, seconds: usize) -> T {
    let reference = Reference::paper();
    let mut state = rig.start(9);
    let mut integral = T::zero();
    for _ in 0..seconds * 1000 {
        let now = state.sample();
        let e = now.measured - reference.at(now.time);
        integral += e * T::from_f64(1e-3);
        let command = -T::from_f64(30.0) * e - T::from_f64(18.0) * integral;
        let now = rig.step(&mut state, command, T::from_f64(1e-3));
        assert!(!now.diverged && now.tau_o.is_finite() && now.measured.is_finite());
    }
    state.sample().tau_o - reference.at(state.sample().time)
}

#[test]
fn single_precision_tells_the_same_story() {
    let double = Rig::<f64, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let single = Rig::<f32, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let (a, b) = (pi(&double, 10), pi(&single, 10).as_f64());
    // The same noise; a converter count (3e-3 N·m) now and then falls the other way, and
    // friction of 7 N·m reverses by it at another sample.
    assert!((a - b).abs() < 0.05, "{a} {b}");
}

#[test]
fn every_effect_that_the_catalogue_has_can_be_switched_on() {
    for info in CATALOGUE {
        let effect = Effect::try_from_name(info.name, &[0.7])
            .or_else(|_| Effect::try_from_name(info.name, &[0.7, 0.4]))
            .or_else(|_| Effect::try_from_name(info.name, &[]))
            .unwrap();
        let term = Term {
            effect,
            source: Source::Channel(1),
            origin: 0.0,
            gain: 1e-3,
        };
        let rig = Rig::<f64, 1>::try_new(RigConfig::reference(), &[term]).unwrap();
        pi(&rig, 1);
    }
}

#[test]
fn bad_commands_and_times_change_nothing() {
    let rig = Rig::<f64, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let mut state = rig.start(1);
    for _ in 0..50 {
        rig.step(&mut state, 20.0, 1e-3);
    }
    let before = state;
    for dt in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        rig.step(&mut state, 20.0, dt);
        assert_eq!(state, before);
    }
    // The drive keeps the last command that was one.
    let mut good = before;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        rig.step_with_load(&mut state, bad, bad, 1e-3);
        rig.step(&mut good, 20.0, 1e-3);
        assert_eq!(state, good);
    }
}

#[test]
fn what_leaves_the_range_of_floats_stands_still_and_says_so() {
    let rig = Rig::<f32, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let mut state = rig.start(1);
    for k in 0..2000 {
        let command = if k % 2 == 0 { f32::MAX } else { f32::MIN };
        let now = rig.step(&mut state, command, 1e-3);
        assert!(now.tau_o.is_finite() && now.measured.is_finite() && now.tau_m.is_finite());
    }
    assert!(state.sample().diverged);
}

#[test]
fn numbers_that_make_no_rig_are_refused_by_name() {
    let refused = |set: fn(&mut RigConfig<f64>)| {
        let mut config = RigConfig::reference();
        set(&mut config);
        Rig::<f64, 0>::try_new(config, &[]).unwrap_err()
    };
    let zero = Error::OutOfRange("joint_inertia");
    assert_eq!(refused(|c| c.joint_inertia = 0.0), zero);
    assert_eq!(refused(|c| c.noise = f64::NAN), Error::NonFinite("noise"));
    assert_eq!(refused(|c| c.delay = 9), Error::OutOfRange("delay"));
    let coarse = refused(|c| c.sub_step = 1e-3);
    assert!(matches!(coarse, Error::Inadmissible(_)));
    let term = Term {
        effect: Viscous.into(),
        source: Source::Channel(2),
        origin: 0.0,
        gain: 1.0,
    };
    let reference = RigConfig::reference();
    let line = Rig::<f64, 1>::try_new(reference, &[term]).unwrap_err();
    assert_eq!(line, Error::OutOfRange("channel"));
    let line = Rig::<f64, 0>::try_new(reference, &[term]).unwrap_err();
    assert_eq!(line, Error::Capacity("undeclared effects"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_command_and_any_step_leave_finite_samples(
        steps in proptest::collection::vec((any::<f32>(), 0.0..5e-3_f32), 1..40)
    ) {
        let rig = Rig::<f32, 0>::try_new(RigConfig::varying(), &[]).unwrap();
        let mut state = rig.start(2);
        for (command, dt) in steps {
            let now = rig.step(&mut state, command, dt);
            prop_assert!(now.time.is_finite() && now.tau_o.is_finite());
            prop_assert!(now.measured.is_finite() && now.measured_input.is_finite());
            prop_assert!(now.proximal.acceleration.is_finite() && now.eta.abs() <= 1.0);
        }
    }
}
