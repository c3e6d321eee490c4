//! A model of the output: a transmission plus effects, evaluated sample by sample.
//!
//! ```text
//! u = input + Σ gain·regressor                         (the input stages)
//! y = transmission(u, eta) + Σ gain·regressor          (all terms that are not stages)
//! y ← y + gain·regressor(y)                            (then each output stage, in order)
//! ```
//! Only the transmission reads u. Every effect reads the measured signals.
//!
//! The x of a regressor is the position minus the origin of the term (see [`Term`]).
//!
//! A [`Model`] has a capacity of `N` terms, uses no heap, and is separate from its state. Its
//! transmission and its terms are optional.
//!
//! A sample is bad if
//! - `dt` is not positive and finite,
//! - a channel that the model reads is missing, or
//! - a number that the model reads is not finite.
//!
//! A bad sample leaves the state unchanged, and the step returns the last good output.

mod curve;
#[cfg(feature = "serde")]
mod file;
mod fixed;
mod state;

use crate::effect::{saturate, Effect, Inputs, Motion, Offset, Stage};
use crate::error::finite;
use crate::transmission::Transmission;
use crate::{Error, Real};
pub use fixed::{FixedModel, Terms};
pub use state::ModelState;

crate::data! {
    /// The motion that an effect reads.
    #[derive(Eq, Hash)]
    pub enum Source {
        /// The transmission's input.
        Input,
        /// One of the sample's channels. The first channel has index 0.
        Channel(u8),
    }
}

/// One effect of a model, with its gain and its origin.
///
/// # Origin
/// The effect reads the position minus the origin, and the unchanged velocity and acceleration. The
/// zero of a sensor is arbitrary. However, an effect such as `x·|x|` or `x·tanh(v/v_e)` depends on
/// the distance from a specific position. A gain is therefore valid only with its origin. Shape
/// parameters that are positions, such as `x_h`, are relative to the origin. The origin does not
/// shift the transmission's input, which `degradation` reads in addition to its source.
///
/// ```
/// use bowden::effect::{Motion, StiffnessProgressive};
/// use bowden::model::{Model, ModelState, Sample, Source, Term};
///
/// let effect = StiffnessProgressive.into(); // x·|x|
/// let spring = Term { effect, source: Source::Input, origin: 5.0, gain: 2.0 };
/// let model = Model::<f64, 1>::try_new(None, &[spring])?;
/// let input = Motion { position: 2.0, velocity: 0.0, acceleration: 0.0 };
/// let sample = Sample { dt: 0.001, input, load: 0.0, channels: &[] };
/// assert_eq!(model.step(&mut ModelState::new(), &sample), -18.0); // 2·(−3)·|−3|
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "T: Real + serde::Deserialize<'de>, E: serde::Deserialize<'de>"))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Term<T, E = Effect<T>> {
    /// The effect: an [`Effect`], or the type of one effect (see [`FixedModel`]).
    pub effect: E,
    /// The motion that the effect reads.
    pub source: Source,
    /// Origin of the position that the effect reads \[channel unit\] (default in a file: 0).
    #[cfg_attr(feature = "serde", serde(default))]
    pub origin: T,
    /// Gain of the regressor \[output unit / unit of the regressor\].
    pub gain: T,
}

/// One sample of the signals that a model reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<'a, T> {
    /// Time since the previous sample \[s\]: positive, including at the first sample.
    pub dt: T,
    /// The transmission's input (x or `tau_i`), with its velocity and acceleration.
    pub input: Motion<T>,
    /// The transmitted load: `tau_i` in torque mode, otherwise a load channel.
    pub load: T,
    /// All other channels. [`Source::Channel`] contains the index of a channel in this slice.
    pub channels: &'a [Motion<T>],
}

