//! Properties of an effect, such as its name, unit and inputs.

use super::bounds::saturate;
use super::{EffectState, Inputs};
use crate::error::finite;
use crate::{Error, Real};

/// A unit, expressed by the exponents of the units in the record.
///
/// The gain of a term has the output unit divided by the unit of its regressor.
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
    /// Exponent of the unit of the transmission's input. It is nonzero only for the shape parameter
    /// of `degradation`.
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

/// One quantity of [`Inputs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Quantity {
    /// Seconds since the previous sample.
    Dt,
    /// Seconds since the start.
    Time,
    /// Position x of the channel.
    Position,
    /// Velocity v of the channel.
    Velocity,
    /// Acceleration a of the channel.
    Acceleration,
    /// The transmission's input.
    Input,
    /// The transmitted load.
    Load,
    /// The hysteresis state.
    Eta,
    /// The sum of all terms before this effect.
    Output,
}

/// The range of a shape parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Any positive finite number. A fit should vary the logarithm of the parameter.
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
    /// Name of the parameter in the formula.
    pub name: &'static str,
    /// Range of the parameter.
    pub range: Range,
    /// Unit of the parameter.
    pub dimension: Dimension,
}

/// Properties of one effect that do not depend on its shape parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Info {
    /// Name of the effect.
    pub name: &'static str,
    /// Family of the effect, such as "drag".
    pub family: &'static str,
    /// Formula of the regressor.
    pub formula: &'static str,
    /// Unit of the regressor.
    pub dimension: Dimension,
    /// The quantities that the effect reads. If one of these quantities is not finite, the
    /// regressor is 0.
    pub reads: &'static [Quantity],
    /// Whether the effect depends on earlier samples.
    pub memory: bool,
    /// The shape parameters, in order.
    pub shapes: &'static [ShapeInfo],
    pub(crate) stage: Stage,
}

/// Position of an effect in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stage {
    /// Adds to the transmission's input.
    Input,
    /// Adds to the output.
    Sum,
    /// Reads the sum of all terms before it, and adds to this sum.
    Output,
}

impl Stage {
    /// The position of an effect that reads these quantities and is not an input stage.
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

/// The interface of a type that represents one effect.
///
/// A [`FixedModel`](crate::model::FixedModel) uses this trait. Only the effects of this crate
/// implement it.
pub trait Regressor<T>: sealed::Sealed + Sized {
    /// Properties of the effect that do not depend on its shape parameters.
    const INFO: &'static Info;

    #[doc(hidden)]
    fn shape(&self, index: usize) -> Option<T>;

    #[doc(hidden)]
    fn try_from_shapes(values: &[T]) -> Result<Self, Error>;

    /// The regressor for finite inputs. The result may be infinite (overflow), or NaN, which means
    /// zero. The memory must stay finite.
    #[doc(hidden)]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T;

    /// The part of [`value`](Self::value) that depends only on `dt`. It is reused while `dt` is
    /// constant.
    #[doc(hidden)]
    #[inline]
    fn share(&self, _dt: T) -> T
    where
        T: Real,
    {
        T::zero()
    }

    /// The same as [`value`](Self::value), with a known [`share`](Self::share) of the sample's
    /// `dt`.
    #[doc(hidden)]
    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, _share: T) -> T {
        self.value(state, at)
    }

    /// The contribution of a term with this gain, for finite inputs. It is gain times regressor,
    /// except for an output stage that is not linear in its gain. It may overflow.
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
