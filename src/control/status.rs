//! Status of a step (good, degraded, held or safe), and the safe command after repeated bad
//! samples.

use crate::error::{must_be_finite, rarely};
use crate::fault::Fault;
use crate::{Error, Real};

crate::data! {
    /// Result of a step.
    ///
    /// ```text
    ///           bad                fault counter ≥ after·weight
    ///  Good ─────────────▶ Held ───────────────────────────────▶ Safe
    ///   ▲ ◀───────────────  │                                      │
    ///   │     good                                                 │ acknowledge()
    ///   └───────────────────────────── good ─────────── returning ◀┘
    /// ```
    #[derive(Eq, Hash)]
    pub enum Status {
        /// All inputs were good; the state has advanced.
        Good,
        /// A regressor was bad, and its term was dropped. The loop is closed, and the estimates do
        /// not change. For [`IterativeLearning`](crate::control::IterativeLearning), this status
        /// means that the error is not usable or that the phase has jumped.
        Degraded(Fault),
        /// A bad sample: the state is unchanged, and the last good command is held.
        Held(Fault),
        /// Too many bad samples: the safe command is applied until
        /// [`acknowledge`](crate::control::PidState::acknowledge), even if later samples are good.
        ///
        /// The value is the fault of the last of these samples, or the reason for the failure of a
        /// [`Relay`](crate::control::Relay) experiment.
        Safe(Fault),
    }
}

impl Status {
    /// The fault, if there is one.
    #[must_use]
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Good => None,
            Self::Degraded(fault) | Self::Held(fault) | Self::Safe(fault) => Some(fault),
        }
    }
}

crate::checked::stored! {
    /// The safe command after repeated bad samples.
    ///
    /// A bad sample adds `weight` to a fault counter, and a good sample subtracts 1. When the
    /// counter reaches `after·weight`, the safe command is applied and latched. The safe command is
    /// applied no later than the earlier of
    /// - the `after`-th consecutive bad sample;
    /// - the end of any n samples of which B are bad, if `(weight + 1)·B − n ≥ after·weight`.
    ///
    /// With a weight of 4, the second condition is met if, over a sufficiently long time, more than
    /// one sample in five is bad.
    ///
    /// ```
    /// use bowden::control::Fallback;
    /// let fallback = Fallback::try_new(10, 0.0)?; // zero from the tenth consecutive bad sample onward
    /// assert_eq!((fallback.after(), fallback.command()), (10, Some(0.0)));
    /// assert_eq!(fallback.weight(), 4);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct Fallback<T> {
        after: u32,
        #[serde(default = "usual")]
        weight: u32,
        /// `after·weight`, stored to avoid a multiplication at a bad sample.
        #[serde(skip)]
        most: u32,
        command: Option<T>,
    }
    => {
        let hold = Self::hold_indefinitely();
        match command {
            Some(command) => Self::try_new(after, command)?.with_weight(weight),
            None if (after, weight) == (hold.after, hold.weight) => Ok(hold),
            // A line that was lost must not take the safe command away.
            None => Err(Error::Inadmissible("a fallback must have a safe command")),
        }
    }
}

/// Default number of good samples that cancel a bad sample.
const WEIGHT: u32 = 4;

crate::checked! {
    Fallback<T>;

    /// Applies the safe command \[command unit\] from the `after`-th consecutive bad sample onward.
    ///
    /// The safe command ignores the slew-rate limit, because it must act immediately. The first
    /// good sample after an acknowledgement starts from the safe command.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"safe command"`; [`Error::OutOfRange`] with `"after"` if `after`
    /// is zero.
    pub fn try_new(after: u32, command: T) {
        if after == 0 {
            return Err(Error::OutOfRange("after"));
        }
        must_be_finite!(command, "safe command");
        let (weight, most) = (WEIGHT, after.saturating_mul(WEIGHT));
        Ok(Fallback { after, weight, most, command: Some(command) })
    }

    /// Sets the number `weight` of good samples that cancel a bad sample (default: 4).
    ///
    /// With a weight of 1 and an `after` of at least 2, the safe command is not applied even if
    /// every second sample is bad.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with `"weight"` if `weight` is zero.
    pub fn with_weight[self fallback](weight: u32) {
        if weight == 0 {
            return Err(Error::OutOfRange("weight"));
        }
        let most = fallback.after.saturating_mul(weight);
        Ok(Fallback { weight, most, ..fallback })
    }
}

