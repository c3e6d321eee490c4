//! Velocity and acceleration from position samples, causally.

use super::Motion;
use crate::error::finite;
use crate::{Error, Real};

/// A gap of more than this many time constants starts again, by default.
const LONGEST_GAP: f64 = 10.0;

/// Time constants after which rates that started at zero count as settled.
const SETTLING: f64 = 5.0;

/// Where the lag of [`Rates::for_cutoff`] stands above the cut-off of the fit.
const ABOVE_CUTOFF: f64 = 2.5;

/// Position samples in, [`Motion`] out: velocity, acceleration, gaps, wrap-around.
///
/// ```text
/// s  = 1 − e^(−h/tau),  h = time since the last good sample
/// v⁺ = v + s·((x − x_last)/h − v)
/// a⁺ = a + s·((v⁺ − v)/h − a)
/// ```
/// Two [`Derivative`](super::Derivative)s in cascade with one time constant tau. Well
/// below the sample rate `V/X = s/(tau·s + 1)` and `A/X = s²/(tau·s + 1)²`: the position is
/// not delayed, the velocity by tau, the acceleration by 2·tau. At `f` \[Hz\] with
/// `w = 2π·f·tau` the velocity has the gain `1/√(1 + w²)` and the phase lag `atan(w)`, the
/// acceleration the square of the one and twice the other. At any rate, with
/// `q = e^(−h/tau)`, `V/X = (1 − q)/(1 − q·z⁻¹)·(1 − z⁻¹)/h`: a ramp gives its exact slope,
/// and the delay at low frequencies is `h·(1/2 + q/(1 − q))`, tau to `h²/(12·tau)`.
///
/// White noise of standard deviation `s_x` on the position gives about `s_x/tau` on the velocity
/// and `s_x/tau²` on the acceleration, both less where tau is not far above h.
///
/// * **First sample**: the rates start at zero, no kick. An axis that moves already
///   reaches its velocity V as `V·(1 − e^(−t/tau))`, with an acceleration pulse of
///   `V/(e·tau)` on the way; the status is [`RatesStatus::Settling`] for five time
///   constants.
/// * **Bad samples** (a position that is not finite, a `dt` that is not positive and
///   finite): the last good motion is held, the status says why.
/// * **Gaps**: the difference spans the time since the last good sample, missing and bad
///   samples included. After more than [`longest_gap`](Self::longest_gap) the rates start
///   again at zero. Where the time is unknown, because a `dt` was negative or not finite,
///   the next good sample only says where the axis is, and the rates are held.
/// * **Wrap-around** of a counter: [`with_period`](Self::with_period).
/// * **Long runs**: a position in `f32` has a spacing of up to `2⁻²³·|x|`, which rates see as
///   noise: at 1000 rad 6e-5 rad, so with tau = 10 ms up to 0.006 rad/s and 0.6 rad/s². Give
///   an axis that turns on and on modulo its period: then the differences are those of
///   small numbers, an integer counts the turns, and only the returned position is rounded.
///
/// ```
/// use bowden::signal::{Rates, RatesState, RatesStatus};
/// # fn main() -> Result<(), bowden::Error> {
/// // An encoder of 4096 counts a turn on a 12-bit counter; the fit's cut-off was 5 Hz.
/// let rates = Rates::for_cutoff(5.0_f32)?.with_period(4096.0)?;
/// let mut state = RatesState::new();
/// for k in 0..2000_u32 {
///     let counter = (4000 + 3 * k) % 4096; // 3 counts a millisecond
///     rates.step(&mut state, counter as f32, 0.001);
/// }
/// let out = rates.step(&mut state, ((4000 + 3 * 2000) % 4096) as f32, 0.001);
/// assert_eq!((out.status, out.motion.position), (RatesStatus::Good, 10_000.0));
/// assert!((out.motion.velocity - 3000.0).abs() < 0.01); // [counts/s]
/// # Ok(())
/// # }
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
pub struct Rates<T> {
    time_constant: T,
    longest_gap: T,
    period: Option<T>,
}

/// Why [`Rates`] could not use a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RatesFault {
    /// The position is not finite.
    Position,
    /// `dt` is not finite.
    Dt,
    /// `dt` is zero or negative: time has not moved on.
    DtNotPositive,
    /// All is finite, but a rate or the unwrapped position would not be.
    Overflow,
}

/// How far the motion of a [`RatesOutput`] can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RatesStatus {
    /// A good sample, and the rates have settled.
    Good,
    /// A good sample, but the rates have started from zero less than five time constants
    /// ago.
    Settling,
    /// A good position after a time that is unknown: the rates are held.
    Resumed,
    /// A bad sample: the last good motion is held.
    Held(RatesFault),
}

/// What a step of [`Rates`] gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RatesOutput<T> {
    /// Position (unwrapped), velocity and acceleration; finite. Zero before the first
    /// good sample.
    pub motion: Motion<T>,
    /// Whether the motion is new, and its rates have settled.
    pub status: RatesStatus,
}

