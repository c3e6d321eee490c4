//! Whether a model can be turned round for a feed-forward, and the fit of one that can.
//!
//! A [`Compensator`] needs a transmission whose output rises with its input on every branch
//! and no stage before or behind it. A free fit need not be so: the rig may well have a
//! steeper loop than any model with an inverse. `--invertible` fits within the bound, by a
//! constraint on the linear gains (`fit::tie`), and says what that costs.

use crate::channels::Prepared;
use crate::closing::{close, Ledger};
use crate::columns::raw_columns;
use crate::export::{ModelFile, MOST_TERMS};
use crate::final_fit::FinalFit;
use crate::fit::{Segments, Solution, MARGIN};
use crate::intervals::term_name;
use crate::structure::{Role, Structure};
use bowden::control::Compensator;
use bowden::effect::Effect;
use bowden::Real;
use serde::Serialize;

/// Whether the model that is handed over can be a feed-forward.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeedForward {
    /// Whether `Compensator::try_new` takes it, in `f32` and in `f64`.
    pub invertible: bool,
    /// Why not.
    pub because: Option<String>,
    /// The nearest model that it takes, where one parameter is all that stands against it.
    pub nearest: Option<Nearest>,
}

/// The nearest model that has an inverse, without a new fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Nearest {
    /// What is changed, in words.
    pub changed: String,
    /// Its errors, as shares of the output's standard deviation.
    pub nrmse: Segments,
}

impl FeedForward {
    /// `yes`, or `no, because …`.
    #[must_use]
    pub fn words(&self) -> String {
        match &self.because {
            None => "yes".to_owned(),
            Some(because) => format!("no, because {because}"),
        }
    }
}

/// Whether no compensator can have an effect among its terms.
#[must_use]
pub fn is_stage(effect: &Effect<f64>) -> bool {
    effect.is_output_stage() || effect.is_input_stage()
}

/// What stands against turning a model round; `None` where nothing does.
///
/// # Errors
/// One sentence where the file is no model.
pub fn obstacle(file: &ModelFile) -> Result<Option<String>, String> {
    if accepted::<f32>(file)? && accepted::<f64>(file)? {
        return Ok(None);
    }
    let Some(t) = &file.transmission else {
        return Ok(Some("the model has no bouc-wen to invert".to_owned()));
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
            return Ok(Some(format!("the inverse of {} jumps", term.effect)));
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

fn accepted<T: Real>(file: &ModelFile) -> Result<bool, String> {
    let model = file.model_in::<T, MOST_TERMS>()?;
    Ok(Compensator::try_new(&model).is_ok())
}

/// The largest sigma with which a transmission has an inverse.
fn bound(gain: f64, kappa_eta: f64, rho: f64) -> f64 {
    gain.abs() / (2.0 * kappa_eta.abs() * rho)
}

/// A number as people write it.
pub(crate) fn three_digits(value: f64) -> String {
    let digits = (2.0 - value.abs().max(1e-12).log10().floor()).clamp(0.0, 12.0) as usize;
    if value.abs() >= 1e5 || (value != 0.0 && value.abs() < 1e-4) {
        format!("{value:.2e}")
    } else {
        format!("{value:.digits$}")
    }
}

/// The loop again without stages among its names, where its final model has one.
///
/// # Errors
/// One sentence where the model without stages cannot be fitted at all.
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

/// The stages among the names of a solution.
#[must_use]
pub fn stages(data: &Prepared, solution: &Solution) -> Vec<String> {
    let terms = solution.structure.terms.iter();
    let stages = terms.filter(|t| is_stage(&t.effect));
    stages.map(|t| term_name(data, t)).collect()
}

/// The nearest model with an inverse, where sigma is all that stands against it; its errors
/// are those without a new fit.
///
/// # Errors
/// One sentence where a file is no model.
pub fn nearest(
    data: &Prepared,
    solution: &Solution,
    files: &[ModelFile],
) -> Result<Option<Nearest>, String> {
    let [file] = files else {
        return Ok(None);
    };
    let Some(t) = file.transmission else {
        return Ok(None);
    };
    let sigma = bound(t.gain, t.kappa_eta, t.rho) * (1.0 - MARGIN);
    if sigma < 0.5 || sigma >= t.sigma {
        return Ok(None);
    }
    let shapes = [(Role::Sigma, sigma)];
    let rmse = changed(data, solution, &shapes);
    Ok(rmse.map(|rmse| Nearest {
        changed: format!("sigma = {}", three_digits(sigma)),
        nrmse: rmse.normalised(data, &data.target),
    }))
}

/// The errors of a solution with some of its shapes changed and its gains as they are.
fn changed(data: &Prepared, solution: &Solution, shapes: &[(Role, f64)]) -> Option<Segments> {
    let mut values = solution.values.clone();
    for (free, value) in solution.free.iter().zip(&mut values) {
        if let Some((_, other)) = shapes.iter().find(|(role, _)| *role == free.role) {
            *value = *other;
        }
    }
    let raw = raw_columns(data, &solution.structure, &solution.free, &values)?;
    let mut prediction = vec![0.0; data.work_len()];
    for (column, gain) in raw.columns.iter().zip(&solution.gains) {
        for (p, c) in prediction.iter_mut().zip(column) {
            *p += gain * c;
        }
    }
    let filtered = data.filtered(&prediction);
    let pairs = data.target.iter().zip(&filtered);
    let residual: Vec<f64> = pairs.map(|(y, p)| y - p).collect();
    Some(Segments::of(data, &residual))
}
