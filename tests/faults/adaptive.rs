//! The adaptive law.

use super::{law, limits, DT, LONGEST};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fault, Form, OnMissing,
    Status,
};

fn good() -> AdaptiveInput<f64, 1> {
    AdaptiveInput::new(DT, 25.0, 24.5, [0.2])
}

#[test]
fn the_rate_of_the_error_bridges_bad_samples() {
    // An error that rises by 2 N·m/s, with 15 samples lost: the rate after them is still 2.
    let settings = AdaptiveSettings {
        form: Form::AsPublished { time_constant: 0.0 },
        ..law(false, 100.0)
    };
    let law = Adaptive::try_new(settings).unwrap();
    let mut state = AdaptiveState::new(&law);
    for k in 0..200_u32 {
        let mut at = AdaptiveInput::new(DT, 0.0, 2.0 * DT * f64::from(k), [0.0]);
        if (100..115).contains(&k) {
            at.measured = f64::NAN;
        }
        let terms = law.step_with_terms(&mut state, &at).terms;
        if at.measured.is_finite() && k > 1 {
            assert!((terms.error_rate - 2.0).abs() < 1e-9, "{k}: {terms:?}");
        }
    }
}

#[test]
fn a_wrapped_counter_is_no_sample_of_either_form() {
    for lag in [false, true] {
        let law = Adaptive::try_new(law(lag, 100.0)).unwrap();
        let mut state = AdaptiveState::new(&law);
        law.step(&mut state, &good());
        let before = state;
        let wrapped = AdaptiveInput {
            dt: 4295.0,
            ..good()
        };
        let out = law.step(&mut state, &wrapped);
        assert_eq!(out.status, Status::Held(Fault::DtTooLong));
        assert_eq!(out.command, before.command());
        assert_eq!(state.accumulated_error(), before.accumulated_error());
    }
}

#[test]
fn the_lag_form_accepts_no_longer_step_than_it_admits_and_than_was_stated() {
    let admits = |settings: AdaptiveSettings<f64, 1>| {
        let law = Adaptive::try_new(settings).unwrap();
        (law.longest_dt(), law.settings().largest_step().unwrap())
    };
    let (longest, largest) = admits(law(true, 100.0));
    assert_eq!(longest, largest.min(LONGEST));
    let (longest, _) = admits(AdaptiveSettings {
        longest_dt: 1.5 * DT,
        ..law(true, 100.0)
    });
    assert_eq!(longest, 1.5 * DT);
}

#[test]
fn a_nan_encoder_that_may_be_dropped_leaves_the_torque_loop_closed() {
    for lag in [false, true] {
        let law = Adaptive::try_new(AdaptiveSettings {
            missing: [OnMissing::DropRegressor],
            ..law(lag, 100.0)
        })
        .unwrap();
        let mut state = AdaptiveState::new(&law);
        for _ in 0..100 {
            law.step(&mut state, &good());
        }
        let before = state;
        let blind = AdaptiveInput {
            regressors: [f64::NAN],
            ..good()
        };
        let at_zero = AdaptiveInput {
            regressors: [0.0],
            ..good()
        };
        let wanted = law.terms(&state, &at_zero).unlimited;
        let out = law.step(&mut state, &blind);
        assert_eq!(out.status, Status::Degraded(Fault::Regressor(0)));
        assert_eq!(out.command, wanted, "the law without that term");
        assert_ne!(state.accumulated_error(), before.accumulated_error());
        assert_eq!(state.theta_hat(), before.theta_hat());
        assert_eq!(state.beta_hat(), before.beta_hat());
        assert_eq!(state.delta_hat(), before.delta_hat());
        // The torque sensor is not an encoder.
        let deaf = AdaptiveInput {
            measured: f64::NAN,
            ..blind
        };
        let out = law.step(&mut state, &deaf);
        assert_eq!(out.status, Status::Held(Fault::Measured));
    }
}

#[test]
fn fixed_estimates_have_a_box_of_one_point_and_the_lag_form_takes_them() {
    let form = Form::FirstOrder {
        step: DT,
        plant_gain: 1.0,
    };
    let settings = AdaptiveSettings::<f64, 1>::new(
        form,
        24.0,
        8.0,
        0.2,
        limits(60.0),
        LONGEST,
        super::fallback(),
    );
    assert!(Adaptive::try_new(settings).is_ok());
    // An estimate that adapts needs room to.
    let adapting = AdaptiveSettings {
        delta: Estimator::fixed(1.0).adapting(0.1, 0.01),
        ..settings
    };
    let refused = Adaptive::try_new(adapting).unwrap_err().to_string();
    assert!(refused.contains("delta"), "{refused}");
}

#[test]
fn the_lag_reaches_its_target_in_f32_at_any_rate() {
    // beta_hat = 1, delta_hat = 0, e = z = 0: the virtual command is the reference, 50.
    for rate in [1e3_f32, 1e4, 5e4] {
        let lambda = 1.0;
        let form = Form::FirstOrder {
            step: 1.0 / rate,
            plant_gain: 1.0,
        };
        let law = Adaptive::try_new(AdaptiveSettings::<f32, 0>::unlimited(
            form, 24.0, lambda, 0.2,
        ))
        .unwrap();
        let mut state = AdaptiveState::new(&law);
        let at = AdaptiveInput::new(1.0 / rate, 50.0, 50.0, []);
        // 25 time constants: e^-25 of 50 is far below half an ulp of it, 2e-6.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        for _ in 0..(25.0 * rate) as u32 {
            law.step(&mut state, &at);
        }
        assert!(
            (state.command() - 50.0).abs() <= 4e-6,
            "{}",
            state.command()
        );
    }
}