/// State of [`Rates`]: the last good sample, the rates, and the time since.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RatesState<T> {
    /// The last good position as it came, not unwrapped.
    last: Option<T>,
    /// Periods between that and the position of `motion`.
    turns: i32,
    motion: Motion<T>,
    /// Time of the bad samples since the last good one.
    gap: T,
    /// Whether an unknown time has passed since the last good sample.
    time_unknown: bool,
    /// Time since the rates started at zero; stands still once they have settled.
    age: T,
}

impl<T: Real> Rates<T> {
    /// Rates with `time_constant > 0` \[s\].
    ///
    /// The longest gap is ten time constants. A loop whose sample time is longer than that
    /// needs [`with_longest_gap`](Self::with_longest_gap): each of its samples would start
    /// again.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`.
    pub fn try_new(time_constant: T) -> Result<Self, Error> {
        let longest_gap = T::of(LONGEST_GAP) * positive(time_constant, "time_constant")?;
        Ok(Self {
            time_constant,
            longest_gap: finite(longest_gap, "time_constant")?,
            period: None,
        })
    }

    /// Rates for a model that was fitted with the cut-off `cutoff` \[Hz\].
    ///
    /// The fit smooths what it derives with a corner at 2.5 times its cut-off f_c, and so
    /// does this: `tau = 1/(2π·2.5·f_c)`. At f_c the velocity then has 93 % of its
    /// amplitude and lags by 22°, the acceleration 86 % and 44°; the delays are
    /// `0.064/f_c` and `0.127/f_c`. The fit's own smoother has no phase, as it looks ahead:
    /// with causal rates the model's error is larger, and a shorter tau trades delay for
    /// noise.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"cutoff"`, also where the time
    /// constant would not be a float.
    pub fn for_cutoff(cutoff: T) -> Result<Self, Error> {
        let corner =
            T::of(2.0 * core::f64::consts::PI * ABOVE_CUTOFF) * positive(cutoff, "cutoff")?;
        Self::try_new(corner.recip()).map_err(|_| Error::OutOfRange("cutoff"))
    }

    /// The same for positions modulo `period > 0` \[channel unit\], as from a counter.
    ///
    /// The motion's position is unwrapped: it goes on where the counter starts again.
    /// Between two good samples the axis must move by less than half a period, so
    /// `period > 2·|v|·longest_gap` makes every gap safe. Turns are counted up to 2³¹;
    /// beyond that the position stands by whole periods, the rates stay right.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"period"`.
    pub fn with_period(self, period: T) -> Result<Self, Error> {
        let period = Some(positive(period, "period")?);
        Ok(Self { period, ..self })
    }

    /// The same with another longest gap \[s\], above zero.
    ///
    /// It must be longer than the longest `dt` of a good loop.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_gap"`.
    pub fn with_longest_gap(self, longest_gap: T) -> Result<Self, Error> {
        let longest_gap = positive(longest_gap, "longest_gap")?;
        Ok(Self {
            longest_gap,
            ..self
        })
    }

    /// The time constant \[s\]: delay of the velocity, half of that of the acceleration.
    #[inline]
    #[must_use]
    pub fn time_constant(&self) -> T {
        self.time_constant
    }

    /// The longest time between two good samples that is bridged \[s\].
    #[inline]
    #[must_use]
    pub fn longest_gap(&self) -> T {
        self.longest_gap
    }

    /// The period of the positions \[channel unit\], where they wrap around.
    #[inline]
    #[must_use]
    pub fn period(&self) -> Option<T> {
        self.period
    }

    /// The motion after a `position` \[channel unit\] that came `dt` \[s\] later.
    ///
    /// `dt` is the time since the last call, good or bad, and above zero also at the first
    /// one. A bad sample leaves the state, but for the time that has passed.
    #[inline]
    pub fn step(&self, state: &mut RatesState<T>, position: T, dt: T) -> RatesOutput<T> {
        let status = match self.advance(state, position, dt) {
            Ok((next, status)) => {
                *state = next;
                status
            }
            Err(fault) => {
                state.wait(dt);
                RatesStatus::Held(fault)
            }
        };
        RatesOutput {
            motion: state.motion,
            status,
        }
    }

