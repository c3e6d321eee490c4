//! What a certificate refuses to be made of.

use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
use bowden::Error;
use bowden_bound::{Interval, Known, PeakContinuous, PeakSampled, PerStep, Plant, Rms, Theorem1};

fn lag() -> AdaptiveSettings<f64, 1> {
    let form = Form::FirstOrder {
        step: 0.001,
        plant_gain: 1.0,
    };
    AdaptiveSettings {
        beta: Estimator::fixed(1.0)
            .within(0.9, 1.1)
            .adapting(2.5e-4, 0.01),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6.25e-3, 0.01),
        theta: [Estimator::fixed(0.0).within(-5.0, 5.0).adapting(5e-4, 0.01)],
        ..AdaptiveSettings::unlimited(form, 24.0, 8.0, 0.2)
    }
}

fn literal() -> AdaptiveSettings<f64, 1> {
    let form = Form::AsPublished {
        time_constant: 0.005,
    };
    AdaptiveSettings { form, ..lag() }
}

fn law(settings: AdaptiveSettings<f64, 1>) -> Adaptive<f64, 1> {
    Adaptive::try_new(settings).unwrap()
}

#[test]
fn each_form_has_its_own_certificates() {
    let plant = Plant::new(1.0, 5.0);
    let not_literal = Error::Inadmissible("the gains must have the form as published");
    assert_eq!(Theorem1::try_new(&law(lag()), &plant), Err(not_literal));
    assert_eq!(Rms::try_new(&law(lag()), &plant), Err(not_literal));
    assert_eq!(
        PeakContinuous::try_new(&law(lag()), &plant),
        Err(not_literal)
    );
    let not_lag = Error::Inadmissible("the gains must have the lag form");
    assert_eq!(PeakSampled::try_new(&law(literal()), &plant), Err(not_lag));
    assert_eq!(PerStep::try_new(&law(literal()), &plant), Err(not_lag));
}

#[test]
fn a_plant_that_is_none_is_named() {
    let at = |plant| PeakSampled::try_new(&law(lag()), &plant).err();
    let good = Plant::new(1.0, 5.0);
    let alpha = Interval {
        low: 0.0,
        high: 1.0,
    };
    assert_eq!(
        at(Plant { alpha, ..good }),
        Some(Error::OutOfRange("alpha"))
    );
    let nan = Plant {
        delta: f64::NAN,
        ..good
    };
    assert_eq!(at(nan), Some(Error::NonFinite("delta")));
    let negative = Plant {
        reference: -1.0,
        ..good
    };
    assert_eq!(at(negative), Some(Error::OutOfRange("reference")));
    let theta = Interval {
        low: 1.0,
        high: 0.0,
    };
    let regressors = [Known {
        theta,
        ..Known::default()
    }];
    assert_eq!(
        at(Plant { regressors, ..good }),
        Some(Error::OutOfRange("theta"))
    );
}

#[test]
fn an_assumption_that_can_be_checked_is_checked() {
    let unmet = |condition| Some(Error::Inadmissible(condition));
    let plant = Plant::new(1.0, 5.0);
    let tight = AdaptiveSettings {
        delta: Estimator::fixed(1.0).within(0.0, 4.0).adapting(0.1, 0.01),
        ..literal()
    };
    assert_eq!(
        Theorem1::try_new(&law(tight), &plant).err(),
        unmet("each box must contain the truth")
    );
    // The RMS certificate aims delta_hat at 4 and pays for the rest.
    assert!(Rms::try_new(&law(tight), &plant).unwrap().target <= 4.0);
    let frozen = AdaptiveSettings {
        frozen: true,
        ..literal()
    };
    let condition = "an estimate must adapt or be the truth";
    let off = Plant {
        alpha: Interval::exactly(0.98),
        ..plant
    };
    assert_eq!(Rms::try_new(&law(frozen), &off).err(), unmet(condition));
    assert!(Rms::try_new(&law(frozen), &plant).is_ok());
    let strong = Plant {
        alpha: Interval::exactly(1.01),
        ..plant
    };
    let condition = "alpha <= plant_gain of the lag form";
    assert_eq!(
        PeakSampled::try_new(&law(lag()), &strong).err(),
        unmet(condition)
    );
    let short = AdaptiveSettings {
        z_limit: 0.01,
        ..lag()
    };
    assert_eq!(
        PeakSampled::try_new(&law(short), &plant).err(),
        unmet("z_limit >= S/lambda")
    );
    let soft = AdaptiveSettings {
        gain: 0.01,
        ..lag()
    };
    assert_eq!(
        PeakSampled::try_new(&law(soft), &plant).err(),
        unmet("k > 1/lambda²")
    );
    let condition = "the boxes must be narrow enough for a finite bound";
    let regressors = [Known {
        magnitude: 1.0,
        ..Known::default()
    }];
    let moving = Plant {
        regressors,
        ..plant
    };
    let wide = AdaptiveSettings {
        theta: [Estimator::free(0.0).adapting(0.1, 0.01)],
        ..lag()
    };
    assert_eq!(
        PeakSampled::try_new(&law(wide), &moving).err(),
        unmet(condition)
    );
    assert!(
        PeakSampled::try_new(&law(wide), &plant).is_ok(),
        "x is always zero"
    );
}
