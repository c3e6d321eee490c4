//! What a bad sample does: nothing, and it is told.

use super::*;

fn good() -> PidInput<f64> {
    with(PidInput::new(DT, 1.0, 0.8), |at| {
        (at.velocity, at.feed_forward) = (0.1, 0.5);
    })
}

fn lost() -> PidInput<f64> {
    with(good(), |at| at.measured = f64::NAN)
}

/// Every way in which a sample can be bad for a PIV, and how it is told.
fn bad() -> Vec<(PidInput<f64>, Fault)> {
    type Change = fn(&mut PidInput<f64>, f64);
    let dt: Change = |at, x| at.dt = x;
    let overflow = Fault::Overflow;
    let mut all: Vec<(Change, f64, Fault)> = vec![
        (dt, 0.0, Fault::DtNotPositive),
        (dt, -DT, Fault::DtNotPositive),
        (
            |at, x| (at.measured, at.reference) = (x, -x),
            f64::MAX,
            overflow,
        ),
        (
            |at, x| (at.feed_forward, at.measured) = (x, -1e307),
            f64::MAX,
            overflow,
        ),
    ];
    for not in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        all.extend::<[(Change, f64, Fault); 5]>([
            (dt, not, Fault::Dt),
            (|at, x| at.reference = x, not, Fault::Reference),
            (|at, x| at.measured = x, not, Fault::Measured),
            (|at, x| at.velocity = x, not, Fault::Velocity),
            (|at, x| at.feed_forward = x, not, Fault::FeedForward),
        ]);
    }
    let spoilt =
        |(change, x, fault): (Change, f64, Fault)| (with(good(), |at| change(at, x)), fault);
    all.into_iter().map(spoilt).collect()
}

#[test]
fn every_bad_input_is_told_by_name_and_holds_the_command_and_the_memory() {
    let pid = Pid::paper_piv();
    let mut state = PidState::new();
    let before = pid.step_with_terms(&mut state, &good());
    let memory = (state.integral(), state.rate());
    for (count, (at, fault)) in (1_u32..).zip(bad()) {
        let out = pid.step_with_terms(&mut state, &at);
        assert_eq!(out.status, Status::Held(fault), "{at:?}");
        assert_eq!((out.command, out.terms), (before.command, before.terms));
        assert_eq!(state.fault_counter(), 4 * count);
        assert_eq!((state.integral(), state.rate()), memory);
    }
    let count = 4 * u32::try_from(bad().len()).unwrap();
    assert_eq!(pid.step(&mut state, &good()).status, Status::Good);
    assert_eq!(state.fault_counter(), count - 1);
}

#[test]
fn a_good_sample_after_bad_ones_is_as_if_they_had_not_been() {
    // dt = 0 takes no time: not even the derivative can see that something was there.
    let pid = Pid::paper_pid();
    let (mut disturbed, mut free) = (PidState::new(), PidState::new());
    for k in 0..50 {
        pid.step(&mut disturbed, &with(lost(), |at| at.dt = 0.0));
        let at = with(good(), |at| at.measured = 0.01 * f64::from(k));
        let [a, b] = [&mut disturbed, &mut free].map(|state| {
            let out = pid.step_with_terms(state, &at);
            (out, pid.terms(state), state.rate())
        });
        assert_eq!(a, b);
    }
}

#[test]
fn a_velocity_that_nobody_reads_may_be_anything() {
    let at = with(good(), |at| at.velocity = f64::NAN);
    for pid in [Pid::paper_pi(), Pid::paper_pid()] {
        assert_eq!(pid.step(&mut PidState::new(), &at).status, Status::Good);
    }
}

#[test]
fn the_derivative_bridges_the_gap_that_bad_samples_leave() {
    // A ramp of 3/s, unfiltered: the rate after ten lost samples is still 3.
    let pid = pid(0.0, 0.0, |s| {
        (s.k_d, s.damping) = (1.0, DerivativeSource::on_error())
    });
    let mut state = PidState::new();
    for k in 0..100_u32 {
        let lost = (40..50).contains(&k);
        let measured = if lost { f64::NAN } else { 3e-3 * f64::from(k) };
        pid.step(&mut state, &PidInput::new(DT, 0.0, measured));
        if k > 1 {
            // Samples around 0.3 over 1 ms: an ulp of the one is 1e-13 of the other.
            near(state.rate(), 3.0, 1e-11);
        }
    }
}

#[test]
fn an_integral_that_cannot_grow_further_is_told_and_can_come_back() {
    let pid = pid(0.0, 1.0, |s| s.anti_windup = AntiWindup::None);
    let mut state = PidState::new();
    let mut up = PidInput::new(1.0, 1.2e308, 0.0);
    pid.step(&mut state, &up);
    let out = pid.step(&mut state, &up);
    assert_eq!(
        (out.command, out.status),
        (1.2e308, Status::Held(Fault::Overflow))
    );
    up.reference = -1.2e308;
    assert_eq!(pid.step(&mut state, &up).status, Status::Good);
    assert_eq!(state.integral(), 0.0);
}
