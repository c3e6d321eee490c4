//! Whether a model can be inverted for a feed-forward, and the fit of an invertible model.
//!
//! A [`Compensator`] needs a transmission whose output rises with its input on every branch,
//! without input or output stages. A free fit need not satisfy this: the loop of the rig may be
//! steeper than that of any invertible model. `--invertible` fits within the bound, by a constraint
//! on the linear gains (`fit::tie`), and reports the increase of the error.

use super::vector::load;
use super::{ModelFile, MOST_TERMS};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::term_name;
use crate::fit::{Segments, Solution};
use crate::ledger::Ledger;
pub use crate::model::kind::is_stage;
use crate::model::structure::{Role, Structure};
use crate::problem::Prepared;
use crate::search::close;
use bowden::control::{Changed, Compensator};
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample, Term};
use bowden::Real;
use serde::de::DeserializeOwned;
use serde::Serialize;

/// Whether the exported model can serve as a feed-forward.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeedForward {
    /// Whether `Compensator::try_new` accepts it, in `f32` and in `f64`.
    pub invertible: bool,
    /// Why not.
    pub reason: Option<String>,
    /// The nearest invertible model, if this one is not invertible.
    pub nearest: Option<Nearest>,
    /// Cautions about its inverse, if there is one: its sign, and what is not proved in `f32`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub caution: Option<String>,
}

/// The nearest invertible model, without a refit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Nearest {
    /// The changes, in words.
    pub changed: String,
    /// Its errors, as shares of the output's standard deviation.
    pub nrmse: Segments,
}

impl FeedForward {
    /// `yes`, with cautions, or `no, because …`.
    #[must_use]
    pub fn words(&self) -> String {
        match (&self.reason, &self.caution) {
            (None, None) => "yes".to_owned(),
            (None, Some(caution)) => format!("yes, but {caution}"),
            (Some(because), _) => format!("no, because {because}"),
        }
    }
}

/// The reason why a model is not invertible; `None` if it is.
///
/// # Errors
/// A message if the file is not a model.
pub fn obstacle(file: &ModelFile) -> Result<Option<String>, String> {
    if accepted::<f32>(file)? && accepted::<f64>(file)? {
        return Ok(None);
    }
    let Some(t) = &file.transmission else {
        return Ok(Some(
            "the model has no Bouc-Wen hysteresis to invert".to_owned(),
        ));
    };
    for term in &file.terms {
        let effect = term.effect()?;
        if effect.is_output_stage() {
            return Ok(Some(format!(
                "{} acts on the whole output and cannot be subtracted from it",
                term.effect
            )));
        }
        if effect.is_input_stage() {
            return Ok(Some(format!(
                "the inverse of {} is discontinuous",
                term.effect
            )));
        }
    }
    let (gain, kappa) = match file.mode.as_str() {
        "torque" => ("B", "kappa_eta"),
        _ => ("kappa_x", "|kappa_eta|"),
    };
    if t.gain == 0.0 {
        return Ok(Some(format!("{gain} is zero")));
    }
    let bound = bound(t.gain, t.kappa_eta, t.rho);
    Ok(Some(format!(
        "sigma {} > {} = {gain}/(2·{kappa}·rho)",
        three_digits(t.sigma),
        three_digits(bound)
    )))
}

/// Up to which n the slope of the `f32` step is proved, over the reals: `theorems/Slope.v`.
const PROVED_N: f64 = 4.0;

/// Up to which n it is measured to be as the inverse needs it, and by how much it is above that
/// beyond: `tests/hysteresis/bounded.rs`.
const MEASURED_N: f64 = 10.0;
const ABOVE: f64 = 1.39;

