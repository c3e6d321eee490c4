//! Names, shapes and their ranges.

use super::*;

proptest! {
    #[test]
    fn a_shape_that_is_not_finite_or_not_in_range_is_refused(
        bad in select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
        negative in -10.0..=0.0_f64,
    ) {
        for name in names() {
            let effect = make::<f64>(name);
            for (index, shape) in effect.info().shapes.iter().enumerate() {
                prop_assert_eq!(effect.with_shape(index, bad), Err(Error::NonFinite(shape.name)));
                let refused = effect.with_shape(index, negative) == Err(Error::OutOfRange(shape.name));
                prop_assert_eq!(refused, shape.range == Range::Positive);
            }
        }
    }
}

#[test]
fn every_name_makes_the_effect_that_bears_it() {
    for info in CATALOGUE {
        let effect = make::<f32>(info.name);
        assert_eq!(effect.info(), *info);
        let shapes: Vec<f32> = (0..).map_while(|index| effect.shape(index)).collect();
        assert_eq!(shapes.len(), effect.info().shapes.len());
        assert_eq!(Effect::try_from_name(info.name, &shapes), Ok(effect));
    }
}

#[test]
fn wrong_names_and_wrong_numbers_of_shapes_are_refused() {
    let count = Error::Inadmissible("there must be one value for each shape of the effect");
    for name in ["", "Viscous", "viscous ", "friction", "drag"] {
        let refused = Effect::<f64>::try_from_name(name, &[]);
        assert_eq!(refused, Err(Error::OutOfRange("effect name")));
    }
    for name in names() {
        let effect = make::<f64>(name);
        let number = effect.info().shapes.len();
        let too_many = vec![0.5; number + 1];
        assert_eq!(Effect::try_from_name(name, &too_many), Err(count), "{name}");
        let none = Effect::<f64>::try_from_name(name, &[]);
        assert_eq!(none.err(), (number > 0).then_some(count), "{name}");
        let index = Error::OutOfRange("shape index");
        assert_eq!(effect.with_shape(number, 0.5), Err(index), "{name}");
        assert_eq!(effect.shape(number), None, "{name}");
    }
}

/// Compact forms store an effect's place: what is added comes last, or old files would be read
/// as other effects.
#[test]
fn effects_keep_the_places_that_older_files_have_stored() {
    let place = |name: &str| names().position(|other| other == name);
    let mut seen: Vec<_> = names().collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), CATALOGUE.len(), "none is there twice");
    for (name, at) in [
        ("offset", 0),
        ("crosstalk", 19),
        ("coulomb", 20),
        ("tone", 43),
        ("stretch-linear", 44),
        ("stretch-cubic", 45),
        ("hardening", 46),
        ("power-law", 47),
        ("curve-position", 48),
        ("curve-velocity", 49),
    ] {
        assert_eq!(place(name), Some(at), "{name}");
    }
}

#[test]
fn what_an_effect_reads_tells_output_stages_and_hysteresis() {
    let that = |condition: fn(&Effect<f64>) -> bool| {
        let all = names().filter(|name| condition(&make(name)));
        all.collect::<Vec<_>>()
    };
    assert_eq!(that(Effect::is_output_stage), ["delay", "lag"]);
    assert_eq!(that(Effect::is_input_stage), ["play-in-series"]);
    let eta = [
        "asymmetry-eta",
        "asymmetry-eta-squared",
        "position-hysteresis",
        "rate",
        "rate-symmetric",
        "degradation",
        "pinching",
    ];
    assert_eq!(that(Effect::reads_eta), eta);
}

/// What configs and the model's TOML form rest on.
#[cfg(feature = "serde")]
mod serde {
    use super::{make, names};
    use bowden::effect::{Coulomb, Effect};
    use serde::de::value::{Error, MapDeserializer, StrDeserializer};
    use serde::de::IntoDeserializer;
    use serde::Deserialize;

    #[test]
    fn an_effect_without_shapes_is_its_name() {
        for name in names().filter(|name| make::<f64>(name).info().shapes.is_empty()) {
            let from: StrDeserializer<Error> = name.into_deserializer();
            assert_eq!(Effect::deserialize(from), Ok(make::<f64>(name)));
        }
    }

    #[test]
    fn reading_a_config_goes_through_its_constructor() {
        let read = |v_e: f64| {
            Coulomb::deserialize(MapDeserializer::<_, Error>::new([("v_e", v_e)].into_iter()))
        };
        assert_eq!(read(0.5).unwrap(), Coulomb::try_new(0.5).unwrap());
        for bad in [0.0, -0.5, f64::NAN] {
            assert!(read(bad).is_err());
        }
    }
}
