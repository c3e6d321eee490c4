//! From the final model to the exported model for firmware.
//!
//! The final model describes the record. The exported model has no effects that refer to the
//! record's first sample ([`clockwork`](crate::export::clockwork)), no curve that the core does not
//! support, and, if requested, gains and shapes within the range that has an inverse
//! ([`invertible`](crate::export::invertible)). If parts are excluded, the rest is refitted on the
//! same segments. The reported errors are those of the exported model.

use super::after_steps::{after_steps, on_record};
use super::causal::{causal, time_constant};
use super::clockwork::{because, has_clockwork, is_clockwork, lost_curve_name, without};
use super::invertible::{caution, nearest, obstacle, stages, without_stages, FeedForward};
use super::{About, LeftOut, ModelFile, NotIdentified, PlayBefore};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::term_name;
use crate::conclude::verdict::{verdict, Verdict};
use crate::fit::{fit_from, Known, Segments, Solution};
use crate::ledger::Ledger;
use crate::model::kind::is_stage;
use crate::problem::still::noise;
use crate::problem::Prepared;
use crate::record::Record;
use crate::scale::{HALF, SWING, TWENTIETH};

/// The reason why a stage is not exported.
const NO_INVERSE: &str = "the term has no inverse, but --invertible requires one";

/// The effect of `--invertible` on the gain of a transmission at the bound.
pub const TIED: &str = "fixed at 2·sigma·kappa_eta·rho by --invertible";

/// The exported model and its errors.
#[derive(Debug, Clone)]
pub struct HandOver {
    /// The exported fit.
    pub fitted: FinalFit,
    /// The files: one, or one for each record with separate gains.
    pub files: Vec<ModelFile>,
    /// Parts of the final model that are excluded.
    pub left_out: Vec<LeftOut>,
    /// Its errors, as shares of the output's standard deviation.
    pub nrmse: Segments,
    /// The errors of the final model, in the same form.
    pub as_fitted: Segments,
    /// Its errors sample by sample with causal rates, in the same form.
    pub causal: Segments,
    /// Time constant of the causal rates \[s\].
    pub time_constant: f64,
    /// The same with a play in front of the hysteresis, if the noise of the input causes the error.
    pub calmed: Option<Calmed>,
    /// Whether a fit within the range that has an inverse was requested.
    pub within_inverse: bool,
    /// Whether it can serve as a feed-forward.
    pub feed_forward: FeedForward,
}

/// A model with play between the measured input and the hysteresis.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Calmed {
    /// Half-width of the play, in the input's unit.
    pub half_width: f64,
    /// Errors sample by sample with causal rates, as shares of the output's standard deviation.
    pub causal_nrmse: Segments,
}

impl HandOver {
    /// Whether the error in firmware is notable, and twice that of the fit. A choice: of the ten measured
    /// rows three get the warning, the positioning drive, whose force is mostly inertia, and a cable tool.
    #[must_use]
    pub fn is_off(&self) -> bool {
        let (fit, firmware) = (self.nrmse.held_out, self.causal.held_out);
        firmware > TWENTIETH && HALF * firmware > fit
    }

    /// Whether `--invertible` has made it different from the final model.
    #[must_use]
    pub fn is_another(&self) -> bool {
        let on_bound = self.fitted.solution.structure.invertible;
        self.within_inverse && (on_bound || !self.left_out.is_empty())
    }

    /// With a play in front of the hysteresis, if it helps.
    fn calmed(&self, records: &[Record], data: &Prepared) -> Result<Option<Calmed>, String> {
        let noise = records.iter().map(|record| noise(&record.input.values));
        let half_width = 0.5 * SWING * noise.fold(0.0, f64::max);
        if !self.is_off() || !self.fitted.solution.structure.hysteresis || half_width <= 0.0 {
            return Ok(None);
        }
        let play = Some(half_width);
        let causal_nrmse = causal(records, data, &self.files, self.time_constant, play)?;
        let helps = causal_nrmse.held_out < HALF * self.causal.held_out;
        Ok(helps.then_some(Calmed {
            half_width,
            causal_nrmse,
        }))
    }

    /// The exported model of a final model. With `invertible`, it is fitted within the range that
    /// has an inverse.
    ///
    /// # Errors
    /// A message if the model cannot be fitted without the excluded parts, or not within the range
    /// that has an inverse.
    pub fn new(
        records: &[Record],
        data: &Prepared,
        ledger: &Ledger,
        done: &FinalFit,
        invertible: bool,
        mut progress: impl FnMut(&str),
    ) -> Result<Self, String> {
        if invertible && !done.solution.structure.hysteresis {
            let because = match done.without_hysteresis {
                Some(_) => "this record cannot distinguish it from a spring and an offset",
                None => "--baseline omits it",
            };
            return Err(format!(
                "--invertible: only the Bouc-Wen hysteresis can be inverted, but {because}"
            ));
        }
        let mut left_out = Vec::new();
        let mut base = done.clone();
        if invertible {
            progress("searching for invertible effects");
            if let Some(other) = without_stages(data, ledger, done, &mut progress)? {
                let names = stages(data, &done.solution).into_iter();
                left_out.extend(names.map(|effect| LeftOut {
                    effect,
                    reason: NO_INVERSE.to_owned(),
                }));
                base = other;
            }
        }
        left_out.extend(records_own(data, &base.solution));
        progress("fitting the exported model");
        base.solution = handed_over(&base, invertible)?;
        base.rmse = Segments::of(data, &base.solution.residual);
        let own = |record| ModelFile::of_record(&base.data, &base.solution, record);
        let several = base.solution.structure.own_gains.max(1);
        let files: Vec<ModelFile> = (0..several).map(own).collect();
        let time_constant = time_constant(data.cutoff)?;
        let share = |rmse: &Segments| rmse.normalised(data, &data.target);
        let mut own = Self {
            nrmse: share(&base.rmse),
            as_fitted: share(&done.rmse),
            causal: causal(records, data, &files, time_constant, None)?,
            calmed: None,
            feed_forward: feed_forward(data, &base.solution, &files)?,
            within_inverse: invertible,
            fitted: base,
            files,
            left_out,
            time_constant,
        };
        if invertible && !own.feed_forward.invertible {
            return Err(format!(
                "--invertible: found no invertible model; as feed-forward: {}",
                own.feed_forward.words()
            ));
        }
        own.calmed = own.calmed(records, data)?;
        own.describe(data, verdict(data, ledger, done));
        Ok(own)
    }