/// A transmission plus at most `N` effects.
///
/// # Formats (feature `serde`)
/// In a human-readable format (TOML, JSON), a model has the schema `bowden.model/1`, which
/// `bowden identify --model-out model.toml` also writes. Reading and writing use no heap. The names
/// of the channels take 2 KB of stack. The source of a term is `input` or one of `channels`, which
/// have the order of [`Sample::channels`]. The `about` table may contain any keys. Elsewhere, an
/// unknown key is an error. A model does not store the names of its channels. It writes them as
/// `channel_0`, `channel_1` and so on.
///
/// Any other format, such as postcard, stores the values in order, without names. Eight terms with
/// eight shape parameters take 143 bytes in `f32`. The bytes contain neither the float type nor a
/// version, and identify an effect by its index in [`CATALOGUE`](crate::effect::CATALOGUE). Store
/// the bytes with a checksum (`to_slice_crc32` of postcard), and write them again after you update
/// this crate.
///
/// ```
/// # #[cfg(feature = "serde")] {
/// use bowden::model::Model;
/// let file = r#"
///     schema = "bowden.model/1"
///     mode = "displacement"
///     channels = ["temperature", "phi"]
///     terms = [{ effect = "coulomb", source = "phi", gain = -0.4, shapes = [{ name = "v_e", value = 0.1 }] }]
/// "#;
/// let model: Model<f32, 4> = toml::from_str(file)?;
/// assert_eq!(model.terms()[0].gain, -0.4);
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// ```
/// use bowden::effect::{Motion, Viscous};
/// use bowden::model::{Model, ModelState, Sample, Source, Term};
///
/// let (effect, source) = (Viscous.into(), Source::Input);
/// let viscous = Term { effect, source, origin: 0.0, gain: 3.0_f32 };
/// let model = Model::<f32, 4>::try_new(None, &[viscous])?;
/// let mut state = ModelState::new();
///
/// let input = Motion { position: 0.0, velocity: 2.0, acceleration: 0.0 };
/// let mut sample = Sample { dt: 0.001, input, load: 0.0, channels: &[] };
/// assert_eq!(model.step(&mut state, &sample), 6.0);
///
/// sample.input.velocity = f32::NAN; // a bad sample: the last good output is held
/// assert_eq!(model.step(&mut state, &sample), 6.0);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Model<T, const N: usize> {
    transmission: Option<Transmission<T>>,
    /// Only the first `len` terms are used. The others are the default.
    terms: [Term<T>; N],
    len: usize,
    stages: Stages,
}

/// Whether the terms include input or output stages, so a step need not search for them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Stages {
    input: bool,
    output: bool,
}

impl Stages {
    fn of<T: Real>(terms: &[Term<T>]) -> Self {
        let has = |stage| terms.iter().any(|term| term.effect.stage() == stage);
        Self {
            input: has(Stage::Input),
            output: has(Stage::Output),
        }
    }
}

impl<T: Real> Default for Term<T> {
    /// A term that adds nothing.
    fn default() -> Self {
        Self {
            effect: Offset.into(),
            source: Source::Input,
            origin: T::zero(),
            gain: T::zero(),
        }
    }
}

impl<T: Real, const N: usize> Model<T, N> {
    /// A model with this transmission and these terms.
    ///
    /// # Errors
    /// [`Error::Capacity`] if there are more than `N` terms; [`Error::NonFinite`] if an origin or a
    /// gain is not finite.
    pub fn try_new(
        transmission: Option<Transmission<T>>,
        terms: &[Term<T>],
    ) -> Result<Self, Error> {
        let mut own = [Term::default(); N];
        let places = own.get_mut(..terms.len());
        places
            .ok_or(Error::Capacity("terms"))?
            .copy_from_slice(terms);
        for term in terms {
            finite(term.origin, "origin")?;
            finite(term.gain, "gain")?;
        }
        Ok(Self {
            transmission,
            terms: own,
            len: terms.len(),
            stages: Stages::of(terms),
        })
    }

    /// A model with `N` checked terms.
    fn full(transmission: Option<Transmission<T>>, terms: [Term<T>; N]) -> Self {
        Self {
            transmission,
            terms,
            len: N,
            stages: Stages::of(&terms),
        }
    }

    /// The transmission, if there is one.
    pub fn transmission(&self) -> Option<&Transmission<T>> {
        self.transmission.as_ref()
    }

    /// The terms, in order.
    pub fn terms(&self) -> &[Term<T>] {
        self.terms.get(..self.len).unwrap_or(&self.terms)
    }

    /// The model without its transmission.
    pub(crate) fn without_transmission(&self) -> Self {
        Self {
            transmission: None,
            ..*self
        }
    }

    /// The terms without the selected terms and without the transmission. The other terms keep
    /// their indices.
    pub(crate) fn without_terms(&self, is_left_out: impl Fn(&Term<T>) -> bool) -> Self {
        let mut kept = self.without_transmission();
        for term in &mut kept.terms {
            if is_left_out(term) {
                *term = Term::default();
            }
        }
        kept.stages = Stages::of(kept.terms());
        kept
    }

