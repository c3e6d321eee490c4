//! The model as a file, `bowden.model/1`, and as bytes.
#![allow(clippy::unwrap_used, clippy::cast_possible_truncation)]

#[path = "shared/mod.rs"]
mod shared;

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState};
use bowden::effect::{Effect, CATALOGUE};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, ModelState, Source, Term};
use bowden::signal::{Derivative, DerivativeState, Plausible, PlausibleState};
use bowden::signal::{Play, PlayState, RampState};
use bowden::transmission::Transmission;
use bowden::Real;
use proptest::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use shared::make;
use std::fmt::Debug;

/// As `bowden close --model-out model.toml` writes it.
const FILE: &str = r#"# Identified by bowden.
schema = "bowden.model/1"
mode = "torque"
channels = ["phi_p", "angle of the joint [rad]"]

[transmission]
gain = 0.952
kappa_eta = 2.29
offset = 0.05
rho = 0.382
sigma = 2.97
n = 1.02

[[terms]]
effect = "stribeck"
source = "angle of the joint [rad]"
origin = -0.25
gain = -0.5

[[terms.shapes]]
name = "v_s"
value = 0.3

[[terms.shapes]]
name = "a"
value = 1.5

[[terms]]
effect = "viscous"
source = "phi_p"
gain = -0.264
shapes = []

[[terms]]
effect = "offset"
source = "input"
gain = 1

[about]
by = "bowden 0.1.0"
records = ["joint.csv"]
cutoff_hz = 5.0

[about.units]
phi_p = "rad"

[[about.not_identified]]
parameter = "n"
because = "its interval is wider than it"
"#;

fn term<T: Real>(name: &str, shapes: &[f64], source: Source, origin: f64, gain: f64) -> Term<T> {
    let shapes: Vec<T> = shapes.iter().map(|&shape| T::from_f64(shape)).collect();
    Term {
        effect: Effect::try_from_name(name, &shapes).unwrap(),
        source,
        origin: T::from_f64(origin),
        gain: T::from_f64(gain),
    }
}

fn cable<T: Real>() -> Transmission<T> {
    let [b, kappa_eta, t0, rho, sigma, n] = [0.952, 2.29, 0.05, 0.382, 2.97, 1.02].map(T::from_f64);
    Transmission::torque(b, kappa_eta, t0, BoucWen::try_new(rho, sigma, n).unwrap()).unwrap()
}

/// What `FILE` says.
fn in_the_file<T: Real>() -> Model<T, 3> {
    let terms = [
        term("stribeck", STRIBECK, Source::Channel(1), -0.25, -0.5),
        term("viscous", &[], Source::Channel(0), 0.0, -0.264),
        term("offset", &[], Source::Input, 0.0, 1.0),
    ];
    Model::try_new(Some(cable()), &terms).unwrap()
}

const STRIBECK: &[f64] = &[0.3, 1.5];

fn refusal<const N: usize>(text: &str) -> String {
    let read = toml::from_str::<Model<f64, N>>(text);
    read.unwrap_err().to_string()
}

/// What is read is what was written, as a file and as JSON.
fn reads_back<S: Serialize + DeserializeOwned + PartialEq + Debug>(value: &S) -> String {
    let json = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<S>(&json).unwrap(), value);
    let written = toml::to_string(value).unwrap();
    assert_eq!(&toml::from_str::<S>(&written).unwrap(), value);
    written
}

#[test]
fn the_file_of_the_lab_is_read_in_both_precisions() {
    assert_eq!(toml::from_str::<Model<f64, 3>>(FILE), Ok(in_the_file()));
    assert_eq!(toml::from_str::<Model<f32, 3>>(FILE), Ok(in_the_file()));
    // More room changes nothing, less is refused.
    let roomy = toml::from_str::<Model<f64, 8>>(FILE).unwrap();
    assert_eq!(roomy.terms(), in_the_file().terms());
    let error = refusal::<2>(FILE);
    assert!(error.contains("too many items"), "{error}");
}

