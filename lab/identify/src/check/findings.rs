//! The findings of a validation, the most important first.

use super::{Check, Verdict, HOLDS};
use crate::conclude::files_apart::is_far;
use crate::conclude::finding::Finding;
use crate::conclude::verdict::POOR;
use crate::scale::PART;

impl Check {
    /// The findings.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let mut all = vec![self.main()];
        match self.verdict {
            Verdict::Holds => all.extend(self.reserves()),
            Verdict::GainOrOffsetMoved => all.extend(self.of_line()),
            Verdict::DoesNotHold => all.extend(self.reasons()),
            Verdict::CannotTell | Verdict::DefectiveRecord => {}
        }
        if self.is_inexact_a_reason() {
            all.extend(self.reference().map(|own| Finding::ModelInexact { own }));
        }
        if self.about.verdict.as_deref() == Some("not-transferable") {
            all.push(Finding::ModelNotTransferable);
        }
        all
    }

    /// An error as a share of the output's standard deviation.
    fn share(&self, rmse: f64) -> f64 {
        rmse / self.deviation
    }

    /// The finding that gives the verdict.
    fn main(&self) -> Finding {
        let error = self.share(self.rmse);
        let own = self.reference();
        let in_unit = |holds| Finding::ErrorAsExpectedInUnit {
            rmse: [self.rmse, self.about.held_out_rmse.unwrap_or(f64::NAN)],
            unit: self.data.output_unit.clone(),
            error,
            holds,
        };
        match (self.verdict, own) {
            (Verdict::Holds, Some(own)) if error <= HOLDS * own => {
                Finding::ErrorAsExpected { error, own }
            }
            (Verdict::Holds, _) if self.is_as_at_home() && !self.is_noise() => in_unit(true),
            (Verdict::Holds, _) => Finding::ErrorIsNoise { error },
            (Verdict::GainOrOffsetMoved, _) => self.line_changed(),
            (Verdict::DoesNotHold, own) => Finding::ErrorTooLarge {
                error,
                own,
                with_line: self.share(self.rmse_gain_offset),
            },
            (Verdict::CannotTell, _) if self.is_quiet() => Finding::OutputAtNoise,
            (Verdict::CannotTell, _) if self.is_as_at_home() => in_unit(false),
            (Verdict::CannotTell, Some(_)) => Finding::ErrorAtLimit {
                error,
                limit: self.share(self.allowed.unwrap_or(f64::NAN)),
            },
            (Verdict::CannotTell, None) => Finding::ErrorWithoutLimit { error },
            (Verdict::DefectiveRecord, _) => Finding::DefectiveMeasurement {
                defects: self.spoilt.clone(),
            },
        }
    }

    /// The change of the gain and the offset, or of the offset alone if the gain has not changed.
    fn line_changed(&self) -> Finding {
        let gain = self.line.gain_moved();
        let (offset, rmse) = match gain {
            false => (self.mean, self.rmse_offset()),
            true => (self.line.offset.value, self.rmse_gain_offset),
        };
        Finding::LineChanged {
            gain: gain.then_some(self.line.gain),
            offset,
            unit: self.data.output_unit.clone(),
            error: self.share(rmse),
            limit: self.share(self.allowed.unwrap_or(f64::NAN)),
        }
    }

    /// The question about a gain that has changed by far.
    fn of_line(&self) -> Option<Finding> {
        let is_far = self.line.gain_moved() && is_far(self.line.gain.value);
        is_far.then(|| Finding::OutputUnitDiffers {
            output: self.data.output_name.clone(),
        })
    }

    /// The reserves about a model that holds.
    fn reserves(&self) -> Vec<Finding> {
        let mut all = Vec::new();
        if self.line.gain_moved() || self.line.offset_moved(self.deviation) {
            all.push(self.line_changed());
        }
        let own = self.reference().filter(|own| *own >= POOR);
        all.extend(own.map(|own| Finding::ModelInexact { own }));
        if self.is_noise() && self.rmse > POOR * self.deviation {
            all.push(Finding::OutputAtNoise);
        }
        let made = self.made_of_input.map(|made| self.share(made));
        let made = made.filter(|made| *made < PART);
        all.extend(made.map(|share| Finding::InputContributesLittle {
            input: self.data.input.name.clone(),
            share,
        }));
        all
    }

    /// Why a model does not hold: the record is suspected before the rig.
    fn reasons(&self) -> Vec<Finding> {
        let mut all = Vec::new();
        if self.is_mended() && self.line.gain.value > 0.0 {
            all.push(self.line_changed());
        }
        if let Some(suspicion) = &self.suspicion {
            all.push(Finding::LoggedDifferently(suspicion.clone()));
            return all;
        }
        let first = self.depends_on.first();
        all.push(Finding::ResidualDependsOn {
            variable: first.map(|first| first.variable.words(&self.data)),
            is_tested: first.is_none_or(|first| first.p.is_some()),
        });
        if !self.outside.is_empty() {
            all.push(Finding::RangesExceeded {
                ranges: self.outside.clone(),
            });
        }
        all
    }

    /// Whether the error may be that of another motion on a model that was never exact.
    fn is_inexact_a_reason(&self) -> bool {
        let may_be = match self.verdict {
            Verdict::DoesNotHold => self.suspicion.is_none(),
            Verdict::GainOrOffsetMoved => self.line.gain_moved(),
            Verdict::CannotTell => self.is_just_above() && !self.is_as_at_home(),
            Verdict::Holds | Verdict::DefectiveRecord => false,
        };
        may_be && self.was_inexact()
    }
}

/// The findings in words.
pub(crate) fn summary(findings: &[Finding]) -> String {
    let words: Vec<String> = findings.iter().map(Finding::words).collect();
    words.join(" ")
}
