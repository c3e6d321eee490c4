//! What a reader must know about a record, its model or the rig, besides the missing mechanisms:
//! each finding has a code, a severity and its evidence. [`words`](super::words) says it.

use crate::ledger::{ChannelApart, CoarseChannel, FileApart};
use crate::record::Defect;
use crate::score::explains::Explained;
use crate::score::ranges::Outside;
use serde::Serialize;

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Something to know.
    Note,
    /// A reason to doubt a part of the model.
    Warning,
    /// A reason not to use the model.
    Error,
}

/// A finding with its evidence. Its code in the JSON is the variant's name in kebab case.
///
/// Errors are shares of the output's standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "code", content = "evidence", rename_all = "kebab-case")]
pub enum Finding {
    /// The rate of the output follows the input.
    OutputIntegrates {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
        /// Whether the input may be the force: then the output creeps.
        may_creep: bool,
    },
    /// In some files the output is another multiple of the input than in the others.
    FilesScaled {
        /// Those files.
        files: Vec<FileApart>,
        /// Number of files that the fit sees.
        of: usize,
        /// The output's unit.
        unit: Option<String>,
    },
    /// A channel has another sign or another place in one of the files.
    ChannelDiffers(ChannelApart),
    /// Neighbouring rows of the input have nothing in common, and the output follows row by row.
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
    /// A channel takes the input's place, although the input alone explains the output.
    ChannelTakesOver {
        /// The input's column.
        input: String,
        /// Shares of the held-out output's variance.
        explains: Explained,
        /// Number of channels.
        channels: usize,
        /// Share that the input explains in the baseline model.
        alone: f64,
    },
    /// The input explains less than half of the output.
    NothingExplained {
        /// The input's column.
        input: String,
        /// Shares of the held-out output's variance.
        explains: Explained,
        /// Number of channels.
        channels: usize,
    },
    /// The error on the held-out segment is that of another rig.
    RigChanged {
        /// Error on the fit segment.
        fit: f64,
        /// Error on the held-out segment.
        held_out: f64,
        /// Time \[s\] from which on it is large, if that is within the held-out segment.
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
        /// That unit.
        unit: Option<String>,
        /// Error with both.
        error: f64,
    },
    /// A held-out file is not described, nor is it with another gain and offset.
    HeldOutFileDiffers,
    /// The mean of the held-out output predicts it better than the model does.
    WorseThanConstant {
        /// Held-out error of the baseline model.
        before: f64,
        /// The same of the final model.
        after: f64,
    },
    /// The final model predicts the held-out segment worse than the baseline model does.
    HeldOutRises {
        /// The second over the first of these errors.
        ratio: f64,
        /// Held-out error of the baseline model.
        before: f64,
        /// The same of the final model.
        after: f64,
        /// The added terms.
        terms: Vec<String>,
        /// Number of first terms that lower the error.
        falls_up_to: usize,
    },
    /// What was concluded rests on a measurement that is spoilt.
    DefectiveMeasurement {
        /// The defects.
        defects: Vec<Defect>,
    },
    /// The residual is the sensor's noise.
    ResidualIsNoise,
    /// The residual is noise on the fit segment, and more on the held-out one.
    HeldOutAboveNoise {
        /// Held-out error in multiples of the noise.
        held_out: f64,
    },
    /// The residual exceeds the noise, or the record does not show the noise.
    ResidualAboveNoise {
        /// Errors on the fit and on the held-out segment, in multiples of the noise.
        floors: Option<[f64; 2]>,
        /// Whether it looks white; `None` where that was not asked.
        is_white: Option<bool>,
        /// Number of added terms.
        terms: usize,
    },
    /// The residual depends on a variable in a way that matches no effect.
    NoNameForCurve {
        /// The variable.
        variable: String,
        /// What the best one or two effects explain of what the curve does.
        by_effects: f64,
    },
    /// The record cannot tell terms from their alternatives.
    TermsConfounded {
        /// Each term with its alternatives.
        pairs: Vec<String>,
    },
    /// Too few independent stretches for a test.
    TooFewBlocks {
        /// Number of added terms.
        terms: usize,
    },
    /// The input reverses fewer than two times.
    OneStroke {
        /// The input's column.
        input: String,
    },
    /// The input of a displacement mode seems to be a velocity.
    InputIsVelocity {
        /// The input's column.
        input: String,
    },
    /// The model misses much of the output, and more than noise.
    PoorModel {
        /// Its held-out error.
        error: f64,
    },
    /// Input and output may stand in each other's place.
    InputOutputSwapped {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
        /// Error of the final model.
        before: f64,
        /// Error of the baseline model with both exchanged.
        after: f64,
    },
    /// The held-out segment goes beyond the positions of the fit segment.
    Extrapolation(Outside),
    /// Some of the motion of the input was not measured, and the hysteresis remembers it.
    MotionUnseen {
        /// The input's column.
        input: String,
    },
    /// Files that are not of one rig.
    FilesOfSeveralRigs {
        /// Error of one model for all files.
        together: f64,
        /// Error with gains of its own for each file.
        own: f64,
    },
    /// A step of the preload lies where a file begins.
    ZeroDiffers {
        /// The file.
        path: String,
        /// Whether gains of its own for each file are to be had.
        may_fit_gains: bool,
    },
    /// Presliding and backlash are one function.
    PreslidingIsBacklash {
        /// Whether the sign of kappa_x tells a spring from slack.
        sign_tells: bool,
    },
    /// A creep starts beyond what the input can explain.
    CreepStartsOutside {
        /// The output's column.
        output: String,
    },
    /// The hysteresis of the baseline is left out of the model.
    HysteresisLeftOut,
    /// The hysteresis is a spring and an offset, which cancel it.
    HysteresisCancelled {
        /// What is its own.
        share: f64,
    },
    /// Tones at lines that the motion itself may make.
    TonesOfMotion {
        /// The tones.
        terms: Vec<String>,
    },
    /// The friction grows with the tension.
    FrictionWithTension,
    /// The friction changes with a temperature.
    FrictionWithTemperature {
        /// The temperature.
        channel: String,
    },
    /// The output falls where the input rises.
    OutputFalls {
        /// The input's column.
        input: String,
        /// The output's column.
        output: String,
    },
    /// The loop of the hysteresis runs against that of the output.
    LoopReversed {
        /// Gain of the hysteresis.
        kappa_eta: f64,
        /// The terms that it cancels.
        terms: Vec<String>,
    },
    /// The steps of a sensor account for much of the residual.
    CoarseSensor {
        /// The channel, and what its steps do.
        #[serde(flatten)]
        channel: CoarseChannel,
        /// Its unit.
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
    /// The output comes before the input.
    OutputLeads {
        /// By so much \[s\].
        seconds: f64,
        /// Whether an effect that the model lacks may be the cause.
        may_be_effect: bool,
    },
    /// A limit that was asked for ended the search.
    SearchStopped {
        /// The time \[s\], if that was it.
        seconds: Option<f64>,
        /// The number of terms, if that was it.
        terms: Option<usize>,
    },
    /// The output moves much less on one segment than on the other.
    SegmentsDiffer {
        /// Standard deviation of the output on the fit segment.
        fit: f64,
        /// The same on the held-out segment.
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
    /// More terms than a record tells apart.
    ManyTerms {
        /// Their number.
        terms: usize,
    },
}

impl Finding {
    /// How grave it is.
    #[must_use]
    pub fn severity(&self) -> Severity {
        match self {
            Self::OutputIntegrates { .. }
            | Self::FilesScaled { .. }
            | Self::ChannelDiffers(_)
            | Self::RowsShuffled { .. }
            | Self::InputAtRest { .. }
            | Self::ChannelTakesOver { .. }
            | Self::NothingExplained { .. }
            | Self::RigChanged { .. }
            | Self::WorseThanConstant { .. }
            | Self::HeldOutRises { .. }
            | Self::DefectiveMeasurement { .. } => Severity::Error,
            Self::ResidualIsNoise
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

/// A finding as the JSON has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Told {
    /// How grave it is.
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