#[test]
fn the_fields_may_come_in_any_order_and_the_term_before_its_channels() {
    let text = r#"{
        "terms": [{
            "gain": -0.5, "source": "b", "origin": 2.0, "effect": "coulomb",
            "shapes": [{"value": 0.01, "name": "v_e"}]
        }],
        "about": {"anything": [1, {"deep": null}]},
        "channels": ["a", "b"],
        "transmission": null,
        "mode": "displacement",
        "schema": "bowden.model/1"
    }"#;
    let coulomb = term("coulomb", &[0.01], Source::Channel(1), 2.0, -0.5);
    let expected = Model::<f64, 1>::try_new(None, &[coulomb]).unwrap();
    let read: Model<f64, 1> = serde_json::from_str(text).unwrap();
    assert_eq!(read, expected);
    // Without a heap in between: borrowed, and from a reader, which owns its texts.
    let read: Model<f64, 1> = serde_json::from_reader(text.as_bytes()).unwrap();
    assert_eq!(read, expected);
}

const TORQUE: &str = "mode = \"torque\"";

/// What is replaced in [`FILE`], by what, and what is said of it.
#[rustfmt::skip]
const BROKEN: &[(&str, &str, &str)] = &[
    ("bowden.model/1", "bowden.model/2", "\"bowden.model/2\" is not the schema \"bowden.model/1\""),
    ("schema = \"bowden.model/1\"\n", "", "missing field `schema`"),
    (TORQUE, "mode = \"twist\"", "unknown variant `twist`, expected `torque` or `displacement`"),
    (TORQUE, "", "missing field `mode`"),
    ("channels = [\"phi_p\", \"angle of the joint [rad]\"]\n", "", "missing field `channels`"),
    ("\"angle of the joint [rad]\"]", "\"angle\"]", "term stribeck: no channel has the name of its source"),
    ("[\"phi_p\", ", "[\"phi_p\", \"phi_p\", ", "two channels have the same name"),
    (TORQUE, "mode = \"torque\"\nauthor = \"me\"", "unknown field `author`"),
    ("rho = 0.382", "rho = -0.382", "transmission: rho is out of range"),
    ("rho = 0.382", "rho = nan", "transmission: rho is not finite"),
    ("n = 1.02", "", "missing field `n`"),
    ("n = 1.02", "n = 1.02\nm = 2", "unknown field `m`"),
    ("\"viscous\"", "\"viscious\"", "\"viscious\" is not an effect of the catalogue"),
    ("\"viscous\"", "\"coulomb\"", "term coulomb: condition not met: there must be one value for each shape"),
    ("name = \"a\"", "name = \"b\"", "term stribeck: a shape must be named a"),
    ("name = \"a\"", "name = \"a_and_quite_a_lot_more\"", "term stribeck: a shape must be named a"),
    ("value = 1.5", "value = 0.0", "term stribeck: a is out of range"),
    ("value = 1.5", "value = 1.5\nunit = \"rad/s\"", "unknown field `unit`"),
    ("origin = -0.25", "origin = inf", "origin is not finite"),
    ("gain = -0.264", "gain = nan", "gain is not finite"),
    ("gain = -0.264", "gain = -0.264\nsize = 1", "unknown field `size`"),
];

#[test]
fn a_file_that_is_not_quite_one_is_refused_with_what_is_wrong() {
    for (good, bad, said) in BROKEN {
        let broken = FILE.replacen(good, bad, 1);
        assert_ne!(broken, FILE);
        let error = refusal::<3>(&broken);
        assert!(error.contains(said), "{bad}: {error}");
    }
    let eight_shapes = "\n[[terms.shapes]]\nname = \"v_e\"\nvalue = 0.01".repeat(8);
    let error = refusal::<3>(&FILE.replacen("shapes = []", &eight_shapes, 1));
    assert!(error.contains("too many items"), "{error}");
}

#[test]
fn as_many_channels_as_a_source_can_count_are_read_and_no_more() {
    let file = |channels: usize, source: usize| {
        let names: Vec<String> = (0..channels).map(|k| format!("\"column {k}\"")).collect();
        format!(
            "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = [{}]\n\n\
             [[terms]]\neffect = \"viscous\"\nsource = \"column {source}\"\ngain = 1.0\n",
            names.join(", ")
        )
    };
    let read = toml::from_str::<Model<f64, 1>>(&file(256, 255)).unwrap();
    assert_eq!(read.terms()[0].source, Source::Channel(255));
    let error = refusal::<3>(&file(257, 0));
    assert!(
        error.contains("too many items") && error.contains("channels = ["),
        "{error}"
    );
}

