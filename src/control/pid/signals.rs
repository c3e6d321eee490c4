//! Input and output of a step of a [`Pid`](super::Pid).

use crate::Real;

crate::data! {
    /// One sample for a [`Pid`](super::Pid).
    ///
    /// ```
    /// use bowden::control::PidInput;
    /// let sample = PidInput { feed_forward: 12.0, ..PidInput::new(0.001, 25.0, 24.8) };
    /// assert_eq!((sample.measured, sample.velocity), (24.8, 0.0));
    /// ```
    #[derive(Default)]
    pub struct PidInput<T> {
        /// Time since the last call \[s\], even if the sample of that call was bad.
        pub dt: T,
        /// Reference y_r \[output unit\], such as \[N·m\].
        pub reference: T,
        /// Measured output y \[output unit\], such as \[N·m\].
        pub measured: T,
        /// Measured distal velocity \[rad/s\]; only PIV (16) reads it.
        pub velocity: T,
        /// Feed-forward, added to the command before the limits \[command unit\].
        pub feed_forward: T,
    }
}

impl<T: Real> PidInput<T> {
    /// A sample without velocity or feed-forward, from `dt` \[s\] and the torques \[N·m\].
    #[inline]
    pub fn new(dt: T, reference: T, measured: T) -> Self {
        Self {
            dt,
            reference,
            measured,
            velocity: T::zero(),
            feed_forward: T::zero(),
        }
    }
}

crate::data! {
    /// All terms of the last good sample.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState};
    /// let at = PidInput { velocity: 0.1, feed_forward: 5.0, ..PidInput::new(0.001, 1.0, 0.5) };
    /// let terms = Pid::paper_piv().step_with_terms(&mut PidState::new(), &at).terms;
    /// assert_eq!((terms.proportional, terms.velocity, terms.feed_forward), (15.0, -1.0, 5.0));
    /// assert_eq!(terms.unlimited, 15.0 + terms.integral - 1.0 + 5.0);
    /// ```
    #[derive(Default)]
    pub struct PidTerms<T> {
        /// e = y − y_r \[output unit\]
        pub error: T,
        /// −k_p·(y − b·y_r) \[command unit\]
        pub proportional: T,
        /// −k_i·∫e, after the anti-windup \[command unit\]
        pub integral: T,
        /// −k_d·d/dt(y − c·y_r), filtered \[command unit\]; zero with PIV
        pub derivative: T,
        /// −k_d·v_d of PIV \[command unit\]; zero with PI and PID
        pub velocity: T,
        /// The feed-forward of the sample \[command unit\].
        pub feed_forward: T,
        /// Sum of all terms except `error`, before range and slew-rate limit \[command unit\].
        pub unlimited: T,
        /// Whether the applied command differs from `unlimited`. Possible causes are the range, the
        /// slew-rate limit, the safe command and [`Pid::applied`](super::Pid::applied).
        pub saturated: bool,
    }
}
