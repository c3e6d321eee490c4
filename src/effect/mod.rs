//! Effects of a cable transmission other than its hysteresis.
//!
//! Each effect defines a *regressor*, a function of the motion, the load and the hysteresis state.
//! A term of a model is a gain times a regressor. A fit identifies the gain. Each effect has its
//! own type, and [`Effect`] can hold any effect. [`Info`] gives the formula, unit and shape
//! parameters of an effect.
//!
//! If the arithmetic overflows, a regressor saturates at the largest finite value.

mod bounds;
mod declare;
mod info;
mod inputs;
#[cfg(kani)]
#[path = "../../proofs/effects.rs"]
mod proofs;

mod friction;
mod memory;
mod signal;
mod spring;

pub use info::{Dimension, Info, Quantity, Range, Regressor, ShapeInfo};
pub use inputs::{EffectState, Inputs, Motion};

use crate::{Error, Real};
pub(crate) use bounds::saturate;
pub(crate) use info::Stage;

/// The types of all effects, the enum over them, and the dispatch to each.
///
/// Compact forms store the index of an effect in this list: add new effects at its end.
macro_rules! effects {
    ($($module:ident::$effect:ident $(<$T:ident>)?,)+) => {
        $(pub use $module::$effect;)+

        crate::data! {
            enum Kind<T: Real> {
                $($effect $(($effect<$T>))?,)+
            }
        }

        /// All effects, in the order of their indices in compact formats.
        ///
        /// ```
        /// let with_memory = bowden::effect::CATALOGUE.iter().filter(|info| info.memory);
        /// assert_eq!(with_memory.count(), 9);
        /// ```
        pub const CATALOGUE: &[&Info] = {
            type T = f64;
            &[$(<$effect $(<$T>)? as Regressor<T>>::INFO,)+]
        };

        $(impl<T> From<$effect $(<$T>)?> for Effect<T> {
            fn from(effect: $effect $(<$T>)?) -> Self {
                effects!(@variant $effect effect $($T)?)
            }
        })+

        #[allow(non_snake_case)]
        impl<T: Real> Effect<T> {
            /// Properties of the effect, without the values of its shape parameters.
            #[must_use]
            pub fn info(&self) -> &'static Info {
                match &self.0 {
                    $(Kind::$effect { .. } => <$effect $(<$T>)? as Regressor<T>>::INFO,)+
                }
            }

            /// Position of the effect in a model.
            pub(crate) fn stage(&self) -> Stage {
                match &self.0 {
                    $(Kind::$effect { .. } => <$effect $(<$T>)? as Regressor<T>>::INFO.stage,)+
                }
            }

            /// The quantities that the effect reads.
            pub(crate) fn reads(&self) -> &'static [Quantity] {
                match &self.0 {
                    $(Kind::$effect { .. } => <$effect $(<$T>)? as Regressor<T>>::INFO.reads,)+
                }
            }

            /// The value of a shape parameter, or `None` if there is no parameter with this index.
            #[must_use]
            pub fn shape(&self, index: usize) -> Option<T> {
                match &self.0 {
                    $(Kind::$effect $(($T))? => {
                        Regressor::<T>::shape(effects!(@effect $effect $($T)?), index)
                    })+
                }
            }

            /// The effect with this name and these shape parameters, in the order of
            /// [`Info::shapes`].
            ///
            /// # Errors
            /// - [`Error::OutOfRange`] if the catalogue has no such effect, or if a shape
            ///   parameter lies outside its range.
            /// - [`Error::Inadmissible`] if the number of shape parameters is wrong.
            /// - [`Error::NonFinite`] if a shape parameter is not finite.
            pub fn try_from_name(name: &str, shapes: &[T]) -> Result<Self, Error> {
                match name {
                    $(name if name == <$effect $(<$T>)? as Regressor<T>>::INFO.name => {
                        <$effect $(<$T>)? as Regressor<T>>::try_from_shapes(shapes).map(Self::from)
                    })+
                    _ => Err(Error::OutOfRange("effect name")),
                }
            }

            /// Passes the regressor at each sample of a record to `take`. The values equal the
            /// results of [`regressor`](Self::regressor) bit for bit. For many samples, this
            /// function is faster.
            pub fn regressors(
                &self,
                state: &mut EffectState<T>,
                record: impl Iterator<Item = Inputs<T>>,
                take: impl FnMut(T),
            ) {
                // The effect is matched once per record, not once per sample.
                match &self.0 {
                    $(Kind::$effect $(($T))? => {
                        along(effects!(@effect $effect $($T)?), state, record, take)
                    })+
                }
            }

            /// The regressor at one sample, without the gain.
            ///
            /// The result is finite for finite inputs. In two cases, the result is 0 and `state` is
            /// unchanged: an input that the effect reads is not finite, or `dt` is negative and the
            /// effect reads it.
            #[inline]
            pub fn regressor(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
                match &self.0 {
                    $(Kind::$effect $(($T))? => evaluate(effects!(@effect $effect $($T)?), state, at),)+
                }
            }
        }
    };

    // The effect of a variant: the type itself if it has no shape parameters.
    (@effect $effect:ident) => { &$effect };
    (@effect $effect:ident $T:ident) => { $T };
    // The variant of an effect.
    (@variant $effect:ident $of:ident) => {{
        let $effect = $of;
        Self(Kind::$effect)
    }};
    (@variant $effect:ident $of:ident $T:ident) => { Self(Kind::$effect($of)) };
}