/// Every effect of the catalogue, on the input and on channels.
fn whole_catalogue<T: Real>() -> Model<T, 64> {
    let of = |(k, name): (usize, &str)| Term {
        effect: make(name),
        source: match k % 3 {
            0 => Source::Input,
            k => Source::Channel(k as u8),
        },
        origin: T::from_f64(0.1 * k as f64),
        gain: T::from_f64(1.0 / 3.0),
    };
    let names = CATALOGUE.iter().map(|info| info.name);
    let terms: Vec<Term<T>> = names.enumerate().map(of).collect();
    Model::try_new(Some(cable()), &terms).unwrap()
}

fn through_files<T: Real + Serialize + DeserializeOwned>() {
    let written = reads_back(&whole_catalogue::<T>());
    assert!(written.starts_with("schema = \"bowden.model/1\"\nmode = \"torque\"\n"));
    assert!(written.contains("channels = [\"channel_0\", \"channel_1\", \"channel_2\"]"));
    let written = reads_back(&Model::<T, 2>::try_new(None, &[]).unwrap());
    assert!(!written.contains("transmission"), "{written}");
}

#[test]
fn every_effect_is_written_to_a_file_and_read_back_to_the_same_bits() {
    through_files::<f64>();
    through_files::<f32>();
}

const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Eight terms: four on channels, six with shapes, two of these with two.
fn eight_terms<T: Real>() -> Model<T, 8> {
    let (p, d) = (Source::Channel(0), Source::Channel(1));
    let terms = [
        term("viscous", &[], Source::Input, 0.1, -0.4),
        term("coulomb", &[0.01], p, 0.1, -0.4),
        term("stribeck", STRIBECK, p, 0.1, -0.4),
        term("inertia", &[], Source::Input, 0.1, -0.4),
        term("ripple", &[12.0, 0.5], d, 0.1, -0.4),
        term("hinge", &[0.2], Source::Input, 0.1, -0.4),
        term("creep", &[1.5], Source::Input, 0.1, -0.4),
        term("load-friction", &[0.02], p, 0.1, -0.4),
    ];
    Model::try_new(Some(cable()), &terms).unwrap()
}

fn bytes<T: Real + Serialize>(model: &Model<T, 8>) -> Vec<u8> {
    let mut room = [0; 512];
    let stored = postcard::to_slice_crc32(model, &mut room, CRC.digest());
    stored.unwrap().to_vec()
}

fn from_bytes<'a, T: Real + Deserialize<'a>>(bytes: &'a [u8]) -> Option<Model<T, 8>> {
    postcard::from_bytes_crc32(bytes, CRC.digest()).ok()
}

