//! What a bad sample does: nothing, and it is told.

use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Fault, Limits, Pid, PidInput, PidSettings, PidState,
    Status,
};

fn good() -> PidInput<f64> {
    PidInput {
        dt: 1e-3,
        reference: 1.0,
        measured: 0.8,
        velocity: 0.1,
        feed_forward: 0.5,
    }
}

/// Every way in which a sample can be bad for a PIV, and how it is told.
fn bad() -> Vec<(PidInput<f64>, Fault)> {
    let with = |change: &dyn Fn(&mut PidInput<f64>), fault| {
        let mut at = good();
        change(&mut at);
        (at, fault)
    };
    let mut all = vec![
        with(&|at| at.dt = 0.0, Fault::DtNotPositive),
        with(&|at| at.dt = -1e-3, Fault::DtNotPositive),
        with(
            &|at| (at.measured, at.reference) = (f64::MAX, f64::MIN),
            Fault::Overflow,
        ),
        with(
            &|at| (at.feed_forward, at.measured) = (f64::MAX, -1e307),
            Fault::Overflow,
        ),
    ];
    for not in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        all.extend([
            with(&|at| at.dt = not, Fault::Dt),
            with(&|at| at.reference = not, Fault::Reference),
            with(&|at| at.measured = not, Fault::Measured),
            with(&|at| at.velocity = not, Fault::Velocity),
            with(&|at| at.feed_forward = not, Fault::FeedForward),
        ]);
    }
    all
}

#[test]
fn every_bad_input_is_told_by_name_and_holds_the_command_and_the_memory() {
    let pid = Pid::paper_piv();
    let mut state = PidState::new();
    let before = pid.step_with_terms(&mut state, &good());
    let memory = state;
    for (count, (at, fault)) in (1_u32..).zip(bad()) {
        let out = pid.step_with_terms(&mut state, &at);
        assert_eq!(out.status, Status::Held(fault), "{at:?}");
        assert_eq!((out.command, out.terms), (before.command, before.terms));
        assert_eq!(state.fault_counter(), 4 * count);
        assert_eq!(
            (state.integral(), state.rate()),
            (memory.integral(), memory.rate())
        );
    }
    assert_eq!(
        pid.step_with_terms(&mut state, &good()).status,
        Status::Good
    );
    assert_eq!(
        state.fault_counter(),
        4 * u32::try_from(bad().len()).unwrap() - 1
    );
}

#[test]
fn a_good_sample_after_bad_ones_is_as_if_they_had_not_been() {
    // dt = 0 takes no time: not even the derivative can see that something was there.
    let pid = Pid::paper_pid();
    let (mut with, mut without) = (PidState::new(), PidState::new());
    let mut frozen = PidInput { dt: 0.0, ..good() };
    for k in 0..50 {
        let at = PidInput {
            measured: 0.01 * f64::from(k),
            ..good()
        };
        frozen.measured = f64::NAN;
        pid.step_with_terms(&mut with, &frozen);
        assert_eq!(
            pid.step_with_terms(&mut with, &at),
            pid.step_with_terms(&mut without, &at)
        );
        assert_eq!(pid.terms(&with), pid.terms(&without));
        assert_eq!(with.rate(), without.rate());
    }
}

#[test]
fn a_velocity_that_nobody_reads_may_be_anything() {
    let at = PidInput {
        velocity: f64::NAN,
        ..good()
    };
    for pid in [Pid::paper_pi(), Pid::paper_pid()] {
        assert_eq!(
            pid.step_with_terms(&mut PidState::new(), &at).status,
            Status::Good
        );
    }
}

#[test]
fn the_safe_command_goes_out_at_the_stated_sample_and_the_slew_rate_starts_from_it() {
    let pid = Pid::try_new(PidSettings {
        fallback: Fallback::try_new(3, -2.0).unwrap(),
        limits: Limits::try_new(-5.0, 15.0)
            .unwrap()
            .with_slew(1000.0)
            .unwrap(),
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    let mut state = PidState::new();
    for _ in 0..10 {
        pid.step_with_terms(&mut state, &good());
    }
    let lost = PidInput {
        measured: f64::NAN,
        ..good()
    };
    let out: Vec<_> = (0..5)
        .map(|_| pid.step_with_terms(&mut state, &lost))
        .collect();
    let held = Status::Held(Fault::Measured);
    let safe = Status::Safe(Fault::Measured);
    let statuses: Vec<_> = out.iter().map(|out| out.status).collect();
    assert_eq!(statuses, [held, held, safe, safe, safe]);
    assert!(out[1].command > 2.0);
    assert!(out[2..].iter().all(|out| out.command == -2.0));
    state.acknowledge();
    // The first good sample starts from it, the slew rate goes on: 1000/s for 1 ms.
    assert_eq!(pid.step_with_terms(&mut state, &good()).command, -2.0);
    let up = PidInput {
        feed_forward: 10.0,
        ..good()
    };
    assert_eq!(pid.step_with_terms(&mut state, &up).command, -1.0);
}

#[test]
fn before_the_first_good_sample_the_command_is_within_the_limits_too() {
    let pid = Pid::try_new(PidSettings {
        limits: Limits::try_new(3.0, 15.0).unwrap(),
        ..PidSettings::unlimited(10.0, 20.0)
    })
    .unwrap();
    let lost = PidInput {
        measured: f64::NAN,
        ..good()
    };
    assert_eq!(
        pid.step_with_terms(&mut PidState::new(), &lost).command,
        3.0
    );
}

#[test]
fn the_derivative_bridges_the_gap_that_bad_samples_leave() {
    // A ramp of 3/s, unfiltered: the rate after ten lost samples is still 3.
    let pid = Pid::try_new(PidSettings {
        k_d: 1.0,
        damping: DerivativeSource::on_error(),
        ..PidSettings::unlimited(0.0, 0.0)
    })
    .unwrap();
    let mut state = PidState::new();
    for k in 0..100_u32 {
        let lost = (40..50).contains(&k);
        let measured = if lost { f64::NAN } else { 3e-3 * f64::from(k) };
        pid.step_with_terms(&mut state, &PidInput::new(1e-3, 0.0, measured));
        if k > 1 {
            // Samples around 0.3 over 1 ms: an ulp of the one is 1e-13 of the other.
            assert!((state.rate() - 3.0).abs() < 1e-11);
        }
    }
}

#[test]
fn an_integral_that_cannot_grow_further_is_told_and_can_come_back() {
    let pid = Pid::try_new(PidSettings {
        anti_windup: AntiWindup::None,
        ..PidSettings::unlimited(0.0, 1.0)
    })
    .unwrap();
    let mut state = PidState::new();
    let mut up = PidInput::new(1.0, 1.2e308, 0.0);
    pid.step_with_terms(&mut state, &up);
    let out = pid.step_with_terms(&mut state, &up);
    assert_eq!(out.status, Status::Held(Fault::Overflow));
    assert_eq!(out.command, 1.2e308);
    up.reference = -1.2e308;
    assert_eq!(pid.step_with_terms(&mut state, &up).status, Status::Good);
    assert_eq!(state.integral(), 0.0);
}