impl<T: Real> Fallback<T> {
    /// Holds the last good command indefinitely, for simulation only.
    pub const fn hold_indefinitely() -> Self {
        Self {
            after: u32::MAX,
            weight: WEIGHT,
            most: u32::MAX,
            command: None,
        }
    }

    /// Number of consecutive bad samples after which the safe command is applied.
    pub const fn after(&self) -> u32 {
        self.after
    }

    /// Number of good samples that cancel a bad sample.
    pub const fn weight(&self) -> u32 {
        self.weight
    }

    /// The fault counter at which the safe command is applied: `after·weight`.
    pub const fn most(&self) -> u32 {
        self.most
    }

    /// The safe command \[command unit\], if there is one.
    pub const fn command(&self) -> Option<T> {
        self.command
    }
}

/// The error of a safe command outside the limits.
pub(crate) const OUTSIDE: &str = "the safe command lies within the limits";

crate::data! {
    /// Whether the loop is closed.
    ///
    /// `repr(u8)`: the tag has a byte of its own, and the usual step compares it with zero. Merged
    /// with the bytes of the fault, the tag would need decoding first.
    #[derive(Default)]
    #[repr(u8)]
    pub(crate) enum Latch {
        /// The loop is closed, and the fault counter is zero.
        #[default]
        Closed,
        /// The safe command is applied, for this fault, until it is acknowledged.
        Safe(Fault),
        /// The fault is acknowledged: the next good sample starts from the applied command.
        Returning,
        /// The loop is closed, and a good sample reduces the fault counter: [`Held::may_step`].
        Counting,
        /// The loop is closed, and the next good sample of an adaptive law needs the drive's
        /// response: [`Held::tell`].
        Told,
    }

    /// The drive's response to the last command.
    ///
    /// A controller assumes that the drive applies its command. Report any other response between
    /// two steps. Examples are an open safety relay, a current limit in the drive, and an inner
    /// loop at its limit. The slew-rate limit, anti-windup and a bumpless start then continue from
    /// the applied command.
    ///
    /// ```
    /// use bowden::control::{Applied, Fallback, Limits, Pid, PidInput, PidSettings, PidState};
    /// let limits = Limits::try_new(-20.0, 60.0)?.with_slew(100.0)?; // [N·m], [N·m/s]
    /// let pi = Pid::try_new(PidSettings::new(1.0, 10.0, limits, 0.005, Fallback::try_new(20, 0.0)?))?;
    /// let mut state = PidState::new();
    /// let at = PidInput::new(0.001, 20.0, 0.0);
    /// for _ in 0..2000 {
    ///     pi.step(&mut state, &at);
    ///     pi.applied(&mut state, Applied::Command(0.0)); // the drive is off
    /// }
    /// assert_eq!(pi.step(&mut state, &at).command, 0.1); // 100/s for 1 ms, from zero
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// These methods accept the response: [`Pid::applied`](super::Pid::applied),
    /// [`AdaptiveState::applied`](super::AdaptiveState::applied) and
    /// [`Compensator::applied`](super::Compensator::applied), which also corrects the hysteresis
    /// state. For a [`DisturbanceObserver`](super::DisturbanceObserver), pass the applied command
    /// as `sent`. For [`IterativeLearning`](super::IterativeLearning), set `learns` to `false`.
    ///
    /// Report `AsCommanded` if the drive deviates slightly from the command for a reason other than
    /// a limit, such as an offset or a measured current. Otherwise, the integral would stop or
    /// shift until the difference is zero.
    pub enum Applied<T> {
        /// The drive applied the command.
        AsCommanded,
        /// The drive applied this command \[command unit\]; a number that is not finite is ignored.
        Command(T),
        /// The applied command is unknown, but is below the requested one. The integral does not
        /// rise, except with [`AntiWindup::None`](super::AntiWindup::None).
        AtUpperLimit,
        /// The applied command is unknown, but is above the requested one. The integral does not
        /// fall, except with [`AntiWindup::None`](super::AntiWindup::None).
        AtLowerLimit,
    }
}

crate::checked::stored! {
    /// The applied command, the fault counter, and whether the loop is closed.
    #[derive(Default)]
    pub(crate) struct Held<T> {
        pub(crate) command: T,
        pub(crate) score: u32,
        pub(crate) latch: Latch,
    }
}

impl<T: Real> Held<T> {
    pub(crate) const fn new(command: T) -> Self {
        Self {
            command,
            score: 0,
            latch: Latch::Closed,
        }
    }

