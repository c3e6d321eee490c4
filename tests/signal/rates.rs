//! Rates of a position: closed forms, bad samples, gaps, wrap-around.

use super::*;
use approx::assert_relative_eq;
use bowden::effect::Motion;

const TIME_CONSTANT: f64 = 0.01;

fn rates<T: Real>() -> Rates<T> {
    Rates::try_new(T::from_f64(TIME_CONSTANT)).unwrap()
}

/// All motions of `x(t)`, sampled at the given times; the first `dt` is the second's.
fn run<T: Real>(rates: &Rates<T>, times: &[f64], x: impl Fn(f64) -> f64) -> Vec<Motion<f64>> {
    let mut state = RatesState::new();
    let mut before = times[0] - (times[1] - times[0]);
    let step = |&t: &f64| {
        let out = rates.step(&mut state, T::from_f64(x(t)), T::from_f64(t - before));
        assert!(!matches!(out.status, RateStatus::Held(_)));
        before = t;
        Motion {
            position: out.motion.position.as_f64(),
            velocity: out.motion.velocity.as_f64(),
            acceleration: out.motion.acceleration.as_f64(),
        }
    };
    times.iter().map(step).collect()
}

fn uniform(samples: u32) -> Vec<f64> {
    (0..samples).map(|k| DT * f64::from(k)).collect()
}

/// Times whose steps vary between half and three halves of a millisecond.
fn jittered(samples: u32) -> Vec<f64> {
    let mut t = 0.0;
    let mut next = |k| {
        t += DT * (1.0 + 0.5 * (f64::from(k) * 1.7).sin());
        t
    };
    (0..samples).map(&mut next).collect()
}

#[test]
fn a_ramp_gives_its_slope_by_one_exponential_whatever_the_steps() {
    for times in [uniform(200), jittered(200)] {
        let motions = run(&rates::<f64>(), &times, |t| 7.0 - 3.0 * t);
        for (t, motion) in times.iter().zip(&motions) {
            let velocity = -3.0 * (1.0 - (-(t - times[0]) / TIME_CONSTANT).exp());
            // Exact between samples: the path is straight. Rounding of 7 over 0.5 ms.
            near(motion.velocity, velocity, 1e-10);
            assert_eq!(motion.position, 7.0 - 3.0 * t);
        }
        near(motions[199].acceleration, 0.0, 1e-4); // 18·e^-18
    }
}

#[test]
fn the_same_in_single_precision() {
    let motions = run(&rates::<f32>(), &uniform(1000), |t| 0.5 - 3.0 * t);
    // Half an ulp of positions up to 3, twice, over tau.
    near(motions[999].velocity, -3.0, 2.4e-7 / TIME_CONSTANT);
    let over_square = 2.4e-7 / (TIME_CONSTANT * TIME_CONSTANT);
    near(motions[999].acceleration, 0.0, 2.0 * over_square);
}

#[test]
fn a_parabola_gives_its_curvature_and_a_velocity_that_is_late_by_the_time_constant() {
    let times = uniform(1000);
    let motion = run(&rates::<f64>(), &times, |t| 2.0 * t * t)[999];
    near(motion.acceleration, 4.0, 1e-8); // rounding over tau²
    let late = times[999] - motion.velocity / 4.0;
    let q = (-DT / TIME_CONSTANT).exp();
    near(late, DT * (0.5 + q / (1.0 - q)), 1e-9);
    // The series of coth: the next term is dt⁴/(720·tau³) = 1e-9.
    let series = TIME_CONSTANT + DT * DT / (12.0 * TIME_CONSTANT);
    near(late, series, 2e-9);
}

/// Gain and phase \[rad\] of a signal at `f` \[Hz\], over whole periods.
fn response(signal: impl Iterator<Item = (f64, f64)>, f: f64) -> (f64, f64) {
    let (mut re, mut im, mut n) = (0.0, 0.0, 0.0);
    for (t, value) in signal {
        re += value * (TAU * f * t).sin();
        im += value * (TAU * f * t).cos();
        n += 1.0;
    }
    (2.0 * re.hypot(im) / n, im.atan2(re))
}

