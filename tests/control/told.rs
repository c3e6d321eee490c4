//! A compensator that is told what went into the cable.

use bowden::control::{Applied, Compensator, CompensatorInput, CompensatorState, Status};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::model::Model;
use bowden::transmission::Transmission;

fn cable() -> Transmission<f64> {
    let shape = BoucWen::try_new(0.095_82, 0.6, 3.871).unwrap();
    Transmission::torque(0.9978, 7.004, 0.051_74, shape).unwrap()
}

fn compensator() -> Compensator<f64, 0> {
    Compensator::try_new(&Model::try_new(Some(cable()), &[]).unwrap()).unwrap()
}

fn desired(k: u32) -> f64 {
    let t = 1e-3 * f64::from(k);
    25.0 * (3.1 * t).sin() + 8.0 * (7.3 * t).cos()
}

/// 16 epsilons of all magnitudes in the equation, below 100, of command and output
/// (`Inverse::step`); the forward step to the same input adds as much.
const ROUNDING: f64 = 32.0 * f64::EPSILON * 100.0;

/// A drive that changes commands of some samples: what the cable has transmitted beside what was
/// desired, at the worst after the last of them.
fn worst_after(tell: bool, drive: impl Fn(u32, f64) -> f64) -> f64 {
    let (compensator, cable) = (compensator(), cable());
    let (mut state, mut true_cable, mut worst) =
        (CompensatorState::new(), BoucWenState::new(), 0.0_f64);
    let mut twin = BoucWenState::new();
    for k in 0..6000 {
        let out = compensator.step(&mut state, &CompensatorInput::new(1e-3, desired(k)));
        assert_eq!(out.status, Status::Good);
        let sent = drive(k, out.command);
        if tell {
            // The inverse of a model that has seen what the cable has.
            let expected = cable.inverse().unwrap().step(&mut twin, desired(k));
            assert!((out.command - expected).abs() < ROUNDING, "{k}");
            compensator.applied(&mut state, Applied::Command(sent));
        }
        let got = cable.step(&mut true_cable, sent);
        twin = true_cable;
        if k >= 4000 {
            worst = worst.max((got - desired(k)).abs());
        } else if tell && sent != out.command {
            assert_eq!((state.command(), state.eta()), (sent, true_cable.eta()));
        }
    }
    worst
}

#[test]
fn after_the_drive_was_off_the_output_is_the_desired_one_from_the_first_sample_on() {
    let off = |k, command| match k {
        // Off where the output turns: the model's cable and the true one are on other branches.
        1000..4000 => 0.0,
        _ => command,
    };
    let (told, untold) = (worst_after(true, off), worst_after(false, off));
    assert!(told < ROUNDING && untold > 0.1, "{told} {untold}");
}

#[test]
fn behind_a_drive_that_limits_the_compensator_follows_the_cable() {
    let limited = |k, command: f64| match k {
        500..4000 => command.clamp(-18.0, 12.0),
        _ => command,
    };
    let (told, untold) = (worst_after(true, limited), worst_after(false, limited));
    assert!(told < ROUNDING && untold > 0.1, "{told} {untold}");
}

#[test]
fn a_command_that_went_out_is_no_news() {
    assert!(worst_after(true, |_, command| command) < ROUNDING);
    let compensator = compensator();
    let mut state = CompensatorState::new();
    for k in 0..100 {
        compensator.step(&mut state, &CompensatorInput::new(1e-3, desired(k)));
        let before = state;
        compensator.applied(&mut state, Applied::AsCommanded);
        compensator.applied(&mut state, Applied::Command(f64::NAN));
        compensator.applied(&mut state, Applied::Command(f64::INFINITY));
        assert_eq!(state, before);
    }
}

#[test]
fn after_a_bad_sample_the_input_moves_from_where_it_was_held() {
    let (compensator, cable) = (compensator(), cable());
    let (mut state, mut true_cable) = (CompensatorState::new(), BoucWenState::new());
    for k in 0..500 {
        let out = compensator.step(&mut state, &CompensatorInput::new(1e-3, desired(4 * k)));
        cable.step(&mut true_cable, out.command);
    }
    // The last good command went out, and has its branch; then the relay falls.
    compensator.step(&mut state, &CompensatorInput::new(1e-3, f64::NAN));
    compensator.applied(&mut state, Applied::Command(0.0));
    cable.step(&mut true_cable, 0.0);
    assert!((state.eta() - true_cable.eta()).abs() < ROUNDING);
    assert_eq!(state.command(), 0.0);
    let out = compensator.step(&mut state, &CompensatorInput::new(1e-3, 9.0));
    assert!((cable.step(&mut true_cable, out.command) - 9.0).abs() < ROUNDING);
}

#[test]
fn of_two_calls_after_one_step_the_second_counts() {
    let compensator = compensator();
    let (mut once, mut twice) = (CompensatorState::new(), CompensatorState::new());
    for k in 0..500 {
        let at = CompensatorInput::new(1e-3, desired(4 * k));
        compensator.step(&mut once, &at);
        compensator.step(&mut twice, &at);
        compensator.applied(&mut twice, Applied::Command(-300.0));
        for state in [&mut once, &mut twice] {
            compensator.applied(state, Applied::Command(0.5 * desired(4 * k)));
        }
        assert_eq!(once, twice);
    }
}

#[test]
fn at_a_limit_of_unknown_size_the_input_goes_no_further_and_comes_back_at_once() {
    let compensator = compensator();
    for (told, sign) in [(Applied::AtUpperLimit, 1.0), (Applied::AtLowerLimit, -1.0)] {
        let mut state = CompensatorState::new();
        let mut step = |desired: f64, told| {
            compensator.step(&mut state, &CompensatorInput::new(1e-3, sign * desired));
            compensator.applied(&mut state, told);
            (sign * state.command(), sign * state.eta())
        };
        // The first sample says where the input is, whatever the drive did.
        let (first, eta) = step(5.0, told);
        assert!(first > 4.0 && eta == 0.0);
        for more in 1..20 {
            assert_eq!(step(5.0 + f64::from(more), told), (first, eta));
        }
        // It falls with the output, at the limit or not.
        let (less, _) = step(3.0, told);
        assert!(less < first - 1.0);
        let (free, slipped) = step(30.0, Applied::AsCommanded);
        assert!(free > 30.0 && slipped > 0.9);
    }
}
