//! The errors of a delivered model in words, and which of them count.

use super::final_fit::FinalFit;
use super::finding::Finding;
use crate::fit::Segments;
use crate::ledger::{Ledger, Round};
use crate::problem::Prepared;
use crate::scale::{is_raised, quantile, LEVEL_OF_ONE, NOISE, TRACE};

/// A model whose error is this share of the output's standard deviation is poor. A choice.
pub const POOR: f64 = 0.2;

/// Ratio of the delivered model's held-out error to that of the baseline model.
#[must_use]
pub fn held_out_ratio(ledger: &Ledger, done: &FinalFit) -> f64 {
    done.rmse.held_out / ledger.declared.rmse.held_out.max(f64::MIN_POSITIVE)
}

/// Whether the delivered model's error on held-out data exceeds that of the baseline model. If
/// nothing was added, both are one model, fitted to more data: the difference is scatter of the
/// fit.
pub(super) fn is_worse(ledger: &Ledger, done: &FinalFit) -> bool {
    let is_another =
        !ledger.rounds.is_empty() || ledger.unknown.is_some() || done.without_hysteresis.is_some();
    is_another && is_raised(held_out_ratio(ledger, done), 1.0)
}

/// Whether the mean of the held-out output would predict it better than the model does.
pub(super) fn worse_than_a_constant(data: &Prepared, done: &FinalFit) -> bool {
    missed(data, done) > 1.0
}

/// The held-out error as a share of the output's standard deviation.
pub(super) fn missed(data: &Prepared, done: &FinalFit) -> f64 {
    done.rmse.normalised(data, &data.target).held_out
}

/// A model whose error is a large part of the output, and exceeds the noise.
pub(super) fn poor(data: &Prepared, done: &FinalFit) -> Option<Finding> {
    let error = missed(data, done);
    let is_poor = error >= POOR && !floors(data, done).is_some_and(|errors| is_noise(data, errors));
    is_poor.then_some(Finding::PoorModel { error })
}

/// Whether a round raises the held-out error. The held-out segment decides nothing: the result is
/// reported, not used.
#[must_use]
pub fn raises(round: &Round) -> bool {
    // A hundredth is less than the last digit that is printed.
    round.after.held_out > (1.0 + TRACE) * round.before.held_out
}

/// Number of leading rounds that lower the held-out error before one raises it.
#[must_use]
pub fn falls_up_to(ledger: &Ledger) -> usize {
    let rounds = ledger.rounds.iter();
    rounds.take_while(|round| !raises(round)).count()
}

/// Fit and held-out error in multiples of the noise floor; `None` if the record has no estimate of
/// the floor.
pub(super) fn floors(data: &Prepared, done: &FinalFit) -> Option<(f64, f64)> {
    let (fit, held_out) = (data.noise_floor, data.held_out_floor);
    let are_known = fit > 0.0 && held_out > 0.0;
    are_known.then(|| (done.rmse.fit / fit, done.rmse.held_out / held_out))
}

/// Whether the errors, in multiples of the noise floor, are noise. Nothing was fitted to the
/// held-out part, and it is short: the rms over `n` independent values of noise has a relative
/// standard deviation of `1/sqrt(2n)`.
pub(super) fn is_noise(data: &Prepared, (fit, held_out): (f64, f64)) -> bool {
    let seconds = data.split.held_out.len() as f64 * data.dt * data.stride as f64;
    let independent = (2.0 * data.cutoff * seconds).max(1.0);
    let scatter = quantile(LEVEL_OF_ONE) / (2.0 * independent).sqrt();
    fit <= NOISE && held_out <= NOISE * (1.0 + scatter)
}

/// An error as a share of the output's standard deviation, "2.23 %".
#[must_use]
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        // A segment on which the output rests has no standard deviation.
        return "–".to_owned();
    }
    if share > 10.0 {
        return "over 1000 %".to_owned();
    }
    let digits = if share >= 1.0 { 0 } else { 2 };
    format!("{:.digits$} %", 100.0 * share)
}

/// The held-out errors of the baseline and of the delivered model, as shares.
pub(super) fn before_after(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> (f64, f64) {
    let held_out = |rmse: &Segments| rmse.normalised(data, &data.target).held_out;
    (held_out(&ledger.declared.rmse), held_out(&done.rmse))
}

/// The names in the order in which they were added.
pub(super) fn names(ledger: &Ledger, done: &FinalFit) -> Vec<String> {
    ledger.rounds.iter().map(|r| done.title_of(r)).collect()
}