effects! {
    signal::Offset,
    signal::Gain,
    friction::Viscous,
    friction::DragQuadratic,
    friction::DragCubic,
    friction::AsymmetryViscous,
    friction::AsymmetryDrag,
    friction::AsymmetryEta,
    friction::AsymmetryEtaSquared,
    signal::Inertia,
    spring::StiffnessLinear,
    spring::StiffnessQuadratic,
    spring::StiffnessCubic,
    spring::StiffnessProgressive,
    friction::PositionHysteresis,
    memory::Delay,
    spring::Rate,
    spring::RateSymmetric,
    signal::Drift,
    signal::Crosstalk,
    friction::Coulomb <T>,
    friction::Stribeck <T>,
    friction::LoadFriction <T>,
    friction::Capstan <T>,
    friction::DriveFriction <T>,
    friction::BackDriveFriction <T>,
    spring::Hinge <T>,
    spring::Gravity <T>,
    spring::Ripple <T>,
    friction::PositionFriction <T>,
    memory::Backlash <T>,
    memory::PlayInSeries <T>,
    memory::DeadZone <T>,
    memory::Lag <T>,
    memory::Creep <T>,
    memory::Presliding <T>,
    memory::PreslidingDahl <T>,
    memory::Degradation <T>,
    spring::Pinching <T>,
    signal::Pretension <T>,
    signal::Temperature <T>,
    spring::SaturationUpper <T>,
    spring::SaturationLower <T>,
    signal::Tone <T>,
    spring::StretchLinear,
    spring::StretchCubic,
    memory::Hardening <T>,
    friction::PowerLaw <T>,
    spring::CurvePosition <T>,
    spring::CurveVelocity <T>,
}

/// Any effect of this module, with its shape parameters. Create it from the type of the effect, or
/// from its name in the [`CATALOGUE`].
///
/// ```
/// use bowden::effect::{Coulomb, Effect};
/// let friction = Effect::from(Coulomb::try_new(0.01)?);
/// assert_eq!(friction, Effect::try_from_name("coulomb", &[0.01])?);
/// assert_eq!(friction.info().formula, "tanh(v/v_e)");
/// assert_eq!(friction.info().shapes[0].name, "v_e");
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Effect<T>(Kind<T>);

crate::checked::stored_as! {
    Effect<T> as Kind<T>: |effect| effect.0, |kind| Ok::<_, Error>(Effect(kind))
}

/// Largest number of shape parameters of an effect.
const MOST_SHAPES: usize = 2;

#[inline]
fn evaluate<T: Real, R: Regressor<T>>(effect: &R, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
    if at.is_usable(R::INFO.reads) {
        saturate(effect.value(state, at))
    } else {
        T::zero()
    }
}

