//! Effects of a cable transmission other than its hysteresis.
//!
//! Each effect is one *regressor* times a gain that the fit identifies. A regressor is a
//! function of the motion, the load and the hysteresis state. Each effect states its formula,
//! unit, symmetries, shape parameters and source. The symmetries show which effects can explain
//! a residual, and which experiment separates two effects from each other. Each effect is a type
//! of its own and a variant of [`Effect`].
//!
//! A regressor is finite for finite input: it saturates if the arithmetic overflows. If an
//! input is not finite or `dt` is negative, the regressor returns 0 and leaves its memory
//! unchanged.

mod bounds;
mod family;
mod info;
#[cfg(kani)]
#[path = "../../proofs/effects.rs"]
mod proofs;
mod shaped;
mod situation;
mod sum;

mod asymmetry;
mod backlash;
mod capstan;
mod coulomb;
mod creep;
mod crosstalk;
mod curve;
mod degradation;
mod delay;
mod direction;
mod drag;
mod drift;
mod gain;
mod gravity;
mod hardening;
mod inertia;
mod lag;
mod load_friction;
mod offset;
mod pinching;
mod position_friction;
mod power_law;
mod presliding;
mod pretension;
mod rate;
mod ripple;
mod saturation;
mod stiffness;
mod stretch;
mod stribeck;
mod temperature;
mod tone;
mod viscous;

pub use crate::signal::Motion;
pub use family::Family;
pub use info::{Dimension, Info, Parity, Quantity, Range, Regressor, ShapeInfo, Symmetry};
pub use situation::{EffectState, Inputs};

use crate::{Error, Real};
pub(crate) use bounds::saturate;
use info::sealed::Sealed;
pub(crate) use info::Stage;
use shaped::{Shaped, COUNT};

/// Common part of the effect types without shape parameters; each type has its own file.
macro_rules! plain_types {
    ($($module:ident: $($plain:ident)+;)*) => {
        $($(
            pub use $module::$plain;

            impl Sealed for $plain {}

            impl<T> From<$plain> for Effect<T> {
                fn from(_: $plain) -> Self {
                    Self::$plain
                }
            }
        )+)*
    };
}

/// Common part of the effect types with shape parameters; each type has its own file.
macro_rules! shaped_types {
    ($($module:ident: $($shaped:ident)+;)*) => {
        $($(
            pub use $module::$shaped;

            impl<T> Sealed for $shaped<T> {}

            impl<T> From<$shaped<T>> for Effect<T> {
                fn from(own: $shaped<T>) -> Self {
                    Self::$shaped(own)
                }
            }
        )+)*
    };
}

