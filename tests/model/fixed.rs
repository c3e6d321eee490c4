//! The model whose effects are types: the numbers of the model that holds any effect.

use super::*;
use std::collections::BTreeSet;

/// A tuple of terms in turn on the input and on two channels, each from an origin of its own.
macro_rules! terms {
    ($($effect:expr),+ $(,)?) => {{
        let mut place = 0_u8;
        ($(
            {
                place += 1;
                let source = match place % 3 {
                    0 => Source::Input,
                    channel => Source::Channel(channel - 1),
                };
                let (origin, gain) = (T::from_f64(0.1 * f64::from(place)), T::from_f64(1.3 - 0.2 * f64::from(place)));
                Term { effect: $effect, source, origin, gain }
            },
        )+)
    }};
}

/// The sum's effects without shapes, and an output stage before its turn.
fn plain<T: Real>() -> impl Terms<T, 16> {
    terms![
        Offset,
        Gain,
        Viscous,
        Delay,
        DragQuadratic,
        DragCubic,
        AsymmetryViscous,
        AsymmetryDrag,
        AsymmetryEta,
        AsymmetryEtaSquared,
        Inertia,
        StiffnessLinear,
        StiffnessQuadratic,
        StiffnessCubic,
        StiffnessProgressive,
        PositionHysteresis,
    ]
}

/// With two output stages and an input stage among the others.
fn staged<T: Real>() -> Result<impl Terms<T, 16>, Error> {
    let one = T::from_f64(0.7);
    Ok(terms![
        Lag::try_new(one)?,
        Rate,
        RateSymmetric,
        PlayInSeries::try_new(one)?,
        Drift,
        Crosstalk,
        Coulomb::try_new(one)?,
        Stribeck::try_new(one, one)?,
        LoadFriction::try_new(one)?,
        Capstan::try_new(one, one)?,
        DriveFriction::try_new(one)?,
        BackDriveFriction::try_new(one)?,
        Delay,
        Hinge::try_new(one)?,
        Gravity::try_new(one)?,
        Ripple::try_new(one, one)?,
    ])
}

/// With memories of their own.
fn remembering<T: Real>() -> Result<impl Terms<T, 16>, Error> {
    let one = T::from_f64(0.7);
    Ok(terms![
        PositionFriction::try_new(one)?,
        Backlash::try_new(one)?,
        DeadZone::try_new(one)?,
        Creep::try_new(one)?,
        Presliding::try_new(one)?,
        PreslidingDahl::try_new(one)?,
        Degradation::try_new(one)?,
        Pinching::try_new(one)?,
        Pretension::try_new(one)?,
        Temperature::try_new(one)?,
        SaturationUpper::try_new(one)?,
        SaturationLower::try_new(one)?,
        Tone::try_new(one, one)?,
        Viscous,
        StretchLinear,
        StretchCubic,
    ])
}

/// What there was no room for above.
fn others<T: Real>() -> Result<impl Terms<T, 4>, Error> {
    let one = T::from_f64(0.7);
    Ok(terms![
        Hardening::try_new(one, one)?,
        PowerLaw::try_new(one)?,
        CurvePosition::try_new(-one, one)?,
        CurveVelocity::try_new(-one, one)?
    ])
}

/// Nothing that is added to the sum: an input stage and two output stages.
fn stages<T: Real>() -> Result<impl Terms<T, 3>, Error> {
    let one = T::from_f64(0.7);
    Ok(terms![
        Delay,
        PlayInSeries::try_new(one)?,
        Lag::try_new(one)?
    ])
}

