//! What a certificate refuses to be made of.

use super::*;

fn lag() -> AdaptiveSettings<f64, 1> {
    let own = |x, low, high, gain| Estimator::fixed(x).within(low, high).adapting(gain, 0.01);
    AdaptiveSettings {
        beta: own(1.0, 0.9, 1.1, 2.5e-4),
        delta: own(1.0, 0.0, 7.0, 6.25e-3),
        theta: [own(0.0, -5.0, 5.0, 5e-4)],
        ..AdaptiveSettings::unlimited(first_order(0.001, 1.0), 24.0, 8.0, 0.2)
    }
}

fn literal() -> AdaptiveSettings<f64, 1> {
    with(lag(), |s| s.form = published())
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
    let not_lag = Error::Inadmissible("the gains must be in first-order form");
    assert_eq!(PeakSampled::try_new(&law(literal()), &plant), Err(not_lag));
    assert_eq!(PerStep::try_new(&law(literal()), &plant), Err(not_lag));
}

#[test]
fn a_plant_that_is_none_is_named() {
    type Change = fn(&mut Plant<f64, 1>);
    #[rustfmt::skip]
    let cases: [(Error, Change); 4] = [
        (Error::OutOfRange("alpha"), |p| p.alpha.low = 0.0),
        (Error::NonFinite("delta"), |p| p.delta = f64::NAN),
        (Error::OutOfRange("reference"), |p| p.reference = -1.0),
        (Error::OutOfRange("theta"), |p| p.regressors[0].theta.low = 1.0),
    ];
    for (error, spoil) in cases {
        let plant = with(Plant::new(1.0, 5.0), spoil);
        assert_eq!(PeakSampled::try_new(&law(lag()), &plant).err(), Some(error));
    }
}

#[test]
fn an_assumption_that_can_be_checked_is_checked() {
    let unmet = |condition| Some(Error::Inadmissible(condition));
    let plant = Plant::new(1.0, 5.0);
    let with_alpha = |alpha| with(plant, |p| p.alpha = Interval::exactly(alpha));
    let narrow = Estimator::fixed(1.0).within(0.0, 4.0).adapting(0.1, 0.01);
    let tight = with(literal(), |s| s.delta = narrow);
    let error = Theorem1::try_new(&law(tight), &plant).err();
    assert_eq!(error, unmet("each box must contain the truth"));
    // The RMS certificate aims delta_hat at 4 and pays for the rest.
    assert!(Rms::try_new(&law(tight), &plant).unwrap().target <= 4.0);
    let frozen = law(with(literal(), |s| s.frozen = true));
    let off = Rms::try_new(&frozen, &with_alpha(0.98)).err();
    assert_eq!(off, unmet("an estimate must adapt or be the truth"));
    assert!(Rms::try_new(&frozen, &plant).is_ok());
    let moving = with(plant, |p| p.regressors[0].magnitude = 1.0);
    let wide = with(lag(), |s| {
        s.theta = [Estimator::free(0.0).adapting(0.1, 0.01)]
    });
    let narrow = "the boxes must be narrow enough for a finite bound";
    for (settings, plant, condition) in [
        (
            lag(),
            with_alpha(1.01),
            "alpha <= plant_gain of the first-order form",
        ),
        (
            with(lag(), |s| s.z_limit = 0.01),
            plant,
            "z_limit >= S/lambda",
        ),
        (with(lag(), |s| s.gain = 0.01), plant, "k > 1/lambda²"),
        (wide, moving, narrow),
    ] {
        let error = PeakSampled::try_new(&law(settings), &plant).err();
        assert_eq!(error, unmet(condition));
    }
    let without = PeakSampled::try_new(&law(wide), &plant);
    assert!(without.is_ok(), "x is always zero");
}
