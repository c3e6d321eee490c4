//! A gains file that can be proved as written.
//!
//! The limits of a design are the range of its record. Against friction, these limits hold only a
//! reference that is smaller than the record's largest output. From the corner of its bounds, the
//! adaptive law moves the command faster than any input of the record. The range of the reference
//! is therefore reduced, or the slew-rate limit raised, until `bowden certify` proves the file.

use super::Designed;
use crate::decimal::digits;
use crate::gains::GainsFile;
use crate::proof::{designed, Named, Proof, Sides};
use bowden::control::{AdaptiveSettings, Form};

/// Number of digits of a changed value, which is rounded to the safe side.
const DIGITS: u8 = 4;

/// The nearest file that is proved, and its proof. The error is the reason why there is none.
pub(super) fn settled(gains: &GainsFile) -> Result<(GainsFile, Proof), String> {
    let mut own = gains.clone();
    let mut why = String::new();
    // After eight changes a file that is still refused stays as it was.
    for _ in 0..8 {
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

/// The result of `bowden certify` for the file of a design.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Certifies {
    /// The bound on the error is proved.
    Proves,
    /// An inequality does not hold. The command names a change that would satisfy it.
    NamesWhatFails,
    /// The file is rejected, for this reason.
    Refuses(String),
}

impl Designed {
    /// The result of `bowden certify` for the file as written.
    #[must_use]
    pub fn certifies(&self) -> Certifies {
        let lacks = match (&self.gains.adaptive, &self.gains.plant) {
            (None, _) => {
                "the file has no [adaptive] table, because no gains of the adaptive law are admissible"
            }
            (_, None) => "the file has no [plant] table",
            _ => {
                return match designed::prove(&self.gains) {
                    Ok(proof) if proof.proved => Certifies::Proves,
                    Ok(_) => Certifies::NamesWhatFails,
                    Err(why) => Certifies::Refuses(why),
                }
            }
        };
        Certifies::Refuses(lacks.to_owned())
    }
}

/// Reduces the reference to a range that the limits can hold against the disturbance and the box of
/// the error.
fn smaller_reference(gains: &mut GainsFile, command: &Sides) -> Option<()> {
    let known = gains.plant.as_mut()?;
    let beyond = command.left.high - command.right.low;
    let held = known.reference - known.alpha[1] * beyond;
    let reference = digits(held, DIGITS, f64::floor);
    (reference > 0.0).then(|| known.reference = reference)
}

/// Increases the slew-rate limit until the limit is not active.
fn faster(gains: &mut GainsFile, slew: &Sides) -> Option<()> {
    let law = gains.adaptive.as_mut()?;
    let Form::FirstOrder { step, .. } = law.form else {
        return None;
    };
    // A thousandth for what the sum with the command rounds.
    let least = digits(1.001 * slew.left.high / step, DIGITS, f64::ceil);
    let limits = law.limits.with_slew(least).ok()?;
    *law = AdaptiveSettings { limits, ..*law };
    Some(())
}
