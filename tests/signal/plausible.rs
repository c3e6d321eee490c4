//! `Plausible` on sensors that are slower than the loop: never too fast while sound, and what a
//! spike can do.

use super::*;

const RATE: f64 = 500.0;

fn with_rate<T: Real>(rate: f64) -> Plausible<T> {
    let range = Plausible::try_new(T::from_f64(-100.0), T::from_f64(100.0)).unwrap();
    range.with_rate(T::from_f64(rate)).unwrap()
}

/// The rate of the signals of this file, plus what the rounding of up to 1000 sums of `dt` in
/// `f32` takes from the time: 1000·6e-8.
fn rated() -> Plausible<f64> {
    with_rate(RATE * 1.0001)
}

/// How many samples of 1 ms with this number are refused until one is taken.
fn refusals(plausible: &Plausible<f64>, state: &mut PlausibleState<f64>, sample: f64) -> usize {
    let steps = (0..1000).take_while(|_| plausible.step(state, sample, DT, true).fault.is_some());
    steps.count()
}

/// A signal that is as fast as the rate allows nearly always: a triangle of ±40.
fn triangle(t: f64) -> f64 {
    let phase = (t * RATE / 80.0).rem_euclid(2.0);
    80.0 * (phase - 1.0).abs() - 40.0
}

/// Samples of a sensor of this period \[s\] that were refused in 5 s of a loop of 1 kHz.
fn refused(plausible: &Plausible<f64>, period: f64, phase: f64) -> usize {
    let mut state = PlausibleState::new();
    (0..5000_u32)
        .filter(|&k| {
            // The last sample of the sensor before this read of the loop.
            let at = ((f64::from(k) * DT - phase) / period + 1e-9).floor();
            let sample = triangle(at * period + phase);
            let out = plausible.step(&mut state, sample, DT, true);
            out.fault.is_some()
        })
        .count()
}

#[test]
fn a_sound_sensor_that_gives_each_number_so_many_times_is_never_refused() {
    for divisor in 1..=100_u32 {
        let period = f64::from(divisor) * DT;
        assert_eq!(refused(&rated(), period, 0.0), 0, "{divisor}");
        let known = rated().with_sample_period(period).unwrap();
        assert_eq!(refused(&known, period, 0.0), 0, "{divisor}");
    }
}

#[test]
fn a_sound_sensor_that_is_not_in_step_with_the_loop_needs_its_sample_period() {
    let mut without = 0;
    for (period, phase) in [
        (0.0025, 0.0),
        (0.0037, 0.0011),
        (0.0101, 0.0),
        (0.0003, 0.0),
    ] {
        let known = rated().with_sample_period(period).unwrap();
        assert_eq!(refused(&known, period, phase), 0, "{period}");
        without += refused(&rated(), period, phase);
    }
    assert!(without > 0);
}

#[test]
fn a_sound_sensor_that_is_slow_is_never_refused_in_single_precision() {
    for divisor in [1, 2, 5, 10_u32] {
        let (plausible, mut state) = (with_rate::<f32>(550.0), PlausibleState::new());
        for k in 0..5000_u32 {
            let t = (k - k % divisor) as f32 * 0.001;
            let y = 40.0 * (12.5 * t).sin(); // 500/s at the steepest
            let fault = plausible.step(&mut state, y, 0.001, true).fault;
            assert_eq!(fault, None, "{divisor} {k}");
        }
    }
}

/// A state after `reads` of one number, 1.0, that came at once after another one.
fn held(plausible: &Plausible<f64>, reads: u32) -> PlausibleState<f64> {
    let mut state = PlausibleState::new();
    plausible.step(&mut state, 0.999, DT, true);
    for _ in 0..reads {
        assert_eq!(plausible.step(&mut state, 1.0, DT, true).fault, None);
    }
    state
}

/// What is believed after one number: up to this distance, and no further.
fn believes(plausible: &Plausible<f64>, state: &PlausibleState<f64>, distance: f64) {
    for sign in [-1.0, 1.0] {
        // The sums of up to 1000 times and the difference of the numbers round by 1e-13.
        for (share, fault) in [(0.999, None), (1.001, Some(Implausible::TooFast))] {
            let mut at = *state;
            let spike = 1.0 + sign * share * distance;
            assert_eq!(plausible.step(&mut at, spike, DT, true).fault, fault);
        }
    }
}

