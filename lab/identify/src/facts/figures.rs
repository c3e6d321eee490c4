//! The data that a page draws in addition to the results table: signals and residuals.

use super::round::rounds_in_order;
use crate::check::Check;
use crate::conclude::final_fit::FinalFit;
use crate::conclude::signals::Signals;
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::model::Variable;
use crate::problem::Prepared;
use crate::score::autocorrelation::Autocorrelation;
use crate::score::binned::{binned, Bin};
use crate::score::blocks::{blocks, BLOCKS};
use crate::score::density::Spectrum;

/// Maximum number of bins for a variable.
const BINS: usize = 20;

/// All data that a page draws for a run. Each pair of residuals is from the baseline and the final
/// model or, in a validation, without and with the fitted gain and offset.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// The signals over time.
    pub signals: Signals,
    /// The residuals versus each measured or derived variable.
    pub over: Vec<Dependence>,
    /// The autocorrelation of the residuals over all samples that are not excluded.
    pub autocorrelation: Autocorrelation,
    /// The spectra of the residuals on the fit segment.
    pub spectrum: Spectrum,
    /// The effect of each term on each block of the fit segment. Terms that are not in the final
    /// model are last.
    pub blocks: Vec<BlockScores>,
}

/// Residuals versus a variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Dependence {
    /// The variable in words.
    pub words: String,
    /// Its unit, if the record states it.
    pub unit: Option<String>,
    /// Bins in ascending order. Each bin has one mean for each of the two residuals.
    pub bins: Vec<Bin>,
}

/// The effect of a term on each block.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockScores {
    /// Share of the block's squared error that the term removed; negative if it added error.
    pub removed: [f64; BLOCKS],
}

impl Figures {
    /// The data of a page for an identified record and a named model.
    ///
    /// # Errors
    /// A message if the parts of the model cannot be computed.
    pub fn of_close(
        data: &Prepared,
        ledger: &Ledger,
        (name, shown): (&str, &FinalFit),
    ) -> Result<Self, String> {
        let (first, last) = (&ledger.declared, &shown.solution);
        let models = [
            ("baseline", first.prediction.as_slice()),
            (name, last.prediction.as_slice()),
        ];
        let mut figures = Self::new(data, models, last)?;
        let mut before = first;
        for after in rounds_in_order(ledger) {
            figures.blocks.push(BlockScores {
                removed: removed(data, before, after),
            });
            before = after;
        }
        Ok(figures)
    }

    /// The data of a page for a validation.
    ///
    /// # Errors
    /// A message if the parts of the model cannot be computed.
    pub fn of_check(check: &Check) -> Result<Self, String> {
        let moved = check.line.of(&check.model.prediction);
        let models = [
            ("model", check.model.prediction.as_slice()),
            ("with gain and offset", moved.as_slice()),
        ];
        Self::new(&check.data, models, &check.model)
    }

    fn new(data: &Prepared, models: [(&str, &[f64]); 2], whole: &Solution) -> Result<Self, String> {
        let signals = Signals::of(data, models, whole)?;
        let rows = signals.counting();
        let residuals = signals.residuals.each_ref().map(Vec::as_slice);
        Ok(Self {
            over: over(data, whole, &rows, residuals),
            autocorrelation: Autocorrelation::of(data, &rows, &residuals),
            spectrum: Spectrum::of(data, &residuals),
            blocks: Vec::new(),
            signals,
        })
    }
}

/// The residuals versus all variables of the record.
fn over(
    data: &Prepared,
    solution: &Solution,
    rows: &[usize],
    residuals: [&[f64]; 2],
) -> Vec<Dependence> {
    let residuals = residuals.map(|r| rows.iter().map(|&i| r[i]).collect::<Vec<f64>>());
    let all = Variable::all(data, solution.structure.hysteresis);
    let of = |variable: Variable| {
        let values = variable.values(data, &solution.eta)?;
        let values: Vec<f64> = rows.iter().map(|&i| values[i * data.stride]).collect();
        Some(Dependence {
            words: variable.words(data),
            unit: variable.unit(data),
            bins: binned(&values, &residuals, BINS),
        })
    };
    all.into_iter().filter_map(of).collect()
}

/// Share of each block's squared error that the second model removes.
fn removed(data: &Prepared, before: &Solution, after: &Solution) -> [f64; BLOCKS] {
    let mut shares = [0.0; BLOCKS];
    for (share, block) in shares.iter_mut().zip(blocks(data)) {
        let rows = &data.split.fit[block];
        let sse = |s: &Solution| rows.iter().map(|&i| s.residual[i].powi(2)).sum::<f64>();
        *share = 1.0 - sse(after) / sse(before).max(f64::MIN_POSITIVE);
    }
    shares
}
