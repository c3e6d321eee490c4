//! What rounding adds in one shipped step of the lag form, operation by operation.

use super::gains::Gains;
use crate::bound::dyadic::Enclosure;
use core::ops::{Add, Mul};

/// A float that lies within `error` of a number of magnitude at most `most`.
#[derive(Clone, Copy)]
struct Computed {
    most: Enclosure,
    error: Enclosure,
}

impl Computed {
    /// A float that goes in: nothing has been rounded yet.
    fn given(most: Enclosure) -> Self {
        Self {
            most,
            error: Enclosure::ZERO,
        }
    }
}

/// Of sums and differences alike: only magnitudes count.
impl Add for Computed {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            most: self.most + other.most,
            error: self.error + other.error,
        }
    }
}

impl Mul for Computed {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let crossed = self.most * other.error + other.most * self.error;
        Self {
            most: self.most * other.most,
            error: crossed + self.error * other.error,
        }
    }
}

/// Rounding to nearest of one word length.
#[derive(Clone, Copy)]
pub(super) struct Word {
    /// Half a unit in the last place of one: 2^-24 of `f32`, 2^-53 of `f64`.
    pub(super) unit: Enclosure,
    /// Half of the least number above zero.
    pub(super) least: Enclosure,
    /// The greatest number.
    pub(super) most: Enclosure,
}

impl Word {
    /// A sum as it is stored. Where it underflows it is exact.
    fn sum(self, x: Computed) -> Computed {
        let error = x.error + self.unit * (x.most + x.error);
        Computed { error, ..x }
    }

    /// A product or a quotient as it is stored.
    fn product(self, x: Computed) -> Computed {
        let stored = self.sum(x);
        Computed {
            error: stored.error + self.least,
            ..x
        }
    }

    fn quotient(self, x: Computed, divisor: Enclosure) -> Computed {
        self.product(Computed {
            most: x.most / divisor,
            error: x.error / divisor,
        })
    }
}

/// By how much the shipped step differs from the exact one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Roundings {
    /// Of s \[N·m\].
    pub s: Enclosure,
    /// Of the command, with what its sum owed before \[command unit\].
    pub command: Enclosure,
    /// Of z, with what its sum owed before \[N·m·s\].
    pub z: Enclosure,
    /// What the sum of the command may owe \[command unit\].
    pub owed_by_command: Enclosure,
    /// What the sum of z may owe \[N·m·s\].
    pub owed_by_z: Enclosure,
    /// What the sum of z owes after a step in which it owed that \[N·m·s\].
    pub owed_after: Enclosure,
    /// What of `T(s/epsilon)` is not in proportion to s: underflow.
    pub smooth_sign: Enclosure,
    /// More than any number of the step, the updates of the estimates included: twice the sum of
    /// all that it adds and multiplies, half of which is for rounding.
    pub largest: Enclosure,
}

/// The roundings while `|s| <= S`, `|z| <= Z` and `|u| <= command`.
///
/// Line by line what `Adaptive::step` computes; a test compares the lines with it, bit for
/// bit. The lag and z are compensated sums: `two_sum` is exact, so a sum owes what its last
/// addition lost, half a unit in the last place of the sum at most.
pub(super) fn roundings(
    gains: &Gains,
    s: Enclosure,
    z: Enclosure,
    command: Enclosure,
) -> Roundings {
    let word = gains.word;
    let given = Computed::given;
    let (lambda, step) = (given(gains.lambda), given(gains.step));
    // e = y - y_r; s = e + lambda·z.
    let error = word.sum(given(s + gains.lambda * z));
    let s_error = word.sum(error + word.product(lambda * given(z))).error;
    // ubar of the s that was computed, from the left as Rust adds.
    let computed = given(s + s_error);
    let change = word.sum(given(gains.step * gains.reference_rate));
    let rate = word.quotient(change, gains.step);
    let rate = word.quotient(word.sum(rate + given(z)), gains.lambda);
    let mut ubar = word.product(given(gains.gain) * computed);
    ubar = word.sum(ubar + given(gains.reference));
    ubar = word.sum(ubar + rate);
    ubar = word.sum(ubar + compensation(gains));
    ubar = word.sum(ubar + word.product(given(gains.delta) * given(Enclosure::ONE)));
    // The way to go, and the share of it that one step takes.
    let wanted = word.product(given(gains.beta) * ubar);
    let way = word.sum(wanted + given(command));
    let moved = word.product(word.product(step * lambda) * way);
    let owed_by_command = word.unit * command;
    let law = summed(word, given(command), moved, owed_by_command);
    // z⁺ = z + dt·e.
    let moved = word.product(step * error);
    // What is owed must reproduce itself: a little more than from nothing.
    let owed_by_z = word.unit * (z + moved.most) * (Enclosure::ONE + Enclosure::power(-10));
    let accumulated = summed(word, given(z), moved, owed_by_z);
    let increment = word.sum(owing(moved, owed_by_z));
    Roundings {
        s: s_error,
        command: law.error,
        z: accumulated.error,
        owed_by_command,
        owed_by_z,
        owed_after: word.unit * (z + increment.most + increment.error),
        // The quotient s/epsilon, and a smooth sign that is off by as much.
        smooth_sign: word.least * Enclosure::power(2),
        largest: largest(gains, s + s_error, z, command, ubar.most),
    }
}

/// Every number of the step is a sum of some of these, or one of them less a factor below one.
fn largest(
    gains: &Gains,
    s: Enclosure,
    z: Enclosure,
    command: Enclosure,
    ubar: Enclosure,
) -> Enclosure {
    let one = Enclosure::ONE;
    let moved = (s + gains.lambda * z + gains.reference_rate) * (one + gains.step);
    let mut all = one + gains.step + gains.reference + moved + z + command;
    for term in gains.regressors() {
        all = all + term.magnitude;
    }
    all = all + s / gains.epsilon + ubar * (one + gains.beta);
    (all + updates(gains, gains.lambda * s, ubar)) * Enclosure::power(1)
}

/// The same of the estimates' updates, of which `lambda·s` and what it multiplies are the drives.
fn updates(gains: &Gains, pull: Enclosure, ubar: Enclosure) -> Enclosure {
    let [beta, delta] = &gains.adapts;
    let mut all = pull + beta.numbers(pull * ubar, gains.step) + delta.numbers(pull, gains.step);
    for term in gains.regressors() {
        all = all + term.adapts.numbers(pull * term.magnitude, gains.step);
    }
    all
}

/// `sum(theta_hat_i·x_i)`: the first product is added to zero, which rounds nothing.
fn compensation(gains: &Gains) -> Computed {
    let (word, mut sum) = (gains.word, None);
    for term in gains.regressors() {
        let product =
            word.product(Computed::given(term.estimate) * Computed::given(term.magnitude));
        sum = Some(sum.map_or(product, |sum| word.sum(sum + product)));
    }
    sum.unwrap_or(Computed::given(Enclosure::ZERO))
}

/// An increment with what a sum owes: all of that is an error of the increment.
fn owing(increment: Computed, owed: Enclosure) -> Computed {
    Computed {
        error: increment.error + owed,
        ..increment
    }
}

/// `Compensated::plus`: the value, whose error holds what was owed before.
fn summed(word: Word, value: Computed, increment: Computed, owed: Enclosure) -> Computed {
    word.sum(value + word.sum(owing(increment, owed)))
}
