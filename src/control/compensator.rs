//! The identified model turned round: which input gives the output that is wanted.
//!
//! ```text
//! tau_i = inverse transmission(desired − Σ gain·regressor, eta)
//! ```
//!
//! What the bench has identified becomes a feed-forward: of a PI, or beside an adaptive
//! law, so that "identified on the bench" can be compared with "adapted online". The
//! inverse is exact along the path of the hysteresis, equations (5)-(7) turned round; the
//! effects are evaluated at the motions that are given, and subtracted first.
//!
//! The model is the open loop's: it drifts from the plant where the plant is not the
//! model. Feed it with the reference, not with the measured output: a noisy desired
//! output destroys the hysteresis state ([`transmission`](crate::transmission)).

use super::status::{fault_of_dt, unless_finite};
use super::{Fault, Status};
use crate::effect::{Effect, Motion, Situation};
use crate::error::finite;
use crate::hysteresis::BoucWen;
use crate::model::{Model, ModelState, Sample, Source};
use crate::signal::{clamp, Play, PlayState};
use crate::transmission::{Inverse, Mode, Transmission};
use crate::{Error, Real};

mod nearest;

pub use nearest::{Changed, Lowered};

#[cfg(kani)]
#[path = "../../proofs/compensator.rs"]
mod proofs;

/// One sample for a [`Compensator`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompensatorInput<'a, T> {
    /// Since the previous sample \[s\]; above zero.
    pub dt: T,
    /// The output that is wanted \[output unit\], such as tau_o \[N·m\].
    pub desired: T,
    /// The transmission's input with its rates, as it is now, for effects that read it.
    pub input: Motion<T>,
    /// The transmitted load: `tau_i` in torque mode, else a load channel.
    pub load: T,
    /// All other channels, in the order that [`Source::Channel`] counts.
    pub channels: &'a [Motion<T>],
}

impl<T: Real> CompensatorInput<'_, T> {
    /// A sample for a model whose effects read no motion: `dt` \[s\], `desired`.
    #[must_use]
    pub fn new(dt: T, desired: T) -> Self {
        Self {
            dt,
            desired,
            input: Motion::default(),
            load: T::zero(),
            channels: &[],
        }
    }
}

/// What a step of a [`Compensator`] gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CompensatorOutput<T> {
    /// The transmission's input \[input unit\], such as tau_i \[N·m\]; finite.
    pub command: T,
    /// A good sample, or what was wrong; the last good command is held then.
    pub status: Status,
    /// Share of the effects in the output \[output unit\], zero on a bad sample.
    pub effects: T,
    /// The model's hysteresis state, within ±1.
    pub eta: T,
}

/// What the bench has seen of one source: the effects are not asked beyond it.
///
/// ```
/// use bowden::control::{BenchRange, Compensator};
/// use bowden::effect::{Effect, Motion};
/// use bowden::hysteresis::Shape;
/// use bowden::model::{Model, Source, Term};
/// use bowden::transmission::Transmission;
/// # fn main() -> Result<(), bowden::Error> {
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, Shape::try_new(0.09582, 0.6, 3.871)?)?;
/// let (effect, source) = (Effect::DragCubic, Source::Channel(0));
/// let model = Model::<f32, 1>::try_new(Some(cable), &[Term { effect, source, origin: 0.0, gain: -0.1 }])?;
/// let high = Motion { position: 1.5, velocity: 3.0, acceleration: 20.0 };
/// let low = Motion { position: -1.5, velocity: -3.0, acceleration: -20.0 };
/// let compensator = Compensator::try_new(&model)?.with_ranges(&[BenchRange { source, low, high }])?;
/// # let _ = compensator;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BenchRange<T> {
    /// Which motion; of [`Source::Input`] the position is the load's range in torque mode.
    pub source: Source,
    /// Least position, velocity and acceleration.
    pub low: Motion<T>,
    /// Greatest position, velocity and acceleration.
    pub high: Motion<T>,
}

impl<T: Real> BenchRange<T> {
    fn check(&self) -> Result<(), Error> {
        let (low, high) = (self.low, self.high);
        for (low, high) in [
            (low.position, high.position),
            (low.velocity, high.velocity),
            (low.acceleration, high.acceleration),
        ] {
            if finite(low, "low of a range")? > finite(high, "high of a range")? {
                return Err(Error::Inadmissible("low <= high in every range"));
            }
        }
        Ok(())
    }

    fn confine(&self, motion: Motion<T>) -> Motion<T> {
        let (low, high) = (self.low, self.high);
        Motion {
            position: clamp(motion.position, low.position, high.position),
            velocity: clamp(motion.velocity, low.velocity, high.velocity),
            acceleration: clamp(motion.acceleration, low.acceleration, high.acceleration),
        }
    }
}