/// The enum of all effects, and the dispatch to the file of each.
///
/// Compact forms store the index of an effect in the enum: add new effects under `later`.
macro_rules! effects {
    (
        plain { $($module:ident: $($plain:ident)+;)* }
        shaped { $($shaped_module:ident: $($shaped:ident)+;)* }
        later { $($later_module:ident: $($later:ident)+;)* }
        later_shaped { $($late_module:ident: $($late:ident)+;)* }
    ) => {
        plain_types! { $($module: $($plain)+;)* $($later_module: $($later)+;)* }

        shaped_types! { $($shaped_module: $($shaped)+;)* $($late_module: $($late)+;)* }

        /// One effect, with its shape parameters.
        ///
        /// ```
        /// use bowden::effect::{Coulomb, Effect};
        /// let friction = Effect::Coulomb(Coulomb::try_new(0.01)?);
        /// assert_eq!(friction, Effect::try_from_name("coulomb", &[0.01])?);
        /// assert_eq!(friction.formula(), "tanh(v/v_e)");
        /// assert_eq!(friction.shape_names(), ["v_e"]);
        /// # Ok::<(), bowden::Error>(())
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(
            rename_all = "kebab-case",
            bound(deserialize = "T: Real + serde::Deserialize<'de>")
        ))]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum Effect<T> {
            $($(#[doc = concat!("Without shapes; formula and source: [`", stringify!($plain), "`].")] $plain,)+)*
            $($(#[doc = concat!("Formula and source: [`", stringify!($shaped), "`].")] $shaped($shaped_module::$shaped<T>),)+)*
            $($(#[doc = concat!("Without shapes; formula and source: [`", stringify!($later), "`].")] $later,)+)*
            $($(#[doc = concat!("Formula and source: [`", stringify!($late), "`].")] $late($late_module::$late<T>),)+)*
        }

        /// All effects, in the order in which compact forms number them.
        ///
        /// ```
        /// let with_memory = bowden::effect::CATALOGUE.iter().filter(|info| info.memory);
        /// assert_eq!(with_memory.count(), 9);
        /// ```
        pub const CATALOGUE: &[&Info] = &[
            $($(<$plain as Regressor<f64>>::INFO,)+)*
            $($(<$shaped_module::$shaped<f64> as Regressor<f64>>::INFO,)+)*
            $($(<$later as Regressor<f64>>::INFO,)+)*
            $($(<$late_module::$late<f64> as Regressor<f64>>::INFO,)+)*
        ];

        impl<T: Real> Effect<T> {
            /// Properties of the effect, without its shape parameters.
            #[must_use]
            pub fn info(&self) -> &'static Info {
                match self {
                    $($(Self::$plain => <$plain as Regressor<T>>::INFO,)+)*
                    $($(Self::$shaped(_) => <$shaped_module::$shaped<T> as Regressor<T>>::INFO,)+)*
                    $($(Self::$later => <$later as Regressor<T>>::INFO,)+)*
                    $($(Self::$late(_) => <$late_module::$late<T> as Regressor<T>>::INFO,)+)*
                }
            }

            /// Position of the effect in a model.
            pub(crate) fn stage(&self) -> Stage {
                match self {
                    $($(Self::$plain => <$plain as Regressor<T>>::STAGE,)+)*
                    $($(Self::$shaped(_) => <$shaped<T> as Regressor<T>>::STAGE,)+)*
                    $($(Self::$later => <$later as Regressor<T>>::STAGE,)+)*
                    $($(Self::$late(_) => <$late<T> as Regressor<T>>::STAGE,)+)*
                }
            }

            /// The names of the shape parameters; empty if the effect has none.
            #[must_use]
            pub fn shape_names(&self) -> &'static [&'static str] {
                match self {
                    $($(Self::$plain)|+ => &[],)*
                    $($(Self::$shaped(_) => <$shaped_module::$shaped<T>>::NAMES,)+)*
                    $($(Self::$later)|+ => &[],)*
                    $($(Self::$late(_) => <$late_module::$late<T>>::NAMES,)+)*
                }
            }

            /// Name, range and unit of the shape parameters; empty if the effect has none.
            #[must_use]
            pub fn shape_info(&self) -> &'static [ShapeInfo] {
                match self {
                    $($(Self::$plain)|+ => &[],)*
                    $($(Self::$shaped(_) => <$shaped_module::$shaped<T>>::SHAPES,)+)*
                    $($(Self::$later)|+ => &[],)*
                    $($(Self::$late(_) => <$late_module::$late<T>>::SHAPES,)+)*
                }
            }

            /// The value of one shape parameter.
            #[must_use]
            pub fn shape(&self, index: usize) -> Option<T> {
                match self {
                    $($(Self::$plain)|+ => None,)*
                    $($(Self::$shaped(config) => config.shape(index),)+)*
                    $($(Self::$later)|+ => None,)*
                    $($(Self::$late(config) => config.shape(index),)+)*
                }
            }

            /// The same effect with one shape parameter changed.
            ///
            /// # Errors
            /// [`Error::OutOfRange`] if there is no such shape parameter or if the value lies
            /// outside its range, [`Error::NonFinite`] if the value is not finite.
            pub fn with_shape(&self, index: usize, value: T) -> Result<Self, Error> {
                match self {
                    $($(Self::$plain)|+ => Err(Error::OutOfRange("shape index")),)*
                    $($(Self::$shaped(config) => config.with_shape(index, value).map(Self::$shaped),)+)*
                    $($(Self::$later)|+ => Err(Error::OutOfRange("shape index")),)*
                    $($(Self::$late(config) => config.with_shape(index, value).map(Self::$late),)+)*
                }
            }

            /// The effect with this name and these shape parameters, in order.
            ///
            /// # Errors
            /// - [`Error::OutOfRange`] if the catalogue has no such effect, or if a shape
            ///   parameter lies outside its range.
            /// - [`Error::Inadmissible`] if the number of shape parameters is wrong.
            /// - [`Error::NonFinite`] if a shape parameter is not finite.
            pub fn try_from_name(name: &str, shapes: &[T]) -> Result<Self, Error> {
                let plain = |effect| if shapes.is_empty() { Ok(effect) } else { Err(COUNT) };
                match name {
                    $($(name if name == <$plain as Regressor<T>>::INFO.name => plain(Self::$plain),)+)*
                    $($(name if name == <$shaped_module::$shaped<T> as Regressor<T>>::INFO.name => {
                        Shaped::try_from_shapes(shapes).map(Self::$shaped)
                    })+)*
                    $($(name if name == <$later as Regressor<T>>::INFO.name => plain(Self::$later),)+)*
                    $($(name if name == <$late_module::$late<T> as Regressor<T>>::INFO.name => {
                        Shaped::try_from_shapes(shapes).map(Self::$late)
                    })+)*
                    _ => Err(Error::OutOfRange("effect name")),
                }
            }

            /// The regressors of a record, one per sample. Each equals
            /// [`regressor`](Self::regressor) bit for bit; for many samples the cost is lower.
            pub fn regressors(
                &self,
                state: &mut EffectState<T>,
                record: impl Iterator<Item = Inputs<T>>,
                take: impl FnMut(T),
            ) {
                // The effect is matched once per record, not once per sample.
                match self {
                    $($(Self::$plain => along(&$plain, state, record, take),)+)*
                    $($(Self::$shaped(config) => along(config, state, record, take),)+)*
                    $($(Self::$later => along(&$later, state, record, take),)+)*
                    $($(Self::$late(config) => along(config, state, record, take),)+)*
                }
            }

            /// The regressor at one sample; the caller multiplies it by the gain.
            ///
            /// The result is finite for finite input. If a number that the effect reads is not
            /// finite, or a `dt` that it reads is negative, the result is 0 and `state` is
            /// unchanged.
            #[inline]
            pub fn regressor(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
                match self {
                    $($(Self::$plain => evaluate(&$plain, state, at),)+)*
                    $($(Self::$shaped(config) => evaluate(config, state, at),)+)*
                    $($(Self::$later => evaluate(&$later, state, at),)+)*
                    $($(Self::$late(config) => evaluate(config, state, at),)+)*
                }
            }
        }
    };
}

effects! {
    plain {
        offset: Offset;
        gain: Gain;
        viscous: Viscous;
        drag: DragQuadratic DragCubic;
        asymmetry: AsymmetryViscous AsymmetryDrag AsymmetryEta AsymmetryEtaSquared;
        inertia: Inertia;
        stiffness: StiffnessLinear StiffnessQuadratic StiffnessCubic StiffnessProgressive;
        position_friction: PositionHysteresis;
        delay: Delay;
        rate: Rate RateSymmetric;
        drift: Drift;
        crosstalk: Crosstalk;
    }
    shaped {
        coulomb: Coulomb;
        stribeck: Stribeck;
        load_friction: LoadFriction;
        capstan: Capstan;
        direction: DriveFriction BackDriveFriction;
        stiffness: Hinge;
        gravity: Gravity;
        ripple: Ripple;
        position_friction: PositionFriction;
        backlash: Backlash PlayInSeries DeadZone;
        lag: Lag;
        creep: Creep;
        presliding: Presliding PreslidingDahl;
        degradation: Degradation;
        pinching: Pinching;
        pretension: Pretension;
        temperature: Temperature;
        saturation: SaturationUpper SaturationLower;
        tone: Tone;
    }
    later {
        stretch: StretchLinear StretchCubic;
    }
    later_shaped {
        hardening: Hardening;
        power_law: PowerLaw;
        curve: CurvePosition CurveVelocity;
    }
}

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
    /// The family that the effect belongs to.
    #[must_use]
    pub fn family(&self) -> Family {
        self.info().family
    }

    /// The effect's own name, such as "drag-quadratic".
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// The regressor as a formula, such as "v·|v|".
    #[must_use]
    pub fn formula(&self) -> &'static str {
        self.info().formula
    }

    /// The unit of the regressor.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        self.info().dimension
    }

    /// The symmetries of the regressor.
    #[must_use]
    pub fn parity(&self) -> Symmetry {
        self.info().parity
    }

    /// The contribution of a term with this gain to the output: gain times regressor, except for a
    /// delay.
    ///
    /// The gain of a [`Delay`] is a time, and the output is not linear in this time; the regressor
    /// is the slope at zero delay. The result is finite for finite input. If a number that the
    /// effect reads is not finite, or a `dt` that it reads is negative, the result is 0 and `state`
    /// is unchanged.
    ///
    /// ```
    /// use bowden::effect::{Effect, EffectState, Inputs};
    /// let (late, mut state) = (Effect::Delay, EffectState::default());
    /// let at = |output| Inputs { dt: 0.001, output, ..Inputs::default() };
    /// let y: [f64; 3] = [5.0, 2.0, 7.0].map(|y| y + late.contribution(0.001, &mut state, &at(y)));
    /// assert_eq!(y, [5.0, 5.0, 2.0]); // one sample late
    /// ```
    #[inline]
    pub fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let part = match self {
            Self::Delay if at.is_usable(<Delay as Regressor<T>>::INFO.reads) => {
                Delay.contribution(gain, state, at)
            }
            _ => gain * self.regressor(state, at),
        };
        saturate(part)
    }

    /// The contributions of a term with this gain along a record, one per sample. Each equals
    /// [`contribution`](Self::contribution) bit for bit; for many samples the cost is lower.
    pub fn contributions(
        &self,
        gain: T,
        state: &mut EffectState<T>,
        record: impl Iterator<Item = Inputs<T>>,
        mut take: impl FnMut(T),
    ) {
        match self {
            Self::Delay => record.for_each(|at| take(self.contribution(gain, state, &at))),
            _ => self.regressors(state, record, |value| take(saturate(gain * value))),
        }
    }

    /// Whether the effect reads the hysteresis state.
    #[must_use]
    pub fn reads_eta(&self) -> bool {
        self.info().reads.contains(&Quantity::Eta)
    }

    /// Whether the effect reads the sum of all terms before it.
    #[must_use]
    pub fn is_output_stage(&self) -> bool {
        self.stage() == Stage::Output
    }

    /// Whether the effect acts on the transmission's input instead of adding to the output.
    ///
    /// The regressor then has the unit of the input, and the gain is dimensionless. Without a
    /// transmission the term has no influence.
    #[must_use]
    pub fn is_input_stage(&self) -> bool {
        self.stage() == Stage::Input
    }

    /// Whether the effect has a memory of earlier samples.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.info().memory
    }
}
