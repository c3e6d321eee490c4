//! What an effect says of itself: name, unit, parity, what it reads.

use super::bounds::saturate;
use super::{EffectState, Family, Situation};
use crate::error::finite;
use crate::{Error, Real};

/// A unit, as exponents of the units that the record declares.
///
/// The coefficient of an effect has the unit of the output divided by this.
///
/// ```
/// use bowden::effect::{Dimension, Effect};
/// // Viscous friction regresses on a velocity: channel unit per second.
/// assert_eq!(Effect::<f64>::Viscous.dimension(), Dimension { channel: 1, time: -1, ..Dimension::ONE });
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dimension {
    /// Exponent of the unit of the channel that the effect reads.
    pub channel: i8,
    /// Exponent of the unit of the transmitted load.
    pub load: i8,
    /// Exponent of the second.
    pub time: i8,
    /// Exponent of the unit of the output.
    pub output: i8,
    /// Exponent of the unit of the transmission's input, where that is read
    /// whatever the channel (the shape of `degradation` only).
    pub input: i8,
}

impl Dimension {
    /// A pure number.
    pub const ONE: Self = Self {
        channel: 0,
        load: 0,
        time: 0,
        output: 0,
        input: 0,
    };
    /// The channel's unit.
    pub const POSITION: Self = Self {
        channel: 1,
        ..Self::ONE
    };
    /// The channel's unit per second.
    pub const VELOCITY: Self = Self {
        channel: 1,
        time: -1,
        ..Self::ONE
    };
    /// The load's unit.
    pub const LOAD: Self = Self {
        load: 1,
        ..Self::ONE
    };
    /// Seconds.
    pub const TIME: Self = Self {
        time: 1,
        ..Self::ONE
    };
    /// The output's unit.
    pub const OUTPUT: Self = Self {
        output: 1,
        ..Self::ONE
    };
}

/// How a regressor answers to a change of sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Symmetry {
    /// It stays.
    Even,
    /// It changes sign too.
    Odd,
    /// Neither.
    Neither,
}

/// The symmetries that tell effects apart.
///
/// ```
/// use bowden::effect::{Effect, Symmetry};
/// let parity = Effect::<f64>::AsymmetryViscous.parity();
/// assert_eq!(parity.mirror, Symmetry::Even); // |v|: breaks the mirror symmetry of friction
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Parity {
    /// Under (x, v) → (−x, −v): all signed signals change sign, that is motion,
    /// input, load, eta and output, along the whole path. Clocks do not.
    pub mirror: Symmetry,
    /// Under v → −v alone, at one instant: x, a, load and eta stay. An effect
    /// with memory answers [`Symmetry::Neither`]: its path has no such mirror.
    pub reversal: Symmetry,
}

impl Parity {
    pub(super) const fn new(mirror: Symmetry, reversal: Symmetry) -> Self {
        Self { mirror, reversal }
    }
}

/// One number of a [`Situation`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Quantity {
    /// Seconds since the previous sample.
    Dt,
    /// Seconds since the start.
    Time,
    /// x of the channel.
    Position,
    /// v of the channel.
    Velocity,
    /// a of the channel.
    Acceleration,
    /// The transmission's input.
    Input,
    /// The transmitted load.
    Load,
    /// The hysteresis state.
    Eta,
    /// The output so far.
    Output,
}

/// The range of a shape parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Finite and above zero: a fit does well to move its logarithm.
    Positive,
}

impl Range {
    pub(super) fn check<T: Real>(self, value: T, name: &'static str) -> Result<T, Error> {
        let value = finite(value, name)?;
        if self == Self::Positive && value <= T::zero() {
            return Err(Error::OutOfRange(name));
        }
        Ok(value)
    }
}

/// What there is to know of one shape parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShapeInfo {
    /// Its name in the formula.
    pub name: &'static str,
    /// The values that it may take.
    pub range: Range,
    /// Its unit.
    pub dimension: Dimension,
}

/// What there is to know of one effect, whatever its shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Info {
    /// The effect's own name.
    pub name: &'static str,
    /// The family that it belongs to.
    pub family: Family,
    /// The regressor as a formula.
    pub formula: &'static str,
    /// The regressor's unit.
    pub dimension: Dimension,
    /// The regressor's symmetries.
    pub parity: Parity,
    /// All that it reads; where one of these is not finite it returns 0.
    pub reads: &'static [Quantity],
    /// Whether it remembers earlier samples.
    pub memory: bool,
}

/// Where in a model an effect acts; no part of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Adds to the transmission's input.
    Input,
    /// Adds to the output.
    Sum,
    /// Reads the output of all before it, and adds to it.
    Output,
}

impl Info {
    /// Where an effect that reads this acts, input stages apart.
    pub(super) const fn stage(&self) -> Stage {
        let mut rest = self.reads;
        while let [first, others @ ..] = rest {
            if matches!(first, Quantity::Output) {
                return Stage::Output;
            }
            rest = others;
        }
        Stage::Sum
    }
}

/// One effect as a type of its own: what it says of itself, and its regressor.
///
/// For a [`FixedModel`](crate::model::FixedModel); [`Effect`](super::Effect) holds any of
/// them. Only the effects of this crate are.
pub trait Regressor<T>: sealed::Sealed {
    /// All that there is to know of the effect, shapes apart.
    const INFO: &'static Info;

    #[doc(hidden)]
    const STAGE: Stage = Self::INFO.stage();

    /// The regressor, where all that it reads is finite. It may overflow to an
    /// infinity, and be NaN where that means zero; memory must stay finite.
    #[doc(hidden)]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T;

    /// What of [`value`](Self::value) depends on `dt` alone: of a record it is computed once.
    #[doc(hidden)]
    #[inline]
    fn share(&self, _dt: T) -> T
    where
        T: Real,
    {
        T::zero()
    }

    /// [`value`](Self::value), where [`share`](Self::share) of the sample's `dt` is known.
    #[doc(hidden)]
    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Situation<T>, _share: T) -> T {
        self.value(state, at)
    }

    /// What a term of that gain adds, where all that it reads is finite: gain times
    /// regressor, but for an output stage that is not linear in its gain. It may overflow.
    #[doc(hidden)]
    #[inline]
    fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Situation<T>) -> T
    where
        T: Real,
    {
        gain * saturate(self.value(state, at))
    }
}

pub(super) mod sealed {
    /// Of the effects of this crate.
    pub trait Sealed {}
}