    /// Whether the sample is good. A step ignores a bad sample.
    #[must_use]
    pub fn accepts(&self, at: &Sample<T>) -> bool {
        let input_is_read = self.transmission.is_some();
        at.dt.is_finite()
            && at.dt > T::zero()
            && (!input_is_read || at.input.position.is_finite())
            && (self.sees_all(at, |source| motion(source, at).is_some_and(is_finite))
                || self.sees_enough(at))
    }

    /// The first term that cannot read its source from this sample.
    #[inline(always)]
    pub(crate) fn first_blind_term(&self, at: &Sample<T>) -> Option<usize> {
        let sees = |source| motion_of(source, at).is_some_and(|motion| is_finite(&motion));
        if self.sees_all(at, sees) {
            None
        } else {
            self.search_blind_term(at)
        }
    }

    #[inline(always)]
    fn search_blind_term(&self, at: &Sample<T>) -> Option<usize> {
        let mut there = around(at, T::ZERO, T::ZERO);
        self.terms().iter().position(|term| {
            !motion_of(term.source, at).is_some_and(|motion| {
                there.motion = counted_from(term.origin, motion);
                there.is_usable(term.effect.reads())
            })
        })
    }

    /// Whether every number that a term may read is finite. A usual sample passes this test, and
    /// then needs no test per effect.
    #[inline]
    fn sees_all(&self, at: &Sample<T>, sees_source: impl Fn(Source) -> bool) -> bool {
        let mut sees = at.dt.is_finite() && at.dt >= T::ZERO && at.load.is_finite();
        sees &= is_finite(&at.input);
        for term in self.terms() {
            sees &= sees_source(term.source);
        }
        sees
    }

    /// Whether the numbers that the terms actually read are finite.
    #[cold]
    #[inline(never)]
    fn sees_enough(&self, at: &Sample<T>) -> bool {
        self.search_blind_term(at).is_none()
    }

    /// Advances the memories of the effects by one good sample, for models without stages, and
    /// returns the sum of the contributions. The clock does not change.
    ///
    /// The caller sets `time` and `eta`. `own` changes the data of the sample that a term reads:
    /// its motion, the input and the load.
    pub(crate) fn effects(
        &self,
        state: &mut ModelState<T, N>,
        at: &Sample<T>,
        (time, eta): (T, T),
        own: impl Fn(usize, &mut Inputs<T>),
    ) -> T {
        let mut sum = T::ZERO;
        for (index, (term, memory)) in self.terms().iter().zip(&mut state.effects).enumerate() {
            // The origin is subtracted after `own`.
            if let Some(motion) = motion_of(term.source, at) {
                let mut there = around(at, time, eta);
                there.motion = motion;
                own(index, &mut there);
                there.motion.position = saturate(there.motion.position - term.origin);
                sum += saturate(term.gain * term.effect.regressor(memory, &there));
            }
        }
        sum
    }

    /// Advances by one sample and returns the predicted output.
    ///
    /// A bad sample (see [`Model::accepts`]) leaves the state unchanged and returns the last good
    /// output, or 0 before the first good sample.
    pub fn step(&self, state: &mut ModelState<T, N>, at: &Sample<T>) -> T {
        self.step_with(state, at, |_, _| {})
    }