#[test]
fn a_sine_at_the_cut_off_keeps_the_gain_and_the_phase_that_the_docs_state() {
    let f_c = 5.0;
    let rates = Rates::for_cutoff(f_c).unwrap();
    assert_relative_eq!(rates.time_constant(), 1.0 / (TAU * 2.5 * f_c));
    let times = uniform(3000);
    for f in [f_c, 0.2 * f_c, 4.0 * f_c] {
        let w = TAU * f;
        let motions = run(&rates, &times, |t| (w * t).sin());
        // The last two seconds: whole periods, and e^-78 of the start.
        let last = || times.iter().zip(&motions).skip(1000);
        let velocity = response(last().map(|(t, m)| (*t, m.velocity)), f);
        let acceleration = response(last().map(|(t, m)| (*t, m.acceleration)), f);

        // The transfer function in z, at z = e^(i·w·dt).
        let q = (-DT / rates.time_constant()).exp();
        let (re, im) = (1.0 - q * (w * DT).cos(), q * (w * DT).sin());
        let gain = (1.0 - q) / re.hypot(im) * 2.0 * (0.5 * w * DT).sin() / DT;
        let phase = PI / 2.0 - 0.5 * w * DT - im.atan2(re);
        // Rounding, and what the start leaves.
        assert_relative_eq!(velocity.0, gain, max_relative = 1e-9);
        near(velocity.1, phase, 1e-9);
        assert_relative_eq!(acceleration.0, gain * gain, max_relative = 1e-9);
        let twice = (2.0 * phase - acceleration.1 + PI).rem_euclid(TAU) - PI;
        near(twice, 0.0, 1e-9);

        // The one in s, which the docs give; the sample time adds (w·dt)² = 1.6 % at 20 Hz.
        let x = w * rates.time_constant();
        let sampled = (w * DT).powi(2) + 1e-4;
        assert_relative_eq!(velocity.0, w / x.hypot(1.0), max_relative = sampled);
        near(velocity.1, PI / 2.0 - x.atan(), sampled);
        if f == f_c {
            near(velocity.0 / w, 0.93, 0.005); // two digits
            near((PI / 2.0 - velocity.1).to_degrees(), 22.0, 0.5);
            near(acceleration.0 / (w * w), 0.86, 0.005);
        }
    }
}

#[test]
fn white_noise_is_at_most_divided_by_the_time_constant_and_by_its_square() {
    // The sum of squares of the impulse response is the gain on the variance.
    for time_constant in [0.01, 0.05, 0.001] {
        let rates = Rates::try_new(time_constant).unwrap();
        let impulse = |t: f64| f64::from(u8::from((t - DT).abs() < 0.5 * DT));
        let motions = run(&rates, &uniform(2000), impulse);
        let rms = |of: fn(&Motion<f64>) -> f64| {
            let squares = motions.iter().map(|m| of(m) * of(m));
            squares.sum::<f64>().sqrt()
        };
        let q = (-DT / time_constant).exp();
        let exact = (1.0 - q) / DT * (2.0 / (1.0 + q)).sqrt();
        assert_relative_eq!(rms(|m| m.velocity), exact, max_relative = 1e-9);
        assert!(rms(|m| m.velocity) <= 1.0 / time_constant);
        assert!(rms(|m| m.acceleration) <= 1.1 / (time_constant * time_constant));
    }
}

