//! Velocity from the time between counts: constant speeds, stops, reversals, a slow sine.

use super::*;

const TIME_CONSTANT: f64 = 0.01;

/// Of a counter that counts ones; stopped after so many seconds.
fn stopping(longest_gap: f32) -> EdgeVelocity<f32> {
    EdgeVelocity::try_new(1.0, TIME_CONSTANT as f32, longest_gap).unwrap()
}

fn edges() -> EdgeVelocity<f32> {
    stopping(3.0).with_period(4096.0).unwrap()
}

fn counter(position: f64) -> f32 {
    position.floor().rem_euclid(4096.0) as f32
}

#[test]
fn a_constant_speed_has_the_error_that_the_docs_state_from_half_a_count_a_second_on() {
    for speed in [
        0.5_f64, 1.0, 7.3, 20.0, 99.0, 333.0, 500.0, 700.0, 951.0, 999.0, 1000.0, 1001.0, 1537.0,
        20e3,
    ] {
        for signed in [speed, -speed] {
            let mut state = EdgeVelocityState::new();
            let (mut worst, mut seen) = (0.0_f64, 0);
            // Four counts or a second, whatever is longer, to start with.
            let start = (4.0 / speed).max(1.0);
            let samples = ((2.0 * start) / DT) as u32;
            for k in 0..samples {
                let t = f64::from(k) * DT;
                let out = edges().step(&mut state, counter(signed * t + 0.37), DT as f32);
                if t > start {
                    assert_eq!(out.status, RateStatus::Good, "{signed} {t}");
                    worst = worst.max((f64::from(out.velocity) - signed).abs());
                    seen += 1;
                }
            }
            assert!(seen > 900);
            let by_time = speed * DT / (1.0 - speed * DT);
            let by_lag = DT / TIME_CONSTANT * (1.0 / (speed * DT)).min(1.0);
            let bound = if by_time > 0.0 {
                by_time.min(by_lag)
            } else {
                by_lag
            };
            // Sums of up to 2000 times in f32 and the lag's roundings, which its pole of 0.9
            // adds up to ten.
            let rounding = 2000.0 * 6e-8 * (0.5_f64).max(20.0 / speed).min(1.0) + 1e-6;
            assert!(
                worst <= speed * (bound + rounding),
                "{signed}: {worst} {bound}"
            );
        }
    }
}

#[test]
fn a_stop_follows_the_bound_down_and_is_zero_after_the_longest_gap() {
    for speed in [20.0, 1234.0] {
        let (velocity, mut state) = (stopping(0.5), EdgeVelocityState::new());
        let position = |k: i32| (speed * f64::from(k) * DT).floor();
        for k in 0..1000 {
            velocity.step(&mut state, position(k) as f32, DT as f32);
        }
        let last = position(999);
        let last_count = (0..1000).rev().find(|k| position(*k) < last).unwrap();
        for k in 1000..2000 {
            let out = velocity.step(&mut state, last as f32, DT as f32);
            let since = f64::from(k - last_count - 1) * DT;
            assert!(f64::from(out.velocity) * since <= 1.0 + 1e-5);
            // One sample for the sum of 500 times in f32.
            if since > 0.5 + DT {
                assert_eq!((out.velocity, out.status), (0.0, RateStatus::Stopped));
            } else if since < 0.5 - DT {
                assert_eq!(out.status, RateStatus::Good);
                assert!(out.velocity > 0.0);
            }
        }
    }
}

#[test]
fn after_a_stop_the_second_count_gives_the_speed_again() {
    let (velocity, mut state) = (stopping(0.2), EdgeVelocityState::new());
    for k in 0..4000_u32 {
        // 20 counts/s, a second of rest, and again.
        let t = f64::from(k) * DT;
        let position = 20.0 * (t.min(1.0) + (t - 2.0).max(0.0));
        let out = velocity.step(&mut state, (position + 0.001).floor() as f32, DT as f32);
        if t > 2.0 + 2.0 / 20.0 + 2.0 * DT {
            // e^(-50 ms/10 ms) of the first count after the rest, and a sample of fifty.
            near(f64::from(out.velocity), 20.0, 20.0 * (0.0068 + 0.0205));
        }
    }
}