/// Every prefix and every flipped bit is refused.
fn nothing_but_the_whole_is_read<T: Real + Serialize + DeserializeOwned>(size: usize) {
    let model = eight_terms::<T>();
    let whole = bytes(&model);
    assert_eq!(whole.len(), size);
    assert_eq!(from_bytes::<T>(&whole), Some(model));
    for end in 0..size {
        assert_eq!(from_bytes::<T>(&whole[..end]), None, "{end} bytes");
    }
    for bit in 0..8 * size {
        let mut bad = whole.clone();
        bad[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(from_bytes::<T>(&bad), None, "bit {bit}");
    }
}

#[test]
fn eight_terms_take_143_bytes_and_a_checksum_that_no_broken_copy_passes() {
    // 30 numbers, 23 bytes that say what they are, and the checksum.
    nothing_but_the_whole_is_read::<f32>(4 * 30 + 23 + 4);
    nothing_but_the_whole_is_read::<f64>(8 * 30 + 23 + 4);
}

#[test]
fn the_compact_form_is_the_one_that_was_stored() {
    // A model in flash outlives a firmware: other bytes are another form.
    let terms = [term("coulomb", &[0.01], Source::Channel(2), 0.5, -0.25)];
    let model = Model::<f32, 1>::try_new(Some(cable()), &terms).unwrap();
    let mut room = [0; 64];
    let stored = postcard::to_slice(&model, &mut room).unwrap();
    let mut expected = vec![1, 0]; // there is a transmission, of torque
    for number in [0.952_f32, 2.29, 0.05, 0.382, 2.97, 1.02] {
        expected.extend(number.to_le_bytes());
    }
    expected.extend([1, 20]); // one term, the catalogue's effect 20: Coulomb
    expected.extend(0.01_f32.to_le_bytes());
    expected.extend([1, 2]); // channel 2
    expected.extend(0.5_f32.to_le_bytes());
    expected.extend((-0.25_f32).to_le_bytes());
    assert_eq!(stored, expected);
    assert_eq!(postcard::from_bytes::<Model<f32, 1>>(&expected), Ok(model));
}

proptest! {
    #[test]
    fn no_bytes_make_a_model_that_its_constructor_would_refuse(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(model) = postcard::from_bytes::<Model<f32, 4>>(&bytes) {
            let again = Model::<f32, 4>::try_new(model.transmission().copied(), model.terms());
            prop_assert_eq!(again, Ok(model));
        }
    }
}

#[test]
fn a_state_is_read_with_the_memories_that_it_lists() {
    let state = ModelState::<f64, 2>::with_eta(0.25).unwrap();
    let written = serde_json::to_string(&state).unwrap();
    let read: ModelState<f64, 2> = serde_json::from_str(&written).unwrap();
    assert_eq!(read, state);
    let beyond = written.replacen("0.25", "1.25", 1);
    assert!(serde_json::from_str::<ModelState<f64, 2>>(&beyond).is_err());
}

/// What was written is read; with one of its numbers not finite it is refused, which else would be
/// refused on every sample, for ever.
fn reads_finite_numbers_only<S: Serialize + DeserializeOwned + PartialEq + Debug>(state: &S) {
    let stored: toml::Value = toml::from_str(&toml::to_string(state).unwrap()).unwrap();
    let read = |stored: &toml::Value| toml::from_str::<S>(&toml::to_string(stored).unwrap());
    assert_eq!(&read(&stored).unwrap(), state);
    let mut paths = Vec::new();
    for (field, value) in stored.as_table().unwrap() {
        match value {
            toml::Value::Float(_) => paths.push(vec![field.as_str()]),
            toml::Value::Table(sum) => {
                let numbers = sum.iter().filter(|(_, value)| value.is_float());
                paths.extend(numbers.map(|(part, _)| vec![field.as_str(), part.as_str()]));
            }
            _ => {}
        }
    }
    assert!(!paths.is_empty());
    for path in paths {
        let mut broken = stored.clone();
        let place = path
            .iter()
            .fold(&mut broken, |place, part| &mut place[*part]);
        *place = f64::NAN.into();
        assert!(read(&broken).is_err(), "{path:?} of {state:?}");
    }
}

#[test]
fn a_stored_state_with_a_number_that_is_not_finite_is_refused() {
    reads_finite_numbers_only(&RampState::at(2.0));
    let mut play = PlayState::new();
    Play::try_new(0.1).unwrap().step(&mut play, 1.0);
    reads_finite_numbers_only(&play);
    let mut plausible = PlausibleState::new();
    let range = Plausible::try_new(-5.0, 5.0).unwrap();
    range.step(&mut plausible, 1.0, 1e-3, true);
    reads_finite_numbers_only(&plausible);
    let (filter, mut rate) = (Derivative::try_new(0.01).unwrap(), DerivativeState::new());
    filter.step(&mut rate, 1.0, 1e-3);
    reads_finite_numbers_only(&rate);
    // One that has seen no sample, in a form that leaves out what is not there.
    assert_eq!(toml::from_str::<PlayState<f64>>(""), Ok(PlayState::new()));
    let law = Adaptive::<f64, 2>::paper();
    let mut state = AdaptiveState::new(&law);
    law.step(&mut state, &AdaptiveInput::new(1e-3, 1.0, 0.5, [0.1, 0.2]));
    reads_finite_numbers_only(&state);
    let mut stored: toml::Table = toml::from_str(&toml::to_string(&state).unwrap()).unwrap();
    let read = |stored: &toml::Table| toml::from_str::<AdaptiveState<f64, 2>>(&stored.to_string());
    assert!(law.is_valid(&read(&stored).unwrap()));
    stored.insert("gap".to_owned(), (-1.0).into());
    assert!(read(&stored).is_err(), "a negative gap");
}
