//! The text of `bowden plan`.

use super::layout::{block, heading, prose, Width};
use anstyle::AnsiColor;
use bowden_lab::facts::{Plan, Planned};

/// The planned motion and its purpose, or the reason why no motion is planned, without the CSV.
#[must_use]
pub fn plan_text(record: &str, plan: &Plan, width: Width) -> String {
    let mut out = String::new();
    let (colour, answer) = answer(plan);
    heading(&mut out, width, ("bowden plan", record), (colour, &answer));
    if let Some(Planned { experiment, .. }) = &plan.planned {
        let words = format!(
            "The motion takes {:.1} s and reaches {:.2} times the largest recorded speed.",
            experiment.seconds, experiment.speed
        );
        prose(&mut out, width, &words);
    }
    let open = [ambiguous(plan), unidentified(plan)];
    for words in open.into_iter().flatten() {
        prose(&mut out, width, &words);
    }
    out.push('\n');
    if let Some(Planned { experiment, .. }) = &plan.planned {
        let aims = experiment.aims.iter().map(|aim| aim.words());
        block(&mut out, width, "Aims", aims);
    }
    block(&mut out, width, "Record", &plan.undescribed);
    let next = match (&plan.planned, &plan.undescribed) {
        (Some(_), _) => "record the motion · bowden identify RECORD NEW_RECORD",
        (None, Some(_)) => "correct the named cause, record again · bowden identify RECORD",
        (None, None) if is_settled(plan) => "bowden validate MODEL.toml NEW_RECORD",
        (None, None) => "bowden identify -v RECORD (alternatives and their tests)",
    };
    block(&mut out, width, "Next", [next]);
    out
}

fn is_settled(plan: &Plan) -> bool {
    plan.inseparable.is_empty() && plan.unidentified.is_empty()
}

/// The answer in a few words.
fn answer(plan: &Plan) -> (AnsiColor, String) {
    match (&plan.planned, &plan.undescribed) {
        (Some(planned), _) => {
            let motion = &planned.experiment.trajectory;
            (AnsiColor::Green, format!("MOTION PLANNED: {motion}"))
        }
        (None, Some(_)) => (
            AnsiColor::Red,
            "NO MOTION PLANNED: the model does not describe the record".to_owned(),
        ),
        (None, None) if is_settled(plan) => {
            (AnsiColor::Green, "NO EXPERIMENT IS NEEDED".to_owned())
        }
        (None, None) => (
            AnsiColor::Yellow,
            "NO MOTION PLANNED: none of the candidate motions helps".to_owned(),
        ),
    }
}

/// Which terms stay ambiguous.
fn ambiguous(plan: &Plan) -> Option<String> {
    let pairs = plan.together.iter();
    let pairs: Vec<String> = pairs.map(|[a, b]| format!("`{a}` without `{b}`")).collect();
    let motion = match pairs.is_empty() {
        true => String::new(),
        false => format!(" A motion of {} would.", pairs.join(", or of ")),
    };
    let is_for_them = plan
        .planned
        .as_ref()
        .is_some_and(|planned| planned.confounded);
    match (plan.inseparable.as_slice(), is_for_them) {
        ([], true) => None,
        ([], false) => Some("No term is ambiguous.".to_owned()),
        (pairs, true) => Some(format!(
            "The motion does not separate {}.{motion}",
            pairs.join(", nor ")
        )),
        (pairs, false) => Some(format!(
            "No planned motion separates {}.{motion}",
            pairs.join(", nor ")
        )),
    }
}

/// Which parameters stay unidentified without a motion.
fn unidentified(plan: &Plan) -> Option<String> {
    match (plan.unidentified.as_slice(), &plan.planned) {
        (_, Some(_)) => None,
        ([], None) => Some("Every parameter is identified.".to_owned()),
        (names, None) => Some(format!(
            "No planned motion identifies these parameters: {}.",
            names.join(", ")
        )),
    }
}