#[test]
fn the_first_sample_gives_no_kick_and_the_rates_settle_in_five_time_constants() {
    let rates = rates::<f64>();
    let mut state = RatesState::new();
    assert_eq!(state.motion(), Motion::default());
    let out = rates.step(&mut state, 1e6, DT);
    assert_eq!(
        (out.motion, out.status),
        (resting(1e6), RateStatus::Settling)
    );
    let mut steepest: f64 = 0.0;
    for k in 1..100_u32 {
        let out = rates.step(&mut state, 1e6 + 2.0 * DT * f64::from(k), DT);
        steepest = steepest.max(out.motion.acceleration);
        // 51 steps of 1 ms are more than 50 ms, with or without rounding.
        if !(50..=52).contains(&k) {
            assert_eq!(out.status == RateStatus::Good, k > 52);
        }
        if out.status == RateStatus::Good {
            assert!((out.motion.velocity - 2.0).abs() <= 2.0 * (-5.0_f64).exp());
        }
    }
    // The pulse V/(e·tau) of the docs, to the sample time's 5 %.
    let pulse = 2.0 / (1.0_f64.exp() * TIME_CONSTANT);
    assert_relative_eq!(steepest, pulse, max_relative = 0.05);
}

fn resting(position: f64) -> Motion<f64> {
    with(Motion::default(), |at| at.position = position)
}

/// Settled on a ramp of 3/s that has got to `x(k) = 3e-3·k` with k = 200.
fn on_a_ramp(rates: &Rates<f64>) -> RatesState<f64> {
    let mut state = RatesState::new();
    for k in 0..=200 {
        rates.step(&mut state, 3.0 * DT * f64::from(k), DT);
    }
    state
}

#[test]
fn bad_samples_hold_the_last_good_motion_and_say_why() {
    let rates = rates::<f64>();
    let settled = on_a_ramp(&rates);
    use Fault::{Dt, DtNotPositive, Position};
    for (position, dt, fault) in [
        (f64::NAN, DT, Position),
        (f64::INFINITY, DT, Position),
        (f64::NEG_INFINITY, DT, Position),
        (0.6, f64::NAN, Dt),
        (0.6, f64::INFINITY, Dt),
        (0.6, 0.0, DtNotPositive),
        (0.6, -0.0, DtNotPositive),
        (0.6, -DT, DtNotPositive),
        (f64::NAN, 0.0, DtNotPositive),
    ] {
        let mut state = settled;
        let out = rates.step(&mut state, position, dt);
        assert_eq!(out.status, RateStatus::Held(fault));
        assert_eq!(out.motion, settled.motion());
        let mut fresh = RatesState::new();
        let out = rates.step(&mut fresh, position, dt);
        let held = RateStatus::Held(fault);
        assert_eq!((out.motion, out.status), (Motion::default(), held));
    }
}

#[test]
fn the_difference_spans_samples_that_were_bad_or_missing() {
    let rates = rates::<f64>();
    for missing in [1, 5, 90] {
        let next = 3.0 * DT * f64::from(201 + missing);
        let mut bad = on_a_ramp(&rates);
        for _ in 0..missing {
            rates.step(&mut bad, f64::NAN, DT);
        }
        near(bad.gap(), DT * f64::from(missing), 1e-15);
        let after_bad = rates.step(&mut bad, next, DT);
        let mut late = on_a_ramp(&rates);
        let after_gap = rates.step(&mut late, next, DT * f64::from(missing + 1));
        for out in [after_bad, after_gap] {
            assert_eq!(out.status, RateStatus::Good);
            // Rounding of positions below 1 over 2 ms, and e^-20 of the start over tau.
            near(out.motion.velocity, 3.0, 1e-8);
            near(out.motion.acceleration, 0.0, 1e-4);
        }
        assert_eq!(bad.gap(), 0.0);
    }
}

