//! Two records of one measured rig. They are not part of the project: where they are
//! absent the test says so and passes, as in `shared_records.rs`.

use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::fit;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{HeldOut, Preparation, Prepared};
use bowden_lab::record::{agree, read, Mode, Options, Record};
use std::path::PathBuf;

fn records(files: &[&str]) -> Option<Vec<Record>> {
    let folder = std::env::var_os("BOWDEN_SHARED_RECORDS").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let options = Options {
        mode: Some(Mode::Displacement),
        time: Some("time_s".to_owned()),
        input: Some("displacement_mm".to_owned()),
        output: Some("force_N".to_owned()),
        ..Options::default()
    };
    let mut all = Vec::new();
    for file in files {
        let path = folder.join("mr_damper_utfsm").join(file);
        if !path.exists() {
            println!("skipped: {} is not there", path.display());
            return None;
        }
        all.push(read(&path, &options).unwrap_or_else(|line| panic!("{line}")));
    }
    agree(&mut all).unwrap();
    Some(all)
}

/// The current through the coil sets how much a damper grips: kappa_eta, and little else.
#[test]
fn a_damper_at_two_currents_has_one_loop_shape_and_two_kappa_eta() {
    let files = ["sine_25mm0x25Hz0x5A.csv", "sine_25mm0x25Hz0A.csv"];
    let Some(records) = records(&files) else {
        return;
    };
    let cutoff = Some(20.0);
    let data = Prepared::joined(&records, Preparation { cutoff }, HeldOut::Trailing).unwrap();
    let mut declared = structure(&["bouc-wen".to_owned(), "viscous".to_owned()], &data).unwrap();
    let common = fit(&data, &declared, None, 0.0).unwrap();
    declared.own_gains = records.len();
    let own = fit(&data, &declared, None, 0.0).unwrap();
    let percent = |s: &bowden_lab::fit::Solution| {
        let share = s.rmse.normalised(&data, &data.target);
        (100.0 * share.fit, 100.0 * share.held_out)
    };
    println!("common {:?}, own {:?}", percent(&common), percent(&own));
    assert!(3.0 * own.rmse.fit < common.rmse.fit);
    assert!(3.0 * own.rmse.held_out < common.rmse.held_out);
    let all = parameters(&data, &own);
    let kappa = |name: &str| all.iter().find(|p| p.name == name).unwrap();
    let (on, off) = (kappa("kappa_eta.1"), kappa("kappa_eta.2"));
    println!("{on:?}\n{off:?}");
    assert!(on.value.abs() > 2.0 * off.value.abs(), "{on:?} {off:?}");
}
