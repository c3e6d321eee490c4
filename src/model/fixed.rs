//! A model whose effects are fixed at compile time.
//!
//! A [`Model`] can hold any effect, so a firmware image contains the code of all effects. A
//! [`FixedModel`] has the types of its effects as parameters, so the image contains only the code
//! of these effects. Both models give the same output, bit for bit.

use super::{motion, Model, ModelState, Sample, Term};
use crate::effect::{saturate, Effect, EffectState, Inputs, Motion, Quantity, Regressor, Stage};
use crate::error::{finite, rarely};
use crate::transmission::Transmission;
use crate::{Error, Real};

/// A transmission plus a tuple of terms, each with the type of its effect.
///
/// `N` is the number of terms, from 1 to 16. The state of a `FixedModel` is the [`ModelState`] of a
/// [`Model`] with the same number of terms. A `FixedModel` treats bad samples as a `Model` does.
///
/// ```
/// use bowden::effect::{Coulomb, Motion, Viscous};
/// use bowden::model::{FixedModel, ModelState, Sample, Source, Term};
///
/// fn model() -> Result<FixedModel<f32, 2, (Term<f32, Viscous>, Term<f32, Coulomb<f32>>)>, bowden::Error> {
///     let source = Source::Input;
///     FixedModel::try_new(None, (
///         Term { effect: Viscous, source, origin: 0.0, gain: 3.0 },
///         Term { effect: Coulomb::try_new(0.01)?, source, origin: 0.0, gain: 0.5 },
///     ))
/// }
///
/// let (model, mut state) = (model()?, ModelState::new());
/// let input = Motion { position: 0.0, velocity: 2.0, acceleration: 0.0 };
/// let sample = Sample { dt: 0.001, input, load: 0.0, channels: &[] };
/// assert_eq!(model.step(&mut state, &sample), 6.5);
/// // The same numbers as from a model that holds any effect.
/// assert_eq!(model.to_model().step(&mut ModelState::new(), &sample), 6.5);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FixedModel<T, const N: usize, L> {
    transmission: Option<Transmission<T>>,
    terms: L,
}

impl<T: Real, const N: usize, L: Terms<T, N>> FixedModel<T, N, L> {
    /// A model with this transmission and these terms.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if an origin or a gain is not finite.
    pub fn try_new(transmission: Option<Transmission<T>>, terms: L) -> Result<Self, Error> {
        terms.check()?;
        Ok(Self {
            transmission,
            terms,
        })
    }

    /// The transmission, if there is one.
    pub fn transmission(&self) -> Option<&Transmission<T>> {
        self.transmission.as_ref()
    }

    /// The terms.
    pub fn terms(&self) -> &L {
        &self.terms
    }

    /// Converts this model to a [`Model`], for a [`Compensator`](crate::control::Compensator) or a
    /// file.
    pub fn to_model(&self) -> Model<T, N> {
        Model::full(self.transmission, self.terms.any())
    }

    /// Whether the sample is good. A step ignores a bad sample.
    #[inline]
    #[must_use]
    pub fn accepts(&self, at: &Sample<T>) -> bool {
        let motions = self.terms.motions(at);
        motions.is_some_and(|motions| self.is_usable(at, &motions))
    }

    #[inline]
    fn is_usable(&self, at: &Sample<T>, motions: &[&Motion<T>; N]) -> bool {
        // Zero times the data: NaN if one number is not finite.
        let mut nothing = at.dt * T::ZERO + self.terms.nothing(at, motions);
        if self.transmission.is_some() {
            nothing += at.input.position * T::ZERO;
        }
        nothing == T::ZERO && at.dt > T::ZERO
    }

    /// Advances by one sample and returns the predicted output.
    ///
    /// A bad sample leaves the state unchanged and returns the last good output, or 0 before the
    /// first good sample.
    #[inline]
    pub fn step(&self, state: &mut ModelState<T, N>, at: &Sample<T>) -> T {
        self.step_with(state, at, |_, _| {})
    }