/// [`evaluate`] at each sample.
#[inline]
fn along<T: Real, R: Regressor<T>>(
    effect: &R,
    state: &mut EffectState<T>,
    record: impl Iterator<Item = Inputs<T>>,
    mut take: impl FnMut(T),
) {
    let mut known: Option<(T, T)> = None;
    record.for_each(|at| {
        let share = match known {
            // 0.0 == -0.0, but the two give contributions of opposite sign.
            Some((dt, share)) if dt == at.dt && dt != T::zero() => share,
            _ => effect.share(at.dt),
        };
        known = Some((at.dt, share));
        take(if at.is_usable(R::INFO.reads) {
            saturate(effect.value_knowing(state, &at, share))
        } else {
            T::zero()
        });
    });
}

impl<T: Real> Effect<T> {
    /// Name of the effect, such as "drag-quadratic".
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// Returns this effect with one shape parameter changed.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if there is no such shape parameter or if the value lies outside its
    /// range; [`Error::NonFinite`] if the value is not finite.
    pub fn with_shape(&self, index: usize, value: T) -> Result<Self, Error> {
        let info = self.info();
        let mut shapes = [T::ZERO; MOST_SHAPES];
        let own = shapes.get_mut(..info.shapes.len()).unwrap_or_default();
        for (i, shape) in own.iter_mut().enumerate() {
            *shape = self.shape(i).unwrap_or(T::ZERO);
        }
        *own.get_mut(index).ok_or(Error::OutOfRange("shape index"))? = value;
        Self::try_from_name(info.name, own)
    }

    /// The contribution of a term with this gain to the output. Except for a delay, the
    /// contribution is the gain times the regressor.
    ///
    /// The gain of a [`Delay`] is a time, and the contribution is the delayed output minus the
    /// output. For a positive gain, this contribution is not linear in the gain. Overflows, and
    /// inputs that are not finite, are handled as in [`regressor`](Self::regressor).
    ///
    /// ```
    /// use bowden::effect::{Delay, Effect, EffectState, Inputs};
    /// let (late, mut state) = (Effect::from(Delay), EffectState::default());
    /// let at = |output| Inputs { dt: 0.001, output, ..Inputs::default() };
    /// let y: [f64; 3] = [5.0, 2.0, 7.0].map(|y| y + late.contribution(0.001, &mut state, &at(y)));
    /// assert_eq!(y, [5.0, 5.0, 2.0]); // one sample late
    /// ```
    #[inline]
    pub fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let part = match &self.0 {
            Kind::Delay if at.is_usable(<Delay as Regressor<T>>::INFO.reads) => {
                Regressor::contribution(&Delay, gain, state, at)
            }
            _ => gain * self.regressor(state, at),
        };
        saturate(part)
    }

    /// Passes the contribution of a term with this gain at each sample of a record to `take`. The
    /// values equal the results of [`contribution`](Self::contribution) bit for bit. For many
    /// samples, this function is faster.
    pub fn contributions(
        &self,
        gain: T,
        state: &mut EffectState<T>,
        record: impl Iterator<Item = Inputs<T>>,
        mut take: impl FnMut(T),
    ) {
        match &self.0 {
            Kind::Delay => record.for_each(|at| take(self.contribution(gain, state, &at))),
            _ => self.regressors(state, record, |value| take(saturate(gain * value))),
        }
    }

    /// Whether the effect reads the hysteresis state.
    pub fn reads_eta(&self) -> bool {
        self.reads().contains(&Quantity::Eta)
    }

    /// Whether the effect reads the sum of all terms before it.
    pub fn is_output_stage(&self) -> bool {
        self.stage() == Stage::Output
    }

    /// Whether the effect acts on the transmission's input instead of adding to the output.
    ///
    /// The regressor of such an effect has the unit of the input, and the gain is dimensionless. In
    /// a model without a transmission, the term adds nothing.
    pub fn is_input_stage(&self) -> bool {
        self.stage() == Stage::Input
    }
}