/// The model as a feed-forward: the input at which it gives the desired output.
///
/// Two choices are made for effects that depend on the answer itself: an effect that
/// reads the transmission's input or the load sees the ones of the sample (the last
/// command, say; that converges while the effect's slope in them is below the cable's
/// gain), and an effect that reads eta sees that of the previous sample. Where no effect
/// does so, the model's output after `command` is `desired`, to rounding.
///
/// ```
/// use bowden::control::{Compensator, CompensatorInput, CompensatorState};
/// use bowden::effect::{Effect, Motion};
/// use bowden::hysteresis::Shape;
/// use bowden::model::{Model, Source, Term};
/// use bowden::transmission::Transmission;
///
/// let shape = Shape::try_new(0.09582, 0.6, 3.871)?;
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?; // [N·m]
/// let (effect, source) = (Effect::Viscous, Source::Channel(0));
/// let friction = Term { effect, source, origin: 0.0, gain: -0.5_f64 };
/// let model = Model::<f64, 1>::try_new(Some(cable), &[friction])?;
///
/// let compensator = Compensator::try_new(&model)?;
/// let mut state = CompensatorState::new();
/// let pulley = [Motion { velocity: 2.0, ..Motion::default() }];
/// let at = CompensatorInput { channels: &pulley, ..CompensatorInput::new(0.001, 10.0) };
/// let out = compensator.step(&mut state, &at);
/// assert_eq!(out.effects, -1.0); // so the cable must transmit 11 N·m
/// assert!(out.command > 11.0);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Compensator<T, const N: usize> {
    transmission: Transmission<T>,
    inverse: Inverse<T>,
    /// The terms alone: a model without a transmission.
    effects: Model<T, N>,
    input_range: Option<BenchRange<T>>,
    term_ranges: [Option<BenchRange<T>>; N],
    longest_dt: T,
    play: Play<T>,
}

impl<T: Real, const N: usize> Compensator<T, N> {
    /// Turns a model round.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the model has no transmission, where that has no
    /// inverse ([`Transmission::inverse`]), where a term is an output stage (delay,
    /// lag): what reads the sum cannot be subtracted from it, or where one is an input
    /// stage (a play in series): its inverse jumps. [`try_nearest`](Self::try_nearest)
    /// takes such a model, and tells what it changed.
    pub fn try_new(model: &Model<T, N>) -> Result<Self, Error> {
        let transmission = *model
            .transmission()
            .ok_or(Error::Inadmissible("the model has a transmission"))?;
        let any = |stage: fn(&Effect<T>) -> bool| {
            let mut terms = model.terms().iter();
            terms.any(|term| stage(&term.effect))
        };
        if any(Effect::is_output_stage) {
            return Err(Error::Inadmissible("no term is an output stage"));
        }
        if any(Effect::is_input_stage) {
            return Err(Error::Inadmissible("no term is an input stage"));
        }
        Self::of(transmission, model.without_transmission())
    }

    /// Of both parts, without ranges, longest `dt` and play.
    fn of(transmission: Transmission<T>, effects: Model<T, N>) -> Result<Self, Error> {
        Ok(Self {
            transmission,
            inverse: transmission.inverse()?,
            effects,
            input_range: None,
            term_ranges: [None; N],
            longest_dt: T::HIGHEST,
            play: Play::NONE,
        })
    }

