//! What a step did: a good one, or a bad sample and what was commanded instead.

use crate::error::{must_be_finite, rarely};
use crate::{Error, Real};

/// Which input of a step could not be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Fault {
    /// `dt` is not finite.
    Dt,
    /// `dt` is zero or negative: time has not moved on.
    DtNotPositive,
    /// `dt` is longer than the longest that was stated, or than the law is stable for.
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
    /// The phase of a cycle is not from 0 to 1, or has jumped.
    Phase,
}

/// What a step did.
///
/// ```text
///           bad                  score reaches after·weight
///  Good ─────────────▶ Held ───────────────────────────────▶ Safe
///   ▲ ◀───────────────  │                                      │
///   │     good                                                 │ acknowledge()
///   └───────────────────────────── good ─────────── returning ◀┘
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// All samples were good; the state has moved on.
    Good,
    /// A regressor was bad and its term was dropped; the loop is closed, the estimates wait. Of
    /// [`Learning`](crate::control::Learning): an error could not be learned from, or the phase has jumped.
    Degraded(Fault),
    /// A bad sample: the state is as it was, the last good command is held.
    Held(Fault),
    /// Too many bad samples: the safe command is out until
    /// [`acknowledge`](crate::control::Controller::acknowledge), good samples or not.
    ///
    /// The fault is the one that was too many.
    Safe(Fault),
}

impl Status {
    /// What was wrong, where something was.
    #[must_use]
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Good => None,
            Self::Degraded(fault) | Self::Held(fault) | Self::Safe(fault) => Some(fault),
        }
    }

    /// Whether the command comes from this sample: good, or good but for a dropped term.
    #[must_use]
    pub const fn is_live(self) -> bool {
        matches!(self, Self::Good | Self::Degraded(_))
    }
}

/// What to command when samples stay bad.
///
/// A score counts: a bad sample adds the weight, a good one takes 1 away. At `after·weight`
/// the safe command goes out and is latched. So the safe command is out
/// - at the `after`-th bad sample in a row, and
/// - at the latest when any stretch of n samples has held B bad ones with
///   `(weight + 1)·B − n ≥ after·weight`: with weight 4, wherever more than one sample in five
///   is bad for long enough. A single good sample does not clear the count.
///
/// ```
/// use bowden::control::Fallback;
/// let fallback = Fallback::try_new(10, 0.0)?; // zero from the tenth bad sample in a row on
/// assert_eq!((fallback.after(), fallback.command()), (10, Some(0.0)));
/// assert_eq!(fallback.weight(), 4);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct Fallback<T> {
    after: u32,
    weight: u32,
    /// `after·weight`: a bad sample is no time to multiply.
    #[cfg_attr(feature = "serde", serde(skip))]
    most: u32,
    command: Option<T>,
}

/// How many good samples make up for a bad one, by default: more than one bad sample in five
/// is then too many for ever.
const WEIGHT: u32 = 4;

/// A fallback after its checks, for any float and for constants.
macro_rules! fallback {
    ($after:ident, $command:ident) => {{
        if $after == 0 {
            return Err(Error::OutOfRange("after"));
        }
        must_be_finite!($command, "safe command");
        Ok(Self {
            after: $after,
            weight: WEIGHT,
            most: $after.saturating_mul(WEIGHT),
            command: Some($command),
        })
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl Fallback<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// As [`try_new`](Self::try_new).
            pub const fn const_new(after: u32, command: $float) -> Result<Self, Error> {
                fallback!(after, command)
            }
        }
    };
}
constant!(f32);
constant!(f64);

impl<T: Real> Fallback<T> {
    /// The safe command \[command unit\] from the `after`-th bad sample in a row on.
    ///
    /// It goes out at once, whatever the slew rate: it is what the machine needs then. It
    /// stays out until it is acknowledged; the first good sample after that starts from it.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"safe command"`, [`Error::OutOfRange`] with `"after"`
    /// where that is zero.
    pub fn try_new(after: u32, command: T) -> Result<Self, Error> {
        fallback!(after, command)
    }

    /// The same where `weight` good samples make up for a bad one; 4 by default.
    ///
    /// At 0, which is refused, nothing would ever count; at 1 every second sample may be bad.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with `"weight"`.
    pub const fn with_weight(self, weight: u32) -> Result<Self, Error> {
        if weight == 0 {
            return Err(Error::OutOfRange("weight"));
        }
        let most = self.after.saturating_mul(weight);
        Ok(Self {
            weight,
            most,
            ..self
        })
    }

    /// Holds the last good command for ever: for a simulation, not for a machine.
    #[must_use]
    pub const fn hold_for_ever() -> Self {
        Self {
            after: u32::MAX,
            weight: WEIGHT,
            most: u32::MAX,
            command: None,
        }
    }

    /// From which bad sample in a row on the safe command is out.
    #[must_use]
    pub const fn after(&self) -> u32 {
        self.after
    }

    /// How many good samples make up for a bad one.
    #[must_use]
    pub const fn weight(&self) -> u32 {
        self.weight
    }