    /// Like [`step`](Self::step), but also reports the contribution of each term to the output.
    ///
    /// The function calls `share(index, contribution)` once per term, with the output stages last.
    /// There is no call for an input stage, and none on a bad sample. The output minus the sum of
    /// these contributions is the contribution of the transmission, which includes the input
    /// stages.
    ///
    /// ```
    /// use bowden::effect::{Inertia, Motion, Viscous};
    /// use bowden::model::{Model, ModelState, Sample, Source, Term};
    ///
    /// let term = |effect, gain| Term { effect, source: Source::Input, origin: 0.0, gain };
    /// let terms = [term(Viscous.into(), 3.0), term(Inertia.into(), 0.5)];
    /// let model = Model::<f64, 2>::try_new(None, &terms)?;
    ///
    /// let input = Motion { position: 0.0, velocity: 2.0, acceleration: 4.0 };
    /// let sample = Sample { dt: 0.001, input, load: 0.0, channels: &[] };
    /// let mut shares = [0.0; 2];
    /// let output = model.step_with(&mut ModelState::new(), &sample, |term, share| {
    ///     shares[term] = share;
    /// });
    /// assert_eq!((output, shares), (8.0, [6.0, 2.0]));
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn step_with(
        &self,
        state: &mut ModelState<T, N>,
        at: &Sample<T>,
        mut share: impl FnMut(usize, T),
    ) -> T {
        if !self.accepts(at) {
            return state.output;
        }
        state.tick(at.dt);
        let (mut output, eta) = self.transmitted(state, at);
        let mut there = around(at, state.time.value, eta);
        let mut stage = Stage::Sum;
        loop {
            let places = self.terms().iter().zip(&mut state.effects).enumerate();
            for (index, (term, memory)) in places {
                if term.effect.stage() != stage {
                    continue;
                }
                let Some(motion) = seen(term.source, term.origin, at) else {
                    continue;
                };
                (there.motion, there.output) = (motion, output);
                let part = term.effect.contribution(term.gain, memory, &there);
                output = saturate(output + part);
                share(index, part);
            }
            if stage == Stage::Output || !self.stages.output {
                break;
            }
            stage = Stage::Output;
        }
        state.output = output;
        output
    }

    /// The output of the transmission for the input, and its hysteresis state.
    ///
    /// This function is not inlined, because its stack must not add to the stack of the effects.
    #[inline(never)]
    fn transmitted(&self, state: &mut ModelState<T, N>, at: &Sample<T>) -> (T, T) {
        let Some(transmission) = &self.transmission else {
            return (T::zero(), T::zero());
        };
        let moved = if self.stages.input {
            self.staged_input(state, at)
        } else {
            at.input.position
        };
        let force = transmission.step(&mut state.hysteresis, moved);
        (saturate(force), state.hysteresis.eta())
    }

    /// The input of the transmission, after the input stages.
    fn staged_input(&self, state: &mut ModelState<T, N>, at: &Sample<T>) -> T {
        let mut there = around(at, state.time.value, T::ZERO);
        let places = self.terms().iter().zip(&mut state.effects);
        let stages = places.filter(|(term, _)| term.effect.is_input_stage());
        stages.fold(at.input.position, |moved, (term, memory)| {
            let Some(motion) = seen(term.source, term.origin, at) else {
                return moved;
            };
            there.motion = motion;
            saturate(moved + term.gain * term.effect.regressor(memory, &there))
        })
    }
}

/// The motion of a source, or `None` if its channel is missing.
#[inline]
fn motion<'a, T>(source: Source, at: &'a Sample<T>) -> Option<&'a Motion<T>> {
    match source {
        Source::Input => Some(&at.input),
        Source::Channel(index) => at.channels.get(usize::from(index)),
    }
}

/// The same as [`motion`], but by value, so a sample that the caller builds need not be in memory.
#[inline]
fn motion_of<T: Real>(source: Source, at: &Sample<T>) -> Option<Motion<T>> {
    match source {
        Source::Input => Some(at.input),
        Source::Channel(index) => at.channels.get(usize::from(index)).copied(),
    }
}

/// Whether each number of a motion is finite.
#[inline]
fn is_finite<T: Real>(motion: &Motion<T>) -> bool {
    motion.position.is_finite() && motion.velocity.is_finite() && motion.acceleration.is_finite()
}

/// The data of one term's source in the sample, or `None` if its channel is missing.
#[inline]
fn seen<T: Real>(source: Source, origin: T, at: &Sample<T>) -> Option<Motion<T>> {
    Some(counted_from(origin, *motion(source, at)?))
}

/// The same motion, with its position relative to the origin.
#[inline]
fn counted_from<T: Real>(origin: T, mut motion: Motion<T>) -> Motion<T> {
    // A difference that overflows is a distant position; a bad position stays bad.
    if motion.position.is_finite() {
        motion.position = saturate(motion.position - origin);
    }
    motion
}

/// The data of the sample for all terms. Each term replaces the motion.
#[inline]
fn around<T: Real>(at: &Sample<T>, time: T, eta: T) -> Inputs<T> {
    Inputs {
        dt: at.dt,
        time,
        motion: at.input,
        input: at.input,
        load: at.load,
        eta,
        output: T::ZERO,
    }
}
