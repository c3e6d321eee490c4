//! What a controller must do: it reaches its limit, it comes back, it lets go.

use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Limits, Pid, PidInput, PidSettings, PidState, Status,
};
use bowden::Real;
use proptest::prelude::*;

/// Laws of each kind of anti-windup that reach both limits.
const LAWS: u32 = 10_000;

/// Kinds of anti-windup, each with its own laws.
const KINDS: u8 = 4;

/// A number between two, spread evenly over its logarithm.
fn over_decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

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

/// Laws over all that firmware has: gains, limits and errors of several decades.
fn journey<T: Real>(kind: u8) -> impl Strategy<Value = Journey<T>> {
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
    (gains, times, range, errors, 1_u32..200).prop_map(
        move |(
            (k_p, k_i, weight),
            (dt, tracking),
            (low, high, slew, feed),
            (there, back),
            near,
        )| {
            let limits = Limits::try_new(T::from_f64(-low), T::from_f64(high)).unwrap();
            // A slew rate that moves the command by whole floats: see `Limits::with_slew`.
            let slew = slew.filter(|slew| {
                T::from_f64(slew * dt) > T::epsilon() * T::from_f64(4.0 * (low + high))
            });
            let limits = slew.map_or(limits, |slew| limits.with_slew(T::from_f64(slew)).unwrap());
            let pid = Pid::try_new(PidSettings {
                setpoint_weight: T::from_f64(weight),
                anti_windup: match kind {
                    0 => AntiWindup::Conditional,
                    1 => AntiWindup::Clamp,
                    2 => AntiWindup::BackCalculation {
                        tracking_time: T::from_f64(tracking),
                    },
                    _ => AntiWindup::None,
                },
                ..PidSettings::new(
                    T::from_f64(k_p),
                    T::from_f64(k_i),
                    limits,
                    T::from_f64(1.0),
                    Fallback::try_new(20, T::ZERO).unwrap(),
                )
            })
            .unwrap();
            Journey {
                pid,
                dt: T::from_f64(dt),
                there: T::from_f64(there),
                back: T::from_f64(back),
                feed_forward: T::from_f64(feed),
                near,
            }
        },
    )
}

impl<T: Real> Journey<T> {
    /// A sample whose reference is ahead of the output by `ahead`.
    fn at(&self, ahead: T) -> PidInput<T> {
        PidInput {
            feed_forward: self.feed_forward,
            ..PidInput::new(self.dt, ahead, T::ZERO)
        }
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
        let far = T::from_f64(400.0) * each;
        if (limit - state.command()).abs() > far {
            let way = T::from_f64(f64::from(self.near)) * each;
            let from = if ahead > T::ZERO {
                limit - way
            } else {
                limit + way
            };
            prop_assert_eq!(state.resume_from(pid, from, &at), Status::Good);
        }
        let first = pid.step_with_terms(state, &at);
        let wound = (first.terms.unlimited - first.command).abs();
        let distance = (limit - first.command).abs();
        // Sums are rounded to an ulp of the largest of their terms, which add up to the command.
        let integral = first.terms.integral.abs() + wound;
        let ulp = T::epsilon() * T::from_f64(2.0) * (limit.abs() + integral);
        // Two samples for the ends, and a thousandth for the rounding of as many changes.
        let most = T::from_f64(1.001) * (distance + wound + T::from_f64(4.0) * ulp) / each
            + T::from_f64(2.0);
        let mut command = first.command;
        let mut samples = T::ONE;
        while command != limit {
            prop_assert!(
                samples <= most,
                "{command} of {limit} after {samples} of {most}"
            );
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

fn laws(seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases: LAWS / 2,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    }
}

/// Half of the laws in each float.
fn every_law_travels(kind: u8) {
    let mut runner = proptest::test_runner::TestRunner::new(laws(u64::from(kind)));
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
    every_law_travels(KINDS - 1);
}

fn law(k_p: f64, k_i: f64, low: f64, high: f64) -> PidSettings<f64> {
    let limits = Limits::try_new(low, high).unwrap();
    let safe = Fallback::try_new(20, limits.clamp(0.0)).unwrap();
    PidSettings::new(k_p, k_i, limits, 10.0, safe)
}

fn run(pid: &Pid<f64>, state: &mut PidState<f64>, at: &PidInput<f64>, samples: u32) -> f64 {
    let mut command = state.command();
    for _ in 0..samples {
        let out = pid.step(state, at);
        assert_eq!(out.status, Status::Good);
        command = out.command;
    }
    command
}

#[test]
fn a_change_larger_than_the_range_takes_the_command_to_the_limit_on_its_side() {
    // Laws of which one change of the integral passes the whole range.
    for (k_p, k_i, low, high, dt, up, down) in [
        (0.0, 5.0, 0.0, 1.0, 0.1, 0.05, 3.0),
        (0.5, 25.0, -20.0, 60.0, 0.02, 1.0, 70.0),
        (0.02, 200.0, -1.0, 1.0, 0.001, 0.1, 12.0),
    ] {
        let pid = Pid::try_new(law(k_p, k_i, low, high)).unwrap();
        let mut state = PidState::new();
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(dt, up, 0.0), 2000),
            high
        );
        assert_eq!(
            run(&pid, &mut state, &PidInput::new(dt, -down, 0.0), 2),
            low
        );
    }
    let integral_law = Pid::try_new(law(0.0, 300.0, -1.0, 1.0)).unwrap();
    let at = PidInput::new(0.005, 1.0, 0.0);
    assert_eq!(run(&integral_law, &mut PidState::new(), &at, 1), 1.0);
}

