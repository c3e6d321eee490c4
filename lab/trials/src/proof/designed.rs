//! The gains of a file from `bowden design` for a proof: its adaptive law, in `f32` as on a
//! microcontroller, on the plant that the design assumed.

use super::form::{Above, Float, Form, NotBelow, NotNegative, Plant, Positive};
use super::{of_form, Named, Proof, Refusal, NO_PLANT};
use crate::gains::{GainsFile, Known};
use bowden::control::{self, AdaptiveSettings};

/// The proof for the adaptive law of a design.
///
/// # Errors
/// A message if the file has no law in first-order form or no plant, or if a limit is zero.
pub(crate) fn prove(gains: &GainsFile) -> Result<Proof, String> {
    let law = gains.adaptive.as_ref().ok_or(
        "has no [adaptive], because the design found no admissible gains of the adaptive law (`bowden design` prints the reason)",
    )?;
    let known = gains.plant.as_ref().ok_or_else(|| {
        format!("{NO_PLANT} (`bowden design` writes this table if the model file contains a bound on the rate of the disturbance)")
    })?;
    let (low, high) = (law.limits.low(), law.limits.high());
    let mut proof = of_form(&form(law, known)?)?;
    // The law has the wider limits; where neither is met it is the same law.
    if proof.proved && proof.may_meet_the_limit && low + high != 0.0 {
        proof.proved = false;
        proof.refused = Some(Refusal {
            text: Named::Command.text(),
            mend: format!(
                "symmetric command limits instead of {low} and {high}, because the command may saturate within the bounds of the proof"
            ),
        });
    }
    Ok(proof)
}

fn form(law: &AdaptiveSettings<f64, 0>, known: &Known) -> Result<Form, String> {
    let control::Form::FirstOrder { step, .. } = law.form else {
        return Err("[adaptive]: must be in first-order form".to_owned());
    };
    let (low, high) = (law.limits.low(), law.limits.high());
    let command = high.min(-low);
    if !(command.is_finite() && command > 0.0) {
        return Err(format!(
            "[adaptive]: limits {low} to {high} must be finite and on both sides of zero"
        ));
    }
    Ok(Form {
        float: Float::F32,
        k: Positive(law.gain),
        lambda: Positive(law.lambda),
        step: Positive(step),
        epsilon: Positive(law.epsilon),
        z_limit: Positive(law.z_limit),
        command: Positive(command),
        slew: law.limits.slew().map(Positive),
        beta: Above([law.beta.low, law.beta.high]),
        delta: NotBelow([law.delta.low, law.delta.high]),
        plant: Plant {
            alpha: Above(known.alpha),
            disturbance: NotNegative(known.disturbance),
            disturbance_rate: NotNegative(known.disturbance_rate),
            reference: NotNegative(known.reference),
            reference_rate: NotNegative(known.reference_rate),
        },
        regressor: Vec::new(),
    })
}
