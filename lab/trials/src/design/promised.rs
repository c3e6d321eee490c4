//! A file of gains that is proved as it stands.
//!
//! The limits of a design are what its record has covered. Against friction they hold a smaller
//! reference than the record's greatest output, and from the corner of its box the law moves the
//! command faster than any input of the record moved. So the file promises less, or its slew
//! rate allows more, until `bowden certify` proves it.

use crate::gains::GainsFile;
use crate::proof::{designed, Named, Proof, Sides};
use bowden::control::{AdaptiveSettings, Form};

/// Changes after which a file that is still refused stays as it was.
const MOST: usize = 8;

/// The nearest file that is proved, and its proof; `Err` is why there is none.
pub(super) fn settled(gains: &GainsFile) -> Result<(GainsFile, Proof), String> {
    let mut own = gains.clone();
    let mut why = String::new();
    for _ in 0..MOST {
        let proof = designed::prove(&own)?;
        let Some(refusal) = &proof.refused else {
            return Ok((own, proof));
        };
        why = format!("{} does not hold", refusal.text);
        let all = proof.inequalities.iter().chain(&proof.slew);
        let mut failing = all.filter(|sides| !sides.holds);
        let changed = failing.next().and_then(|sides| match sides.name {
            Named::Command => smaller_reference(&mut own, sides),
            Named::Slew => faster(&mut own, sides),
            _ => None,
        });
        if changed.is_none() {
            break;
        }
    }
    Err(why)
}

/// The reference that the limits hold against the disturbance and the box of the error.
fn smaller_reference(gains: &mut GainsFile, command: &Sides) -> Option<()> {
    let known = gains.plant.as_mut()?;
    let beyond = command.left.high - command.right.low;
    let reference = down(known.reference - known.alpha[1] * beyond);
    (reference > 0.0).then(|| known.reference = reference)
}

/// The slew rate that is not met.
fn faster(gains: &mut GainsFile, slew: &Sides) -> Option<()> {
    let law = gains.adaptive.as_mut()?;
    let Form::Lag { step, .. } = law.form else {
        return None;
    };
    // A thousandth for what the sum with the command rounds.
    let least = up(1.001 * slew.left.high / step);
    let limits = law.limits.with_slew(least).ok()?;
    *law = AdaptiveSettings { limits, ..*law };
    Some(())
}

/// Four digits, not above the number.
fn down(x: f64) -> f64 {
    digits(x, f64::floor)
}

/// Four digits, not below it.
fn up(x: f64) -> f64 {
    digits(x, f64::ceil)
}

fn digits(x: f64, round: fn(f64) -> f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return x;
    }
    #[allow(clippy::cast_possible_truncation)]
    let places = 3 - x.log10().floor() as i32;
    match places >= 0 {
        true => round(x * 10_f64.powi(places)) / 10_f64.powi(places),
        false => round(x / 10_f64.powi(-places)) * 10_f64.powi(-places),
    }
}
