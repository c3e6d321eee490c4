//! What the drive did with the command of a compensator: the crate's numbers.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
mod signal;

use bowden::*;
use core_bowden::control::{Applied, Compensator, CompensatorInput, CompensatorState};
use core_bowden::effect::Motion;
use core_bowden::model::Model;
use objects::blank;
use signal::Signal;
use std::ptr::{null, null_mut};

const MODEL: &str = include_str!("../../examples/data/demo.toml");

macro_rules! drive {
    ($f:ident) => {
        pastey::paste! {
            /// The crate's compensator of the demonstration, and the same in C.
            fn [<both_ $f>]() -> (Compensator<$f, 16>, [<bowden_compensator_ $f>]) {
                let own: Model<$f, 16> = toml::from_str(MODEL).unwrap();
                let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
                let bytes = postcard::to_allocvec_crc32(&own, crc.digest()).unwrap();
                let mut model = blank::<[<bowden_model_ $f>]>();
                let mut in_c = blank::<[<bowden_compensator_ $f>]>();
                unsafe {
                    let loaded = [<bowden_model_load_ $f>](
                        &mut model, bytes.as_ptr(), bytes.len(), 0.0, null_mut(),
                    );
                    assert_eq!(loaded, bowden_result::Ok);
                    let made = [<bowden_compensator_init_ $f>](
                        &mut in_c, &model, 0.005, null(), 0, null_mut(),
                    );
                    assert_eq!(made, bowden_result::Ok);
                }
                let own = Compensator::try_new(&own).unwrap().with_longest_dt(0.005).unwrap();
                (own, in_c)
            }

            #[test]
            fn [<a_compensator_is_told_what_the_drive_did_in_ $f>]() {
                let (own, mut in_c) = [<both_ $f>]();
                let (mut state, mut untold) = (CompensatorState::new(), CompensatorState::new());
                let mut signal = Signal::new();
                let (mut differs, mut phase) = (0, 0.0);
                for k in 0..4000 {
                    phase += 0.002 + 0.001 * signal.next(1.0);
                    let wave = 10.0 * (phase * 7.0).sin();
                    // Bad samples as well.
                    let sound = signal.measured(k);
                    let desired = if sound.is_finite() { wave as $f } else { sound as $f };
                    let dt = signal.dt(k) as $f;
                    let motion = Motion { position: 0.1, velocity: desired * 0.1, acceleration: 0.0 };
                    let channel = [<bowden_motion_ $f>] {
                        position: 0.1,
                        velocity: desired * 0.1,
                        acceleration: 0.0,
                    };
                    let at = CompensatorInput {
                        channels: &[motion],
                        ..CompensatorInput::new(dt, desired)
                    };
                    let sample = [<bowden_compensator_sample_ $f>] {
                        dt,
                        desired,
                        input: blank(),
                        load: 0.0,
                        channels: &channel,
                        channel_count: 1,
                    };
                    let mut out = blank::<[<bowden_compensator_output_ $f>]>();
                    unsafe { [<bowden_compensator_step_ $f>](&mut in_c, &sample, &mut out) };
                    let expected = own.step(&mut state, &at);
                    assert_eq!(out.command.to_bits(), expected.command.to_bits(), "{k}");
                    assert_eq!(out.eta.to_bits(), state.eta().to_bits(), "{k}");
                    own.step(&mut untold, &at);
                    differs += u32::from(untold.eta() != state.eta());
                    let given = 0.7 * expected.command;
                    let applied = match k % 11 {
                        2 | 3 => Applied::Command(given),
                        4 => Applied::AtUpperLimit,
                        5 => Applied::AtLowerLimit,
                        7 => Applied::AsCommanded,
                        8 => Applied::Command($f::NAN),
                        _ => continue,
                    };
                    own.applied(&mut state, applied);
                    let mut at_limit = |side: bowden_saturation| unsafe {
                        [<bowden_compensator_at_limit_ $f>](&mut in_c, side as u32)
                    };
                    let told = match applied {
                        Applied::Command(command) => unsafe {
                            [<bowden_compensator_applied_ $f>](&mut in_c, command)
                        },
                        Applied::AtUpperLimit => at_limit(bowden_saturation::Upper),
                        Applied::AtLowerLimit => at_limit(bowden_saturation::Lower),
                        Applied::AsCommanded => at_limit(bowden_saturation::None),
                    };
                    let wanted = if k % 11 == 8 { bowden_result::Held } else { bowden_result::Ok };
                    assert_eq!(told, wanted, "{k}");
                }
                assert!(differs > 1000, "{differs}");
            }
        }
    };
}
drive!(f32);
drive!(f64);

#[test]
fn a_report_that_is_refused_changes_nothing() {
    let (_, mut in_c) = both_f32();
    let words = in_c.opaque;
    unsafe {
        for side in [3, u32::MAX] {
            let told = bowden_compensator_at_limit_f32(&mut in_c, side);
            assert_eq!(told, bowden_result::ErrorChoice);
        }
        for result in [
            bowden_compensator_applied_f32(&mut blank(), 0.0),
            bowden_compensator_at_limit_f32(&mut blank(), 1),
        ] {
            assert_eq!(result, bowden_result::ErrorUninitialised);
        }
        for result in [
            bowden_compensator_applied_f32(null_mut(), 0.0),
            bowden_compensator_at_limit_f32(null_mut(), 1),
        ] {
            assert_eq!(result, bowden_result::ErrorNull);
        }
    }
    assert_eq!(in_c.opaque, words);
}
