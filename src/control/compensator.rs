//! Inverse of the identified model as a feed-forward.
//!
//! ```text
//! tau_i = inverse transmission(desired − Σ gain·regressor, eta)
//! ```
//!
//! The feed-forward supplements a PI or an adaptive law. A step evaluates the effects at the given
//! motions and subtracts them from the desired output. It then computes the input for which the
//! transmission gives the remaining output.
//!
//! Use the reference as the desired output, not the measured output. Measurement noise would
//! corrupt the hysteresis state (see [`transmission`](crate::transmission)).

use super::{Fault, Status};
use crate::effect::{Effect, Inputs, Motion};
use crate::error::finite;
use crate::fault::{fault_of_dt, unless_finite};
use crate::hysteresis::BoucWenState;
use crate::model::{Model, ModelState, Sample, Source};
use crate::signal::{clamp, Play, PlayState};
use crate::transmission::{Inverse, Mode, Transmission};
use crate::{Error, Real};

mod applied;
mod nearest;

pub use nearest::Changed;

#[cfg(kani)]
#[path = "../../proofs/compensator.rs"]
mod proofs;

/// One sample for a [`Compensator`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompensatorInput<'a, T> {
    /// Time since the previous sample \[s\], positive.
    pub dt: T,
    /// Desired output \[output unit\], such as tau_o \[N·m\].
    pub desired: T,
    /// The present input of the transmission, with its derivatives; only some effects read it.
    pub input: Motion<T>,
    /// The transmitted load: `tau_i` in torque mode, otherwise a load channel.
    pub load: T,
    /// All other channels, in the order of the indices in [`Source::Channel`].
    pub channels: &'a [Motion<T>],
}

impl<T: Real> CompensatorInput<'_, T> {
    /// A sample for a model whose effects read neither motion nor load, from `dt` \[s\] and
    /// `desired`.
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

crate::data! {
    /// Output of a step of a [`Compensator`].
    pub struct CompensatorOutput<T> {
        /// Input of the transmission \[input unit\], such as tau_i \[N·m\]; finite.
        pub command: T,
        /// Status of the sample; a bad sample holds the last good command.
        pub status: Status,
        /// Contribution of the effects to the output \[output unit\]; zero for a bad sample.
        pub effects: T,
    }

    /// Range of one source in the bench record. The compensator clamps the motion of the source to
    /// this range, so the effects do not extrapolate.
    ///
    /// ```
    /// use bowden::control::{BenchRange, Compensator};
    /// use bowden::effect::{DragCubic, Motion};
    /// use bowden::hysteresis::BoucWen;
    /// use bowden::model::{Model, Source, Term};
    /// use bowden::transmission::Transmission;
    /// # fn main() -> Result<(), bowden::Error> {
    /// let cable = Transmission::torque(0.9978, 7.004, 0.05174, BoucWen::try_new(0.09582, 0.6, 3.871)?)?;
    /// let (effect, source) = (DragCubic.into(), Source::Channel(0));
    /// let model = Model::<f32, 1>::try_new(Some(cable), &[Term { effect, source, origin: 0.0, gain: -0.1 }])?;
    /// let high = Motion { position: 1.5, velocity: 3.0, acceleration: 20.0 };
    /// let low = Motion { position: -1.5, velocity: -3.0, acceleration: -20.0 };
    /// let compensator = Compensator::try_new(&model)?.with_ranges(&[BenchRange { source, low, high }])?;
    /// # let _ = compensator;
    /// # Ok(())
    /// # }
    /// ```
    pub struct BenchRange<T> {
        /// The source. For [`Source::Input`] in torque mode, the position range also applies to the
        /// load.
        pub source: Source,
        /// Minimum of position, velocity and acceleration.
        pub low: Motion<T>,
        /// Maximum of position, velocity and acceleration.
        pub high: Motion<T>,
    }
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

    fn clamp(&self, motion: Motion<T>) -> Motion<T> {
        let (low, high) = (self.low, self.high);
        Motion {
            position: clamp(motion.position, low.position, high.position),
            velocity: clamp(motion.velocity, low.velocity, high.velocity),
            acceleration: clamp(motion.acceleration, low.acceleration, high.acceleration),
        }
    }
}

