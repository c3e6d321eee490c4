//! What a controller must do: it reaches its limit, it comes back, it lets go.

use super::*;

/// Laws of each kind of anti-windup that reach both limits.
const LAWS: u32 = 10_000;

/// A law, a sample time, and the errors by which it is sent to one limit and to the other.
#[derive(Debug, Clone, Copy)]
struct Journey<T> {
    pid: Pid<T>,
    dt: T,
    there: T,
    back: T,
    feed_forward: T,
    /// How many samples before its limit a law starts that would take too long from the middle.
    near: u32,
}

fn of<T: Real>(x: f64) -> T {
    T::from_f64(x)
}

/// Laws over all that firmware has: gains, limits and errors of several decades.
fn journey<T: Real>(kind: usize) -> impl Strategy<Value = Journey<T>> {
    let gains = (
        prop_oneof![1 => Just(0.0), 3 => over_decades(0.01, 100.0)],
        over_decades(0.5, 500.0),
        prop_oneof![Just(1.0), 0.0..=1.0_f64],
    );
    let times = (over_decades(1e-4, 0.05), over_decades(0.01, 10.0));
    let range = (
        over_decades(0.5, 80.0),
        over_decades(0.5, 80.0),
        prop::option::of(over_decades(1.0, 1e5)),
        -40.0..40.0_f64,
    );
    let errors = (over_decades(1e-3, 100.0), over_decades(1e-3, 100.0));
    let all = (gains, times, range, errors, 1_u32..200);
    all.prop_map(move |(gains, (dt, tracking), range, (there, back), near)| {
        let ((k_p, k_i, weight), (low, high, slew, feed)) = (gains, range);
        let limits = Limits::try_new(of::<T>(-low), of(high)).unwrap();
        // A slew rate that moves the command by whole floats: see `Limits::with_slew`.
        let slew = slew.filter(|slew| of::<T>(slew * dt) > T::epsilon() * of(4.0 * (low + high)));
        let limits = slew.map_or(limits, |slew| limits.with_slew(of(slew)).unwrap());
        let safe = Fallback::try_new(20, T::ZERO).unwrap();
        let tracking_time = of(tracking);
        let settings = PidSettings {
            setpoint_weight: of(weight),
            anti_windup: match kind {
                0 => AntiWindup::Conditional,
                1 => AntiWindup::Clamp,
                2 => AntiWindup::BackCalculation { tracking_time },
                _ => AntiWindup::None,
            },
            ..PidSettings::new(of(k_p), of(k_i), limits, T::ONE, safe)
        };
        Journey {
            pid: Pid::try_new(settings).unwrap(),
            dt: of(dt),
            there: of(there),
            back: of(back),
            feed_forward: of(feed),
            near,
        }
    })
}

impl<T: Real> Journey<T> {
    /// A sample whose reference is ahead of the output by `ahead`.
    fn at(&self, ahead: T) -> PidInput<T> {
        with(PidInput::new(self.dt, ahead, T::ZERO), |at| {
            at.feed_forward = self.feed_forward
        })
    }

    /// Steps until the command is `limit`, no more than what is computed from the distance.
    ///
    /// In a sample the command moves by the change of the integral or by what the slew rate
    /// allows, whichever is less. Before, the integral gives back what it holds beyond the limits.
    fn reaches(&self, state: &mut PidState<T>, ahead: T, limit: T) -> Result<(), TestCaseError> {
        let (pid, at) = (&self.pid, self.at(ahead));
        let settings = pid.settings();
        let change = (settings.k_i * ahead * self.dt).abs();
        let slewed = settings.limits.slew().map_or(change, |slew| slew * self.dt);
        let each = if slewed < change { slewed } else { change };
        let far = of::<T>(400.0) * each;
        if (limit - state.command()).abs() > far {
            let way = of::<T>(f64::from(self.near)) * each;
            let from = limit - if ahead > T::ZERO { way } else { -way };
            prop_assert_eq!(state.resume_from(pid, from, &at), Status::Good);
        }
        let first = pid.step_with_terms(state, &at);
        let wound = (first.terms.unlimited - first.command).abs();
        let distance = (limit - first.command).abs();
        // Sums are rounded to an ulp of the largest of their terms, which add up to the command.
        let integral = first.terms.integral.abs() + wound;
        let ulp = T::epsilon() * of::<T>(2.0) * (limit.abs() + integral);
        // Two samples for the ends, and a thousandth for the rounding of as many changes.
        let most = of::<T>(1.001) * (distance + wound + of::<T>(4.0) * ulp) / each + of(2.0);
        let mut command = first.command;
        let mut samples = T::ONE;
        while command != limit {
            prop_assert!(samples <= most, "{command} of {limit} after {samples}");
            let out = pid.step(state, &at);
            prop_assert_eq!(out.status, Status::Good);
            command = out.command;
            samples += T::ONE;
        }
        // It stays there while the error stays.
        for _ in 0..20 {
            command = pid.step(state, &at).command;
            prop_assert!((command - limit).abs() <= ulp, "{command} of {limit}");
        }
        Ok(())
    }