#[test]
fn a_gap_that_is_too_long_starts_again_at_rest() {
    let rates = rates::<f64>();
    let mut bridged = on_a_ramp(&rates);
    let out = rates.step(&mut bridged, 0.0, 9.99 * TIME_CONSTANT);
    assert_eq!(out.status, RateStatus::Good);
    let jump = 50.0;
    for dt in [0.101, 4295.0] {
        let mut state = on_a_ramp(&rates);
        let out = rates.step(&mut state, jump, dt);
        assert_eq!(
            (out.motion, out.status),
            (resting(jump), RateStatus::Settling)
        );
        let next = rates.step(&mut state, jump, DT).status;
        assert_eq!(next, RateStatus::Settling);
    }
    let mut state = on_a_ramp(&rates);
    for _ in 0..101 {
        rates.step(&mut state, f64::NAN, DT);
    }
    assert_eq!(rates.step(&mut state, jump, DT).motion.velocity, 0.0);
    let patient = rates.with_longest_gap(1.0).unwrap();
    let mut state = on_a_ramp(&patient);
    let out = patient.step(&mut state, 0.6 + 3.0 * 0.9, 0.9);
    assert_eq!(out.status, RateStatus::Good);
    near(out.motion.velocity, 3.0, 1e-8);
}

#[test]
fn after_an_unknown_time_the_rates_are_held_until_a_difference_is_known_again() {
    let rates = rates::<f64>();
    for bad_dt in [f64::NAN, f64::INFINITY, -DT] {
        let mut state = on_a_ramp(&rates);
        rates.step(&mut state, 0.603, bad_dt);
        let before = state.motion();
        let out = rates.step(&mut state, 0.606, DT);
        assert_eq!(out.status, RateStatus::Resumed);
        assert_eq!(out.motion.position, 0.606);
        assert_eq!(out.motion.velocity, before.velocity); // 6 mm in one ms it was not
        let out = rates.step(&mut state, 0.609, DT);
        assert_eq!(out.status, RateStatus::Good);
        near(out.motion.velocity, 3.0, 1e-8);
    }
    // A second sample in one tick of the clock: no time has passed.
    let mut state = on_a_ramp(&rates);
    rates.step(&mut state, 0.6, 0.0);
    let out = rates.step(&mut state, 0.603, DT);
    assert_eq!(out.status, RateStatus::Good);
    near(out.motion.velocity, 3.0, 1e-8);
}

#[test]
fn a_counter_that_wraps_gives_the_motion_of_one_that_does_not() {
    let straight = rates::<f64>();
    // Slow enough for less than half a turn a sample; both ways; any range of one period.
    let path = |t: f64| 200.0 + 900.0 * (5.0 * t).sin() + 300.0 * t;
    let times = jittered(3000);
    let expected = run(&straight, &times, path);
    for (period, low) in [(16.0, 0.0), (16.0, -8.0), (64.0, 0.0)] {
        let rates = straight.with_period(period).unwrap();
        let wrapped = |t: f64| low + (path(t) - low).rem_euclid(period);
        let got = run(&rates, &times, wrapped);
        let turns = ((path(times[0]) - wrapped(times[0])) / period).round();
        for (a, b) in got.iter().zip(&expected) {
            // Rounding of 1e3 over tau.
            near(a.position + turns * period, b.position, 1e-11);
            near(a.velocity, b.velocity, 1e-9);
            near(a.acceleration, b.acceleration, 1e-6);
        }
    }
}

#[test]
fn a_counter_that_wraps_within_a_gap_is_unwrapped_too() {
    let rates = rates::<f64>().with_period(1.0).unwrap();
    let mut state = on_a_ramp(&rates); // at 0.6, with 3/s
    for k in 1..=100 {
        rates.step(&mut state, 0.6 + 3.0 * DT * f64::from(k), DT);
    }
    for _ in 0..140 {
        rates.step(&mut state, f64::NAN, DT * 0.5);
    }
    let at = 0.9 + 3.0 * 141.0 * DT * 0.5;
    let out = rates.step(&mut state, at.rem_euclid(1.0), DT * 0.5);
    near(out.motion.position, at, 1e-14);
    near(out.motion.velocity, 3.0, 1e-7);
}

