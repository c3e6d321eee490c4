//! The faults of signals and controllers.

use crate::Real;

crate::data! {
    /// The bad input of a step, or the reason for the failure of a relay experiment.
    #[derive(Eq, Hash)]
    #[non_exhaustive]
    pub enum Fault {
        /// `dt` is not finite.
        Dt,
        /// `dt` is zero or negative: time has not advanced.
        DtNotPositive,
        /// `dt` exceeds the longest `dt` that the configuration accepts.
        DtTooLong,
        /// The reference, the reference at the next sample, or the desired output of a
        /// [`Compensator`](crate::control::Compensator).
        Reference,
        /// The measured output.
        Measured,
        /// The measured velocity.
        Velocity,
        /// The feed-forward command.
        FeedForward,
        /// The command to resume from, or the applied command for a
        /// [`DisturbanceObserver`](crate::control::DisturbanceObserver).
        Command,
        /// The regressor of an adaptive law, or the term of a compensator, with this zero-based
        /// index. An index above 255 becomes 255.
        Regressor(u8),
        /// An overflow: every input is finite, but the result is not.
        Overflow,
        /// The phase of a cycle is not within 0 to 1, or has jumped.
        Phase,
        /// The position signal.
        Position,
        /// In a relay experiment, the output deviated from the reference by more than
        /// `most_deviation`.
        ///
        /// Choose a smaller amplitude, a centre that holds the output at the reference, or an
        /// amplitude with the opposite sign.
        OutputOutOfRange,
        /// A relay experiment reached `longest_time` without a complete cycle.
        ///
        /// Possible causes: the amplitude is too small or has the wrong sign, or `longest_time` is
        /// shorter than two periods.
        NoOscillation,
        /// A relay experiment reached `longest_time` before enough consecutive cycles agreed.
        ///
        /// Possible causes: `longest_time` is too short, the noise exceeds the hysteresis, or a
        /// cycle has fewer than `2/agreement` samples.
        TimeOut,
    }
}

impl Fault {
    /// The fault of the regressor with this index.
    pub(crate) fn of_regressor(index: usize) -> Self {
        Self::Regressor(u8::try_from(index).unwrap_or(u8::MAX))
    }
}

/// The fault of `dt`, if there is one.
pub(crate) fn fault_of_dt<T: Real>(dt: T, longest: T) -> Option<Fault> {
    if !dt.is_finite() {
        Some(Fault::Dt)
    } else if dt <= T::ZERO {
        Some(Fault::DtNotPositive)
    } else if dt > longest {
        Some(Fault::DtTooLong)
    } else {
        None
    }
}

/// The fault, if the number is not finite.
pub(crate) fn unless_finite<T: Real>(number: T, fault: Fault) -> Option<Fault> {
    (!number.is_finite()).then_some(fault)
}
