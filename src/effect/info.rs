//! Properties of an effect: name, unit, symmetries, inputs.

use super::bounds::saturate;
use super::{EffectState, Inputs};
use crate::error::finite;
use crate::{Error, Real};

/// A unit, as exponents of the record's units.
///
/// The coefficient of an effect has the unit of the output divided by this unit.
///
/// ```
/// use bowden::effect::{Dimension, Effect, Viscous};
/// // The regressor of viscous friction is a velocity: channel unit per second.
/// assert_eq!(Effect::<f64>::from(Viscous).info().dimension, Dimension { channel: 1, time: -1, ..Dimension::default() });
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
    /// Exponent of the unit of the transmission's input, if the effect reads that input for any
    /// channel (the shape parameter of `degradation` only).
    pub input: i8,
}

impl Dimension {
    /// A pure number.
    pub(super) const ONE: Self = Self::of(0, 0, 0, 0);
    /// The channel's unit.
    pub(super) const POSITION: Self = Self::of(1, 0, 0, 0);
    /// The channel's unit per second.
    pub(super) const VELOCITY: Self = Self::of(1, 0, -1, 0);
    /// The load's unit.
    pub(super) const LOAD: Self = Self::of(0, 1, 0, 0);
    /// Seconds.
    pub(super) const TIME: Self = Self::of(0, 0, 1, 0);
    /// The output's unit.
    pub(super) const OUTPUT: Self = Self::of(0, 0, 0, 1);

    const fn of(channel: i8, load: i8, time: i8, output: i8) -> Self {
        Self {
            channel,
            load,
            time,
            output,
            input: 0,
        }
    }
}

/// How a regressor responds to a change of sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Parity {
    /// The regressor keeps its sign.
    Even,
    /// The regressor changes its sign.
    Odd,
    /// Neither of the two.
    Neither,
}

/// The symmetries that distinguish effects.
///
/// ```
/// use bowden::effect::{AsymmetryViscous, Effect, Parity};
/// let parity = Effect::<f64>::from(AsymmetryViscous).info().parity;
/// assert_eq!(parity.mirror, Parity::Even); // |v|: breaks the mirror symmetry of friction
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Symmetry {
    /// Under (x, v) → (−x, −v): all signed signals (motion, input, load, eta and output) change
    /// sign along the whole path. Times do not change sign.
    pub mirror: Parity,
    /// Under v → −v alone, at one instant: x, a, load and eta stay the same. An effect with memory
    /// returns [`Parity::Neither`]: its path has no such mirror image.
    pub reversal: Parity,
}

/// One quantity of [`Inputs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
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
    /// The output before this effect.
    Output,
}

/// The range of a shape parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Finite and above zero; a fit should vary its logarithm.
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

/// Properties of one shape parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShapeInfo {
    /// Its name in the formula.
    pub name: &'static str,
    /// Its range.
    pub range: Range,
    /// Its unit.
    pub dimension: Dimension,
}

/// Properties of one effect that do not depend on its shape parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Info {
    /// The effect's own name.
    pub name: &'static str,
    /// The family that the effect belongs to, such as "drag".
    pub family: &'static str,
    /// The regressor as a formula.
    pub formula: &'static str,
    /// The regressor's unit.
    pub dimension: Dimension,
    /// The regressor's symmetries.
    pub parity: Symmetry,
    /// The quantities that the effect reads. If one of them is not finite, the regressor returns 0.
    pub reads: &'static [Quantity],
    /// Whether the effect has a memory of earlier samples.
    pub memory: bool,
    /// The shape parameters, in order.
    pub shapes: &'static [ShapeInfo],
    pub(crate) stage: Stage,
}

/// Position of an effect in a model; not part of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stage {
    /// Adds to the transmission's input.
    Input,
    /// Adds to the output.
    Sum,
    /// Reads the output of all terms before it, and adds to this output.
    Output,
}

impl Stage {
    /// The position of an effect with these inputs, input stages excluded.
    pub(super) const fn of(reads: &[Quantity]) -> Self {
        let mut rest = reads;
        while let [first, others @ ..] = rest {
            if matches!(first, Quantity::Output) {
                return Self::Output;
            }
            rest = others;
        }
        Self::Sum
    }
}

/// The number of values differs from the number of shape parameters.
pub(super) const COUNT: Error =
    Error::Inadmissible("there must be one value for each shape of the effect");

/// One effect as a separate type: its properties and its regressor.
///
/// A [`FixedModel`](crate::model::FixedModel) uses this trait; an [`Effect`](super::Effect) can
/// hold any effect. Only the effects of this crate implement the trait.
pub trait Regressor<T>: sealed::Sealed + Sized {
    /// Properties of the effect, without its shape parameters.
    const INFO: &'static Info;

    #[doc(hidden)]
    fn shape(&self, index: usize) -> Option<T>;

    #[doc(hidden)]
    fn try_from_shapes(values: &[T]) -> Result<Self, Error>;

    /// The regressor, if all its inputs are finite. It may overflow to an infinity, and may be NaN
    /// if this means zero; the memory must stay finite.
    #[doc(hidden)]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T;

    /// The part of [`value`](Self::value) that depends on `dt` alone; it is computed once per
    /// record.
    #[doc(hidden)]
    #[inline]
    fn share(&self, _dt: T) -> T
    where
        T: Real,
    {
        T::zero()
    }

    /// [`value`](Self::value), if [`share`](Self::share) of the sample's `dt` is known.
    #[doc(hidden)]
    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, _share: T) -> T {
        self.value(state, at)
    }

    /// The contribution of a term with this gain, if all its inputs are finite: gain times
    /// regressor, except for an output stage that is not linear in its gain. The contribution may
    /// overflow.
    #[doc(hidden)]
    #[inline]
    fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Inputs<T>) -> T
    where
        T: Real,
    {
        gain * saturate(self.value(state, at))
    }
}

pub(super) mod sealed {
    /// Restricts the trait to the effects of this crate.
    pub trait Sealed {}
}