#[test]
fn dither_of_one_count_is_no_speed() {
    for samples in [1, 3, 10_u32] {
        let mut state = EdgeVelocityState::new();
        for k in 0..1000_u32 {
            let position = (k / samples % 2) as f32;
            let out = edges().step(&mut state, position, DT as f32);
            assert_eq!(out.velocity, 0.0);
        }
    }
    // Behind a motion it fades with the lag: no count adds to it.
    let mut state = EdgeVelocityState::new();
    for k in 0..100_u32 {
        edges().step(&mut state, k as f32, DT as f32);
    }
    let before = state.velocity();
    for k in 0..100_u32 {
        edges().step(&mut state, 98.0 + (k % 2) as f32, DT as f32);
    }
    assert!(
        state.velocity().abs() <= before * (-9.8_f32).exp(),
        "{state:?}"
    );
}

#[test]
fn a_reversal_takes_one_count_off_the_way_that_was_counted() {
    // Lines at 1, 2, 3: up past 3, back past 3 and 2 after 40 ms: one count in 40 ms.
    let mut state = EdgeVelocityState::new();
    for position in 0..4 {
        edges().step(&mut state, position as f32, 0.04);
    }
    let out = edges().step(&mut state, 1.0, 0.04);
    let kept = (-0.04_f64 / TIME_CONSTANT).exp();
    let expected = 25.0 * kept - 25.0 * (1.0 - kept);
    // 25·6e-8 and the lag's share.
    near(f64::from(out.velocity), expected, 1e-5);
}

#[test]
fn a_slow_sine_of_the_speed_is_late_by_what_the_docs_state() {
    for (mean, time_constant) in [
        (20.0_f64, 0.001_f64),
        (20.0, 0.03),
        (200.0, 0.01),
        (5000.0, 0.01),
    ] {
        let velocity = EdgeVelocity::try_new(1.0, time_constant, 3.0).unwrap();
        let mut state = EdgeVelocityState::new();
        let (f, depth) = (0.05, 0.02);
        let w = TAU * f;
        let (mut re, mut im) = (0.0, 0.0);
        for k in 0..80_000_u32 {
            let t = f64::from(k) * 0.5 * DT;
            // The integral of mean·(1 + depth·sin(w·t)), well above zero.
            let position = mean * (t + depth / w * (1.0 - (w * t).cos()));
            let out = velocity.step(&mut state, position.floor(), 0.0005);
            if t >= 20.0 {
                re += out.velocity * (w * t).sin();
                im += out.velocity * (w * t).cos();
            }
        }
        let (gain, late) = (re.hypot(im) / 20_000.0 / (mean * depth), -im.atan2(re) / w);
        let between = (1.0 / mean).max(0.0005);
        let q = (-between / time_constant).exp();
        let exact = between * (0.5 + q / (1.0 - q)) + 0.5 * between;
        // One sample of the loop, and the bound, which spares deceleration a share of the time
        // that is like the depth.
        near(late, exact, 0.0005 + 2.0 * depth * exact);
        // The time of a count is known to a share like the depth: over 400 counts and more that
        // averages to a twentieth of it. The gain itself is 1 − (w·late)²/2.
        near(gain, 1.0, 0.05);
    }
}

