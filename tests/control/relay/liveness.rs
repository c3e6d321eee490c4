//! The experiment ends: with a result where the plant oscillates, at the longest time in any case.

use super::*;
use std::f64::consts::PI;

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Three to five lags oscillate under a relay. Thirty periods are enough: the amplitudes of the
    /// start fall by more than half in each.
    #[test]
    fn a_plant_that_oscillates_gives_a_result_in_time(
        lags in prop::collection::vec(-2.0..0.0_f64, 3..6),
        delay in 0.0..1.0_f64, gain in -1.0..1.0_f64, negative: bool, jitter in 0.0..0.5_f64,
    ) {
        let lags: Vec<f64> = lags.iter().map(|exponent| 10.0_f64.powf(*exponent)).collect();
        let sign = if negative { -1.0 } else { 1.0 };
        let [plant, positive] = [sign, 1.0].map(|k| Plant::new(k * 10.0_f64.powf(gain), &lags, delay * lags[0]));
        let (true_gain, w) = positive.ultimate();
        let period = 2.0 * PI / w;
        let settings = RelaySettings {
            amplitude: sign,
            most_deviation: 20.0,
            agreement: 0.05,
            longest_time: 30.0 * period,
            longest_dt: period / 50.0,
            ..usual()
        };
        let sampled = Sampled::every(period / 200.0).jittering(jitter);
        let (out, state) = ended::<f64>(settings, &plant, sampled);
        let Some(it) = state.result() else {
            return Err(TestCaseError::fail(format!("{:?}", out.status)));
        };
        // The describing function, −19 % to +28 %, and the sampling: two samples of 1 % of a radian.
        let share = sign * it.gain / true_gain;
        prop_assert!(0.7 < share && share < 1.35, "{}", share);
        prop_assert!((it.period / period - 1.0).abs() < 0.3, "{:?} {}", it, period);
    }

    /// Whatever is measured, and however bad the samples are, the time is over at the longest time.
    #[test]
    fn anything_else_ends_at_the_longest_time(
        samples in prop::collection::vec((0..6_u8, -12.0..12.0_f32), 50),
        tiny: bool,
    ) {
        let relay = relay::<f32>(|s| (s.longest_time, s.longest_dt, s.most_deviation) = (20.0, 0.1, 11.0));
        let mut state = RelayState::new();
        let (mut time, mut ended_at) = (0.0_f64, None);
        for (kind, measured) in samples.iter().cycle().take(5000) {
            let measured = if *kind == 0 { f32::NAN } else { *measured };
            let dt = match kind {
                1 => f32::NAN,
                2 => -1.0,
                3 => 4295.0,
                4 if tiny => 1e-30,
                _ => 0.05,
            };
            // A dt that is not usable takes the longest one.
            let usable = dt > 0.0 && dt <= 0.1;
            time += if usable { f64::from(dt) } else { 0.1 };
            let before = state.remaining();
            let out = relay.step(&mut state, dt, measured);
            if !state.is_running() {
                ended_at = Some(time);
                break;
            }
            prop_assert!(state.remaining() < before);
            prop_assert!(out.command == 1.0 || out.command == -1.0 || out.command == 0.0);
            // To the rounding of a share of 5e-3: 1e-7 each.
            prop_assert!(time < 20.0 * (1.0 + 1e-5), "{}", time);
        }
        // All 5000 samples last 250 s, but for the tiny ones.
        let all_tiny = tiny && samples.iter().all(|(kind, _)| *kind == 4);
        prop_assert!(ended_at.is_some() || all_tiny);
    }
}

/// The budget is exact: n samples of one dt end the experiment, early by n ticks at most.
#[test]
fn the_longest_time_is_neither_shortened_nor_exceeded() {
    for dt in [1e-4_f32, 1e-3, 0.013] {
        let (relay, mut state) = (relay(|s| s.longest_time = 100.0), RelayState::new());
        let (mut count, mut status) = (0.0, Status::Good);
        while state.is_running() {
            status = relay.step(&mut state, dt, 1.0).status;
            count += 1.0;
        }
        assert_eq!(status, Status::Safe(Fault::NoOscillation));
        let expected = 100.0 / f64::from(dt);
        // n/2³² of the time, and the sample in which it is over; f32 knows a share to 1e-7.
        let late = 1.0 + 2e-7 * expected;
        let early = expected * expected / 4.3e9 + late;
        assert!(
            (expected - early..=expected + late).contains(&count),
            "{count} {expected}"
        );
    }
}

/// Steps of 1e-30 s pass no time that a float of 100 s could show, and yet each takes a tick.
#[test]
fn a_clock_that_hardly_moves_takes_from_the_time() {
    let (relay, mut state) = (relay(|s| s.longest_time = 100.0_f32), RelayState::new());
    for k in 1..1000 {
        relay.step(&mut state, 1e-30, 1.0);
        assert_eq!(state.remaining(), u32::MAX - k);
    }
}

/// A clock that fails for good: each sample takes the longest `dt`, so that 400 of 0.5 s are 200 s.
#[test]
fn samples_without_a_time_take_the_longest_one() {
    let relay = relay(|s| s.fallback = Fallback::try_new(u32::MAX, 0.25).unwrap());
    for dt in [f64::NAN, 0.0, -1.0, 9.0] {
        let mut state = RelayState::new();
        for _ in 0..399 {
            relay.step(&mut state, dt, 0.0);
            assert!(state.is_running());
        }
        let out = relay.step(&mut state, dt, 0.0);
        let ended = Status::Safe(Fault::NoOscillation);
        assert_eq!((out.command, out.status), (0.25, ended));
    }
}
