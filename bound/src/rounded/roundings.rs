//! Rounding errors in one shipped step of the first-order form, operation by operation.

use super::gains::Gains;
use crate::dyadic::Enclosure;
use core::ops::{Add, Mul};

/// A float that lies within `error` of a number of magnitude at most `most`.
#[derive(Clone, Copy)]
struct Computed {
    most: Enclosure,
    error: Enclosure,
}

impl Computed {
    /// An input, which has no rounding error yet.
    fn given(most: Enclosure) -> Self {
        Self {
            most,
            error: Enclosure::ZERO,
        }
    }
}

/// For sums and differences alike: only magnitudes count.
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

/// Rounding to nearest for one word length.
#[derive(Clone, Copy)]
pub(super) struct Word {
    /// Half a unit in the last place of one: 2^-24 of `f32`, 2^-53 of `f64`.
    pub(super) unit: Enclosure,
    /// Half of the smallest positive number.
    pub(super) least: Enclosure,
    /// The largest number.
    pub(super) most: Enclosure,
}

impl Word {
    /// A sum as stored. If it underflows it is exact.
    fn sum(self, x: Computed) -> Computed {
        let error = x.error + self.unit * (x.most + x.error);
        Computed { error, ..x }
    }

    /// A product or a quotient as stored.
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

/// Difference between the shipped step and the exact step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Roundings {
    /// Rounding error of s \[N·m\].
    pub s: Enclosure,
    /// Rounding error of the command, with the earlier carry of its sum \[command unit\].
    pub command: Enclosure,
    /// Rounding error of z, with the earlier carry of its sum \[N·m·s\].
    pub z: Enclosure,
    /// Largest permitted carry of the command's sum \[command unit\].
    pub owed_by_command: Enclosure,
    /// Largest permitted carry of z's sum \[N·m·s\].
    pub carry_error_z: Enclosure,
    /// Carry of z's sum after a step that starts with the permitted carry \[N·m·s\].
    pub owed_after: Enclosure,
    /// The part of `T(s/epsilon)` that is not proportional to s, because of underflow.
    pub smooth_sign: Enclosure,
    /// Upper bound on every number of the step, including the updates of the estimates. It is twice
    /// the sum of all numbers that the step adds and multiplies. Half of this bound covers rounding
    /// errors.
    pub largest: Enclosure,
}

/// The rounding errors while `|s| <= S`, `|z| <= Z` and `|u| <= command`.
///
/// The lines follow the computation of `Adaptive::step`. A test compares them with the step, bit
/// for bit. The lag and z are compensated sums, because `two_sum` is exact. The carry of a sum is
/// therefore the rounding error of its last addition, at most half a unit in the last place of the
/// sum.
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
    // The distance, and the share of the distance that one step takes.
    let wanted = word.product(given(gains.beta) * ubar);
    let way = word.sum(wanted + given(command));
    let moved = word.product(word.product(step * lambda) * way);
    let owed_by_command = word.unit * command;
    let law = summed(word, given(command), moved, owed_by_command);
    // z⁺ = z + dt·e.
    let moved = word.product(step * error);
    // The carry must reproduce itself: a little more than from zero.
    let carry_error_z = word.unit * (z + moved.most) * (Enclosure::ONE + Enclosure::power(-10));
    let accumulated = summed(word, given(z), moved, carry_error_z);
    let increment = word.sum(owing(moved, carry_error_z));
    Roundings {
        s: s_error,
        command: law.error,
        z: accumulated.error,
        owed_by_command,
        carry_error_z,
        owed_after: word.unit * (z + increment.most + increment.error),
        // The quotient s/epsilon, and a smooth sign with the same error.
        smooth_sign: word.least * Enclosure::power(2),
        largest: largest(gains, s + s_error, z, command, ubar.most),
    }
}

/// Every number of the step is a sum of some of these numbers, or one of them times a factor below
/// one.
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

/// The same bound for the updates of the estimates, whose inputs are `lambda·s` and its factors.
fn updates(gains: &Gains, pull: Enclosure, ubar: Enclosure) -> Enclosure {
    let [beta, delta] = &gains.adapts;
    let mut all = pull + beta.numbers(pull * ubar, gains.step) + delta.numbers(pull, gains.step);
    for term in gains.regressors() {
        all = all + term.adapts.numbers(pull * term.magnitude, gains.step);
    }
    all
}

/// `sum(theta_hat_i·x_i)`: the sum of zero and the first product is exact.
fn compensation(gains: &Gains) -> Computed {
    let (word, mut sum) = (gains.word, None);
    for term in gains.regressors() {
        let product =
            word.product(Computed::given(term.estimate) * Computed::given(term.magnitude));
        sum = Some(sum.map_or(product, |sum| word.sum(sum + product)));
    }
    sum.unwrap_or(Computed::given(Enclosure::ZERO))
}

/// An increment with the carry of a sum: the carry is an error of the increment.
fn owing(increment: Computed, owed: Enclosure) -> Computed {
    Computed {
        error: increment.error + owed,
        ..increment
    }
}

/// `Compensated::plus`: the value, whose error includes the earlier carry.
fn summed(word: Word, value: Computed, increment: Computed, owed: Enclosure) -> Computed {
    word.sum(value + word.sum(owing(increment, owed)))
}
