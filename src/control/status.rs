//! What a step did: a good one, or a bad sample and what was commanded instead.

use super::Limits;
use crate::error::finite;
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
    /// `dt` is longer than the law is stable for.
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
}

/// What a step did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// All samples were good; the state has moved on.
    Good,
    /// A bad sample: the state is as it was, the last good command is held.
    Held(Fault),
    /// Too many bad samples in a row: the state is as it was, the safe command is out.
    Safe(Fault),
}

/// What to command when samples stay bad.
///
/// ```
/// use bowden::control::Fallback;
/// let fallback = Fallback::try_new(10, 0.0)?; // zero from the tenth bad sample on
/// assert_eq!((fallback.after(), fallback.command()), (10, Some(0.0)));
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
    command: Option<T>,
}

impl<T: Real> Fallback<T> {
    /// The safe command \[command unit\] from the `after`-th bad sample in a row on.
    ///
    /// It goes out at once, whatever the slew rate: it is what the machine needs then.
    /// The first good command after it starts from it.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"safe command"`, [`Error::OutOfRange`] with `"after"`
    /// where that is zero.
    pub fn try_new(after: u32, command: T) -> Result<Self, Error> {
        if after == 0 {
            return Err(Error::OutOfRange("after"));
        }
        Ok(Self {
            after,
            command: Some(finite(command, "safe command")?),
        })
    }

    /// Holds the last good command for ever.
    #[must_use]
    pub fn hold() -> Self {
        Self {
            after: u32::MAX,
            command: None,
        }
    }

    /// Refuses a safe command that the limits would not let out.
    ///
    /// # Errors
    /// [`Error::Inadmissible`].
    pub(crate) fn check_within(&self, limits: &Limits<T>) -> Result<(), Error> {
        match self.command {
            Some(safe) if !limits.contains(safe) => Err(Error::Inadmissible(
                "the safe command lies within the limits",
            )),
            _ => Ok(()),
        }
    }

    /// From which bad sample in a row on the safe command is out.
    #[must_use]
    pub fn after(&self) -> u32 {
        self.after
    }

    /// The safe command \[command unit\], where there is one.
    #[must_use]
    pub fn command(&self) -> Option<T> {
        self.command
    }
}

/// The command that is out, and for how many samples in a row there was no better.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Held<T> {
    pub(crate) command: T,
    pub(crate) bad: u32,
}

impl<T: Real> Held<T> {
    pub(crate) fn new(command: T) -> Self {
        Self { command, bad: 0 }
    }

    /// Takes note of a good command.
    #[inline]
    pub(crate) fn good(&mut self, command: T) -> Status {
        *self = Self::new(command);
        Status::Good
    }

    /// Whether the safe command is out.
    #[inline]
    pub(crate) fn is_safe(&self, fallback: &Fallback<T>) -> bool {
        fallback.command.is_some() && self.bad >= fallback.after
    }

    /// Counts a bad sample, and lets the safe command out when there were enough.
    #[inline]
    pub(crate) fn bad(&mut self, fault: Fault, fallback: &Fallback<T>) -> Status {
        self.bad = self.bad.saturating_add(1);
        match fallback.command {
            Some(safe) if self.bad >= fallback.after => {
                self.command = safe;
                Status::Safe(fault)
            }
            _ => Status::Held(fault),
        }
    }
}

/// The sample time, or why it cannot be used.
#[inline]
pub(crate) fn usable_dt<T: Real>(dt: T) -> Result<T, Fault> {
    if !dt.is_finite() {
        Err(Fault::Dt)
    } else if dt <= T::zero() {
        Err(Fault::DtNotPositive)
    } else {
        Ok(dt)
    }
}

/// A finite sample, or the fault.
#[inline]
pub(crate) fn usable<T: Real>(value: T, fault: Fault) -> Result<T, Fault> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(fault)
    }
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    after: u32,
    command: Option<T>,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Fallback<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        match raw.command {
            Some(command) => Self::try_new(raw.after, command),
            None => Ok(Self::hold()),
        }
    }
}
