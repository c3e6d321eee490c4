//! Signal conditioning: what it promises for good samples and for bad ones.

use super::*;

#[test]
fn bad_samples_leave_the_play_and_the_derivative_untouched() {
    let play = Play::try_new(0.2).unwrap();
    let derivative = Derivative::try_new(0.01).unwrap();
    let (mut p, mut d) = (PlayState::new(), DerivativeState::new());
    assert_eq!(play.step(&mut p, f64::NAN), 0.0);
    assert_eq!(p, PlayState::new());
    for k in 0..20 {
        play.step(&mut p, f64::from(k));
        derivative.step(&mut d, f64::from(k), DT);
    }
    let (held_p, held_d) = (p, d);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Some(play.step(&mut p, bad)), held_p.output());
        assert_eq!(derivative.step(&mut d, bad, DT), held_d.rate());
        for dt in [bad, 0.0, -DT] {
            assert_eq!(derivative.step(&mut d, 0.0, dt), held_d.rate());
        }
    }
    assert_eq!((p, d), (held_p, held_d));
}

#[test]
fn the_time_of_a_bad_sample_belongs_to_the_dt_of_the_next_good_one() {
    let derivative = Derivative::try_new(0.0).unwrap();
    for (dt, rate) in [(DT, 20.0), (2.0 * DT, 10.0)] {
        let mut state = DerivativeState::new();
        // 10 a second; the sample at 2 ms is lost, that at 3 ms is good.
        for (x, dt) in [(0.0, DT), (0.01, DT), (f64::NAN, DT), (0.03, dt)] {
            derivative.step(&mut state, x, dt);
        }
        near(state.rate(), rate, 1e-9);
    }
    // `Rates` adds it by itself.
    let rates = Rates::try_new(1e-6).and_then(|own| own.with_longest_gap(0.01));
    let (rates, mut state) = (rates.unwrap(), RatesState::new());
    for position in [0.00, 0.01, f64::NAN, 0.03, 0.04] {
        rates.step(&mut state, position, DT);
    }
    near(state.motion().velocity, 10.0, 1e-6);
}

#[test]
fn the_derivative_starts_without_a_kick_and_the_time_constant_means_the_same_at_every_rate() {
    let derivative = Derivative::try_new(0.02).unwrap();
    for dt in [1e-4, 1e-3, 0.02_f64] {
        let mut state = DerivativeState::new();
        assert_eq!(derivative.step(&mut state, 1e6, dt), 0.0);
        assert_eq!(derivative.step(&mut state, 1e6, dt), 0.0);
        let mut state = DerivativeState::new();
        let steps = (0.02 / dt).round() as u32;
        for k in 0..=steps {
            derivative.step(&mut state, 5.0 * f64::from(k) * dt, dt);
        }
        // One time constant into a ramp of 5/s; rounding only.
        let left = (0.02 / (0.02 + dt)).powi(steps as i32);
        near(state.rate(), 5.0 * (1.0 - left), 1e-9);
        // The implicit lag is late by half a sample: (1 + x)^(-1/x) - e^-1 < x/2·e^-1·1.5.
        let exact = 5.0 * (1.0 - (-1.0_f64).exp());
        near(state.rate(), exact, 5.0 * 0.28 * dt / 0.02);
    }
}

#[test]
fn without_a_time_constant_it_is_the_difference_quotient() {
    // Minus zero is not below zero, so it is accepted; dt/-0.0 is minus infinity.
    for time_constant in [0.0, -0.0_f32] {
        let derivative = Derivative::try_new(time_constant).unwrap();
        let mut state = DerivativeState::new();
        derivative.step(&mut state, 1.0, 0.5);
        assert_eq!(derivative.step(&mut state, 3.0, 0.5), 4.0);
        assert_eq!(derivative.step(&mut state, 2.0, 0.5), -2.0);
    }
    let refused = Derivative::try_new(-1.0);
    assert_eq!(refused, Err(Error::OutOfRange("time_constant")));
}

proptest! {
    #![proptest_config(seeded(256, 3))]

    #[test]
    fn a_clamped_number_is_within(x in prop::num::f32::NORMAL, a in -1e6..1e6_f32, b in -1e6..1e6_f32) {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let got = clamp(x, low, high);
        prop_assert!(low <= got && got <= high);
        prop_assert!(got == x || x < low || x > high);
    }
}
