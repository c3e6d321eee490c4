//! Two records of one measured rig; `shared` says where they are.

use super::shared::DAMPER;
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::fit;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{HeldOut, Preparation, Prepared};
use bowden_lab::record::Record;

fn records(files: &[&'static str]) -> Option<Vec<Record>> {
    let paths: Option<Vec<_>> = files.iter().map(|f| DAMPER.of_file(f).path()).collect();
    let records = DAMPER.asked().read_together(&paths?);
    Some(records.unwrap_or_else(|line| panic!("{line}")))
}

/// The current through the coil sets how much a damper grips: kappa_eta, and little else.
#[test]
fn a_damper_at_two_currents_has_one_loop_shape_and_two_kappa_eta() {
    let files = [DAMPER.file, "mr_damper_utfsm/sine_25mm0x25Hz0A.csv"];
    let Some(records) = records(&files) else {
        return;
    };
    let cutoff = Some(DAMPER.cutoff);
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
