//! A compensator that is told what went into the cable.

use super::*;

fn compensator() -> Compensator<f64, 0> {
    Compensator::try_new(&Model::try_new(Some(paper(0.6)), &[]).unwrap()).unwrap()
}

/// A sample, and what is desired in it.
fn at(k: u32) -> (CompensatorInput<'static, f64>, f64) {
    let t = DT * f64::from(k);
    let desired = 25.0 * (3.1 * t).sin() + 8.0 * (7.3 * t).cos();
    (CompensatorInput::new(DT, desired), desired)
}

/// 16 epsilons of all magnitudes in the equation, below 100, of command and output
/// (`Inverse::step`); the forward step to the same input adds as much.
const ROUNDING: f64 = 32.0 * f64::EPSILON * 100.0;

/// A drive that changes commands of some samples: what the cable has transmitted beside what was
/// desired, at the worst after the last of them.
fn worst_after(tell: bool, drive: impl Fn(u32, f64) -> f64) -> f64 {
    let (compensator, cable) = (compensator(), paper(0.6));
    let (mut state, mut worst) = (CompensatorState::new(), 0.0_f64);
    let (mut true_cable, mut twin) = (BoucWenState::new(), BoucWenState::new());
    for k in 0..6000 {
        let (at, desired) = at(k);
        let out = compensator.step(&mut state, &at);
        assert_eq!(out.status, Status::Good);
        let sent = drive(k, out.command);
        if tell {
            // The inverse of a model that has seen what the cable has.
            let expected = cable.inverse().unwrap().step(&mut twin, desired);
            near(out.command, expected, ROUNDING);
            compensator.applied(&mut state, Applied::Command(sent));
        }
        let got = cable.step(&mut true_cable, sent);
        twin = true_cable;
        if k >= 4000 {
            worst = worst.max((got - desired).abs());
        } else if tell && sent != out.command {
            assert_eq!((state.command(), state.eta()), (sent, true_cable.eta()));
        }
    }
    worst
}

/// Off where the output turns, so that the model's cable and the true one are on other branches; and
/// behind a drive that limits itself.
#[test]
fn after_a_drive_that_was_off_or_limited_the_output_is_the_desired_one_from_the_first_sample_on() {
    let off = |k, command| {
        if (1000..4000).contains(&k) {
            0.0
        } else {
            command
        }
    };
    let limited = |k, command: f64| match k {
        500..4000 => command.clamp(-18.0, 12.0),
        _ => command,
    };
    for (told, untold) in [
        (worst_after(true, off), worst_after(false, off)),
        (worst_after(true, limited), worst_after(false, limited)),
    ] {
        assert!(told < ROUNDING && untold > 0.1, "{told} {untold}");
    }
}

#[test]
fn a_command_that_went_out_is_no_news() {
    assert!(worst_after(true, |_, command| command) < ROUNDING);
    let (compensator, mut state) = (compensator(), CompensatorState::new());
    for k in 0..100 {
        compensator.step(&mut state, &at(k).0);
        let before = state;
        let lost = [f64::NAN, f64::INFINITY].map(Applied::Command);
        for told in lost.into_iter().chain([Applied::AsCommanded]) {
            compensator.applied(&mut state, told);
            assert_eq!(state, before);
        }
    }
}

#[test]
fn after_a_bad_sample_the_input_moves_from_where_it_was_held() {
    let (compensator, cable) = (compensator(), paper(0.6));
    let (mut state, mut true_cable) = (CompensatorState::new(), BoucWenState::new());
    for k in 0..500 {
        let out = compensator.step(&mut state, &at(4 * k).0);
        cable.step(&mut true_cable, out.command);
    }
    // The last good command went out, and has its branch; then the relay falls.
    compensator.step(&mut state, &CompensatorInput::new(DT, f64::NAN));
    compensator.applied(&mut state, Applied::Command(0.0));
    cable.step(&mut true_cable, 0.0);
    near(state.eta(), true_cable.eta(), ROUNDING);
    assert_eq!(state.command(), 0.0);
    let out = compensator.step(&mut state, &CompensatorInput::new(DT, 9.0));
    near(cable.step(&mut true_cable, out.command), 9.0, ROUNDING);
}

#[test]
fn of_two_calls_after_one_step_the_second_counts() {
    let compensator = compensator();
    let (mut once, mut twice) = (CompensatorState::new(), CompensatorState::new());
    for k in 0..500 {
        let (at, desired) = at(4 * k);
        compensator.step(&mut once, &at);
        compensator.step(&mut twice, &at);
        compensator.applied(&mut twice, Applied::Command(-300.0));
        for state in [&mut once, &mut twice] {
            compensator.applied(state, Applied::Command(0.5 * desired));
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
            compensator.step(&mut state, &CompensatorInput::new(DT, sign * desired));
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
        assert!(step(3.0, told).0 < first - 1.0);
        let (free, slipped) = step(30.0, Applied::AsCommanded);
        assert!(free > 30.0 && slipped > 0.9);
    }
}