    /// There, and back again.
    fn travels(&self) -> Result<(), TestCaseError> {
        let (mut state, limits) = (PidState::new(), self.pid.settings().limits);
        self.reaches(&mut state, self.there, limits.high())?;
        self.reaches(&mut state, -self.back, limits.low())?;
        self.reaches(&mut state, self.there, limits.high())
    }
}

/// Half of the laws in each float.
fn every_law_travels(kind: usize) {
    let mut runner = proptest::test_runner::TestRunner::new(seeded(LAWS / 2, kind as u64));
    runner
        .run(&journey::<f32>(kind), |journey| journey.travels())
        .unwrap();
    runner
        .run(&journey::<f64>(kind), |journey| journey.travels())
        .unwrap();
}

#[test]
fn any_law_with_conditional_integration_reaches_one_limit_and_then_the_other() {
    every_law_travels(0);
}

#[test]
fn any_law_with_a_clamped_integral_reaches_one_limit_and_then_the_other() {
    every_law_travels(1);
}

#[test]
fn any_law_with_back_calculation_reaches_one_limit_and_then_the_other() {
    every_law_travels(2);
}

#[test]
fn any_law_without_anti_windup_reaches_one_limit_and_after_unwinding_the_other() {
    every_law_travels(3);
}

fn law(k_p: f64, k_i: f64, limits: Limits<f64>) -> Pid<f64> {
    pid(k_p, k_i, |s| s.limits = limits)
}

fn run(pid: &Pid<f64>, state: &mut PidState<f64>, at: &PidInput<f64>, samples: u32) -> f64 {
    for _ in 0..samples {
        assert_eq!(pid.step(state, at).status, Status::Good);
    }
    state.command()
}

#[test]
fn a_change_larger_than_the_range_takes_the_command_to_the_limit_on_its_side() {
    // Laws of which one change of the integral passes the whole range.
    for (k_p, k_i, low, high, dt, up, down) in [
        (0.0, 5.0, 0.0, 1.0, 0.1, 0.05, 3.0),
        (0.5, 25.0, -20.0, 60.0, 0.02, 1.0, 70.0),
        (0.02, 200.0, -1.0, 1.0, 0.001, 0.1, 12.0),
    ] {
        let (pid, mut state) = (law(k_p, k_i, range(low, high)), PidState::new());
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(dt, up, 0.0), 2000),
            high
        );
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(dt, -down, 0.0), 2),
            low
        );
    }
    let (pid, at) = (
        law(0.0, 300.0, range(-1.0, 1.0)),
        PidInput::new(0.005, 1.0, 0.0),
    );
    assert_eq!(run(&pid, &mut PidState::new(), &at, 1), 1.0);
}

#[test]
fn the_integral_unwinds_by_its_whole_change_from_the_first_sample_on() {
    let limits = range(-20.0, 60.0);
    for limits in [limits, limits.with_slew(1000.0).unwrap()] {
        let (pid, mut state) = (law(1.0, 10.0, limits), PidState::new());
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(DT, 5.0, 0.0), 20_000),
            60.0
        );
        for _ in 0..100 {
            let before = state.integral();
            // A feed-forward that keeps the command at its limit.
            let at = with(PidInput::new(DT, -5.0, 0.0), |at| at.feed_forward = 100.0);
            let out = pid.step_with_terms(&mut state, &at);
            assert!(out.command == 60.0 && out.terms.saturated);
            // k_i·e·dt, to the rounding of sums of numbers below 100.
            near(state.integral() - before, -0.05, 1e-13);
        }
    }
}

