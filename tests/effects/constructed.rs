//! Effects by their own types, as generated firmware constructs them.

use bowden::effect::*;
use bowden::Error;

#[test]
fn every_effect_with_shapes_is_one_expression_of_its_own_type() -> Result<(), Error> {
    let (a, b) = (0.7_f32, 0.3);
    let constructed: [Effect<f32>; 28] = [
        Coulomb::try_new(a)?.into(),
        Stribeck::try_new(a, b)?.into(),
        LoadFriction::try_new(a)?.into(),
        Capstan::try_new(a, b)?.into(),
        DriveFriction::try_new(a)?.into(),
        BackDriveFriction::try_new(a)?.into(),
        Hinge::try_new(a)?.into(),
        Gravity::try_new(a)?.into(),
        Ripple::try_new(a, b)?.into(),
        PositionFriction::try_new(a)?.into(),
        Backlash::try_new(a)?.into(),
        PlayInSeries::try_new(a)?.into(),
        DeadZone::try_new(a)?.into(),
        Lag::try_new(a)?.into(),
        Creep::try_new(a)?.into(),
        Presliding::try_new(a)?.into(),
        PreslidingDahl::try_new(a)?.into(),
        Degradation::try_new(a)?.into(),
        Pinching::try_new(a)?.into(),
        Pretension::try_new(a)?.into(),
        Temperature::try_new(a)?.into(),
        SaturationUpper::try_new(a)?.into(),
        SaturationLower::try_new(a)?.into(),
        Tone::try_new(a, b)?.into(),
        Hardening::try_new(a, b)?.into(),
        PowerLaw::try_new(a)?.into(),
        CurvePosition::try_new(a, b)?.into(),
        CurveVelocity::try_new(a, b)?.into(),
    ];
    for effect in constructed {
        let shapes = &[a, b][..effect.info().shapes.len()];
        assert_eq!(Effect::try_from_name(effect.name(), shapes)?, effect);
    }
    let is_plain = |info: &&&Info| Effect::<f32>::try_from_name(info.name, &[]).is_ok();
    let shaped: Vec<_> = CATALOGUE.iter().filter(|info| !is_plain(info)).collect();
    assert_eq!(shaped.len(), constructed.len());
    for (info, effect) in shaped.iter().zip(constructed) {
        assert_eq!(info.name, effect.name());
    }
    Ok(())
}