/// The inverse of a model as a feed-forward.
///
/// A step computes the input for which the model produces the desired output.
///
/// Two rules apply to effects that depend on the result:
/// - An effect that reads the transmission's input or the load uses the values in the sample, for
///   example the last command. Each sample is then one step of an iteration. The iteration
///   converges if the slope of the effect with respect to these values is smaller in magnitude than
///   the smallest slope of the transmission. With friction, the smallest slope of the transmission
///   is below the gain of the cable.
/// - An effect that reads eta uses eta of the previous sample.
///
/// Without such effects, `command` makes the output of the model equal to `desired`, up to rounding
/// errors. A play or a clamped motion adds an error.
///
/// ```
/// use bowden::control::{Compensator, CompensatorInput, CompensatorState};
/// use bowden::effect::{Motion, Viscous};
/// use bowden::hysteresis::BoucWen;
/// use bowden::model::{Model, Source, Term};
/// use bowden::transmission::Transmission;
///
/// let shape = BoucWen::try_new(0.09582, 0.6, 3.871)?;
/// let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?; // [N·m]
/// let (effect, source) = (Viscous.into(), Source::Channel(0));
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
    /// The terms as a model without a transmission.
    effects: Model<T, N>,
    input_range: Option<BenchRange<T>>,
    term_ranges: [Option<BenchRange<T>>; N],
    longest_dt: T,
    play: Play<T>,
}

impl<T: Real, const N: usize> Compensator<T, N> {
    /// Inverts a model.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] in these cases:
    /// - the model has no transmission;
    /// - the transmission has no inverse ([`Transmission::inverse`]);
    /// - a term is an output stage (delay, lag), which reads the sum and cannot be subtracted from
    ///   it; or
    /// - a term is an input stage (a play in series), whose inverse jumps.
    ///
    /// In the last three cases, [`try_nearest`](Self::try_nearest) changes the model so that it has
    /// an inverse, and returns the changes. `try_nearest` also returns an error if the gain is
    /// zero.
    pub fn try_new(model: &Model<T, N>) -> Result<Self, Error> {
        let transmission = *model
            .transmission()
            .ok_or(Error::Inadmissible("the model must have a transmission"))?;
        let any = |stage: fn(&Effect<T>) -> bool| {
            let mut terms = model.terms().iter();
            terms.any(|term| stage(&term.effect))
        };
        if any(Effect::is_output_stage) {
            return Err(Error::Inadmissible("no term may be an output stage"));
        }
        if any(Effect::is_input_stage) {
            return Err(Error::Inadmissible("no term may be an input stage"));
        }
        Self::of(transmission, model.without_transmission())
    }

    /// A compensator from both parts, without ranges, longest `dt` and play.
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

