//! A fitted model: its parts, its parameters, its errors.

use crate::conclude::by_file::{nrmse_by_file, rmse_by_file, FileErrors};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::{
    gain_names, numbered, parameters, term_name, term_title, Parameter,
};
use crate::fit::{Segments, Solution};
use crate::problem::Prepared;

/// The baseline model.
#[derive(Debug, Clone)]
pub struct ModelFacts {
    /// Names of all its parts.
    pub effects: Vec<String>,
    /// Its parameters, gains first.
    pub parameters: Vec<Parameter>,
    /// Rms errors in the unit of the output.
    pub rmse: Segments,
    /// The same errors as fractions of the standard deviation of the filtered output.
    pub nrmse: Segments,
    /// Errors relative to the unfiltered output, as fractions of its standard deviation.
    pub nrmse_raw: Segments,
    /// Errors by file; `None` for a single record.
    pub rmse_by_file: Option<Vec<FileErrors>>,
    /// The same errors as fractions of the standard deviation of the filtered output in each file.
    pub nrmse_by_file: Option<Vec<FileErrors>>,
}

/// The final model.
#[derive(Debug, Clone)]
pub struct FinalFacts {
    /// Names of all its parts.
    pub effects: Vec<String>,
    /// Whether the parameters were fitted to the selection segment too.
    pub refitted: bool,
    /// Its parameters, gains first.
    pub parameters: Vec<Parameter>,
    /// The printed name of each parameter. The names of two ripples, for example, differ by their
    /// order.
    pub titles: Vec<String>,
    /// Number of leading parameters that are gains of one file.
    pub own_gains: usize,
    /// Names of the separate gains of each file.
    pub gain_names: [&'static str; 3],
    /// The separate gains of each file; empty if the gains are common to all files.
    pub gains_by_file: Vec<GainsOfFile>,
    /// Rms errors in the unit of the output.
    pub rmse: Segments,
    /// The same errors as fractions of the standard deviation of the filtered output.
    pub nrmse: Segments,
    /// Errors by file; `None` for a single record.
    pub rmse_by_file: Option<Vec<FileErrors>>,
    /// The same errors as fractions of the standard deviation of the filtered output in each file.
    pub nrmse_by_file: Option<Vec<FileErrors>>,
}

/// The gains of one file.
#[derive(Debug, Clone, PartialEq)]
pub struct GainsOfFile {
    /// The file.
    pub path: String,
    /// The gains in the order of [`FinalFacts::gain_names`].
    pub gains: [Option<Parameter>; 3],
}

impl ModelFacts {
    pub(super) fn new(data: &Prepared, declared: &Solution) -> Self {
        Self {
            effects: effects(data, declared),
            parameters: parameters(data, declared),
            rmse: declared.rmse,
            nrmse: declared.rmse.normalised(data, &data.target),
            nrmse_raw: raw(data, declared),
            rmse_by_file: rmse_by_file(data, declared),
            nrmse_by_file: nrmse_by_file(data, declared),
        }
    }
}

impl FinalFacts {
    pub(super) fn new(data: &Prepared, done: &FinalFit) -> Self {
        let last = &done.solution;
        let parameters = parameters(&done.data, last);
        let (gain_names, _) = gain_names(data.mode);
        let own_gains = match last.structure.own_gains {
            0 => 0,
            _ => last.structure.base(),
        };
        let of_file = |record: usize, path: &str| GainsOfFile {
            path: path.to_owned(),
            gains: gain_names.map(|name| {
                let name = numbered(name, record);
                parameters.iter().find(|p| p.name == name).cloned()
            }),
        };
        let files = done.data.pieces.iter().enumerate();
        Self {
            effects: effects(data, last),
            refitted: done.refitted,
            titles: parameters.iter().map(|p| title(done, p)).collect(),
            gains_by_file: match own_gains {
                0 => Vec::new(),
                _ => files.map(|(k, piece)| of_file(k, &piece.path)).collect(),
            },
            parameters,
            own_gains,
            gain_names,
            rmse: done.rmse,
            nrmse: done.rmse.normalised(data, &data.target),
            rmse_by_file: rmse_by_file(data, last),
            nrmse_by_file: nrmse_by_file(data, last),
        }
    }
}

/// Names of all parts of a model.
pub(super) fn effects(data: &Prepared, solution: &Solution) -> Vec<String> {
    let hysteresis = solution.structure.hysteresis.then(|| "bouc-wen".to_owned());
    hysteresis
        .into_iter()
        .chain(solution.structure.terms.iter().map(|t| term_name(data, t)))
        .chain(solution.structure.table.iter().map(|t| t.name(data)))
        .collect()
}

/// The name of a parameter, with the property that distinguishes two effects of the same name.
fn title(done: &FinalFit, parameter: &Parameter) -> String {
    let term = parameter
        .term
        .and_then(|index| done.solution.structure.terms.get(index));
    let Some(term) = term else {
        return parameter.name.clone();
    };
    match parameter.name.strip_prefix(&term_name(&done.data, term)) {
        Some(rest) => term_title(&done.data, term) + rest,
        None => parameter.name.clone(),
    }
}

/// Errors relative to the unfiltered output, as fractions of its standard deviation.
fn raw(data: &Prepared, solution: &Solution) -> Segments {
    let prediction = solution.unfiltered.iter().step_by(data.stride);
    let residual: Vec<f64> = data
        .target_raw
        .iter()
        .zip(prediction)
        .map(|(y, p)| y - p)
        .collect();
    Segments::of(data, &residual).normalised(data, &data.target_raw)
}
