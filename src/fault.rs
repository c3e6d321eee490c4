//! The faults of signals and controllers.

use crate::Real;

crate::data! {
    /// The bad input of a step, or why a relay experiment failed.
    #[derive(Eq, Hash)]
    #[non_exhaustive]
    pub enum Fault {
        /// `dt` is not finite.
        Dt,
        /// `dt` is zero or negative: time has not advanced.
        DtNotPositive,
        /// `dt` exceeds the longest `dt` of the configuration, or the stability limit of the law.
        DtTooLong,
        /// The reference, or its next value.
        Reference,
        /// The measured output.
        Measured,
        /// The measured velocity.
        Velocity,
        /// The feed-forward command.
        FeedForward,
        /// The command to resume from.
        Command,
        /// A regressor, counted from 0.
        Regressor(u8),
        /// Every input is finite, but the command could not be computed: an overflow.
        Overflow,
        /// The phase of a cycle lies outside 0 to 1, or has jumped.
        Phase,
        /// The position of a sensor.
        Position,
        /// The output of a relay experiment was further from the reference than `most_deviation`.
        ///
        /// Choose a smaller amplitude, a centre that holds the reference, or the other sign of the
        /// amplitude.
        OutputOutOfRange,
        /// The `longest_time` of a relay experiment has passed without a complete cycle.
        ///
        /// The amplitude does not move the output through the reference, its sign is wrong, or the
        /// time is too short for two periods.
        NoOscillation,
        /// The `longest_time` of a relay experiment has passed and the cycles did not agree with
        /// each other.
        ///
        /// The time is too short, the noise exceeds the hysteresis, or a cycle has fewer than
        /// `2/agreement` samples.
        TimeOut,
    }
}

impl Fault {
    /// The fault of the regressor with this index.
    pub(crate) fn of_regressor(index: usize) -> Self {
        Self::Regressor(u8::try_from(index).unwrap_or(u8::MAX))
    }
}

/// The fault of the sample time, if there is one.
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

/// The fault of a number that is not finite.
pub(crate) fn unless_finite<T: Real>(number: T, fault: Fault) -> Option<Fault> {
    (!number.is_finite()).then_some(fault)
}