#[test]
fn a_spike_is_believed_as_far_as_the_time_since_the_last_change_allows() {
    for (rate, reads) in [(500.0, 1), (500.0, 10), (10.0, 1000)] {
        let plausible = with_rate(rate);
        // The first read of the number is its change.
        let reach = rate * DT * f64::from(reads);
        believes(&plausible, &held(&plausible, reads), reach);
    }
}

#[test]
fn a_sample_period_bounds_the_spike_that_is_believed_however_long_the_number_was_held() {
    for reads in [1, 10, 1000] {
        for period in [0.001, 0.01] {
            let plausible = rated().with_sample_period(period).unwrap();
            let reach = RATE * 1.0001 * (period + DT);
            believes(&plausible, &held(&plausible, reads), reach);
        }
    }
}

#[test]
fn a_signal_that_has_really_moved_is_taken_up_again_after_its_distance_over_the_rate() {
    for period in [None, Some(0.004)] {
        let own = rated();
        let plausible = period.map_or(own, |period| own.with_sample_period(period).unwrap());
        let mut state = held(&plausible, 1);
        let refusals = refusals(&plausible, &mut state, 61.0);
        // The first sample that is far enough is the one that is taken; its age may spare some.
        let time = 60.0 / (RATE * 1.0001) - period.unwrap_or(0.0);
        assert_eq!(refusals, (time / DT).ceil() as usize - 1);
        assert_eq!(state.last(), Some(61.0));
    }
}

#[test]
fn after_a_believed_spike_the_true_number_returns_within_its_distance_over_the_rate() {
    let plausible = rated();
    let mut state = held(&plausible, 20);
    // 9.5 N·m: within 20 ms of 500 N·m/s, and believed.
    assert_eq!(plausible.step(&mut state, 10.5, DT, true).fault, None);
    let refusals = refusals(&plausible, &mut state, 1.0);
    assert_eq!(refusals, (9.5 / (RATE * 1.0001) / DT).ceil() as usize - 1);
}

#[test]
fn a_stuck_sensor_is_found_after_as_many_repeats_with_a_rate_and_a_period_as_without() {
    let range = Plausible::try_new(-100.0, 100.0)
        .unwrap()
        .with_stuck_after(50);
    let rated = range.with_rate(RATE).unwrap();
    let known = rated.with_sample_period(0.01).unwrap();
    for plausible in [range, rated, known] {
        let mut state = PlausibleState::new();
        plausible.step(&mut state, 0.999, DT, true);
        for repeat in 0..200 {
            let stuck = (repeat >= 50).then_some(Implausible::Stuck);
            assert_eq!(plausible.step(&mut state, 1.0, DT, true).fault, stuck);
        }
        // It comes back with a new number that is within reach of the whole time.
        assert_eq!(plausible.step(&mut state, 50.0, DT, true).fault, None);
    }
}

#[test]
fn a_sample_period_that_is_none_is_refused_by_name() {
    let refused = |period| rated().with_sample_period(period).err();
    for bad in [0.0, -0.0, -1.0] {
        assert_eq!(refused(bad), Some(Error::OutOfRange("sample_period")));
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(refused(bad), Some(Error::NonFinite("sample_period")));
    }
}

proptest! {
    /// Any loop, any jitter of the sensor within its sample period.
    #[test]
    fn a_sound_sensor_with_jitter_is_never_refused(
        reads in prop::collection::vec((0.0002..0.003_f64, any::<bool>()), 10..200),
    ) {
        let period = 0.01;
        let plausible = rated().with_sample_period(period).unwrap();
        let mut state = PlausibleState::new();
        let (mut now, mut measured) = (0.0, 0.0);
        for (dt, is_new) in reads {
            now += dt;
            // A new number at any read, and at the latest when the old one is too old.
            if is_new || now - measured > period {
                measured = now - 0.5 * dt;
            }
            let out = plausible.step(&mut state, triangle(measured), dt, true);
            prop_assert_eq!(out.fault, None);
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn a_stored_sample_period_is_read_back_and_one_that_is_missing_is_none() {
    let known = rated().with_sample_period(0.01).unwrap();
    let own = ("\"sample_period\":0.01", "\"sample_period\":-0.01");
    reads_back(&known, &[own]);
    let stored = serde_json::to_string(&known).unwrap();
    let without = stored.replace("\"sample_period\":0.01,", "");
    assert_ne!(without, stored);
    let read: Plausible<f64> = serde_json::from_str(&without).unwrap();
    assert_eq!(read, rated());
}