    /// The score at which the safe command goes out: `after·weight`.
    #[must_use]
    pub const fn most(&self) -> u32 {
        self.most
    }

    /// The safe command \[command unit\], where there is one.
    #[must_use]
    pub const fn command(&self) -> Option<T> {
        self.command
    }
}

/// What is wrong with a safe command that is not within the limits.
pub(crate) const OUTSIDE: &str = "the safe command lies within the limits";

/// Whether the loop is closed.
///
/// `repr(u8)`: the tag has a byte of its own, and the usual step compares it with zero. Folded
/// into the bytes of the fault it would have to be worked out first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(u8)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Latch {
    /// It is, and no bad sample is remembered.
    #[default]
    Closed,
    /// The safe command is out, for this fault, until it is acknowledged.
    Safe(Fault),
    /// It was acknowledged: the next good sample starts from the command that is out.
    Returning,
    /// It is closed, and a good sample makes up for a bad one: [`Held::may_step`].
    Counting,
}

/// The command that is out, the score of the bad samples, and whether the loop is closed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Held<T> {
    pub(crate) command: T,
    pub(crate) score: u32,
    pub(crate) latch: Latch,
}

impl<T: Real> Held<T> {
    pub(crate) const fn new(command: T) -> Self {
        Self {
            command,
            score: 0,
            latch: Latch::Closed,
        }
    }

    /// Whether nothing stands between a good sample and the command; where bad samples are
    /// remembered, this one is taken for good, until
    /// [`bad_after_step`](Self::bad_after_step) says otherwise.
    ///
    /// So the usual step looks at the latch alone, and not at the score.
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

    /// The same with another command that the loop goes on from: bad samples stay remembered.
    #[must_use]
    pub(crate) fn going_on_from(self, command: T) -> Self {
        let latch = Latch::Closed;
        Self {
            command,
            latch,
            ..self
        }
        .remembering()
    }

    /// The same after the power was off, with this command out: what is latched stays so; else the
    /// next good sample starts from there.
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

    /// Closes the loop with a good sample, after a safe command.
    pub(crate) fn close(&mut self) {
        self.score = self.score.saturating_sub(1);
        self.latch = Latch::Closed;
        *self = self.remembering();
    }

    /// The same where the latch says whether bad samples are remembered, as it may not in a
    /// state that was stored.
    #[must_use]
    pub(crate) fn remembering(self) -> Self {
        let latch = match self.latch {
            Latch::Closed if self.score > 0 => Latch::Counting,
            latch => latch,
        };
        Self { latch, ..self }
    }

    /// Whether the safe command is out until it is acknowledged.
    pub(crate) fn is_latched(&self) -> bool {
        matches!(self.latch, Latch::Safe(_))
    }

    /// Where the safe command is latched: puts it out, and says why.
    pub(crate) fn latched(&mut self, fallback: &Fallback<T>) -> Option<Status> {
        let Latch::Safe(fault) = self.latch else {
            return None;
        };
        self.command = fallback.command.unwrap_or(self.command);
        Some(Status::Safe(fault))
    }

    /// [`bad`](Self::bad) of a sample for which [`may_step`](Self::may_step) was asked: what it
    /// has counted there is taken back.
    pub(crate) fn bad_after_step(&mut self, fault: Fault, fallback: &Fallback<T>) -> Status {
        self.score = self
            .score
            .saturating_add(u32::from(self.latch == Latch::Counting));
        self.bad(fault, fallback)
    }

    /// Counts a bad sample, and lets the safe command out when there were enough; not where it
    /// is latched already.
    pub(crate) fn bad(&mut self, fault: Fault, fallback: &Fallback<T>) -> Status {
        let most = fallback.most();
        self.score = self.score.saturating_add(fallback.weight).min(most);
        match fallback.command {
            Some(safe) if self.score >= most => {
                self.command = safe;
                self.latch = Latch::Safe(fault);
                Status::Safe(fault)
            }
            _ => {
                if self.latch == Latch::Closed {
                    self.latch = Latch::Counting;
                }
                Status::Held(fault)
            }
        }
    }

    /// Lets the loop be closed again by the next good sample; nothing where it is closed.
    pub(crate) fn acknowledge(&mut self) {
        if let Latch::Safe(_) = self.latch {
            self.latch = Latch::Returning;
            self.score = 0;
        }
    }
}

/// What is wrong with the sample time, where something is.
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

/// What is wrong with a number that is not finite.
pub(crate) fn unless_finite<T: Real>(number: T, fault: Fault) -> Option<Fault> {
    (!number.is_finite()).then_some(fault)
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    after: u32,
    #[serde(default = "usual")]
    weight: u32,
    command: Option<T>,
}

#[cfg(feature = "serde")]
const fn usual() -> u32 {
    WEIGHT
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Fallback<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        let hold = Self::hold_for_ever();
        match raw.command {
            Some(command) => Self::try_new(raw.after, command)?.with_weight(raw.weight),
            None if (raw.after, raw.weight) == (hold.after, hold.weight) => Ok(hold),
            // A line that was lost must not take the safe command away.
            None => Err(Error::Inadmissible("a fallback has a safe command")),
        }
    }
}
