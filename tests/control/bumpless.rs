//! Starts, hand-overs and changes of gains without a jump of the command.

use super::*;

fn at(k: u32) -> PidInput<f64> {
    let t = DT * f64::from(k);
    with(
        PidInput::new(DT, 25.0 + t.sin(), 25.0 + (1.1 * t).sin()),
        |at| {
            (at.velocity, at.feed_forward) = ((3.0 * t).cos(), 20.0 + t);
        },
    )
}

fn after(pid: &Pid<f64>, samples: u32) -> PidState<f64> {
    let mut state = PidState::new();
    for k in 0..samples {
        pid.step(&mut state, &at(k));
    }
    state
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
        near(out.command, 41.5, one_step + 1e-12);
    }
}

#[test]
fn a_start_reads_no_dt() {
    let pid = pid(10.0, 20.0, |s| s.longest_dt = 0.01);
    // Ten seconds with the drive off, or a sample that was made for the start alone.
    for dt in [10.0, 0.0, -1.0, f64::NAN] {
        let (mut state, sample) = (PidState::new(), PidInput::new(DT, 1.0, 1.0));
        pid.step(&mut state, &sample);
        let pause = with(sample, |at| at.dt = dt);
        assert_eq!(state.resume_from(&pid, 42.0, &pause), Status::Good, "{dt}");
        assert_eq!(pid.step(&mut state, &sample).command, 42.0);
    }
}

#[test]
fn a_start_from_something_that_is_no_number_is_refused_and_told() {
    let pid = Pid::paper_piv();
    let mut state = after(&pid, 1);
    let before = (state.integral(), pid.terms(&state), state.command());
    type Change = fn(&mut PidInput<f64>);
    let cases: [(f64, Change, Fault); 4] = [
        (f64::NAN, |_| (), Fault::Command),
        (1.0, |at| at.reference = f64::NAN, Fault::Reference),
        (1.0, |at| at.velocity = f64::NAN, Fault::Velocity),
        (f64::MAX, |at| at.feed_forward = f64::MIN, Fault::Overflow),
    ];
    for (output, change, fault) in cases {
        let status = state.resume_from(&pid, output, &with(at(1), change));
        assert_eq!(status, Status::Held(fault));
        assert_eq!(
            (state.integral(), pid.terms(&state), state.command()),
            before
        );
    }
}

/// Every pair of these settings must hand over to each other.
fn family() -> [Pid<f64>; 7] {
    let rate = |weight, k_d, time| {
        let damping = DerivativeSource::Rate { weight };
        pid(30.0, 18.0, |s| {
            (s.damping, s.k_d, s.derivative_time) = (damping, k_d, time)
        })
    };
    [
        pid(30.0, 18.0, |_| ()),
        pid(3.0, 320.0, |_| ()),
        pid(7.0, 0.0, |_| ()),
        pid(30.0, 18.0, |s| s.setpoint_weight = 0.2),
        rate(1.0, 2.0, 0.1),
        rate(0.0, 5.0, 0.02),
        pid(30.0, 18.0, |s| {
            (s.k_d, s.damping) = (10.0, DerivativeSource::Velocity)
        }),
    ]
}

#[test]
fn any_settings_take_over_from_any_others_without_a_jump() {
    for (from, to) in family()
        .iter()
        .flat_map(|from| family().map(|to| (*from, to)))
    {
        let mut state = after(&from, 200);
        let before = state.command();
        to.bumpless_transfer(&mut state);
        assert_eq!(state.command(), before);
        // The terms of the old sample add up to the old command, to rounding.
        near(to.terms(&state).unlimited, before, 1e-11);

        // With the same sample once more the rate has one step in which to fade.
        let out = to.step_with_terms(&mut state, &with(at(199), |at| at.dt = 1e-9));
        let fades = out.terms.derivative.abs() * 1e-9 / 0.02;
        let integral = 320.0 * out.terms.error.abs() * 1e-9;
        // Without k_i the integral has a time constant of 1 s.
        let returns = match to.settings().k_i == 0.0 {
            true => out.terms.integral.abs() * 1e-9,
            false => 0.0,
        };
        near(out.command, before, fades + integral + returns + 1e-11);
    }
}

#[test]
fn a_limited_command_stays_at_its_limit_and_the_integral_where_it_was() {
    let law = |k_p| pid(k_p, 20.0, |s| s.limits = range(-5.0, 15.0));
    let mut state = PidState::new();
    for _ in 0..100 {
        law(10.0).step(&mut state, &PidInput::new(DT, 4.0, 0.0));
    }
    let integral = state.integral();
    law(100.0).bumpless_transfer(&mut state);
    assert_eq!((state.command(), state.integral()), (15.0, integral));
    // A gain too low to hold the limit: the integral fills what is missing.
    law(1.0).bumpless_transfer(&mut state);
    assert_eq!((state.command(), state.integral()), (15.0, 11.0));
}

#[test]
fn wider_limits_do_not_let_out_at_once_what_the_old_ones_cut_off() {
    let within = |high: f64| pid(10.0, 20.0, |s| s.limits = range(-high, high));
    let mut state = PidState::new();
    let at = PidInput::new(DT, 4.0, 0.0); // asks for 40
    assert_eq!(within(15.0).step(&mut state, &at).command, 15.0);
    within(100.0).bumpless_transfer(&mut state);
    let command = within(100.0).step(&mut state, &at).command;
    near(command, 15.0 + 20.0 * 4.0 * DT, 1e-12);
}

#[test]
fn a_change_of_the_integral_gain_alone_moves_nothing() {
    let mut state = after(&Pid::paper_pi(), 100);
    let integral = state.integral();
    pid(30.0, 320.0, |_| ()).bumpless_transfer(&mut state);
    // The integral is a command: it is found again by a difference of two numbers near 30.
    near(state.integral(), integral, 1e-13);
}

#[test]
fn a_reset_forgets_all_but_the_command_that_is_out() {
    let pid = pid(10.0, 20.0, |s| {
        s.limits = range(-50.0, 50.0).with_slew(1000.0).unwrap();
        s.anti_windup = AntiWindup::Clamp;
    });
    let mut state = after(&pid, 100);
    let out = state.command();
    state.reset();
    assert_eq!(
        (state.integral(), state.rate(), state.command()),
        (0.0, 0.0, out)
    );
    // The slew rate goes on from there.
    let next = pid.step(&mut state, &PidInput::new(DT, 0.0, 0.0)).command;
    near(next, out - 1.0, 1e-12);
    assert_eq!(PidState::<f64>::new(), PidState::default());
}
