//! Result of a relay experiment, and PI gains.

use crate::Real;

crate::checked::stored! {
    /// Result of a [`Relay`](super::Relay): ultimate gain and period, and the averaged cycle.
    ///
    /// ```
    /// use bowden::control::{PiRule, Ultimate};
    /// // 1/(s + 1)³: k_u = 8, T_u = 2·pi/sqrt(3).
    /// let ultimate = Ultimate { gain: 8.0_f64, period: 3.628, amplitude: 0.16, duty: 0.5 };
    /// let (cautious, fast) = (ultimate.pi(PiRule::TyreusLuyben), ultimate.pi(PiRule::ZieglerNichols));
    /// assert!((cautious.k_p - 2.5).abs() < 1e-12 && (fast.k_p - 3.6).abs() < 1e-12);
    /// assert!((cautious.k_p / cautious.k_i - 7.9816).abs() < 1e-9); // T_i = 2.2·T_u
    /// ```
    pub struct Ultimate<T> {
        /// k_u \[command unit/output unit\], with the sign of the relay's amplitude.
        pub gain: T,
        /// T_u \[s\]
        pub period: T,
        /// a: half the distance from the lowest to the highest output \[output unit\].
        pub amplitude: T,
        /// D: share of the period in which the command is `centre + d`; 1/2 in a symmetric cycle.
        pub duty: T,
    }
}

crate::data! {
    /// Tuning rule: PI gains from ultimate gain and period.
    #[derive(Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum PiRule {
        /// k_p = k_u/3.2, T_i = 2.2·T_u: the conservative rule, and the default.
        ///
        /// On the tested plants (lags with and without a delay), the gain margin is above 2.5 and
        /// the phase margin is above 45°. These margins include the error of the describing
        /// function, which may overestimate k_u by 27 %.
        ///
        /// Source: B. Tyreus, W. Luyben, "Tuning PI controllers for integrator/dead time
        /// processes", *Ind. Eng. Chem. Res.* 31, 1992.
        #[default]
        TyreusLuyben,
        /// k_p = 0.45·k_u, T_i = T_u/1.2: fast, with an overshoot after a reference step.
        ///
        /// On the same plants, the gain margin may be as low as 1.5 and the phase margin as low as
        /// 15°.
        ///
        /// Source: J. Ziegler, N. Nichols, "Optimum settings for automatic controllers", *Trans.
        /// ASME* 64, 1942.
        ZieglerNichols,
    }

    /// PI gains for [`PidSettings`](crate::control::PidSettings).
    pub struct PiGains<T> {
        /// Proportional gain \[command unit/output unit\].
        pub k_p: T,
        /// Integral gain k_p/T_i \[command unit/(output unit·s)\].
        pub k_i: T,
    }
}

impl<T: Real> Ultimate<T> {
    /// The PI gains that a tuning rule gives.
    #[must_use]
    pub fn pi(&self, rule: PiRule) -> PiGains<T> {
        let (k_p, t_i) = match rule {
            PiRule::TyreusLuyben => (self.gain / T::from_f64(3.2), T::from_f64(2.2) * self.period),
            PiRule::ZieglerNichols => (
                T::from_f64(0.45) * self.gain,
                self.period / T::from_f64(1.2),
            ),
        };
        PiGains {
            k_p,
            k_i: k_p / t_i,
        }
    }
}
