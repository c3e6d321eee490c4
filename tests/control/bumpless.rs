//! Starts, hand-overs and changes of gains without a jump of the command.

use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Fault, Limits, Pid, PidInput, PidSettings, PidState,
    Status,
};

const DT: f64 = 1e-3;

fn at(k: u32) -> PidInput<f64> {
    let t = DT * f64::from(k);
    PidInput {
        velocity: (3.0 * t).cos(),
        feed_forward: 20.0 + t,
        ..PidInput::new(DT, 25.0 + t.sin(), 25.0 + (1.1 * t).sin())
    }
}

#[test]
fn a_start_goes_on_from_the_output_with_the_feed_forward_in_it() {
    for pid in [Pid::paper_pi(), Pid::paper_pid(), Pid::paper_piv()] {
        let mut state = PidState::new();
        assert_eq!(state.resume_from(&pid, 41.5, &at(300)), Status::Good);
        assert_eq!(state.command(), 41.5);
        let out = pid.step_with_terms(&mut state, &at(300));
        let one_step = 18.0 * out.terms.error.abs() * DT;
        // The rounding of a sum of five numbers around 100.
        assert!((out.command - 41.5).abs() <= one_step + 1e-12);
    }
}

#[test]
fn a_start_reads_no_dt() {
    let pid = Pid::try_new(PidSettings {
        longest_dt: 0.01,
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    // Ten seconds with the drive off, or a sample that was made for the start alone.
    for dt in [10.0, 0.0, -1.0, f64::NAN] {
        let (mut state, sample) = (PidState::new(), PidInput::new(DT, 1.0, 1.0));
        pid.step(&mut state, &sample);
        let pause = PidInput { dt, ..sample };
        assert_eq!(state.resume_from(&pid, 42.0, &pause), Status::Good, "{dt}");
        assert_eq!(pid.step(&mut state, &sample).command, 42.0);
    }
}

#[test]
fn a_start_at_each_good_sample_does_not_keep_the_safe_command_back() {
    let pid = Pid::try_new(PidSettings {
        fallback: Fallback::try_new(20, -3.0).unwrap(),
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    let (mut state, good) = (PidState::new(), PidInput::new(DT, 1.0, 1.0));
    let bad = PidInput {
        measured: f64::NAN,
        ..good
    };
    // A bad sample counts four times as much as a good one takes away, and only steps take away.
    let first = (1..100).find(|_| {
        let command = state.command();
        state.resume_from(&pid, command, &good);
        pid.step(&mut state, &bad).status == Status::Safe(Fault::Measured)
    });
    assert_eq!((first, state.command()), (Some(20), -3.0));
}

#[test]
fn a_start_outside_the_limits_begins_at_the_limit() {
    let pid = Pid::try_new(PidSettings {
        limits: Limits::try_new(-5.0, 15.0).unwrap(),
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    let mut state = PidState::new();
    state.resume_from(&pid, 1e6, &PidInput::new(DT, 1.0, 1.0));
    assert_eq!((state.command(), state.integral()), (15.0, 15.0));
}

#[test]
fn a_start_from_something_that_is_no_number_is_refused_and_told() {
    let (pid, mut state) = (Pid::paper_piv(), PidState::new());
    pid.step_with_terms(&mut state, &at(0));
    let before = state;
    let nan = f64::NAN;
    let mut refuses = |output, change: &dyn Fn(&mut PidInput<f64>), fault| {
        let mut at = at(1);
        change(&mut at);
        assert_eq!(state.resume_from(&pid, output, &at), Status::Held(fault));
        assert_eq!(state.integral(), before.integral());
        assert_eq!(pid.terms(&state), pid.terms(&before));
        assert_eq!(state.command(), before.command());
    };
    refuses(nan, &|_| (), Fault::Command);
    refuses(1.0, &|at| at.reference = nan, Fault::Reference);
    refuses(1.0, &|at| at.velocity = nan, Fault::Velocity);
    refuses(f64::MAX, &|at| at.feed_forward = f64::MIN, Fault::Overflow);
}

/// Every pair of these settings must hand over to each other.
fn family() -> Vec<Pid<f64>> {
    let plain = PidSettings::unlimited(30.0, 18.0);
    let rate = |weight, k_d, derivative_time| PidSettings {
        damping: DerivativeSource::Rate { weight },
        k_d,
        derivative_time,
        ..plain
    };
    let all = [
        plain,
        PidSettings::unlimited(3.0, 320.0),
        PidSettings::unlimited(7.0, 0.0),
        PidSettings {
            setpoint_weight: 0.2,
            ..plain
        },
        rate(1.0, 2.0, 0.1),
        rate(0.0, 5.0, 0.02),
        PidSettings {
            k_d: 10.0,
            damping: DerivativeSource::Velocity,
            ..plain
        },
    ];
    all.into_iter().map(|s| Pid::try_new(s).unwrap()).collect()
}

#[test]
fn any_settings_take_over_from_any_others_without_a_jump() {
    for from in family() {
        for to in family() {
            let mut state = PidState::new();
            for k in 0..200 {
                from.step_with_terms(&mut state, &at(k));
            }
            let before = state.command();
            to.bumpless_transfer(&mut state);
            assert_eq!(state.command(), before);
            // The terms of the old sample add up to the old command, to rounding.
            assert!((to.terms(&state).unlimited - before).abs() < 1e-11);

            // With the same sample once more the rate has one step in which to fade.
            let again = PidInput {
                dt: 1e-9,
                ..at(199)
            };
            let out = to.step_with_terms(&mut state, &again);
            let fades = out.terms.derivative.abs() * 1e-9 / 0.02;
            let integral = 320.0 * out.terms.error.abs() * 1e-9;
            // Without k_i the integral has a time constant of 1 s.
            let returns = match to.settings().k_i == 0.0 {
                true => out.terms.integral.abs() * 1e-9,
                false => 0.0,
            };
            assert!((out.command - before).abs() <= fades + integral + returns + 1e-11);
        }
    }
}

#[test]
fn a_limited_command_stays_at_its_limit_and_the_integral_where_it_was() {
    let settings = |k_p| PidSettings {
        limits: Limits::try_new(-5.0, 15.0).unwrap(),
        ..PidSettings::unlimited(k_p, 20.0)
    };
    let before = Pid::try_new(settings(10.0)).unwrap();
    let mut state = PidState::new();
    for _ in 0..100 {
        before.step(&mut state, &PidInput::new(DT, 4.0, 0.0));
    }
    let integral = state.integral();
    let firm = Pid::try_new(settings(100.0)).unwrap();
    firm.bumpless_transfer(&mut state);
    assert_eq!((state.command(), state.integral()), (15.0, integral));
    // A gain too low to hold the limit: the integral fills what is missing.
    let soft = Pid::try_new(settings(1.0)).unwrap();
    soft.bumpless_transfer(&mut state);
    assert_eq!((state.command(), state.integral()), (15.0, 11.0));
}

#[test]
fn wider_limits_do_not_let_out_at_once_what_the_old_ones_cut_off() {
    let within = |high: f64| {
        Pid::try_new(PidSettings {
            limits: Limits::try_new(-high, high).unwrap(),
            ..PidSettings::unlimited(10.0, 20.0)
        })
        .unwrap()
    };
    let mut state = PidState::new();
    let at = PidInput::new(DT, 4.0, 0.0); // asks for 40
    assert_eq!(within(15.0).step(&mut state, &at).command, 15.0);
    within(100.0).bumpless_transfer(&mut state);
    let out = within(100.0).step(&mut state, &at);
    assert!((out.command - (15.0 + 20.0 * 4.0 * DT)).abs() < 1e-12);
}

#[test]
fn a_change_of_the_integral_gain_alone_moves_nothing() {
    let mut state = PidState::new();
    for k in 0..100 {
        Pid::paper_pi().step(&mut state, &at(k));
    }
    let integral = state.integral();
    let matched = Pid::try_new(PidSettings::unlimited(30.0, 320.0)).unwrap();
    matched.bumpless_transfer(&mut state);
    // The integral is a command: it is found again by a difference of two numbers near 30.
    assert!((state.integral() - integral).abs() < 1e-13);
}

#[test]
fn a_reset_forgets_all_but_the_command_that_is_out() {
    let pid = Pid::try_new(PidSettings {
        limits: Limits::try_new(-50.0, 50.0)
            .unwrap()
            .with_slew(1000.0)
            .unwrap(),
        anti_windup: AntiWindup::Clamp,
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    let mut state = PidState::new();
    for k in 0..100 {
        pid.step_with_terms(&mut state, &at(k));
    }
    let out = state.command();
    state.reset();
    assert_eq!(
        (state.integral(), state.rate(), state.command()),
        (0.0, 0.0, out)
    );
    let next = pid
        .step_with_terms(&mut state, &PidInput::new(DT, 0.0, 0.0))
        .command;
    assert!((next - (out - 1.0)).abs() < 1e-12); // the slew rate goes on from there
    state = PidState::new();
    assert_eq!(state, PidState::default());
}