#[test]
fn a_clamped_integral_fills_the_range_next_to_the_other_terms() {
    // A plant with gain 1 and a lag of 0.1 s; 30 of -20..60 are wanted.
    for (weight, feed_forward) in [(1.0, 0.0), (0.5, 0.0), (0.0, 0.0), (1.0, -40.0)] {
        let pid = pid(2.0, 10.0, |s| {
            (s.setpoint_weight, s.anti_windup) = (weight, AntiWindup::Clamp);
            s.limits = range(-20.0, 60.0);
        });
        let (mut state, mut y) = (PidState::new(), 0.0);
        for _ in 0..60_000 {
            let at = with(PidInput::new(DT, 30.0, y), |at| {
                at.feed_forward = feed_forward
            });
            y += DT * (pid.step(&mut state, &at).command - y) / 0.1;
        }
        // A minute is some 50 of the slowest time constant.
        near(y, 30.0, 1e-9);
    }
}

#[test]
fn a_clamped_integral_is_not_moved_by_a_kick_of_the_derivative() {
    let pid = pid(2.0, 10.0, |s| {
        (s.k_d, s.damping) = (0.2, DerivativeSource::on_error());
        (s.limits, s.anti_windup) = (range(-20.0, 60.0), AntiWindup::Clamp);
    });
    let mut state = PidState::new();
    state.resume_from(&pid, 20.0, &PidInput::new(DT, 0.0, 0.0));
    // A step of the reference by 5: 1000 for one sample, which the range cuts off.
    assert_eq!(
        pid.step(&mut state, &PidInput::new(DT, 5.0, 0.0)).command,
        60.0
    );
    near(state.integral(), 20.05, 1e-12);
}

#[test]
fn without_an_integral_gain_nothing_is_left_in_the_command_at_error_zero() {
    let dampings = [
        (0.0, DerivativeSource::on_error()),
        (0.1, DerivativeSource::on_measurement()),
        (1.0, DerivativeSource::Velocity),
    ];
    for (anti_windup, damped) in WINDUPS.iter().flat_map(|own| dampings.map(|it| (*own, it))) {
        let pid = pid(10.0, 0.0, |s| {
            (s.k_d, s.damping) = damped;
            (s.derivative_time, s.anti_windup) = (0.01, anti_windup);
            s.limits = range(-5.0, 5.0);
        });
        // At the limit for half a second, then at the reference.
        let mut state = PidState::new();
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(DT, 2.0, 0.0), 500),
            5.0
        );
        let left = run(&pid, &mut state, &PidInput::new(DT, 2.0, 2.0), 10_000);
        assert_eq!(state.integral(), 0.0);
        // The filtered rate of the step has decayed by 1.1^10000, to below the normal numbers.
        assert!(left.abs() < f64::MIN_POSITIVE);
    }
}

#[test]
fn an_integral_that_was_taken_over_without_k_i_returns_to_zero_without_a_jump() {
    let [pi, p] = [20.0, 0.0].map(|k_i| law(4.0, k_i, range(-20.0, 20.0)));
    let at = PidInput::new(DT, 0.0, 0.0);
    for how in 0..3 {
        let mut state = PidState::new();
        state.resume_from(&pi, 12.0, &at);
        pi.step(&mut state, &at);
        match how {
            0 => p.bumpless_transfer(&mut state),
            1 => assert_eq!(state.resume_from(&p, 12.0, &at), Status::Good),
            _ => {}
        }
        let (mut last, mut samples) = (12.0_f64, 0);
        while state.integral() != 0.0 {
            let command = p.step(&mut state, &at).command;
            // A time constant of 1 s: by a thousandth of itself a sample, and towards zero.
            assert!(command >= 0.0 && command < last && last - command <= 0.001 * last + 1e-300);
            (last, samples) = (command, samples + 1);
            // ln(12/2.2e-308) time constants of 1000 samples, and then by the least number.
            assert!(samples < 711_000 + 2000, "{how}: {command}");
        }
    }
}

proptest! {
    #[test]
    fn an_integral_without_k_i_comes_nearer_to_zero_with_every_sample(
        integral in any::<f32>().prop_filter("finite", |x| x.is_finite()),
        dt in 1e-6_f32..1.0,
    ) {
        let p = Pid::try_new(PidSettings::unlimited(1.0_f32, 0.0)).unwrap();
        let (mut state, at) = (PidState::new(), PidInput::new(dt, 0.0, 0.0));
        state.resume_from(&p, integral, &at);
        for _ in 0..10 {
            let before = state.integral();
            p.step(&mut state, &at);
            prop_assert!(state.integral().abs() < before.abs() || state.integral() == 0.0);
            prop_assert!(state.integral() == 0.0 || (state.integral() > 0.0) == (before > 0.0));
        }
    }
}

fn law_with<T: Real>(k_p: f64, k_i: f64, limits: Limits<T>, longest: f64) -> PidSettings<T> {
    let [k_p, k_i, longest] = [k_p, k_i, longest].map(T::from_f64);
    PidSettings::new(k_p, k_i, limits, longest, Fallback::hold_indefinitely())
}