/// Steps both models over the rows, and asks them for the same bits; `gain` is the cable's, where
/// there is one.
fn same<T: Real, const N: usize, L: Terms<T, N>>(terms: L, rows: &[[f64; 8]], gain: Option<f64>) {
    let transmission = gain.map(cable_of_gain);
    let fixed = FixedModel::try_new(transmission, terms).unwrap();
    let any = fixed.to_model();
    let (mut a, mut b) = (ModelState::new(), ModelState::new());
    for row in rows {
        let [dt, x, v, acceleration, y, w, load, z] = row.map(T::from_f64);
        let motion = |position, velocity| Motion {
            position,
            velocity,
            acceleration,
        };
        let channels = [motion(y, w), motion(z, v)];
        let at = Sample {
            dt,
            input: motion(x, v),
            load,
            channels: &channels,
        };
        assert_eq!(fixed.accepts(&at), any.accepts(&at));
        let (mut own, mut others) = (vec![], vec![]);
        let output = fixed.step_with(&mut a, &at, |index, share| own.push((index, share)));
        let same = any.step_with(&mut b, &at, |index, share| others.push((index, share)));
        assert_eq!((output, own, a), (same, others, b));
        assert!(output.is_finite());
    }
}

/// Any number, now and then one that is none or too large for arithmetic.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![20 => -2.0..2.0_f64, 1 => prop::num::f64::ANY]
}

fn row() -> impl Strategy<Value = [f64; 8]> {
    let dt = prop_oneof![20 => 0.001..0.02_f64, 1 => prop::num::f64::ANY];
    (dt, prop::array::uniform7(number()))
        .prop_map(|(dt, [a, b, c, d, e, f, g])| [dt, a, b, c, d, e, f, g])
}

proptest! {
    #[test]
    fn it_has_the_bits_of_the_model_that_holds_any_effect(
        rows in prop::collection::vec(row(), 1..40),
        with in prop_oneof![Just(None), Just(Some(0.9)), Just(Some(3.0))],
    ) {
        same_in::<f64>(&rows, with);
        same_in::<f32>(&rows, with);
    }
}

fn same_in<T: Real>(rows: &[[f64; 8]], gain: Option<f64>) {
    same::<T, 16, _>(plain(), rows, gain);
    same::<T, 16, _>(staged().unwrap(), rows, gain);
    same::<T, 16, _>(remembering().unwrap(), rows, gain);
    same::<T, 4, _>(others().unwrap(), rows, gain);
    same::<T, 3, _>(stages().unwrap(), rows, gain);
}

#[test]
fn an_output_that_overflows_where_no_effect_is_added_to_it_is_finite() {
    let rows = [0.01, 2e38, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    same::<f32, 3, _>(stages().unwrap(), &[rows, rows], Some(3.0));
}

#[test]
fn the_three_lists_above_hold_the_whole_catalogue() {
    fn names<const N: usize>(terms: impl Terms<f64, N>) -> Vec<&'static str> {
        let model = FixedModel::try_new(None, terms).unwrap().to_model();
        let effects = model.terms().iter().map(|term| term.effect);
        let name = |effect: Effect<f64>| {
            // Made by its own type, as generated firmware does, it is the one of its name.
            let shapes: Vec<f64> = (0..).map_while(|index| effect.shape(index)).collect();
            let named = Effect::try_from_name(effect.name(), &shapes);
            assert_eq!(named, Ok(effect));
            effect.name()
        };
        effects.map(name).collect()
    }
    let all = [
        names(plain()),
        names(staged().unwrap()),
        names(remembering().unwrap()),
        names(others().unwrap()),
    ];
    let catalogue: BTreeSet<&str> = CATALOGUE.iter().map(|info| info.name).collect();
    assert_eq!(BTreeSet::from_iter(all.concat()), catalogue);
}

#[test]
fn what_is_not_finite_is_refused_by_its_name() {
    let source = Source::Input;
    let build = |origin, gain| {
        let viscous = Term {
            effect: Viscous,
            source,
            origin,
            gain,
        };
        FixedModel::try_new(None, (viscous,)).map(|model| *model.terms())
    };
    assert!(build(0.0, 1.0).is_ok());
    assert_eq!(build(f64::NAN, 1.0), Err(Error::NonFinite("origin")));
    assert_eq!(build(0.0, f64::INFINITY), Err(Error::NonFinite("gain")));
}