#[test]
fn a_million_turns_cost_a_single_precision_counter_no_velocity() {
    let rates = rates::<f32>();
    let (wrapping, period) = (rates.with_period(4096.0).unwrap(), 4096_u32);
    let (mut on, mut off) = (RatesState::new(), RatesState::new());
    let mut worst = [0.0_f32; 2];
    let per_step = 1500_u32;
    for k in 0..3_000_000_u32 {
        let count = u64::from(k) * u64::from(per_step);
        let counter = (count % u64::from(period)) as f32;
        let good = wrapping.step(&mut on, counter, DT as f32).motion;
        let plain = rates.step(&mut off, count as f32, DT as f32).motion;
        if k > 1000 {
            for (worst, motion) in worst.iter_mut().zip([good, plain]) {
                *worst = worst.max((motion.velocity - 1.5e6).abs());
            }
        }
    }
    // The difference of two counts is exact: what remains is the rounding of the lag, half
    // an ulp (0.06) a product and sum, over a share of 0.1.
    assert!(worst[0] <= 3.0, "{worst:?}");
    // The spacing of floats at 4.5e9 is 512, over 10 ms.
    assert!(worst[1] > 1000.0, "{worst:?}");
    let turns = 3_000_000.0 * f64::from(per_step);
    assert_relative_eq!(f64::from(on.motion().position), turns, max_relative = 1e-6);
}

#[test]
fn a_jump_out_of_the_reach_of_floats_is_held_and_heals_with_the_longest_gap() {
    let rates = rates::<f32>();
    let mut state = RatesState::new();
    rates.step(&mut state, f32::MIN, 0.001);
    for _ in 0..99 {
        let out = rates.step(&mut state, f32::MAX, 0.001);
        assert_eq!(out.status, RateStatus::Held(Fault::Overflow));
        assert_eq!(out.motion.position, f32::MIN);
    }
    let last = [(); 2].map(|()| rates.step(&mut state, f32::MAX, 0.001));
    let settling = last.iter().find(|out| out.status == RateStatus::Settling);
    assert_eq!(settling.unwrap().motion.position, f32::MAX);
}

#[test]
fn parameters_that_make_no_rates_are_refused_by_name() {
    use Error::{NonFinite, OutOfRange};
    for bad in [0.0, -0.0, -1.0] {
        assert_eq!(Rates::try_new(bad), Err(OutOfRange("time_constant")));
        assert_eq!(Rates::for_cutoff(bad), Err(OutOfRange("cutoff")));
        let period = rates::<f64>().with_period(bad);
        assert_eq!(period, Err(OutOfRange("period")));
        let gap = rates::<f64>().with_longest_gap(bad);
        assert_eq!(gap, Err(OutOfRange("longest_gap")));
    }
    for bad in [f64::NAN, f64::MAX] {
        assert_eq!(Rates::try_new(bad), Err(NonFinite("time_constant")));
    }
    for (cutoff, error) in [
        (f64::INFINITY, NonFinite("cutoff")),
        (1e-310, OutOfRange("cutoff")),
    ] {
        assert_eq!(Rates::for_cutoff(cutoff), Err(error));
    }
    assert_eq!(Rates::for_cutoff(f32::MAX), Err(OutOfRange("cutoff")));
}

#[cfg(feature = "serde")]
#[test]
fn a_state_that_was_saved_goes_on_as_it_was_and_a_bad_one_is_refused() {
    let rates = rates::<f64>().with_period(1.0).unwrap();
    reads_back(&rates, &[("0.01", "-0.01")]);
    let mut state = on_a_ramp(&rates);
    rates.step(&mut state, f64::NAN, 0.5);
    let gap = ("\"gap\":0.5", "\"gap\":-0.5");
    let position = ("\"position\":0.6", "\"position\":1e999");
    reads_back(&state, &[gap, position]);
}