fn sample<T: Real>(dt: f64, reference: f64, measured: f64) -> PidInput<T> {
    let [dt, reference, measured] = [dt, reference, measured].map(T::from_f64);
    PidInput::new(dt, reference, measured)
}

fn a_report_reverses_what_the_integral_moved<T: Real>() {
    let limits = Limits::try_new(T::from_f64(-10.0), T::from_f64(10.0)).unwrap();
    let tracking_time = T::from_f64(0.05);
    for anti_windup in [
        AntiWindup::Conditional,
        AntiWindup::Clamp,
        AntiWindup::BackCalculation { tracking_time },
    ] {
        for (way, report) in [(1.0, Applied::AtUpperLimit), (-1.0, Applied::AtLowerLimit)] {
            let settings = law_with(0.0, 100.0, limits, 0.1);
            let pid = Pid::try_new(with(settings, |s| s.anti_windup = anti_windup)).unwrap();
            let mut state = PidState::new();
            // The change of 60 is cut to the range, or is left to back-calculation.
            let out = pid.step(&mut state, &sample(0.01, 60.0 * way, 0.0));
            assert_eq!(out.command, T::from_f64(10.0 * way));
            pid.applied(&mut state, report);
            assert_eq!(state.integral(), T::ZERO, "{anti_windup:?}");
            let out = pid.step(&mut state, &sample(0.01, 0.0, 0.0));
            assert_eq!(out.command, T::ZERO, "{anti_windup:?}");
            // An integral at rest at its end has nothing to reverse.
            if matches!(anti_windup, AntiWindup::BackCalculation { .. }) {
                continue;
            }
            for _ in 0..3 {
                pid.step(&mut state, &sample(0.01, 60.0 * way, 0.0));
            }
            for _ in 0..3 {
                pid.applied(&mut state, report);
                pid.step(&mut state, &sample(0.01, 60.0 * way, 0.0));
                assert_eq!(state.integral(), T::from_f64(10.0 * way));
            }
        }
    }
}

#[test]
fn a_report_of_the_drive_reverses_what_the_integral_moved_and_no_more() {
    a_report_reverses_what_the_integral_moved::<f32>();
    a_report_reverses_what_the_integral_moved::<f64>();
}

fn the_integral_keeps_its_limit<T: Real>() {
    let range = Limits::try_new(T::from_f64(-10.0), T::from_f64(10.0)).unwrap();
    let tracking_time = T::from_f64(0.05);
    for (limits, anti_windup) in [
        (range, AntiWindup::BackCalculation { tracking_time }),
        (
            range.with_slew(T::from_f64(20.0)).unwrap(),
            AntiWindup::Conditional,
        ),
    ] {
        let most = T::from_f64(3.0);
        let pid = Pid::try_new(with(law_with(10.0, 5.0, limits, 0.01), |s| {
            (s.anti_windup, s.integral_limit) = (anti_windup, Some(most));
        }));
        let (pid, mut state) = (pid.unwrap(), PidState::new());
        for k in 0..8000 {
            let wanted = if k / 2000 % 2 == 0 { 8.0 } else { -8.0 };
            pid.step(&mut state, &sample(0.001, wanted, 0.0));
            assert!(
                state.integral().abs() <= most,
                "{anti_windup:?}: {}",
                state.integral()
            );
        }
    }
}

#[test]
fn no_anti_windup_moves_the_integral_beyond_its_limit() {
    the_integral_keeps_its_limit::<f32>();
    the_integral_keeps_its_limit::<f64>();
}

#[test]
fn a_transfer_to_a_law_with_a_period_does_not_jump() {
    let limits = Limits::try_new(-1000.0, 1000.0).unwrap();
    let straight = Pid::try_new(law_with::<f64>(1.0, 0.1, limits, 0.01)).unwrap();
    let period = Some(360.0);
    let turning = with(law_with(1.0, 0.1, limits, 0.01), |s| s.period = period);
    let turning = Pid::try_new(turning).unwrap();
    let (mut state, at) = (PidState::new(), sample(0.001, 350.0, 0.0));
    let before = straight.step(&mut state, &at).command;
    turning.bumpless_transfer(&mut state);
    let after = turning.step(&mut state, &at).command;
    // One increment of the integral: k_i times the 10 degrees to the reference times dt.
    assert!((after - before + 0.001).abs() < 1e-9, "{before} {after}");
}