    /// The same, where a `dt` longer than this one is a bad sample \[s\]; any is good before.
    ///
    /// A counter that wrapped would age every memory of the model (creep, temperature) by
    /// an hour.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt(self, longest_dt: T) -> Result<Self, Error> {
        if finite(longest_dt, "longest_dt")? <= T::ZERO {
            return Err(Error::OutOfRange("longest_dt"));
        }
        Ok(Self { longest_dt, ..self })
    }

    /// The same, where what the cable has to transmit passes through a [`Play`] of this half-width
    /// \[output unit\], zero or more; zero is none.
    ///
    /// After each reversal the inverse is steep, the steeper the larger kappa_eta is within the bound
    /// of [`Transmission::inverse`](crate::transmission::Transmission::inverse), and a model that was
    /// fitted *at* that bound (`bowden close --invertible`) has no greatest steepness. A term that reads
    /// a velocity from an encoder's counts reverses what is to be transmitted from sample to sample, and
    /// the command chatters. A play of a little more than half of what one count makes of output takes
    /// these reversals out, `|gain|·count/(2·time constant)` behind [`Rates`](crate::signal::Rates); the
    /// model's output is then `desired` within the half-width.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"half_width"`.
    pub fn with_play(self, half_width: T) -> Result<Self, Error> {
        let play = Play::try_new(half_width)?;
        Ok(Self { play, ..self })
    }

    /// The same, with motions clamped to what the bench has seen of each source.
    ///
    /// A curve that was fitted on the bench is then never extrapolated. Sources without
    /// a range stay free; of two ranges of one source the later counts.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Inadmissible`] where `low > high` or where no term
    /// reads the channel.
    pub fn with_ranges(mut self, ranges: &[BenchRange<T>]) -> Result<Self, Error> {
        for range in ranges {
            range.check()?;
            let mut is_read = range.source == Source::Input;
            if is_read {
                self.input_range = Some(*range);
            }
            for (term, own) in self.effects.terms().iter().zip(&mut self.term_ranges) {
                if term.source == range.source {
                    *own = Some(*range);
                    is_read = true;
                }
            }
            if !is_read {
                return Err(Error::Inadmissible(
                    "a term reads the source of every range",
                ));
            }
        }
        Ok(self)
    }

    /// The transmission that is inverted.
    #[must_use]
    pub fn transmission(&self) -> &Transmission<T> {
        &self.transmission
    }

    /// One sample: the input that makes the model's output `desired`.
    ///
    /// A bad sample (a `dt` that is not positive or too long, a desired output or a number that a
    /// term reads that is not finite, a missing channel) leaves the state, but for the
    /// count of bad ones, and holds the last good command, zero before the first one.
    pub fn step(
        &self,
        state: &mut CompensatorState<T, N>,
        at: &CompensatorInput<T>,
    ) -> CompensatorOutput<T> {
        let (status, effects) = match self.advance(state, at) {
            Ok(effects) => (Status::Good, effects),
            Err(fault) => {
                state.bad = state.bad.saturating_add(1);
                (Status::Held(fault), T::zero())
            }
        };
        CompensatorOutput {
            command: state.command(),
            status,
            effects,
            eta: state.eta(),
        }
    }

    /// Moves the state by a good sample and returns the share of the effects; or what is wrong, and
    /// nothing has moved.
    fn advance(
        &self,
        state: &mut CompensatorState<T, N>,
        at: &CompensatorInput<T>,
    ) -> Result<T, Fault> {
        let (dt, desired) = (at.dt, at.desired);
        let fault =
            fault_of_dt(dt, self.longest_dt).or_else(|| unless_finite(desired, Fault::Reference));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let (input, load, channels) = (at.input, at.load, at.channels);
        let sample = Sample {
            dt,
            input,
            load,
            channels,
        };
        if let Some(term) = self.effects.first_blind_term(&sample) {
            return Err(Fault::Regressor(u8::try_from(term).unwrap_or(u8::MAX)));
        }
        let confine = |term, there: &mut Situation<T>| self.confine(term, there);
        let memories = &mut state.effects;
        let (before, clock) = (memories.memories(), memories.ticked(dt));
        let now = (clock.value, state.hysteresis.eta());
        let effects = self.effects.effects(memories, &sample, now, confine);
        let wanted = desired - effects;
        let mut play = state.play;
        let target = if wanted.is_finite() {
            self.play.step(&mut play, wanted)
        } else {
            wanted
        };
        // The inverse holds what is out of the reach of floats; here that must be told.
        let cable = &self.transmission;
        let most = target.abs() + cable.offset().abs() + cable.kappa_eta().abs();
        if !(T::of(2.0) * most / cable.gain()).is_finite() {
            state.effects.restore(before);
            return Err(Fault::Overflow);
        }
        state.effects.set_clock(clock);
        self.inverse.step(&mut state.hysteresis, target);
        state.play = play;
        state.bad = 0;
        Ok(effects)
    }

    /// Takes what a term sees into the bench's ranges.
    fn confine(&self, term: usize, there: &mut Situation<T>) {
        if let Some(Some(range)) = self.term_ranges.get(term) {
            there.motion = range.confine(there.motion);
        }
        if let Some(range) = &self.input_range {
            there.input = range.confine(there.input);
            if self.transmission.mode() == Mode::Torque {
                there.load = clamp(there.load, range.low.position, range.high.position);
            }
        }
    }
}

/// State of a [`Compensator`]: the hysteresis, the play and the memories of the effects.
///
/// ```
/// use bowden::control::CompensatorState;
/// let state = CompensatorState::<f32, 2>::new();
/// assert_eq!((state.command(), state.eta(), state.consecutive_bad()), (0.0, 0.0, 0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        deny_unknown_fields,
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CompensatorState<T, const N: usize> {
    hysteresis: BoucWen<T>,
    effects: ModelState<T, N>,
    #[cfg_attr(feature = "serde", serde(default = "PlayState::new"))]
    play: PlayState<T>,
    bad: u32,
}

impl<T: Real, const N: usize> CompensatorState<T, N> {
    /// A state that has seen no sample, with the hysteresis at zero.
    #[must_use]
    pub fn new() -> Self {
        Self::from_hysteresis(BoucWen::new())
    }

    /// The same, with the hysteresis state where the cable's is.
    ///
    /// # Errors
    /// As [`BoucWen::with_eta`], where `eta` is not finite or beyond ±1.
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        BoucWen::with_eta(eta).map(Self::from_hysteresis)
    }

    fn from_hysteresis(hysteresis: BoucWen<T>) -> Self {
        Self {
            hysteresis,
            effects: ModelState::new(),
            play: PlayState::new(),
            bad: 0,
        }
    }

    /// The last good command \[input unit\], zero before the first one.
    #[must_use]
    pub fn command(&self) -> T {
        self.hysteresis.input().unwrap_or_else(T::zero)
    }

    /// The hysteresis state, within ±1.
    #[must_use]
    pub fn eta(&self) -> T {
        self.hysteresis.eta()
    }

    /// How many samples in a row were bad; stays at `u32::MAX`.
    #[must_use]
    pub fn consecutive_bad(&self) -> u32 {
        self.bad
    }
}

impl<T: Real, const N: usize> Default for CompensatorState<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
