//! Every fault ends in the safe command, which stays until somebody has seen it.

use super::*;

const SAFE: f64 = 0.25;

/// A state in the third cycle of 1/(s + 1)³.
fn under_way(relay: &Relay<f64>) -> RelayState<f64> {
    let (mut state, mut plant) = (RelayState::new(), Plant::third_order());
    while state.cycles() < 2 {
        let out = relay.step(&mut state, 0.01, plant.output());
        assert!(out.status == Status::Good && state.is_running());
        plant.run(out.command, 0.01);
    }
    state
}

/// The safe command is out, whatever comes, until it is acknowledged; then the experiment starts
/// again and succeeds.
fn stays_and_starts_again(mut state: RelayState<f64>, reason: Fault) {
    let relay = relay(|_| ());
    let failed = Status::Safe(reason);
    assert!(state.is_latched());
    for k in 0..1000 {
        let bad = [(0.01, f64::NAN), (f64::NAN, 0.0), (9.0, 0.0), (0.01, 1e300)];
        let good = (0.01, f64::from(k % 7 - 3));
        let (dt, measured) = if k % 2 == 0 {
            good
        } else {
            bad[k as usize / 2 % 4]
        };
        let out = relay.step(&mut state, dt, measured);
        assert_eq!((out.command, out.status), (SAFE, failed));
        assert!(!state.is_running() && state.result().is_none());
    }
    state.acknowledge();
    assert!(!state.is_latched());
    assert_eq!(state.command(), SAFE);
    // A bad sample does not switch the relay on.
    let held = relay.step(&mut state, 0.01, f64::NAN);
    assert_eq!(
        (held.command, held.status),
        (SAFE, Status::Held(Fault::Measured))
    );
    let mut plant = Plant::third_order();
    while state.result().is_none() {
        let out = relay.step(&mut state, 0.01, plant.output());
        assert_eq!(out.status, Status::Good);
        plant.run(out.command, 0.01);
    }
}

/// An experiment that fails for this reason.
fn fails(
    settings: Settings<f64>,
    plant: &Plant,
    sampled: Sampled,
    reason: Fault,
) -> RelayState<f64> {
    let (out, state) = ended(settings, plant, sampled);
    assert_eq!((out.command, out.status), (SAFE, Status::Safe(reason)));
    state
}

#[test]
fn a_bad_sample_holds_the_command_and_too_many_are_the_end() {
    let relay = relay(|_| ());
    for (dt, measured, fault) in [
        (0.01, f64::NAN, Fault::Measured),
        (0.01, f64::INFINITY, Fault::Measured),
        (f64::NAN, 0.0, Fault::Dt),
        (f64::INFINITY, 0.0, Fault::Dt),
        (0.0, 0.0, Fault::DtNotPositive),
        (-0.01, 0.0, Fault::DtNotPositive),
        (0.51, 0.0, Fault::DtTooLong),
    ] {
        let mut state = under_way(&relay);
        assert_eq!(state.command(), 1.0);
        for count in 1..=10 {
            let out = relay.step(&mut state, dt, measured);
            let held = (1.0, Status::Held(fault));
            let expected = if count < 10 {
                held
            } else {
                (SAFE, Status::Safe(fault))
            };
            assert_eq!((out.command, out.status), expected);
        }
        stays_and_starts_again(state, fault);
    }
}

#[test]
fn an_output_out_of_range_is_the_end_at_once() {
    let relay = relay(|_| ());
    for measured in [10.01, -10.01, f64::MAX, f64::MIN] {
        let mut state = under_way(&relay);
        relay.step(&mut state, 0.01, 10.0 * measured.signum());
        assert!(state.is_running());
        let out = relay.step(&mut state, 0.01, measured);
        assert_eq!(
            (out.command, out.status),
            (SAFE, Status::Safe(Fault::OutputOutOfRange))
        );
        stays_and_starts_again(state, Fault::OutputOutOfRange);
    }
}

