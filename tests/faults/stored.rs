//! What comes back from flash: states after the power was off, and settings of which a line was lost.

use super::*;

/// Runs until a command is out, cuts the power, and starts again; the first command is that which
/// goes on from `start`, as far as one step of the law reaches (`way`).
fn starts_again<C: Controller<f64>>(law: &C, start: f64, way: f64) -> C::State
where
    C::State: PartialEq + core::fmt::Debug,
{
    let mut state = law.start();
    for _ in 0..500 {
        law.step(&mut state, &good());
    }
    let before = law.command(&state);
    assert!((before - start).abs() > 0.2, "{before}");

    // Without it the old command goes on at once.
    let mut as_stored = state;
    let first = law.step(&mut as_stored, &bad());
    assert_eq!(first.command, before);

    let mut powered = state;
    law.restore(&mut powered);
    assert_eq!(law.command(&powered), start);
    let mut dead = powered;
    let held = law.step(&mut dead, &bad());
    assert_eq!(
        (held.command, held.status),
        (start, Status::Held(Fault::Measured))
    );
    let live = law.step(&mut powered, &good());
    assert_eq!(live.status, Status::Good);
    assert!((live.command - start).abs() <= way, "{}", live.command);
    // Twice is once.
    let (mut once, mut twice) = (state, state);
    law.restore(&mut once);
    law.restore(&mut twice);
    law.restore(&mut twice);
    assert_eq!(once, twice);

    // A fault that nobody has seen outlives the power cut.
    for _ in 0..20 {
        law.step(&mut state, &bad());
    }
    assert!(law.is_latched(&state));
    law.restore(&mut state);
    assert!(law.is_latched(&state));
    let safe = law.step(&mut state, &good());
    assert_eq!(
        (safe.command, safe.status),
        (0.0, Status::Safe(Fault::Measured))
    );
    law.acknowledge(&mut state);
    assert!(!law.is_latched(&state));
    assert_eq!(law.step(&mut state, &good()).status, Status::Good);
    powered
}

#[test]
fn after_the_power_was_off_a_law_starts_from_nothing_with_what_it_has_learned() {
    let exactly = 1e-9;
    starts_again(&pid(|_| ()), 0.0, exactly);
    // The command nearest to zero where zero is none; the safe one is 0 within the other limits.
    let asymmetric = pid(|s| {
        s.limits = Limits::try_new(2.0, 60.0).unwrap();
        s.fallback = Fallback::try_new(20, 2.5).unwrap();
    });
    let mut state = asymmetric.start();
    for _ in 0..500 {
        Controller::step(&asymmetric, &mut state, &good());
    }
    state.restore(&asymmetric);
    assert_eq!(state.command(), 2.0);

    // The lag moves by a share h·lambda = 0.008 of the way to a command within 100.
    for (own, way) in forms(|_| ()).into_iter().zip([exactly, 0.8]) {
        let state = starts_again(&own, 0.0, way);
        let fresh = own.start();
        // One step after it the estimates are still those of 500 steps.
        assert!((state.beta_hat() - fresh.beta_hat()).abs() > 1e-3);
        assert!((state.delta_hat() - fresh.delta_hat()).abs() > 1e-3);
        assert!((state.theta_hat()[0] - fresh.theta_hat()[0]).abs() > 1e-5);
    }
}

#[cfg(feature = "serde")]
#[test]
fn a_lost_table_takes_no_limit_no_safe_command_and_no_longest_dt_away() {
    fn refused<S: serde::Serialize, C: serde::de::DeserializeOwned>(settings: &S) {
        let whole: toml::Table = toml::from_str(&toml::to_string(settings).unwrap()).unwrap();
        let read = |table: &toml::Table| toml::from_str::<C>(&table.to_string());
        assert!(read(&whole).is_ok());
        for lost in ["limits", "longest_dt", "fallback"] {
            let mut table = whole.clone();
            assert!(table.remove(lost).is_some(), "{lost}");
            let error = read(&table).err().unwrap().to_string();
            let expected = format!("missing field `{lost}`");
            assert!(error.contains(&expected), "{error}");
        }
    }
    refused::<_, Pid<f64>>(&pi());
    let (range, safe) = (Limits::try_new(-60.0, 60.0), Fallback::try_new(20, 0.0));
    let single = PidSettings::new(3.0_f32, 30.0, range.unwrap(), 0.005, safe.unwrap());
    refused::<_, Pid<f32>>(&single);
    refused::<_, Adaptive<f64, 1>>(&law(true));
    // What is without them says so, and comes back as it was.
    let unlimited = PidSettings::unlimited(3.0, 30.0);
    refused::<_, Pid<f64>>(&unlimited);
    let read: Pid<f64> = toml::from_str(&toml::to_string(&unlimited).unwrap()).unwrap();
    assert_eq!(*read.settings(), unlimited);
}