#[test]
fn bad_samples_hold_the_velocity_and_their_time_counts() {
    let run = |bad: &[(f32, f32, Fault)]| {
        let mut state = EdgeVelocityState::new();
        for k in 0..=10 {
            edges().step(&mut state, k as f32, 0.05);
        }
        let before = state.velocity();
        for &(position, dt, fault) in bad {
            let out = edges().step(&mut state, position, dt);
            let held = RateStatus::Held(fault);
            assert_eq!((out.velocity, out.status), (before, held));
        }
        state
    };
    let nan = f32::NAN;
    let is_twenty = |state: &mut EdgeVelocityState<f32>, position, dt| {
        let out = edges().step(state, position, dt);
        assert_eq!(out.status, RateStatus::Good);
        near(f64::from(out.velocity), 20.0, 1e-4);
    };
    // 20 counts/s; 40 of the 50 ms are bad.
    let mut state = run(&[(nan, 0.02, Fault::Position), (nan, 0.02, Fault::Position)]);
    is_twenty(&mut state, 11.0, 0.01);
    // A time that nobody knows: the next count starts again, the one after it is good.
    for (dt, fault) in [(nan, Fault::Dt), (-1.0, Fault::DtNotPositive)] {
        let mut state = run(&[(11.0, dt, fault)]);
        let before = state.velocity();
        let out = edges().step(&mut state, 13.0, 0.01);
        assert_eq!((out.velocity, out.status), (before, RateStatus::Settling));
        is_twenty(&mut state, 14.0, 0.05);
    }
    is_twenty(&mut run(&[(11.0, 0.0, Fault::DtNotPositive)]), 11.0, 0.05);
}

#[test]
fn a_counter_that_wraps_has_the_speed_of_one_that_does_not() {
    let plain = EdgeVelocity::try_new(1.0_f64, TIME_CONSTANT, 3.0).unwrap();
    let wrapping = plain.with_period(64.0).unwrap();
    let (mut a, mut b) = (EdgeVelocityState::new(), EdgeVelocityState::new());
    for k in 0..5000_u32 {
        let t = f64::from(k) * DT;
        let position = (900.0 * (2.0 * t).sin()).floor();
        let plain = plain.step(&mut a, position, DT);
        let wrapped = wrapping.step(&mut b, position.rem_euclid(64.0), DT);
        assert_eq!(plain, wrapped);
    }
}

#[test]
fn settings_that_make_no_velocity_are_refused_by_name() {
    let new = EdgeVelocity::<f64>::try_new;
    for bad in [0.0, -1.0] {
        assert_eq!(new(bad, 1.0, 1.0), Err(Error::OutOfRange("count")));
        assert_eq!(new(1.0, bad, 1.0), Err(Error::OutOfRange("time_constant")));
        assert_eq!(new(1.0, 1.0, bad), Err(Error::OutOfRange("longest_gap")));
        let period = new(1.0, 1.0, 1.0).unwrap().with_period(bad);
        assert_eq!(period, Err(Error::OutOfRange("period")));
    }
    assert_eq!(new(f64::NAN, 1.0, 1.0), Err(Error::NonFinite("count")));
}

#[cfg(feature = "serde")]
#[test]
fn a_state_that_was_saved_goes_on_as_it_was_and_a_bad_one_is_refused() {
    reads_back(&edges(), &[("\"count\":1.0", "\"count\":-1.0")]);
    let mut state = EdgeVelocityState::new();
    for k in 0..5 {
        edges().step(&mut state, k as f32, 0.05);
    }
    let stored = serde_json::to_string(&state).unwrap();
    reads_back(&state, &[("\"last\":4.0", "\"last\":1e999")]);
    // A gap that no run leads to: the velocity stays a number, and is right again at the next
    // count but one (e^-5 of what the first made of it).
    let negative = stored.replace("\"gap\":0.0", "\"gap\":-1.0");
    assert_ne!(negative, stored);
    let mut odd: EdgeVelocityState<f32> = serde_json::from_str(&negative).unwrap();
    assert!(edges().step(&mut odd, 3.0, 0.05).velocity.is_finite());
    edges().step(&mut odd, 2.0, 0.05);
    let velocity = edges().step(&mut odd, 1.0, 0.05).velocity;
    near(f64::from(velocity), -20.0, 20.0 * 0.01);
}