/// The wrong sign pushes the output away: it never comes back, or leaves its range.
#[test]
fn the_wrong_sign_of_the_amplitude_fails() {
    let (wrong, plant) = (with(usual(), |s| s.amplitude = -1.0), Plant::third_order());
    let state = fails(wrong, &plant, Sampled::every(0.01), Fault::NoOscillation);
    assert_eq!(state.cycles(), 0);
    let narrow = with(wrong, |s| s.most_deviation = 0.5);
    fails(
        narrow,
        &plant,
        Sampled::every(0.01),
        Fault::OutputOutOfRange,
    );
}

/// A load above the amplitude, an output that does not move; a lag without delay, which switches at
/// every sample or two: no period that is known.
#[test]
fn no_oscillation_is_told_at_the_longest_time() {
    let loaded = Plant::third_order().with_load(-2.0);
    let (still, quick) = (Plant::new(0.0, &[1.0], 0.0), Plant::new(1.0, &[1.0], 0.0));
    for (plant, reason) in [
        (loaded, Fault::NoOscillation),
        (still, Fault::NoOscillation),
        (quick, Fault::TimeOut),
    ] {
        let state = fails(usual(), &plant, Sampled::every(0.01), reason);
        assert!(reason == Fault::NoOscillation || state.cycles() > 1000);
        stays_and_starts_again(state, reason);
    }
}

#[test]
fn chatter_is_no_result() {
    for dt in [0.01, 0.011, 0.012] {
        let noisy = Sampled::every(dt).noisy(0.5);
        fails(usual(), &Plant::third_order(), noisy, Fault::TimeOut);
    }
}

#[test]
fn bad_measurements_whose_time_is_known_leave_the_result() {
    let mut plant = Plant::third_order();
    let expected = result::<f64>(usual(), &plant, Sampled::every(0.005));
    let (relay, mut state) = (relay(|_| ()), RelayState::new());
    let mut k = 0;
    while state.is_running() {
        let is_lost = k % 10 == 9;
        let measured = if is_lost { f64::NAN } else { plant.output() };
        plant.run(relay.step(&mut state, 0.005, measured).command, 0.005);
        k += 1;
    }
    let it = state.result().unwrap();
    // A switch is one sample later at most, and the cycle longer by four.
    near(it.period, expected.period, 4.0 * 0.005);
    near(it.gain / expected.gain, 1.0, 0.02);
}

#[test]
fn a_cycle_whose_time_is_unknown_does_not_count() {
    // A hysteresis, so that no cycle of a few samples passes between two of the unknown times.
    let relay = relay(|s| s.hysteresis = 0.05);
    let (mut state, mut plant) = (RelayState::new(), Plant::third_order());
    let mut time = 0;
    let out = loop {
        // Less than half of any cycle.
        let dt = if time % 50 == 49 { f64::NAN } else { 0.01 };
        let out = relay.step(&mut state, dt, plant.output());
        if !state.is_running() {
            break out;
        }
        plant.run(out.command, 0.01);
        time += 1;
    };
    assert_eq!(state.cycles(), 0);
    assert_eq!(
        (out.command, out.status),
        (SAFE, Status::Safe(Fault::NoOscillation))
    );
}

#[test]
fn a_result_leaves_the_centre_out_whatever_comes() {
    let settings = with(usual(), |s| s.centre = 0.1);
    let (out, mut state) = ended::<f64>(settings, &Plant::third_order(), Sampled::every(0.01));
    let relay = Relay::try_new(settings).unwrap();
    let found = state.result();
    assert!(found.is_some() && out.status == Status::Good);
    for k in 0..1000 {
        let measured = [0.0, f64::NAN, 1e9, -1.0][k % 4];
        let after = relay.step(&mut state, [0.01, f64::NAN, 9.0][k % 3], measured);
        assert_eq!(after, out);
        assert_eq!((after.command, state.result()), (0.1, found));
    }
    // Nothing to acknowledge.
    state.acknowledge();
    assert_eq!(state.result(), found);
}
