//! One law at a time: PID and the adaptive one.

use super::*;

#[test]
fn the_rate_of_the_error_bridges_bad_samples() {
    // An error that rises by 2 N·m/s, with 15 samples lost: the rate after them is still 2.
    let form = Form::AsPublished { time_constant: 0.0 };
    let law = Adaptive::try_new(with(law(false), |s| s.form = form)).unwrap();
    let mut state = AdaptiveState::new(&law);
    for k in 0..200_u32 {
        let is_lost = (100..115).contains(&k);
        let y = if is_lost {
            f64::NAN
        } else {
            2.0 * DT * f64::from(k)
        };
        let at = AdaptiveInput::new(DT, 0.0, y, [0.0]);
        let terms = law.step_with_terms(&mut state, &at).terms;
        if !is_lost && k > 1 {
            near(terms.error_rate, 2.0, 1e-9);
        }
    }
}

#[test]
fn the_lag_form_accepts_no_longer_step_than_it_admits_and_than_was_stated() {
    for longest_dt in [LONGEST, 1.5 * DT] {
        let [_, law] = forms(|s| s.longest_dt = longest_dt);
        let largest = law.settings().largest_step().unwrap();
        assert_eq!(law.longest_dt(), largest.min(longest_dt));
        assert!(longest_dt == LONGEST || law.longest_dt() == longest_dt);
    }
}

#[test]
fn fixed_estimates_have_a_box_of_one_point_and_the_lag_form_takes_them() {
    let form = law(true).form;
    let fixed =
        AdaptiveSettings::<f64, 1>::new(form, 24.0, 8.0, 0.2, limits(60.0), LONGEST, fallback());
    assert!(Adaptive::try_new(fixed).is_ok());
    // An estimate that adapts needs room to.
    let adapting = with(fixed, |s| {
        s.delta = Estimator::fixed(1.0).adapting(0.1, 0.01)
    });
    let refused = Adaptive::try_new(adapting).unwrap_err().to_string();
    assert!(refused.contains("delta"), "{refused}");
}

#[test]
fn the_lag_reaches_its_target_in_f32_at_any_rate() {
    // beta_hat = 1, delta_hat = 0, e = z = 0: the virtual command is the reference, 50.
    for rate in [1e3_f32, 1e4, 5e4] {
        let (step, plant_gain) = (1.0 / rate, 1.0);
        let form = Form::FirstOrder { step, plant_gain };
        let law = Adaptive::try_new(AdaptiveSettings::<f32, 0>::unlimited(form, 24.0, 1.0, 0.2));
        let law = law.unwrap();
        let mut state = AdaptiveState::new(&law);
        // 25 time constants: e^-25 of 50 is far below half an ulp of it, 2e-6.
        for _ in 0..(25.0 * rate) as u32 {
            law.step(&mut state, &AdaptiveInput::new(step, 50.0, 50.0, []));
        }
        near(f64::from(state.command()), 50.0, 4e-6);
    }
}

#[test]
fn a_gap_of_unknown_length_gives_no_rate() {
    // The signal moves by 1 while the clock is lost: over 1 ms that would be a rate of 1000.
    let pid = pid(|s| s.k_d = 1.0);
    for lost in [f64::NAN, -1.0, 4295.0] {
        let mut state = PidState::new();
        for (dt, y) in [(DT, 0.0), (lost, 0.5), (DT, 1.0)] {
            pid.step(&mut state, &PidInput::new(dt, 0.0, y));
        }
        assert_eq!(state.rate(), 0.0, "{lost}");
        pid.step(&mut state, &PidInput::new(DT, 0.0, 1.001));
        near(state.rate(), 1.0, 1e-9); // 0.001 in 1 ms, unfiltered
    }
}
