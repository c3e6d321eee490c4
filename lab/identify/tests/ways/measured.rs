//! Models on the next record of a rig that others measured; `shared` says where it is.

use super::shared::{Row, DAMPER, PIEZO_FULL, PIEZO_VARYING};
use bowden_lab::check::{About, Check, Errors, Given, Verdict};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::export::ModelFile;
use bowden_lab::facts::CheckFacts;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::Record;
use bowden_lab::search::close_within;

fn record(row: Row, file: &'static str) -> Option<Record> {
    let path = row.of_file(file).path()?;
    let record = row.asked().read(&path);
    Some(record.unwrap_or_else(|line| panic!("{line}")))
}

/// The model of one file with those effects, on another one.
fn check(row: Row, own: &'static str, next: &'static str, effects: &[&str]) -> Option<Check> {
    let (own, next) = (record(row, own)?, record(row, next)?);
    let cutoff = Some(row.cutoff);
    let data = Prepared::new(&own, Preparation { cutoff }).unwrap();
    let names = ["bouc-wen"].iter().chain(effects);
    let names: Vec<String> = names.map(|&name| name.to_owned()).collect();
    let declared = structure(&names, &data).unwrap();
    let ledger = close_within(&data, &declared, 0, |_| ()).unwrap();
    let done = FinalFit::new(&data, &ledger);
    let errors = done.rmse.normalised(&data, &data.target);
    let given = Given {
        file: ModelFile::new(&done.data, &done.solution),
        left_out: Vec::new(),
        about: About {
            cutoff_hz: cutoff,
            nrmse: Some(Errors {
                fit: Some(errors.fit),
                selection: Some(errors.selection),
                held_out: Some(errors.held_out),
            }),
            ..About::default()
        },
    };
    let check = Check::new(next, &given, None).unwrap();
    let percent = |rmse: f64| 100.0 * rmse / check.deviation;
    println!(
        "{effects:?}: own held out {:.2} %, here {:.2} %, with gain {:.3} and offset {:.2} {:.2} %: {}",
        100.0 * errors.held_out,
        percent(check.rmse),
        check.line.gain.value,
        check.line.offset.value,
        percent(check.rmse_gain_offset),
        CheckFacts::new(&check).sentence
    );
    Some(check)
}

/// At twice the frequency the fluid is as it was: a model misses about what it missed at home.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_dampers_model_holds_at_twice_the_frequency() {
    let files = (
        "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
        "mr_damper_utfsm/sine_25mm0x5Hz0x5A.csv",
    );
    for effects in [&[][..], &["viscous"]] {
        let Some(check) = check(DAMPER, files.0, files.1, effects) else {
            return;
        };
        assert_eq!(check.verdict, Verdict::Holds, "{effects:?}");
    }
}

/// Without current the magnetic part of the force is gone: what is left of the loop is a
/// quarter of it, of the same shape within what the model misses at home.
#[test]
fn without_its_current_the_dampers_gain_has_moved_to_a_quarter() {
    let files = (
        "mr_damper_utfsm/sine_25mm0x25Hz0x5A.csv",
        "mr_damper_utfsm/sine_25mm0x25Hz0A.csv",
    );
    let Some(check) = check(DAMPER, files.0, files.1, &["viscous"]) else {
        return;
    };
    assert_eq!(check.verdict, Verdict::GainOrOffsetMoved);
    let gain = check.line.gain.value;
    assert!(gain > 0.2 && gain < 0.3, "{gain}");
}

/// The stage's zero is arbitrary, and its loop is another one at small amplitudes: another
/// offset mends most of the error, and does not make it hold.
#[test]
fn the_piezos_model_of_the_full_range_does_not_hold_at_varying_amplitudes() {
    let files = (PIEZO_FULL.file, PIEZO_VARYING.file);
    for effects in [&[][..], &["stiffness-quadratic"]] {
        let Some(check) = check(PIEZO_FULL, files.0, files.1, effects) else {
            return;
        };
        assert_eq!(check.verdict, Verdict::DoesNotHold, "{effects:?}");
        assert!(check.rmse_gain_offset < 0.1 * check.rmse);
        assert!(!check.depends_on.is_empty());
    }
}