    /// Whether a good sample may set the command. If bad samples are remembered, this sample
    /// counts as good until [`bad_after_step`](Self::bad_after_step) reports otherwise.
    ///
    /// The usual step therefore checks the latch and not the fault counter.
    #[inline]
    pub(crate) fn may_step(&mut self) -> bool {
        if self.latch == Latch::Closed {
            return true;
        }
        rarely();
        if self.latch != Latch::Counting {
            return false;
        }
        if self.score == 0 {
            self.latch = Latch::Closed;
        } else {
            self.score -= 1;
        }
        true
    }

    /// Records that the next good sample needs the drive's response.
    pub(crate) fn tell(&mut self) {
        if matches!(self.latch, Latch::Closed | Latch::Counting) {
            self.latch = Latch::Told;
        }
    }

    /// The same with another command to continue from: the fault counter is kept.
    #[must_use]
    pub(crate) fn going_on_from(self, command: T) -> Self {
        Self {
            command,
            latch: Latch::Closed,
            ..self
        }
        .remembering()
    }

    /// The same after a power-off, with this command applied. A latched safe command stays
    /// latched; otherwise the next good sample starts from this command.
    #[must_use]
    pub(crate) fn after_power_off(self, command: T) -> Self {
        let latch = match self.latch {
            Latch::Safe(fault) => Latch::Safe(fault),
            _ => Latch::Returning,
        };
        Self {
            command,
            latch,
            ..self
        }
    }

    /// Whether the next good sample is the first one after a safe command.
    pub(crate) fn is_returning(&self) -> bool {
        self.latch == Latch::Returning
    }

    /// Records a good sample without a call of [`may_step`](Self::may_step): the loop is closed,
    /// and the fault counter falls by one.
    pub(crate) fn good(&mut self) {
        self.score = self.score.saturating_sub(1);
        self.latch = Latch::Closed;
        *self = self.remembering();
    }

    /// The same, with a latch that agrees with the fault counter; in a stored state, it may not.
    #[must_use]
    pub(crate) fn remembering(self) -> Self {
        let latch = match self.latch {
            Latch::Closed | Latch::Told if self.score > 0 => Latch::Counting,
            Latch::Told => Latch::Closed,
            latch => latch,
        };
        Self { latch, ..self }
    }

    /// Whether the safe command is applied until it is acknowledged.
    pub(crate) fn is_latched(&self) -> bool {
        matches!(self.latch, Latch::Safe(_))
    }

    /// If the safe command is latched: applies it and returns the fault.
    pub(crate) fn latched(&mut self, fallback: &Fallback<T>) -> Option<Status> {
        let Latch::Safe(fault) = self.latch else {
            return None;
        };
        self.command = fallback.command.unwrap_or(self.command);
        Some(Status::Safe(fault))
    }

    /// [`bad`](Self::bad) for a sample that called [`may_step`](Self::may_step): the count of
    /// that call is reversed.
    pub(crate) fn bad_after_step(&mut self, fault: Fault, fallback: &Fallback<T>) -> Status {
        self.score = self
            .score
            .saturating_add(u32::from(self.latch == Latch::Counting));
        self.bad(fault, fallback)
    }

    /// Counts a bad sample and applies the safe command at the limit of the fault counter, unless
    /// it is latched already.
    pub(crate) fn bad(&mut self, fault: Fault, fallback: &Fallback<T>) -> Status {
        let most = fallback.most();
        self.score = self.score.saturating_add(fallback.weight).min(most);
        match fallback.command {
            Some(safe) if self.score >= most => self.fail(fault, safe),
            _ => {
                if self.latch == Latch::Closed {
                    self.latch = Latch::Counting;
                }
                Status::Held(fault)
            }
        }
    }

    /// Applies the safe command and latches it, for this fault.
    #[inline]
    pub(crate) fn fail(&mut self, fault: Fault, safe: T) -> Status {
        self.command = safe;
        self.latch = Latch::Safe(fault);
        Status::Safe(fault)
    }

    /// Allows the next good sample to close the loop again; has no effect on a closed loop.
    pub(crate) fn acknowledge(&mut self) {
        if let Latch::Safe(_) = self.latch {
            self.latch = Latch::Returning;
            self.score = 0;
        }
    }
}

#[cfg(feature = "serde")]
const fn usual() -> u32 {
    WEIGHT
}