    /// Sets the longest `dt` \[s\], which must be positive (default: no limit).
    ///
    /// A longer `dt` is a bad sample. Without a limit, a timer that wraps can advance an effect
    /// such as creep by about an hour.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt(self, longest_dt: T) -> Result<Self, Error> {
        if finite(longest_dt, "longest_dt")? <= T::ZERO {
            return Err(Error::OutOfRange("longest_dt"));
        }
        Ok(Self { longest_dt, ..self })
    }

    /// Adds a [`Play`] to the desired output of the cable. The half-width \[output unit\] must not
    /// be negative; zero means no play.
    ///
    /// After each reversal, the inverse is steep. Its slope increases as sigma approaches the bound
    /// of [`Transmission::inverse`](crate::transmission::Transmission::inverse). For a model that
    /// was fitted *at* this bound (`bowden identify --invertible`), the slope is unbounded.
    ///
    /// A term that reads a velocity from encoder counts reverses the desired output from sample to
    /// sample, so the command chatters. A play removes these reversals. Choose a half-width
    /// slightly above half the effect of one count on the output. With velocities from
    /// [`Rates`](crate::signal::Rates), half the effect is `|gain|·count/(2·time constant)`. The
    /// output of the model then equals `desired` to within the half-width.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"half_width"`.
    pub fn with_play(self, half_width: T) -> Result<Self, Error> {
        let play = Play::try_new(half_width)?;
        Ok(Self { play, ..self })
    }

    /// Clamps the motion of each source to its bench range.
    ///
    /// Sources without a range are not clamped. If a source has two ranges, the last one applies.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if a range is not finite; [`Error::Inadmissible`] if `low > high`, or
    /// if no term reads the source. A range of [`Source::Input`] is valid even if no term reads the
    /// input.
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
                    "a term must read the source of every range",
                ));
            }
        }
        Ok(self)
    }

    /// The inverted transmission.
    pub fn transmission(&self) -> &Transmission<T> {
        &self.transmission
    }

    /// Processes one sample and returns the input for which the model's output is `desired`.
    ///
    /// A bad sample holds the last good command, and leaves the state unchanged except for the
    /// count of bad samples. The command is zero before the first good sample. A sample is bad if
    /// - `dt` is not positive or too long,
    /// - the desired output or a number that a term reads is not finite,
    /// - a channel that a term reads is missing, or
    /// - the command overflows.
    pub fn step(
        &self,
        state: &mut CompensatorState<T, N>,
        at: &CompensatorInput<T>,
    ) -> CompensatorOutput<T> {
        let (status, effects) = match self.advance(state, at) {
            Ok(effects) => (Status::Good, effects),
            Err(fault) => {
                state.bad = state.bad.saturating_add(1);
                state.before = state.hysteresis;
                (Status::Held(fault), T::zero())
            }
        };
        CompensatorOutput {
            command: state.command(),
            status,
            effects,
        }
    }

    /// Advances the state by a good sample and returns the contribution of the effects. For a bad
    /// sample, returns the fault and leaves the state unchanged.
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
            return Err(Fault::of_regressor(term));
        }
        let clamp = |term, there: &mut Inputs<T>| self.clamp(term, there);
        let memories = &mut state.effects;
        let (before, clock) = (memories.effects, memories.ticked(dt));
        let now = (clock.value, state.hysteresis.eta());
        let effects = self.effects.effects(memories, &sample, now, clamp);
        let wanted = desired - effects;
        let mut play = state.play;
        let target = if wanted.is_finite() {
            self.play.step(&mut play, wanted)
        } else {
            wanted
        };
        // The inverse holds a value beyond the range of floats; this case is reported here.
        let cable = &self.transmission;
        let most = target.abs() + cable.offset().abs() + cable.kappa_eta().abs();
        if !(T::from_f64(2.0) * most / cable.gain()).is_finite() {
            state.effects.effects = before;
            return Err(Fault::Overflow);
        }
        state.effects.set_clock(clock);
        state.before = state.hysteresis;
        self.inverse.step(&mut state.hysteresis, target);
        state.play = play;
        state.bad = 0;
        Ok(effects)
    }

    /// Clamps the inputs of a term to the bench ranges.
    fn clamp(&self, term: usize, there: &mut Inputs<T>) {
        if let Some(Some(range)) = self.term_ranges.get(term) {
            there.motion = range.clamp(there.motion);
        }
        if let Some(range) = &self.input_range {
            there.input = range.clamp(there.input);
            if self.transmission.mode() == Mode::Torque {
                there.load = clamp(there.load, range.low.position, range.high.position);
            }
        }
    }
}

crate::checked::stored! {
    /// State of a [`Compensator`]: the hysteresis, the play and the states of the effects.
    ///
    /// ```
    /// use bowden::control::CompensatorState;
    /// let state = CompensatorState::<f32, 2>::new();
    /// assert_eq!((state.command(), state.eta(), state.consecutive_bad()), (0.0, 0.0, 0));
    /// ```
    pub struct CompensatorState<T, const N: usize> {
        hysteresis: BoucWenState<T>,
        /// The hysteresis before the last sample.
        before: BoucWenState<T>,
        effects: ModelState<T, N>,
        #[serde(default = "PlayState::new")]
        play: PlayState<T>,
        bad: u32,
    }
    => {
        Ok(Self { hysteresis, before, effects, play, bad })
    }
}

impl<T: Real, const N: usize> CompensatorState<T, N> {
    /// Initial state with the hysteresis at zero.
    pub fn new() -> Self {
        Self::from_hysteresis(BoucWenState::new())
    }

    /// Initial state with the hysteresis state `eta` of the cable.
    ///
    /// # Errors
    /// The errors of [`BoucWenState::with_eta`]: `eta` is not finite or lies outside −1 to 1.
    pub fn with_eta(eta: T) -> Result<Self, Error> {
        BoucWenState::with_eta(eta).map(Self::from_hysteresis)
    }

    fn from_hysteresis(hysteresis: BoucWenState<T>) -> Self {
        Self {
            hysteresis,
            before: hysteresis,
            effects: ModelState::new(),
            play: PlayState::new(),
            bad: 0,
        }
    }

    /// The last good command, or the input that was then reported to
    /// [`applied`](Compensator::applied) \[input unit\]. Zero before the first good sample.
    pub fn command(&self) -> T {
        self.hysteresis.input().unwrap_or_else(T::zero)
    }

    /// The hysteresis state, within ±1.
    pub fn eta(&self) -> T {
        self.hysteresis.eta()
    }

    /// Number of consecutive bad samples; saturates at `u32::MAX`.
    pub fn consecutive_bad(&self) -> u32 {
        self.bad
    }
}

impl<T: Real, const N: usize> Default for CompensatorState<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