/// Cautions about the inverse of a model: a torque that falls while its input rises, for which no
/// controller is designed, and what is not proved.
#[must_use]
pub fn caution(file: &ModelFile) -> Option<String> {
    let t = file.transmission.as_ref()?;
    let falls = (file.mode == "torque" && t.gain < 0.0).then(|| {
        "the output falls while the input rises, which `bowden design` rejects".to_owned()
    });
    let all: Vec<String> = falls.into_iter().chain(unproved(file)).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// What is not proved of the inverse that a model has: that one input belongs to each output of
/// the step that `f32` takes.
fn unproved(file: &ModelFile) -> Option<String> {
    let t = file.transmission.as_ref()?;
    let against = match file.mode.as_str() {
        "torque" => t.kappa_eta,
        _ => -t.kappa_eta,
    };
    let is_aided = t.kappa_eta == 0.0 || (against < 0.0) == (t.gain > 0.0);
    if is_aided || t.n <= PROVED_N {
        return None;
    }
    let n = three_digits(t.n);
    let has_room = ABOVE * t.sigma <= bound(t.gain, t.kappa_eta, t.rho);
    Some(match t.n <= MEASURED_N || has_room {
        true => format!("for n = {n}, tests show one input for each output of the f32 step, but this is not proved"),
        false => format!("for n = {n} and sigma {} close to its bound, the f32 step may have more than one input for an output", three_digits(t.sigma)),
    })
}

fn accepted<T: Real + DeserializeOwned>(file: &ModelFile) -> Result<bool, String> {
    let model = file.model_in::<T, MOST_TERMS>()?;
    Ok(Compensator::try_new(&model).is_ok())
}

/// The largest sigma with which a transmission has an inverse.
fn bound(gain: f64, kappa_eta: f64, rho: f64) -> f64 {
    gain.abs() / (2.0 * kappa_eta.abs() * rho)
}

/// A number in its usual notation.
#[must_use]
pub fn three_digits(value: f64) -> String {
    let digits = (2.0 - value.abs().max(1e-12).log10().floor()).clamp(0.0, 12.0) as usize;
    if value.abs() >= 1e5 || (value != 0.0 && value.abs() < 1e-4) {
        format!("{value:.2e}")
    } else {
        format!("{value:.digits$}")
    }
}

/// The search again without stages, if its final model has one.
///
/// # Errors
/// A message if the model without stages cannot be fitted.
pub fn without_stages(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    progress: impl FnMut(&str),
) -> Result<Option<FinalFit>, String> {
    let mut terms = done.solution.structure.terms.iter();
    if !terms.any(|t| is_stage(&t.effect)) {
        return Ok(None);
    }
    let mut structure = Structure {
        no_stages: true,
        ..ledger.declared.structure.clone()
    };
    structure.terms.retain(|t| !is_stage(&t.effect));
    let anew = close(data, &structure, progress)?;
    Ok(Some(FinalFit::new(data, &anew)))
}

/// The stages among the terms of a solution.
#[must_use]
pub fn stages(data: &Prepared, solution: &Solution) -> Vec<String> {
    let terms = solution.structure.terms.iter();
    let stages = terms.filter(|t| is_stage(&t.effect));
    stages.map(|t| term_name(data, t)).collect()
}

/// The differences between a compensator and the model with these terms; `None` if there are none.
#[must_use]
pub fn words<const N: usize>(changed: &Changed<f64, N>, terms: &[Term<f64>]) -> String {
    let lowered = [("sigma", changed.sigma), ("rho", changed.rho)];
    let lowered = lowered.into_iter().filter_map(|(name, lowered)| {
        let (from, to) = lowered?;
        let (from, to) = (three_digits(from), three_digits(to));
        Some(format!("{name} {from} → {to}"))
    });
    let gone = changed.left_out().filter_map(|index| {
        let term = terms.get(index)?;
        Some(format!("without {}", term.effect.name()))
    });
    let all: Vec<String> = lowered.chain(gone).collect();
    all.join(", ")
}

/// The nearest invertible model from `Compensator::try_nearest`, and its errors, without a refit.
/// `None` if there is none, or if there is a model for each record.
///
/// # Errors
/// A message if a file is not a model.
pub fn nearest(
    data: &Prepared,
    solution: &Solution,
    files: &[ModelFile],
) -> Result<Option<Nearest>, String> {
    let [file] = files else {
        return Ok(None);
    };
    let model = file.model::<MOST_TERMS>()?;
    let Ok((compensator, changed)) = Compensator::try_nearest(&model) else {
        return Ok(None);
    };
    let kept = |index: &usize| changed.left_out().all(|gone| gone != *index);
    let terms: Vec<Term<f64>> = (0..model.terms().len())
        .filter(kept)
        .map(|index| model.terms()[index])
        .collect();
    let changed = words(&changed, model.terms());
    let model: Model<f64, MOST_TERMS> =
        Model::try_new(Some(*compensator.transmission()), &terms).map_err(|e| e.to_string())?;
    let rmse = Segments::of(data, &left_by(data, solution, &model)?);
    Ok(Some(Nearest {
        changed,
        nrmse: rmse.normalised(data, &data.target),
    }))
}

/// The residual of a model in the filtered output; each record starts from the fitted hysteresis
/// state.
fn left_by(
    data: &Prepared,
    solution: &Solution,
    model: &Model<f64, MOST_TERMS>,
) -> Result<Vec<f64>, String> {
    let mut output = Vec::with_capacity(data.work_len());
    for (record, piece) in data.pieces.iter().enumerate() {
        let eta = solution.value(Role::Eta0 { record }).unwrap_or(0.0);
        let mut state = ModelState::with_eta(eta).map_err(|e| e.to_string())?;
        for i in piece.work.clone() {
            let input = data.input.motion[i];
            let channels: Vec<Motion<f64>> = data.channels.iter().map(|c| c.motion[i]).collect();
            let sample = Sample {
                dt: data.dt,
                input,
                load: load(data, input.position, &channels),
                channels: &channels,
            };
            output.push(model.step(&mut state, &sample));
        }
    }
    let answered = data.filtered(&output);
    Ok(data
        .target
        .iter()
        .zip(&answered)
        .map(|(y, p)| y - p)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::super::TransmissionFile;
    use super::{caution, ModelFile};

    fn file(mode: &str, kappa_eta: f64, sigma: f64, n: f64) -> ModelFile {
        ModelFile {
            schema: "bowden.model/1".to_owned(),
            mode: mode.to_owned(),
            channels: Vec::new(),
            transmission: Some(TransmissionFile {
                gain: 1.0,
                kappa_eta,
                offset: 0.0,
                rho: 0.1,
                sigma,
                n,
            }),
            terms: Vec::new(),
            about: None,
        }
    }

    /// The greatest sigma that has an inverse is 1/(2·7·0.1) = 0.714 here, 0.514 over 1.39.
    #[test]
    fn what_is_not_proved_of_an_inverse_is_said() {
        let said = |n, sigma| caution(&file("torque", 7.0, sigma, n)).unwrap_or_default();
        assert_eq!(said(4.0, 0.7), "");
        assert!(said(4.1, 0.7).contains("n = 4.10, tests show one input for each output"));
        assert!(said(10.0, 0.7).contains("but this is not proved"));
        assert!(said(20.0, 0.51).contains("but this is not proved"));
        assert!(said(20.0, 0.52).contains("may have more than one input"));
        // A hysteresis that helps its gain needs no slope.
        assert_eq!(caution(&file("torque", -7.0, 0.7, 20.0)), None);
        assert_eq!(caution(&file("displacement", 7.0, 0.7, 20.0)), None);
        assert!(caution(&file("displacement", -7.0, 0.7, 20.0)).is_some());
    }
}
