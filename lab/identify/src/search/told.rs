//! Progress messages of a search on the models that it reaches.

use crate::fit::Solution;
use crate::problem::Prepared;

/// The terms of a model and its error on the selection segment, in one line.
pub(super) fn reached(data: &Prepared, now: &Solution) -> String {
    let hysteresis = now.structure.hysteresis.then(|| "bouc-wen".to_owned());
    let terms = now.structure.terms.iter().map(|term| {
        let (effect, channel) = (term.effect.name(), data.channel(term.source));
        match channel {
            Some(channel) => format!("{effect}@{}", channel.name),
            None => effect.to_owned(),
        }
    });
    let curve = now.structure.table.as_ref().map(|_| "a curve".to_owned());
    let parts: Vec<String> = hysteresis.into_iter().chain(terms).chain(curve).collect();
    let error = now.rmse.normalised(data, &data.target).selection;
    format!(
        "so far: {}; error {:.2} % of the output's std",
        parts.join(" + "),
        100.0 * error
    )
}
