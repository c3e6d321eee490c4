//! Findings about a record, its model or the rig, besides the missing mechanisms. Each finding has
//! a code, a severity and its evidence; [`Finding::words`] gives its sentences.

use super::line::Fitted;
use crate::alteration::Suspicion;
use crate::ledger::{CoarseChannel, FileApart};
use crate::record::Defect;
use crate::score::explains::Explained;
use crate::score::ranges::Outside;
use serde::Serialize;

/// The severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Information.
    Note,
    /// A reason to doubt part of the model.
    Warning,
    /// A reason not to use the model.
    Error,
}

/// A finding with its evidence. Its code in the JSON is the variant's name in kebab case.
///
/// Errors are fractions of the output's standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "code", content = "evidence", rename_all = "kebab-case")]
pub enum Finding {
    /// The rate of the output follows the input.
    OutputIntegrates {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
        /// Whether the input may be the force, so that the output creeps.
        may_creep: bool,
    },
    /// In some files the ratio of the output to the input differs from that in the other files.
    FilesScaled {
        /// These files.
        files: Vec<FileApart>,
        /// Number of files in the fit.
        of: usize,
        /// The output's unit.
        unit: Option<String>,
    },
    /// The records appear to be logged differently from what the model assumes.
    LoggedDifferently(Suspicion),
    /// Neighbouring input rows are uncorrelated, and the output follows the input row by row.
    RowsShuffled {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
    },
    /// The input does not move.
    InputAtRest {
        /// The input's column.
        input: String,
    },
    /// A channel replaces the input in the model, although the input alone explains the output.
    ChannelTakesOver {
        /// The input's column.
        input: String,
        /// Fractions of the variance of the held-out output.
        explains: Explained,
        /// Number of channels.
        channels: usize,
        /// Fraction that the input explains in the baseline model.
        alone: f64,
    },
    /// The input explains less than half of the output.
    NothingExplained {
        /// The input's column.
        input: String,
        /// Fractions of the variance of the held-out output.
        explains: Explained,
        /// Number of channels.
        channels: usize,
    },
    /// The error on the held-out segment is so large that the rig must have changed.
    RigChanged {
        /// Error on the fit segment.
        fit: f64,
        /// Error on the held-out segment.
        held_out: f64,
        /// Time \[s\] after which the error is large, if this time is within the held-out segment.
        since: Option<f64>,
        /// The output's column.
        output: String,
        /// The added terms.
        terms: Vec<String>,
    },
    /// A held-out file differs from the others by gain and offset.
    HeldOutFileScaled {
        /// The file.
        path: String,
        /// The gain.
        gain: f64,
        /// The offset, in the output's unit.
        offset: f64,
        /// The output's unit.
        unit: Option<String>,
        /// Error with both.
        error: f64,
    },
    /// The model does not describe a held-out file, even with another gain and offset.
    HeldOutFileDiffers,
    /// The mean of the held-out output predicts it better than the model does.
    WorseThanConstant {
        /// Held-out error of the baseline model.
        before: f64,
        /// Held-out error of the final model.
        after: f64,
    },
    /// The final model predicts the held-out segment worse than the baseline model does.
    HeldOutRises {
        /// The held-out error of the final model, divided by that of the baseline model.
        ratio: f64,
        /// Held-out error of the baseline model.
        before: f64,
        /// Held-out error of the final model.
        after: f64,
        /// The added terms.
        terms: Vec<String>,
        /// Number of leading terms that lower the error.
        falls_up_to: usize,
    },
    /// The conclusions rest on a defective measurement.
    DefectiveMeasurement {
        /// The defects.
        defects: Vec<Defect>,
    },
    /// The residual is sensor noise.
    ResidualIsNoise,
    /// The residual is noise on the fit segment, but exceeds the noise on the held-out segment.
    HeldOutAboveNoise {
        /// Held-out error in multiples of the noise.
        held_out: f64,
    },
    /// The residual exceeds the noise, or the record does not show the noise.
    ResidualAboveNoise {
        /// Errors on the fit and on the held-out segment, in multiples of the noise.
        floors: Option<[f64; 2]>,
        /// Whether the residual appears white; `None` if this was not tested.
        is_white: Option<bool>,
        /// Number of added terms.
        terms: usize,
    },
    /// The residual depends on a variable in a way that matches no effect.
    NoNameForCurve {
        /// The variable.
        variable: String,
        /// Fraction of the curve's contribution that the best one or two effects explain.
        by_effects: f64,
    },
    /// The record cannot distinguish terms from their alternatives.
    TermsConfounded {
        /// Each term with its alternatives.
        pairs: Vec<String>,
    },
    /// The record has too few independent blocks for a test.
    TooFewBlocks {
        /// Number of added terms.
        terms: usize,
    },
    /// The input reverses fewer than two times.
    OneStroke {
        /// The input's column.
        input: String,
    },
    /// In displacement mode, the input appears to be a velocity.
    InputIsVelocity {
        /// The input's column.
        input: String,
    },
    /// The error of the model is a large part of the output, and exceeds the noise.
    PoorModel {
        /// Its held-out error.
        error: f64,
    },
    /// The positions of the held-out segment extend beyond those of the fit segment.
    Extrapolation(Outside),
    /// Part of the input's motion was not measured, but the hysteresis depends on it.
    MotionUnseen {
        /// The input's column.
        input: String,
    },
    /// The files do not come from one rig.
    FilesOfSeveralRigs {
        /// Error of one model for all files.
        together: f64,
        /// Error with separate gains for each file.
        own: f64,
    },
    /// A step of the preload lies where a file begins.
    ZeroDiffers {
        /// The file.
        path: String,
        /// Whether separate gains for each file are available.
        may_fit_gains: bool,
    },
    /// Presliding and backlash are the same function, up to a factor.
    PreslidingIsBacklash {
        /// Whether the sign of kappa_x distinguishes a spring from slack.
        sign_tells: bool,
    },
    /// The fitted initial state of a creep is at its bound, outside the range of the input.
    CreepStartsOutside {
        /// The output's column.
        output: String,
    },
    /// The model omits the hysteresis of the baseline model.
    HysteresisLeftOut,
    /// The hysteresis is nearly a spring and an offset, and the terms of that kind cancel it.
    HysteresisCancelled {
        /// Difference from a spring and an offset, as a fraction of the output.
        share: f64,
    },
    /// Tones at frequencies that the motion itself may cause.
    TonesOfMotion {
        /// The tones.
        terms: Vec<String>,
    },
    /// The friction grows with the tension.
    FrictionWithTension,
    /// The friction changes with a temperature.
    FrictionWithTemperature {
        /// The temperature channel.
        channel: String,
    },
    /// The output falls when the input rises.
    OutputFalls {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
    },
    /// The fitted hysteresis loop is traversed in the opposite direction to the measured loop.
    LoopReversed {
        /// Gain of the hysteresis.
        kappa_eta: f64,
        /// The terms that it cancels.
        terms: Vec<String>,
    },
    /// The resolution of a sensor accounts for much of the residual.
    CoarseSensor {
        /// The channel, and the effect of its resolution.
        #[serde(flatten)]
        channel: CoarseChannel,
        /// Unit of the channel.
        unit: Option<String>,
    },
    /// Nearly all of the model's output comes from a channel that the baseline does not need.
    ChannelRepeatsOutput {
        /// The channel.
        channel: String,
    },
    /// Nearly all of the model's output comes from a channel, and none from the input.
    LoadFollowsChannel {
        /// The channel.
        channel: String,
        /// The input's column.
        input: String,
    },
    /// The output leads the input.
    OutputLeads {
        /// Lead \[s\].
        seconds: f64,
    },
    /// A limit set by the user ended the search.
    SearchStopped {
        /// The time limit \[s\], if it ended the search.
        seconds: Option<f64>,
        /// The maximum number of terms, if it ended the search.
        terms: Option<usize>,
    },
    /// The output varies much less on one segment than on the other.
    SegmentsDiffer {
        /// Standard deviation of the output on the fit segment.
        fit: f64,
        /// Standard deviation of the output on the held-out segment.
        held_out: f64,
    },
    /// A round raises the held-out error.
    RoundRaises {
        /// The term of that round.
        term: String,
        /// Number of rounds before it.
        after: usize,
    },
    /// The final model is worse for a file than the baseline model.
    FileWorse {
        /// The file.
        path: String,
        /// Error of the baseline model.
        before: f64,
        /// Error of the final model.
        after: f64,
    },
    /// The model has more terms than a record can distinguish.
    ManyTerms {
        /// Number of terms.
        terms: usize,
    },
    /// Validation: the error is that of the model on its own record.
    ErrorAsExpected {
        /// The error.
        error: f64,
        /// The held-out error on its own record.
        own: f64,
    },
    /// Validation: in the output's unit, the error is that of the model on its own record.
    ErrorAsExpectedInUnit {
        /// The errors here and on its own record, in the output's unit.
        rmse: [f64; 2],
        /// The output's unit.
        unit: Option<String>,
        /// The error.
        error: f64,
        /// Whether the model holds.
        holds: bool,
    },
    /// Validation: the error is the sensor's noise.
    ErrorIsNoise {
        /// The error.
        error: f64,
    },
    /// Validation: the error is larger than that of the model on its own record.
    ErrorTooLarge {
        /// The error.
        error: f64,
        /// The held-out error on its own record.
        own: Option<f64>,
        /// The error with another gain and offset.
        with_line: f64,
    },
    /// Validation: the error is slightly above the limit.
    ErrorAtLimit {
        /// The error.
        error: f64,
        /// The limit.
        limit: f64,
    },
    /// Validation: the error exceeds the noise, and the expected error is unknown.
    ErrorWithoutLimit {
        /// The error.
        error: f64,
    },
    /// Validation: the output hardly exceeds the noise.
    OutputAtNoise,
    /// Validation: gain or offset has changed.
    LineChanged {
        /// The gain; `None` if the offset alone has changed.
        gain: Option<Fitted>,
        /// The offset, in the output's unit.
        offset: f64,
        /// The output's unit.
        unit: Option<String>,
        /// The error with both.
        error: f64,
        /// The limit.
        limit: f64,
    },
    /// Validation: the gain has changed by more than a factor of two.
    OutputUnitDiffers {
        /// The output's column.
        output: String,
    },
    /// Validation: the model was not exact on its own record.
    ModelInexact {
        /// The held-out error on its own record.
        own: f64,
    },
    /// Validation: the model's own verdict was `not-transferable`.
    ModelNotTransferable,
    /// Validation: the variable that the residual depends on, if there is one.
    ResidualDependsOn {
        /// The variable.
        variable: Option<String>,
        /// Whether there are enough independent stretches for a test.
        is_tested: bool,
    },
    /// Validation: the record exceeds the ranges of the model's own record.
    RangesExceeded {
        /// The ranges.
        ranges: Vec<Outside>,
    },
    /// Validation: the input contributes little to the output of this record.
    InputContributesLittle {
        /// The input's column.
        input: String,
        /// Its contribution.
        share: f64,
    },
}

