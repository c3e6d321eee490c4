//! Unchecked settings of a [`Relay`](super::Relay).

use super::Relay;
use crate::control::status::OUTSIDE;
use crate::control::{Fallback, Limits};
use crate::error::{above_zero, must_be_finite, not_below_zero};
use crate::{Error, Real};

crate::data! {
    /// Settings of a [`Relay`](super::Relay), with public fields; [`Relay::try_new`] checks them.
    ///
    /// ```
    /// use bowden::constant;
    /// use bowden::control::{Fallback, Limits, Relay, RelaySettings};
    /// static RELAY: Relay<f32> = constant!(Relay::<f32>::try_new(RelaySettings {
    ///     reference: 5.0,      // [N·m]
    ///     centre: 10.0,        // [command unit]
    ///     amplitude: 8.0,      // [command unit]
    ///     hysteresis: 0.05,    // [N·m]
    ///     most_deviation: 8.0, // [N·m]
    ///     cycles: 4,
    ///     agreement: 0.05,
    ///     longest_time: 20.0, // [s]
    ///     longest_dt: 0.005,  // [s]
    ///     limits: constant!(Limits::<f32>::try_new(-20.0, 60.0)),
    ///     fallback: constant!(Fallback::<f32>::try_new(20, 0.0)),
    /// }));
    /// assert_eq!(RELAY.settings().cycles, 4);
    /// ```
    pub struct RelaySettings<T: Real> {
        /// Reference y_r, about which the output oscillates \[output unit\]; finite.
        pub reference: T,
        /// Mean of the two levels of the command \[command unit\]; finite.
        ///
        /// Choose the command that holds the output at the reference, so that the half-periods are
        /// equal.
        pub centre: T,
        /// d, the distance from the centre to each level \[command unit\]: finite, nonzero, and
        /// with the sign of the plant's gain. Both levels must lie within `limits`.
        pub amplitude: T,
        /// Hysteresis eps \[output unit\], not negative. Choose at least the peak value of the
        /// noise. Otherwise, the relay chatters.
        pub hysteresis: T,
        /// Largest deviation of the output from the reference \[output unit\], greater than
        /// `hysteresis`.
        ///
        /// The first sample with a larger deviation ends the experiment.
        pub most_deviation: T,
        /// Number of consecutive cycles in the average, at least two.
        pub cycles: u32,
        /// Largest relative deviation of the period and amplitude of a cycle from the mean of
        /// earlier cycles, between 0 and 1.
        ///
        /// A cycle with a larger deviation restarts the average. A period must contain at least
        /// `2/agreement` samples. Otherwise, the period cannot be measured with this relative
        /// accuracy.
        pub agreement: T,
        /// Maximum duration of the experiment, at least `longest_dt` \[s\].
        ///
        /// Because of rounding errors, an experiment of n samples may end early, by up to about
        /// n/2³² of this duration.
        pub longest_time: T,
        /// Longest `dt` of a good sample \[s\], positive; for example, five sampling periods.
        pub longest_dt: T,
        /// Range of the command. A slew-rate limit is an error, because the formula for k_u assumes
        /// steps in the command.
        pub limits: Limits<T>,
        /// Fallback after a failure: a safe command within `limits`.
        ///
        /// [`Fallback::hold_indefinitely`] is an error, because it has no safe command.
        pub fallback: Fallback<T>,
    }
}

crate::checked! {
    Relay<T>;

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the name of the setting, or
    /// [`Error::Inadmissible`] with the violated condition. The fields of [`RelaySettings`]
    /// document the ranges and conditions.
    pub fn try_new(settings: RelaySettings<T>) {
        let s = &settings;
        must_be_finite!(s.reference, "reference");
        must_be_finite!(s.centre, "centre");
        must_be_finite!(s.amplitude, "amplitude");
        if s.amplitude == T::ZERO {
            return Err(Error::OutOfRange("amplitude"));
        }
        not_below_zero!(s.hysteresis, "hysteresis");
        must_be_finite!(s.most_deviation, "most_deviation");
        if s.most_deviation <= s.hysteresis {
            return Err(Error::Inadmissible("hysteresis < most_deviation"));
        }
        if s.cycles < 2 {
            return Err(Error::OutOfRange("cycles"));
        }
        above_zero!(s.agreement, "agreement");
        if s.agreement >= T::ONE {
            return Err(Error::OutOfRange("agreement"));
        }
        above_zero!(s.longest_dt, "longest_dt");
        must_be_finite!(s.longest_time, "longest_time");
        if s.longest_time < s.longest_dt {
            return Err(Error::Inadmissible("longest_dt <= longest_time"));
        }
        let (low, high) = (s.limits.low(), s.limits.high());
        let (above, below) = (s.centre + s.amplitude, s.centre - s.amplitude);
        if above < low || above > high || below < low || below > high {
            return Err(Error::Inadmissible(
                "centre ± amplitude must lie within the limits",
            ));
        }
        if s.limits.slew().is_some() {
            return Err(Error::Inadmissible(
                "the limits of a relay must not include a slew-rate limit",
            ));
        }
        match s.fallback.command() {
            Some(safe) if safe >= low && safe <= high => Ok(Relay { settings }),
            Some(_) => Err(Error::Inadmissible(OUTSIDE)),
            None => Err(Error::Inadmissible("a relay must have a safe command")),
        }
    }
}
