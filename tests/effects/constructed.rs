//! Effects by their own types, as generated firmware constructs them.

use bowden::effect::*;
use bowden::Error;

#[test]
fn every_effect_with_shapes_is_one_expression_of_its_own_type() -> Result<(), Error> {
    let (a, b) = (0.7_f32, 0.3);
    let constructed = [
        Effect::Coulomb(Coulomb::try_new(a)?),
        Effect::Stribeck(Stribeck::try_new(a, b)?),
        Effect::LoadFriction(LoadFriction::try_new(a)?),
        Effect::Capstan(Capstan::try_new(a, b)?),
        Effect::DriveFriction(DriveFriction::try_new(a)?),
        Effect::BackDriveFriction(BackDriveFriction::try_new(a)?),
        Effect::Hinge(Hinge::try_new(a)?),
        Effect::Gravity(Gravity::try_new(a)?),
        Effect::Ripple(Ripple::try_new(a, b)?),
        Effect::PositionFriction(PositionFriction::try_new(a)?),
        Effect::Backlash(Backlash::try_new(a)?),
        Effect::PlayInSeries(PlayInSeries::try_new(a)?),
        Effect::DeadZone(DeadZone::try_new(a)?),
        Effect::Lag(Lag::try_new(a)?),
        Effect::Creep(Creep::try_new(a)?),
        Effect::Presliding(Presliding::try_new(a)?),
        Effect::PreslidingDahl(PreslidingDahl::try_new(a)?),
        Effect::Degradation(Degradation::try_new(a)?),
        Effect::Pinching(Pinching::try_new(a)?),
        Effect::Pretension(Pretension::try_new(a)?),
        Effect::Temperature(Temperature::try_new(a)?),
        Effect::SaturationUpper(SaturationUpper::try_new(a)?),
        Effect::SaturationLower(SaturationLower::try_new(a)?),
        Effect::Tone(Tone::try_new(a, b)?),
        Effect::Hardening(Hardening::try_new(a, b)?),
        Effect::PowerLaw(PowerLaw::try_new(a)?),
        Effect::CurvePosition(CurvePosition::try_new(a, b)?),
        Effect::CurveVelocity(CurveVelocity::try_new(a, b)?),
    ];
    for effect in constructed {
        let shapes = &[a, b][..effect.shape_names().len()];
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