impl Finding {
    /// The severity of the finding.
    #[must_use]
    pub fn severity(&self) -> Severity {
        match self {
            Self::OutputIntegrates { .. }
            | Self::FilesScaled { .. }
            | Self::LoggedDifferently(_)
            | Self::InputIsVelocity { .. }
            | Self::FilesOfSeveralRigs { .. }
            | Self::RowsShuffled { .. }
            | Self::InputAtRest { .. }
            | Self::ChannelTakesOver { .. }
            | Self::NothingExplained { .. }
            | Self::RigChanged { .. }
            | Self::WorseThanConstant { .. }
            | Self::HeldOutRises { .. }
            | Self::DefectiveMeasurement { .. }
            | Self::ErrorTooLarge { .. }
            | Self::ModelNotTransferable => Severity::Error,
            Self::ResidualIsNoise
            | Self::ErrorAsExpected { .. }
            | Self::ErrorIsNoise { .. }
            | Self::PreslidingIsBacklash { .. }
            | Self::HysteresisLeftOut
            | Self::FrictionWithTension
            | Self::FrictionWithTemperature { .. }
            | Self::SearchStopped { .. }
            | Self::HeldOutFileDiffers
            | Self::HeldOutFileScaled { .. } => Severity::Note,
            _ => Severity::Warning,
        }
    }
}

/// A finding as it appears in the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Told {
    /// The severity of the finding.
    pub severity: Severity,
    /// The finding in words.
    pub words: String,
    /// Its code and its evidence.
    #[serde(flatten)]
    pub finding: Finding,
}

impl From<Finding> for Told {
    fn from(finding: Finding) -> Self {
        Self {
            severity: finding.severity(),
            words: finding.words(),
            finding,
        }
    }
}
