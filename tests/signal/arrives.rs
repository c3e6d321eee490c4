//! What conditions a signal arrives where that is, in a computed time, after bad samples too.

use super::*;

/// Numbers of every size, near powers of two and on them.
fn target() -> impl Strategy<Value = f64> {
    let size = prop_oneof![
        over_decades(1e-3, 100.0),
        (0_i32..7).prop_map(|k| 2.0_f64.powi(k)),
        ((0_i32..7), -1e-6..1e-6_f64).prop_map(|(k, by)| 2.0_f64.powi(k) * (1.0 + by)),
    ];
    (size, any::<bool>()).prop_map(|(size, sign)| if sign { size } else { -size })
}

/// Steps to a target: never beyond it, never back, and there within the computed time.
fn arrives<T: Real>(
    (from, wanted): (f64, f64),
    (samples, lags): (f64, f64),
    dt: f64,
    bad: bool,
) -> Result<(), TestCaseError> {
    let (from, wanted, dt) = (T::from_f64(from), T::from_f64(wanted), T::from_f64(dt));
    let way = (wanted - from).abs().as_f64();
    prop_assume!(way > 0.0);
    let rate = T::from_f64(way / (samples * dt.as_f64()));
    let ramp = Ramp::try_new(rate, T::from_f64(lags * dt.as_f64()));
    let ramp = ramp
        .and_then(|ramp| ramp.with_longest_dt(T::from_f64(0.1)))
        .unwrap();
    let mut state = RampState::at(from);
    if bad {
        for dt in [T::nan(), -dt, T::zero(), T::infinity(), T::from_f64(100.0)] {
            prop_assert_eq!(ramp.step(&mut state, wanted, dt), from);
        }
        prop_assert_eq!(ramp.step(&mut state, T::nan(), dt), from);
    }
    // The ramp takes the way at its rate, a thousandth more for the rounding of rate·dt. The lag then
    // leaves (tau/(tau + dt))^n of the way, until that is an ulp.
    let digits = -T::epsilon().as_f64().ln();
    // The digits are of the target: a way far longer than it takes as many more.
    let more = 1.0 + (way / wanted.abs().as_f64()).ln().max(9.0);
    let by_lag = (digits + more) / (1.0 + 1.0 / lags.max(1e-9)).ln();
    let most = 1.001 * samples + by_lag.max(0.0) + 3.0;
    let (mut last, mut taken) = (from, 0.0);
    let rises = wanted > from;
    while taken < most {
        let value = ramp.step(&mut state, wanted, dt);
        let is_between = if rises {
            last <= value && value <= wanted
        } else {
            wanted <= value && value <= last
        };
        prop_assert!(is_between, "{last} {value} {wanted}");
        // The rate·dt, and the rounding of what this sample and the one before computed: where the
        // ramp passes zero, its last values are larger than both of these.
        let (moved, reach) = ((value - last).abs(), rate * dt);
        let of = last.abs() + value.abs() + (reach + reach);
        prop_assert!(moved <= reach + T::epsilon() * T::from_f64(2.0) * of);
        (last, taken) = (value, taken + 1.0);
    }
    // The distance of two floats there.
    let ulp = T::from_f64(2.0) * T::epsilon() * wanted.abs();
    prop_assert!((last - wanted).abs() <= ulp, "{last} {wanted} {most}");
    if lags == 0.0 {
        prop_assert_eq!(last, wanted);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn a_ramp_arrives_in_the_computed_time_and_never_passes_its_target(
        from in target(),
        wanted in target(),
        samples in over_decades(0.5, 5000.0),
        lags in prop_oneof![Just(0.0), over_decades(0.01, 300.0)],
        dt in over_decades(1e-5, 0.05),
        bad: bool,
    ) {
        arrives::<f32>((from, wanted), (samples, lags), dt, bad)?;
        arrives::<f64>((from, wanted), (samples, lags), dt, bad)?;
    }
}

/// At 10 kHz and 0.005/s, a sample moves an f32 of 25 by a quarter of its rounding.
#[test]
fn in_f32_a_slow_ramp_arrives_in_the_computed_time() {
    for (from, way) in [(16.0, 0.05), (25.0, -0.03), (30.7, 0.01)] {
        let samples = f64::abs(way) / (0.005 * 1e-4);
        for (lags, bad) in [(0.0, true), (200.0, false)] {
            arrives::<f32>((from, from + way), (samples, lags), 1e-4, bad).unwrap();
        }
    }
}

/// Just below a power of two the floats are twice as dense: what a sum owes from above is more than
/// a half of the distance there.
#[test]
fn a_ramp_that_comes_down_past_a_power_of_two_does_not_pass_its_target() {
    let dense = 2.0_f64.powi(-19);
    for samples in 0..2000 {
        let samples = 2.0 + 0.02 * f64::from(samples);
        let from = 32.0 + 40.0 * dense;
        for below in 1..4 {
            let wanted = 32.0 - f64::from(below) * dense;
            arrives::<f32>((from, wanted), (samples, 0.0), 1e-4, false).unwrap();
        }
    }
}

/// Bad samples of every kind, and good ones that say anything.
fn before() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let position = prop_oneof![4 => -100.0..100.0_f64, 1 => Just(f64::NAN), 1 => Just(1e30)];
    let dt = prop_oneof![
        4 => 1e-4..0.02_f64,
        1 => Just(f64::NAN),
        1 => Just(-0.01),
        1 => Just(0.0),
        1 => Just(40.0),
    ];
    prop::collection::vec((position, dt), 0..30)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// On a ramp the velocity arrives at its slope and the acceleration at zero, whatever was before,
    /// and the rates say that they have settled.
    #[test]
    fn rates_arrive_on_a_ramp_and_are_good_again(
        before in before(),
        tau in over_decades(0.002, 0.5),
        samples in over_decades(0.3, 100.0),
        slope in -20.0..20.0_f64,
    ) {
        let rates = Rates::try_new(tau).unwrap();
        let mut state = RatesState::new();
        for (position, dt) in before {
            if position.is_nan() || position < 1e3 {
                rates.step(&mut state, position, dt);
            }
        }
        let dt = tau / samples;
        let mut at = 0.0;
        let mut step = |state: &mut RatesState<f64>| {
            at += slope * dt;
            rates.step(state, at, dt)
        };
        // Five time constants, a sample at each end, and one that only says where the axis is.
        let settled = (5.0 * samples).floor() + 3.0;
        let mut taken = 0.0;
        while step(&mut state).status != RateStatus::Good {
            taken += 1.0;
            prop_assert!(taken <= settled, "{taken} {settled}");
        }
        // 60 time constants leave 1e-26 of what was; the rest is rounding, of a position up to
        // 70·tau·slope over dt.
        let mut out = step(&mut state);
        for _ in 0..(60.0 * samples) as u32 + 2 {
            out = step(&mut state);
            prop_assert_eq!(out.status, RateStatus::Good);
        }
        let rounding = f64::EPSILON * 70.0 * tau * slope.abs() / dt + 1e-9;
        prop_assert!((out.motion.velocity - slope).abs() <= rounding);
        prop_assert!(out.motion.acceleration.abs() * dt <= 2.0 * rounding);
    }

    /// The output follows at the half-width: once that is used up it moves by all that the input does.
    #[test]
    fn a_play_follows_its_input_once_the_half_width_is_used_up(
        before in before(),
        half_width in over_decades(1e-3, 10.0),
        each in over_decades(1e-4, 1.0),
        rises: bool,
    ) {
        let play = Play::try_new(half_width).unwrap();
        let mut state = PlayState::new();
        let sign = if rises { 1.0 } else { -1.0 };
        play.step(&mut state, 0.0);
        for (input, _) in before {
            if input.abs() < 1e3 || input.is_nan() {
                play.step(&mut state, input);
            }
        }
        let start = state.output().unwrap_or(0.0) + sign * half_width;
        for k in 1..100 {
            let input = start + sign * each * f64::from(k);
            prop_assert_eq!(play.step(&mut state, input), input - sign * half_width);
        }
    }
}

/// Samples at 10 kHz in 3000 s: more than `f32` counts one by one.
const MANY: u32 = 30_000_000;

#[test]
fn a_distant_reading_is_accepted_in_the_end_at_any_rate_of_samples() {
    let check = Plausible::try_new(-1000.0_f32, 1000.0).unwrap();
    let check = check.with_rate(0.01).unwrap();
    let mut state = PlausibleState::new();
    check.step(&mut state, 0.0, 1e-4, true);
    // 30 units at 0.01 units per second are due after 3000 s.
    let is_accepted = |_: &u32| check.step(&mut state, 30.0, 1e-4, true).fault.is_none();
    assert!((0..=MANY).find(is_accepted).is_some());
}
