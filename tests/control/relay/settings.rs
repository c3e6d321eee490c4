//! Settings, constants and stored forms.

use super::*;
use bowden::Constant;

#[test]
fn what_cannot_be_is_refused_by_name() {
    type Change = fn(&mut RelaySettings<f64>);
    #[rustfmt::skip]
    let cases: [(Change, Error); 19] = [
        (|s| s.reference = f64::NAN, Error::NonFinite("reference")),
        (|s| s.centre = f64::INFINITY, Error::NonFinite("centre")),
        (|s| s.amplitude = f64::NAN, Error::NonFinite("amplitude")),
        (|s| s.amplitude = 0.0, Error::OutOfRange("amplitude")),
        (|s| s.hysteresis = -0.1, Error::OutOfRange("hysteresis")),
        (|s| s.hysteresis = f64::NAN, Error::NonFinite("hysteresis")),
        (|s| s.hysteresis = 10.0, Error::Inadmissible("hysteresis < most_deviation")),
        (|s| s.most_deviation = f64::INFINITY, Error::NonFinite("most_deviation")),
        (|s| s.cycles = 1, Error::OutOfRange("cycles")),
        (|s| s.agreement = 0.0, Error::OutOfRange("agreement")),
        (|s| s.agreement = 1.0, Error::OutOfRange("agreement")),
        (|s| s.longest_dt = 0.0, Error::OutOfRange("longest_dt")),
        (|s| s.longest_time = f64::INFINITY, Error::NonFinite("longest_time")),
        (|s| s.longest_time = 0.4, Error::Inadmissible("longest_dt <= longest_time")),
        (|s| s.centre = 4.5, Error::Inadmissible("centre ± amplitude must lie within the limits")),
        (|s| s.amplitude = -3.5, Error::Inadmissible("centre ± amplitude must lie within the limits")),
        (|s| s.limits = s.limits.with_slew(100.0).unwrap(), Error::Inadmissible("the limits of a relay must not include a slew-rate limit")),
        (|s| s.fallback = Fallback::try_new(10, 5.5).unwrap(), Error::Inadmissible("the safe command lies within the limits")),
        (|s| s.fallback = Fallback::hold_indefinitely(), Error::Inadmissible("a relay must have a safe command")),
    ];
    assert!(Relay::try_new(usual::<f64>()).is_ok());
    for (change, error) in cases {
        let settings = with(usual(), change);
        assert_eq!(Relay::try_new(settings).err(), Some(error));
        assert_eq!(Constant::<Relay<f64>>::try_new(settings).err(), Some(error));
    }
    relay(|s| s.limits = range(-1.0, 1.0));
}

#[test]
fn the_rules_are_those_of_their_papers() {
    let it = Ultimate {
        gain: 3.2_f32,
        period: 1.2,
        amplitude: 1.0,
        duty: 0.5,
    };
    assert_eq!(PiRule::default(), PiRule::TyreusLuyben);
    let near = |x: f32, y: f32| (x / y - 1.0).abs() < 1e-6;
    let cautious = it.pi(PiRule::TyreusLuyben);
    assert!(near(cautious.k_p, 1.0) && near(cautious.k_i, 1.0 / 2.64));
    let fast = it.pi(PiRule::ZieglerNichols);
    assert!(near(fast.k_p, 1.44) && near(fast.k_i, 1.44));
}

#[cfg(feature = "serde")]
#[test]
fn what_is_stored_is_checked_when_it_is_read() {
    let relay = relay::<f64>(|_| ());
    let cycles = ("\"cycles\":3", "\"cycles\":1");
    reads_back(&relay, &[cycles, ("agreement", "accord")]);

    let (mut state, mut plant) = (RelayState::new(), Plant::third_order());
    while state.is_running() {
        reads_back(&state, &[]);
        let out = relay.step(&mut state, 0.02, plant.output());
        plant.run(out.command, 0.02);
    }
    // JSON has no NaN, but this overflows.
    let period = ("\"period\":", "\"period\":1e999,\"was\":");
    reads_back(&state, &[period]);
}

/// A state may be that of another machine: its command is held within the limits of this one.
#[cfg(feature = "serde")]
#[test]
fn a_state_that_was_stored_commands_within_the_limits() {
    let relay = relay::<f64>(|_| ());
    let text = serde_json::to_string(&RelayState::<f64>::new()).unwrap();
    let far = text.replacen("\"command\":0.0", "\"command\":1e9", 1);
    assert_ne!(far, text);
    let mut state: RelayState<f64> = serde_json::from_str(&far).unwrap();
    assert_eq!(relay.step(&mut state, 0.01, f64::NAN).command, 5.0);
}