    /// Gives each file its table `about`.
    fn describe(&mut self, data: &Prepared, verdict: Verdict) {
        let several = self.files.len() > 1;
        let mut about = About {
            verdict: Some(verdict.name().to_owned()),
            rates_time_constant_s: self.time_constant,
            fitted_invertible: self.within_inverse,
            feed_forward: self.feed_forward.words(),
            held_out_rmse: Some(self.fitted.rmse.held_out).filter(|rmse| rmse.is_finite()),
            play: self.calmed.map(|calmed| PlayBefore {
                half_width: calmed.half_width,
                held_out_causal: calmed.causal_nrmse.held_out,
            }),
            excluded_terms: self.left_out.clone(),
            ..About::new(&self.fitted.data, &self.fitted.solution)
        }
        .with_errors(&self.nrmse, Some(&self.causal), self.as_fitted.held_out);
        if self.fitted.solution.structure.invertible {
            let tied = NotIdentified {
                parameter: "gain".to_owned(),
                reason: TIED.to_owned(),
            };
            about.not_identified.insert(0, tied);
        }
        for (record, file) in self.files.iter_mut().enumerate() {
            let piece = data.pieces.get(record).filter(|_| several);
            let gains_of = piece.and_then(|_| about.records.get(record).cloned());
            file.about = Some(About {
                gains_of,
                ..about.clone()
            });
        }
    }
}

/// What belongs to the record among the parts of a solution.
fn records_own(data: &Prepared, solution: &Solution) -> Vec<LeftOut> {
    let terms = solution.structure.terms.iter();
    let clocks = terms.filter(|t| is_clockwork(&t.effect));
    let curve = lost_curve_name(data, solution).map(|effect| LeftOut {
        effect,
        reason: "firmware supports only curves over a position, a load or a velocity".to_owned(),
    });
    clocks
        .map(|term| LeftOut {
            effect: term_name(data, term),
            reason: because(term.effect.info().family).to_owned(),
        })
        .chain(curve)
        .collect()
}

/// The fit without the excluded parts, if requested within the range that has an inverse.
pub(crate) fn handed_over(base: &FinalFit, invertible: bool) -> Result<Solution, String> {
    match after_steps(&base.data, &base.solution) {
        Some(after) => {
            let solution = fitted_without(&after, &base.solution, invertible)?;
            Ok(on_record(&base.data, solution))
        }
        None => fitted_without(&base.data, &base.solution, invertible),
    }
}

fn fitted_without(data: &Prepared, last: &Solution, invertible: bool) -> Result<Solution, String> {
    let mut structure = without(last, |effect| {
        is_clockwork(effect) || (invertible && is_stage(effect))
    });
    let free = match has_clockwork(last) || structure.terms.len() < last.structure.terms.len() {
        false => last.clone(),
        true => fit_from(data, &structure, Some(&Known::of(last)), 0.0)
            .ok_or("the model cannot be fitted without the terms that belong only to the record")?,
    };
    if !invertible || !stands_against(data, &free)? {
        return Ok(free);
    }
    structure.invertible = true;
    let within = fit_from(data, &structure, Some(&Known::of(&free)), 0.0);
    within.ok_or_else(|| {
        "--invertible: the model cannot be fitted with sigma at or below its bound".to_owned()
    })
}

/// Whether any of a solution's models cannot be inverted.
fn stands_against(data: &Prepared, solution: &Solution) -> Result<bool, String> {
    for record in 0..solution.structure.own_gains.max(1) {
        if obstacle(&ModelFile::of_record(data, solution, record))?.is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether all files can be inverted; if not, the reason and the nearest model.
fn feed_forward(
    data: &Prepared,
    solution: &Solution,
    files: &[ModelFile],
) -> Result<FeedForward, String> {
    let mut because = None;
    for (index, file) in files.iter().enumerate() {
        if let Some(reason) = obstacle(file)? {
            because = Some(match files.len() {
                1 => reason,
                _ => format!("{reason} in file {}", index + 1),
            });
            break;
        }
    }
    Ok(FeedForward {
        invertible: because.is_none(),
        caution: match because {
            Some(_) => None,
            None => files.iter().find_map(caution),
        },
        nearest: match because {
            Some(_) => nearest(data, solution, files)?,
            None => None,
        },
        reason: because,
    })
}