    /// Like [`step`](Self::step), but also reports the contribution of each term to the output, as
    /// [`Model::step_with`] does.
    #[inline]
    pub fn step_with(
        &self,
        state: &mut ModelState<T, N>,
        at: &Sample<T>,
        mut share: impl FnMut(usize, T),
    ) -> T {
        let Some(motions) = self.terms.motions(at) else {
            return state.output;
        };
        if !self.is_usable(at, &motions) {
            return state.output;
        }
        state.tick(at.dt);
        let mut sum = Sum {
            at,
            motions,
            time: state.time.value,
            eta: T::zero(),
            output: T::zero(),
        };
        if let Some(transmission) = &self.transmission {
            let moved = self.terms.moved(&mut state.effects, &sum);
            sum.output = transmission.step_finite(&mut state.hysteresis, moved);
            sum.eta = state.hysteresis.eta();
        }
        self.terms.add(&mut state.effects, &mut sum, &mut share);
        self.terms.correct(&mut state.effects, &mut sum, &mut share);
        state.output = sum.output;
        sum.output
    }
}

/// The running sum of the terms at one sample.
#[derive(Debug)]
#[doc(hidden)]
pub struct Sum<'a, 's, T, const N: usize> {
    at: &'a Sample<'s, T>,
    /// The motion of each term's source.
    motions: [&'a Motion<T>; N],
    time: T,
    eta: T,
    output: T,
}

/// The terms of a [`FixedModel`]: a tuple of [`Term`], each with the type of its effect.
///
/// The trait is implemented for tuples of 1 to 16 terms.
pub trait Terms<T, const N: usize>: sealed::Sealed {
    #[doc(hidden)]
    fn check(&self) -> Result<(), Error>;
    #[doc(hidden)]
    fn any(&self) -> [Term<T>; N];
    /// The motion of each term's source, or `None` if a channel is missing.
    #[doc(hidden)]
    fn motions<'a>(&self, at: &'a Sample<T>) -> Option<[&'a Motion<T>; N]>;
    #[doc(hidden)]
    fn nothing(&self, at: &Sample<T>, motions: &[&Motion<T>; N]) -> T;
    /// The input of the transmission, after the input stages.
    #[doc(hidden)]
    fn moved(&self, memories: &mut [EffectState<T>; N], sum: &Sum<T, N>) -> T;
    /// Adds the terms that are not stages, in order. The output is then finite.
    #[doc(hidden)]
    fn add(
        &self,
        memories: &mut [EffectState<T>; N],
        sum: &mut Sum<T, N>,
        share: &mut impl FnMut(usize, T),
    );
    /// Adds the output stages, in order. Each reads the output of the stages before it.
    #[doc(hidden)]
    fn correct(
        &self,
        memories: &mut [EffectState<T>; N],
        sum: &mut Sum<T, N>,
        share: &mut impl FnMut(usize, T),
    );
}

mod sealed {
    pub trait Sealed {}
}

impl<T: Real, E: Regressor<T> + Copy + Into<Effect<T>>> Term<T, E> {
    fn check(&self) -> Result<(), Error> {
        finite(self.origin, "origin")?;
        finite(self.gain, "gain").map(|_| ())
    }

    fn any(&self) -> Term<T> {
        Term {
            effect: self.effect.into(),
            source: self.source,
            origin: self.origin,
            gain: self.gain,
        }
    }

    /// Zero times all data of the sample that the term reads.
    #[inline]
    fn nothing(&self, at: &Sample<T>, motion: &Motion<T>) -> T {
        let read = |sum: T, quantity: &Quantity| {
            sum + T::ZERO
                * match quantity {
                    Quantity::Position => motion.position,
                    Quantity::Velocity => motion.velocity,
                    Quantity::Acceleration => motion.acceleration,
                    Quantity::Input => at.input.position,
                    Quantity::Load => at.load,
                    // The model's own, or checked for all.
                    Quantity::Dt | Quantity::Time | Quantity::Eta | Quantity::Output => T::ZERO,
                }
        };
        E::INFO.reads.iter().fold(T::ZERO, read)
    }

    /// The data of an accepted sample for the effect.
    #[inline]
    fn there<const N: usize>(&self, motion: &Motion<T>, sum: &Sum<T, N>) -> Inputs<T> {
        Inputs {
            dt: sum.at.dt,
            time: sum.time,
            motion: Motion {
                // A difference that overflows is a distant position.
                position: saturate(motion.position - self.origin),
                ..*motion
            },
            input: sum.at.input,
            load: sum.at.load,
            eta: sum.eta,
            output: sum.output,
        }
    }