#[test]
fn the_integral_unwinds_by_its_whole_change_from_the_first_sample_on() {
    for slew in [None, Some(1000.0)] {
        let limits = Limits::try_new(-20.0, 60.0).unwrap();
        let limits = slew.map_or(limits, |slew| limits.with_slew(slew).unwrap());
        let settings = PidSettings {
            limits,
            ..law(1.0, 10.0, -20.0, 60.0)
        };
        let (pid, mut state) = (Pid::try_new(settings).unwrap(), PidState::new());
        run(&pid, &mut state, &PidInput::new(0.001, 5.0, 0.0), 20_000);
        assert_eq!(state.command(), 60.0);
        for _ in 0..100 {
            let before = state.integral();
            // A feed-forward that keeps the command at its limit.
            let at = PidInput {
                feed_forward: 100.0,
                ..PidInput::new(0.001, -5.0, 0.0)
            };
            let out = pid.step_with_terms(&mut state, &at);
            assert!(out.command == 60.0 && out.terms.saturated);
            // k_i·e·dt, to the rounding of sums of numbers below 100.
            assert!((state.integral() - before + 0.05).abs() < 1e-13);
        }
    }
}

#[test]
fn a_clamped_integral_fills_the_range_next_to_the_other_terms() {
    // A plant with gain 1 and a lag of 0.1 s; 30 of -20..60 are wanted.
    for (setpoint_weight, feed_forward) in [(1.0, 0.0), (0.5, 0.0), (0.0, 0.0), (1.0, -40.0)] {
        let settings = PidSettings {
            setpoint_weight,
            anti_windup: AntiWindup::Clamp,
            ..law(2.0, 10.0, -20.0, 60.0)
        };
        let (pid, mut state, mut y) = (Pid::try_new(settings).unwrap(), PidState::new(), 0.0);
        for _ in 0..60_000 {
            let at = PidInput {
                feed_forward,
                ..PidInput::new(0.001, 30.0, y)
            };
            y += 0.001 * (pid.step(&mut state, &at).command - y) / 0.1;
        }
        // A minute is some 50 of the slowest time constant.
        assert!(
            (y - 30.0).abs() < 1e-9,
            "{setpoint_weight} {feed_forward}: {y}"
        );
    }
}

#[test]
fn a_clamped_integral_is_not_moved_by_a_kick_of_the_derivative() {
    let settings = PidSettings {
        k_d: 0.2,
        damping: DerivativeSource::on_error(),
        anti_windup: AntiWindup::Clamp,
        ..law(2.0, 10.0, -20.0, 60.0)
    };
    let (pid, mut state) = (Pid::try_new(settings).unwrap(), PidState::new());
    state.resume_from(&pid, 20.0, &PidInput::new(0.001, 0.0, 0.0));
    // A step of the reference by 5: 1000 for one sample, which the range cuts off.
    let out = pid.step(&mut state, &PidInput::new(0.001, 5.0, 0.0));
    assert_eq!(out.command, 60.0);
    assert!((state.integral() - 20.05).abs() < 1e-12);
}

#[test]
fn without_an_integral_gain_nothing_is_left_in_the_command_at_error_zero() {
    let all = [
        AntiWindup::None,
        AntiWindup::Clamp,
        AntiWindup::Conditional,
        AntiWindup::BackCalculation { tracking_time: 0.1 },
    ];
    for anti_windup in all {
        for (k_d, damping) in [
            (0.0, DerivativeSource::on_error()),
            (0.1, DerivativeSource::on_measurement()),
            (1.0, DerivativeSource::Velocity),
        ] {
            let pid = Pid::try_new(PidSettings {
                k_d,
                damping,
                derivative_time: 0.01,
                anti_windup,
                ..law(10.0, 0.0, -5.0, 5.0)
            })
            .unwrap();
            // At the limit for half a second, then at the reference.
            let mut state = PidState::new();
            assert_eq!(
                run(&pid, &mut state, &PidInput::new(0.001, 2.0, 0.0), 500),
                5.0
            );
            run(&pid, &mut state, &PidInput::new(0.001, 2.0, 2.0), 10_000);
            assert_eq!(state.integral(), 0.0);
            // The filtered rate of the step has decayed by 1.1^10000, to below the normal numbers.
            assert!(state.command().abs() < f64::MIN_POSITIVE);
        }
    }
}

#[test]
fn an_integral_that_was_taken_over_without_k_i_returns_to_zero_without_a_jump() {
    let pi = Pid::try_new(law(4.0, 20.0, -20.0, 20.0)).unwrap();
    let p = Pid::try_new(law(4.0, 0.0, -20.0, 20.0)).unwrap();
    let at = PidInput::new(0.001, 0.0, 0.0);
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
