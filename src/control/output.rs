//! Outputs of a step.

use super::Status;

crate::data! {
    /// Output of a step of a controller, of [`IterativeLearning`](super::IterativeLearning), or of
    /// a [`DisturbanceObserver`](super::DisturbanceObserver).
    pub struct Output<T> {
        /// Command for the drive, or the value to add to the command \[command unit\]; finite and
        /// within the limits.
        pub command: T,
        /// Status of the sample: good, or the fault.
        pub status: Status,
    }
}

/// Output of a step, with all terms of the control law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Telemetry<T, M> {
    /// Command for the drive \[command unit\]; finite and within the limits.
    pub command: T,
    /// Status of the sample: good, or the fault.
    pub status: Status,
    /// The terms: [`PidTerms`](super::PidTerms) of the last good sample, or
    /// [`AdaptiveTerms`](super::AdaptiveTerms).
    pub terms: M,
}

impl<T> Output<T> {
    pub(super) fn with<M>(self, terms: M) -> Telemetry<T, M> {
        let Self { command, status } = self;
        Telemetry {
            command,
            status,
            terms,
        }
    }
}
