//! The first sentence: what the baseline model lacks, and how the added terms change the error.

use super::errors::{before_after, floors, held_out_ratio, is_noise, missed, names, percent};
use super::final_fit::FinalFit;
use super::mechanisms::{lacking, mechanisms, Complete};
use super::words::from_to;
use crate::fit::Segments;
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::scale::is_raised;

/// The effect of the added terms on the held-out error.
pub(super) fn lacks(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let added = names(ledger, done);
    match added.len() {
        0 if ledger.unknown.is_some() => {
            return format!(
                "The missing part of the baseline model matches no effect in the catalogue. With a free-form curve, the held-out error changes {}.",
                from_to(before_after(data, ledger, done))
            )
        }
        0 => return nothing_found(data, ledger, done),
        _ => {}
    }
    if let Some(unknown) = &ledger.unknown {
        return beside_a_curve(data, ledger, done, &unknown.before);
    }
    let goes = match held_out_ratio(ledger, done) {
        r if is_raised(r, 1.0) => "rises",
        r if !is_raised(1.0, r) => "hardly changes,",
        _ => "falls",
    };
    format!(
        "{} With {}, the held-out error {goes} {}.{}",
        lacking(&mechanisms(data, ledger, done)),
        added.join(", then "),
        from_to(before_after(data, ledger, done)),
        candidates(data, ledger)
    )
}

/// The remark on the names of an incomplete model: two records fitted together show more than
/// either of them.
fn candidates(data: &Prepared, ledger: &Ledger) -> String {
    let terms = match (Complete::new(data, ledger).at_floor, ledger.rounds.len()) {
        (true, _) | (_, 0) => return String::new(),
        (false, 1) => ["The term is a candidate", "formula describes the mechanism"],
        (false, _) => [
            "The terms are candidates",
            "formulas describe the mechanisms",
        ],
    };
    let [what, which] = terms;
    match data.pieces.len() {
        0 | 1 => format!(" {what}, but this record cannot show which {which}. Record another motion and identify both records together."),
        _ => format!(" {what}, but these files cannot show which {which}."),
    }
}

/// The reduction by the names, and the further reduction by a curve: the curve is included in the
/// final error, but matches no effect and is not exported.
fn beside_a_curve(data: &Prepared, ledger: &Ledger, done: &FinalFit, named: &Segments) -> String {
    let added = names(ledger, done);
    let held_out = |rmse: &Segments| percent(rmse.normalised(data, &data.target).held_out);
    format!(
        "The baseline model lacks {} and a part that matches no effect in the catalogue. With the named effects, the held-out error changes from {} to {} of the output's standard deviation. An additional curve changes this error to {}.",
        added.join(", then "),
        held_out(&ledger.declared.rmse),
        held_out(named),
        held_out(&done.rmse)
    )
}

fn nothing_found(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    if ledger.is_stopped() {
        return format!(
            "The baseline model has a held-out error of {} of the output's standard deviation.",
            percent(missed(data, done))
        );
    }
    // What is left is more than noise: the model lacks something all the same.
    match floors(data, done).is_some_and(|errors| !is_noise(data, errors)) {
        true => format!(
            "No effect in the catalogue explains the residual of the baseline model, which is {} of the output's standard deviation on the held-out segment.",
            percent(missed(data, done))
        ),
        false => "In this record, no effect is missing from the baseline model.".to_owned(),
    }
}
