//! Any bytes into `bowden_model_load`: a model of every effect, and what is none.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
// Its bad samples are for the other tests.
#[allow(dead_code)]
mod signal;

use bowden::*;
use core_bowden::effect::Motion;
use core_bowden::effect::{Effect, CATALOGUE};
use core_bowden::hysteresis::BoucWen;
use core_bowden::model::{Model, ModelState, Sample, Source, Term};
use core_bowden::transmission::Transmission;
use objects::blank;
use signal::Signal;
use std::ffi::CStr;
use std::ptr::null_mut;

const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// An effect of the catalogue, with as many shapes as it has.
fn effect(name: &str) -> Effect<f32> {
    let of = |count: usize| Effect::try_from_name(name, &vec![0.5; count]);
    (0..4).find_map(|count| of(count).ok()).unwrap()
}

#[test]
fn a_model_of_every_effect_loads_and_gives_the_crates_numbers() {
    assert!(CATALOGUE.len() > 40, "{}", CATALOGUE.len());
    let shape = BoucWen::try_new(0.5, 0.6, 1.5).unwrap();
    let cable = Transmission::torque(0.95, 1.7, 0.01, shape).unwrap();
    for info in CATALOGUE {
        let term = Term {
            effect: effect(info.name),
            source: Source::Channel(1),
            origin: 0.125,
            gain: -0.3,
        };
        let own = Model::<f32, 1>::try_new(Some(cable), &[term]).unwrap();
        let bytes = postcard::to_allocvec_crc32(&own, CHECKSUM.digest()).unwrap();
        let mut model = blank::<bowden_model_f32>();
        let (from, length) = (bytes.as_ptr(), bytes.len());
        let loaded = unsafe { bowden_model_load_f32(&mut model, from, length, 0.0, null_mut()) };
        assert_eq!(loaded, bowden_result::Ok, "{}", info.name);
        let mut state = ModelState::new();
        let mut signal = Signal::new();
        for k in 0..300 {
            let mut next = || bowden_motion_f32 {
                position: signal.next(2.0) as f32,
                velocity: signal.next(2.0) as f32,
                acceleration: signal.next(2.0) as f32,
            };
            let (input, channels) = (next(), [next(), next()]);
            let motion = |m: bowden_motion_f32| Motion {
                position: m.position,
                velocity: m.velocity,
                acceleration: m.acceleration,
            };
            let at = Sample {
                dt: 0.001,
                input: motion(input),
                load: input.position,
                channels: &channels.map(motion),
            };
            let sample = bowden_model_sample_f32 {
                dt: 0.001,
                input,
                load: input.position,
                channels: channels.as_ptr(),
                channel_count: 2,
            };
            let mut y = 7.0;
            let result = unsafe { bowden_model_step_f32(&mut model, &sample, &mut y) };
            assert_eq!(result, bowden_result::Ok, "{} {k}", info.name);
            let expected = own.step(&mut state, &at);
            assert_eq!(y.to_bits(), expected.to_bits(), "{} {k}", info.name);
        }
    }
}

/// With the right checksum, so that the model itself is read.
#[test]
fn bytes_that_are_no_model_are_refused_or_are_a_model_that_steps() {
    let mut signal = Signal::new();
    let (mut loaded, mut refused) = (0, 0);
    let seed = include_bytes!("../../examples/data/demo.postcard");
    for round in 0..200_000 {
        let mut bytes = seed[..seed.len() - 4].to_vec();
        for _ in 0..=round % 4 {
            let place = (signal.next(0.5) + 0.5) * bytes.len() as f64;
            bytes[place as usize] = ((signal.next(0.5) + 0.5) * 256.0) as u8;
        }
        bytes.extend(CHECKSUM.checksum(&bytes).to_le_bytes());
        let mut model = blank::<bowden_model_f32>();
        let (from, length) = (bytes.as_ptr(), bytes.len());
        let result = unsafe { bowden_model_load_f32(&mut model, from, length, 0.0, null_mut()) };
        if result != bowden_result::Ok {
            assert!(matches!(
                result,
                bowden_result::ErrorModel | bowden_result::ErrorCapacity
            ));
            refused += 1;
            continue;
        }
        loaded += 1;
        let channels = [bowden_motion_f32::default(); BOWDEN_CHANNELS];
        let mut sample = blank::<bowden_model_sample_f32>();
        (sample.dt, sample.input.position) = (0.001, 3.0);
        sample.channels = channels.as_ptr();
        sample.channel_count = BOWDEN_CHANNELS;
        for _ in 0..3 {
            let mut y = f32::NAN;
            unsafe { bowden_model_step_f32(&mut model, &sample, &mut y) };
            assert!(y.is_finite(), "{bytes:?}");
            sample.input.position = -sample.input.position;
        }
    }
    assert!(loaded > 1000 && refused > 1000, "{loaded} {refused}");
}

/// The model and its checksum are good in every one of these; what stands behind them is not.
#[test]
fn bytes_behind_the_checksum_are_refused() {
    let seed = include_bytes!("../../examples/data/demo.postcard");
    let load = |bytes: &[u8]| {
        let mut model = blank::<bowden_model_f32>();
        let mut about = blank::<bowden_about>();
        let (from, length) = (bytes.as_ptr(), bytes.len());
        let result = unsafe { bowden_model_load_f32(&mut model, from, length, 0.0, &mut about) };
        let text = unsafe { CStr::from_ptr(about.text.as_ptr()) };
        (result, text.to_str().unwrap().to_owned())
    };
    assert_eq!(load(seed).0, bowden_result::Ok);
    // An array of its own size that a file was read into, empty flash behind a model.
    for (fill, most) in [(0xff, 100), (0, 100), (0xff, BOWDEN_MODEL_BYTES)] {
        let mut bytes = seed.to_vec();
        while bytes.len() < most {
            bytes.push(fill);
            assert_eq!(
                load(&bytes),
                (bowden_result::ErrorModel, "checksum".to_owned()),
                "{} of {fill}",
                bytes.len()
            );
        }
    }
    // Twice the same model: the last four bytes are a checksum, though not of all before them.
    assert_eq!(load(&seed.repeat(2)).0, bowden_result::ErrorModel);
    // With a checksum over all that stands before it, only the form is wrong.
    let mut bytes = [&seed[..], &[1, 2, 3]].concat();
    bytes.extend(CHECKSUM.checksum(&bytes).to_le_bytes());
    let (result, about) = load(&bytes);
    assert_eq!(result, bowden_result::ErrorModel);
    assert_ne!(about, "checksum");
}