    /// The state after a good sample, or what is wrong with the sample.
    #[inline]
    fn advance(
        &self,
        state: &RatesState<T>,
        position: T,
        dt: T,
    ) -> Result<(RatesState<T>, RatesStatus), RatesFault> {
        if !dt.is_finite() {
            return Err(RatesFault::Dt);
        }
        if dt <= T::zero() {
            return Err(RatesFault::DtNotPositive);
        }
        if !position.is_finite() {
            return Err(RatesFault::Position);
        }
        let Some(last) = state.last else {
            let start = RatesState::start(position, 0, position);
            return Ok((start, RatesStatus::Settling));
        };
        let elapsed = state.gap + dt;
        // An overflow is a gap too: the sum of two times that are finite.
        let bridged = elapsed <= self.longest_gap;
        let (moved, turns) = match self.moved(last, position, state.turns) {
            Some(moved) => moved,
            // Out of the reach of floats from the last position, but good by itself.
            None if !bridged => (T::zero(), 0),
            None => return Err(RatesFault::Overflow),
        };
        let unwrapped = match self.period {
            Some(period) => reach(position + count::<T>(turns) * period)?,
            None => position,
        };
        if !bridged {
            let start = RatesState::start(position, turns, unwrapped);
            return Ok((start, RatesStatus::Settling));
        }
        let mut next = RatesState {
            last: Some(position),
            turns,
            gap: T::zero(),
            time_unknown: false,
            ..*state
        };
        next.motion.position = unwrapped;
        if state.time_unknown {
            return Ok((next, RatesStatus::Resumed));
        }
        let share = -(-elapsed / self.time_constant).exp_m1();
        // Two products instead of share·(quotient - rate), which could overflow.
        let lag = |rate: T, change: T| {
            reach((T::one() - share) * rate + share * reach(change / elapsed)?)
        };
        let before = state.motion;
        next.motion.velocity = lag(before.velocity, moved)?;
        next.motion.acceleration =
            lag(before.acceleration, next.motion.velocity - before.velocity)?;
        if state.age > T::of(SETTLING) * self.time_constant {
            return Ok((next, RatesStatus::Good));
        }
        next.age = state.age + elapsed;
        Ok((next, RatesStatus::Settling))
    }

    /// The way from the last position to this one, and the turns at this one.
    #[inline]
    fn moved(&self, last: T, position: T, turns: i32) -> Option<(T, i32)> {
        let difference = position - last;
        if !difference.is_finite() {
            return None;
        }
        let Some(period) = self.period else {
            return Some((difference, turns));
        };
        let half = period * T::of(0.5);
        if difference.abs() <= half {
            return Some((difference, turns));
        }
        // The counter has gone back where the axis has gone on.
        let periods = (difference / period).round();
        let moved = difference - periods * period;
        let turns = turns.saturating_sub(periods.to_i32()?);
        moved.is_finite().then_some((moved, turns))
    }
}

impl<T: Real> RatesState<T> {
    /// A state that has seen no sample.
    #[inline]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The motion at the last good sample, zero before the first one.
    #[inline]
    #[must_use]
    pub fn motion(&self) -> Motion<T> {
        self.motion
    }

    /// The time that bad samples have taken since the last good one \[s\].
    ///
    /// Without the `dt` that could not be used.
    #[inline]
    #[must_use]
    pub fn gap(&self) -> T {
        self.gap
    }

    /// At rest at a first sample.
    fn start(last: T, turns: i32, position: T) -> Self {
        let mut start = Self {
            last: Some(last),
            turns,
            ..Self::default()
        };
        start.motion.position = position;
        start
    }

    /// Takes note of the time of a bad sample.
    #[inline]
    fn wait(&mut self, dt: T) {
        if dt > T::zero() && dt.is_finite() {
            let gap = self.gap + dt;
            self.gap = if gap.is_finite() { gap } else { T::max_value() };
        } else if dt != T::zero() {
            self.time_unknown = true;
        }
    }
}

/// A finite number, or an overflow.
#[inline]
fn reach<T: Real>(value: T) -> Result<T, RatesFault> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(RatesFault::Overflow)
    }
}

/// A count as a float.
#[inline]
fn count<T: Real>(turns: i32) -> T {
    <T as num_traits::NumCast>::from(turns).unwrap_or_else(T::zero)
}

/// Passes a finite value above zero on.
fn positive<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if finite(value, name)? <= T::zero() {
        return Err(Error::OutOfRange(name));
    }
    Ok(value)
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
// Without its period a shaft that turns round would leap: a misspelt one is refused.
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    time_constant: T,
    longest_gap: T,
    period: Option<T>,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Rates<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        let rates = Self::try_new(raw.time_constant)?.with_longest_gap(raw.longest_gap)?;
        match raw.period {
            Some(period) => rates.with_period(period),
            None => Ok(rates),
        }
    }
}

#[cfg(feature = "serde")]
impl<'de, T> serde::Deserialize<'de> for RatesState<T>
where
    T: Real + serde::Deserialize<'de>,
{
    /// Refuses numbers that are not finite and times that are negative.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(bound = "T: Real + serde::Deserialize<'de>")]
        struct Fields<T> {
            last: Option<T>,
            turns: i32,
            motion: Motion<T>,
            gap: T,
            time_unknown: bool,
            age: T,
        }
        let refused = <D::Error as serde::de::Error>::custom;
        let read = Fields::<T>::deserialize(from)?;
        let motion = read.motion;
        let numbers = [motion.position, motion.velocity, motion.acceleration];
        for number in numbers.into_iter().chain(read.last) {
            finite(number, "motion").map_err(refused)?;
        }
        for time in [read.gap, read.age] {
            if finite(time, "time").map_err(refused)? < T::zero() {
                return Err(refused(Error::OutOfRange("time")));
            }
        }
        Ok(Self {
            last: read.last,
            turns: read.turns,
            motion,
            gap: read.gap,
            time_unknown: read.time_unknown,
            age: read.age,
        })
    }
}