    /// The contribution of the term, saturated.
    #[inline]
    fn part<const N: usize>(
        &self,
        memory: &mut EffectState<T>,
        motion: &Motion<T>,
        sum: &Sum<T, N>,
    ) -> T {
        let there = self.there(motion, sum);
        saturate(self.effect.contribution(self.gain, memory, &there))
    }
}

/// The output plus gain times value, saturated after each operation. `value` becomes the
/// contribution.
#[cold]
#[inline(never)]
fn saturated_with<T: Real>(output: T, gain: T, value: &mut T) -> T {
    *value = saturated(gain * saturated(*value));
    saturated(saturated(output) + *value)
}

/// [`saturate`] for rare cases. A firmware image contains one copy of this function, not three per
/// term.
#[cold]
#[inline(never)]
fn saturated<T: Real>(value: T) -> T {
    saturate(value)
}

macro_rules! tuple {
    ($n:literal: $($E:ident $i:tt),*) => {
        impl<T, $($E),*> sealed::Sealed for ($(Term<T, $E>,)*) {}

        impl<T: Real, $($E: Regressor<T> + Copy + Into<Effect<T>>),*> Terms<T, $n> for ($(Term<T, $E>,)*) {
            fn check(&self) -> Result<(), Error> {
                $(self.$i.check()?;)*
                Ok(())
            }

            fn any(&self) -> [Term<T>; $n] {
                [$(self.$i.any()),*]
            }

            #[inline]
            fn motions<'a>(&self, at: &'a Sample<T>) -> Option<[&'a Motion<T>; $n]> {
                Some([$(motion(self.$i.source, at)?),*])
            }

            #[inline]
            fn nothing(&self, at: &Sample<T>, motions: &[&Motion<T>; $n]) -> T {
                T::ZERO $(+ self.$i.nothing(at, motions[$i]))*
            }

            #[inline]
            #[allow(non_snake_case)]
            fn moved(&self, [$($E),*]: &mut [EffectState<T>; $n], sum: &Sum<T, $n>) -> T {
                let mut moved = sum.at.input.position;
                $(
                    if $E::INFO.stage == Stage::Input {
                        moved = saturate(moved + self.$i.part($E, sum.motions[$i], sum));
                    }
                )*
                moved
            }

            #[inline]
            #[allow(non_snake_case)]
            fn add(
                &self,
                [$($E),*]: &mut [EffectState<T>; $n],
                sum: &mut Sum<T, $n>,
                share: &mut impl FnMut(usize, T),
            ) {
                let mut values = [T::ZERO; $n];
                let mut output = sum.output;
                $(
                    if $E::INFO.stage == Stage::Sum {
                        let there = self.$i.there(sum.motions[$i], sum);
                        values[$i] = self.$i.effect.value($E, &there);
                        output += self.$i.gain * values[$i];
                    }
                )*
                // One test: a number that is not finite leaves no finite sum.
                if output.is_finite() {
                    sum.output = output;
                    $(
                        if $E::INFO.stage == Stage::Sum {
                            share($i, self.$i.gain * values[$i]);
                        }
                    )*
                } else {
                    rarely();
                    if !($($E::INFO.stage == Stage::Sum)||*) {
                        sum.output = saturated(sum.output);
                    }
                    $(
                        if $E::INFO.stage == Stage::Sum {
                            sum.output = saturated_with(sum.output, self.$i.gain, &mut values[$i]);
                            share($i, values[$i]);
                        }
                    )*
                }
            }

            #[inline]
            #[allow(non_snake_case)]
            fn correct(
                &self,
                [$($E),*]: &mut [EffectState<T>; $n],
                sum: &mut Sum<T, $n>,
                share: &mut impl FnMut(usize, T),
            ) {
                $(
                    if $E::INFO.stage == Stage::Output {
                        let part = self.$i.part($E, sum.motions[$i], sum);
                        sum.output = saturate(sum.output + part);
                        share($i, part);
                    }
                )*
            }
        }
    };
}

tuple!(1: A 0);
tuple!(2: A 0, B 1);
tuple!(3: A 0, B 1, C 2);
tuple!(4: A 0, B 1, C 2, D 3);
tuple!(5: A 0, B 1, C 2, D 3, E 4);
tuple!(6: A 0, B 1, C 2, D 3, E 4, F 5);
tuple!(7: A 0, B 1, C 2, D 3, E 4, F 5, G 6);
tuple!(8: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7);
tuple!(9: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8);
tuple!(10: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9);
tuple!(11: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10);
tuple!(12: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10, L 11);
tuple!(13: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10, L 11, M 12);
tuple!(14: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10, L 11, M 12, N 13);
tuple!(15: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10, L 11, M 12, N 13, O 14);
tuple!(16: A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8, J 9, K 10, L 11, M 12, N 13, O 14, P 15);
