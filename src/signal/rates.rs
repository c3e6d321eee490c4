//! Causal velocity and acceleration from samples of the position.

use crate::effect::Motion;
use crate::error::{above_zero, must_be_finite};
use crate::fault::{fault_of_dt, unless_finite, Fault};
use crate::real::of;
use crate::{Error, Real};

/// Default: a gap of more than this number of time constants restarts the rates.
const LONGEST_GAP: f64 = 10.0;

/// Time constants after which rates that started at zero count as settled.
const SETTLING: f64 = 5.0;

/// Corner of [`Rates::for_cutoff`] \[rad/s\] divided by the cut-off frequency of the fit \[Hz\].
/// The corner is at 2.5 times the cut-off frequency.
const CORNER: f64 = 2.0 * core::f64::consts::PI * 2.5;

crate::checked::stored! {
    /// Velocity and acceleration ([`Motion`]) from samples of the position, with gaps and
    /// wrap-around.
    ///
    /// ```text
    /// s  = 1 − e^(−h/tau),  h = time since the last good sample
    /// v⁺ = v + s·((x − x_last)/h − v)
    /// a⁺ = a + s·((v⁺ − v)/h − a)
    /// ```
    /// At frequencies well below the sample rate, the transfer functions are `V/X = s/(tau·s + 1)`
    /// and `A/X = s²/(tau·s + 1)²`, where tau is the time constant. The position has no delay, the
    /// velocity has a delay of tau, and the acceleration has a delay of 2·tau. At `f` \[Hz\], with
    /// `w = 2π·f·tau`, the gain of the velocity is `1/√(1 + w²)` and its phase lag is `atan(w)`.
    /// The acceleration has the square of this gain and twice this lag. At any sample rate, with
    /// `q = e^(−h/tau)`, `V/X = (1 − q)/(1 − q·z⁻¹)·(1 − z⁻¹)/h`. For a ramp, the velocity is
    /// therefore exact. The delay at low frequencies is `h·(1/2 + q/(1 − q))`, which is tau to
    /// within `h²/(12·tau)`.
    ///
    /// White noise with a standard deviation of `s_x` on the position gives noise of about
    /// `s_x/tau` on the velocity and `s_x/tau²` on the acceleration. Both values are smaller if tau
    /// is not much larger than h.
    ///
    /// * **First sample**: velocity and acceleration start at zero. On an axis that moves at the
    ///   velocity V, the computed velocity is then `V·(1 − e^(−t/tau))`. The acceleration has a
    ///   pulse with the height `V/(e·tau)`. The status is [`RateStatus::Settling`] for five time
    ///   constants.
    /// * **Bad samples**: if the position is not finite, or if `dt` is not positive and finite, the
    ///   last good motion is held. The status reports the fault.
    /// * **Gaps**: h is the time since the last good sample, including the time of bad samples. If
    ///   h exceeds the [longest gap](Self::with_longest_gap), velocity and acceleration restart at
    ///   zero. After a `dt` that is negative or not finite, the time is unknown. The next good
    ///   sample then only sets the position, and velocity and acceleration are held.
    /// * **Wrap-around** of a counter: see [`with_period`](Self::with_period).
    /// * **Long runs**: a position in `f32` has a resolution of up to `2⁻²³·|x|`, which appears as
    ///   noise in velocity and acceleration. At 1000 rad, the resolution is 6e-5 rad. With tau = 10
    ///   ms, the noise is then up to 0.006 rad/s and 0.6 rad/s². For an axis that turns
    ///   continuously, use the position modulo its period. An integer then counts the turns, and
    ///   only the returned position has this rounding error.
    ///
    /// ```
    /// use bowden::signal::{Rates, RatesState, RateStatus};
    /// # fn main() -> Result<(), bowden::Error> {
    /// // An encoder of 4096 counts per turn on a 12-bit counter; the fit's cut-off was 5 Hz.
    /// let rates = Rates::for_cutoff(5.0_f32)?.with_period(4096.0)?;
    /// let mut state = RatesState::new();
    /// for k in 0..2000_u32 {
    ///     let counter = (4000 + 3 * k) % 4096; // 3 counts a millisecond
    ///     rates.step(&mut state, counter as f32, 0.001);
    /// }
    /// let out = rates.step(&mut state, ((4000 + 3 * 2000) % 4096) as f32, 0.001);
    /// assert_eq!((out.status, out.motion.position), (RateStatus::Good, 10_000.0));
    /// assert!((out.motion.velocity - 3000.0).abs() < 0.01); // [counts/s]
    /// # Ok(())
    /// # }
    /// ```
    pub struct Rates<T> {
        time_constant: T,
        longest_gap: T,
        period: Option<T>,
    }
    => {
        let rates = Self::try_new(time_constant)?.with_longest_gap(longest_gap)?;
        period.map_or(Ok(rates), |period| rates.with_period(period))
    }
}

crate::data! {
    /// Validity of the velocity and acceleration from [`Rates`] or
    /// [`EdgeVelocity`](super::EdgeVelocity).
    #[derive(Eq, Hash)]
    pub enum RateStatus {
        /// A good sample, and velocity and acceleration have settled. From an
        /// [`EdgeVelocity`](super::EdgeVelocity): the position has changed at least twice, and the
        /// time between two changes is known.
        Good,
        /// A good sample, but velocity and acceleration started from zero less than five time
        /// constants ago. From an [`EdgeVelocity`](super::EdgeVelocity): the time between two
        /// changes of the position is not yet known.
        Settling,
        /// A good sample after an unknown time. [`Rates`] holds velocity and acceleration.
        Resumed,
        /// No count has occurred within the longest gap. The velocity of an
        /// [`EdgeVelocity`](super::EdgeVelocity) is zero.
        Stopped,
        /// A bad sample. The last good velocity and acceleration are held.
        Held(Fault),
    }

    /// Output of a step of [`Rates`].
    pub struct RatesOutput<T> {
        /// Position (unwrapped), velocity and acceleration. They are finite, and zero before the
        /// first good sample.
        pub motion: Motion<T>,
        /// Validity of the motion.
        pub status: RateStatus,
    }
}

crate::checked::stored! {
    /// State of [`Rates`]: the last good sample, velocity, acceleration and the elapsed time.
    #[derive(Default)]
    pub struct RatesState<T> {
        /// The last good position as received, not unwrapped.
        last: Option<T>,
        /// Number of periods between this position and the position of `motion`.
        turns: i32,
        motion: Motion<T>,
        /// Time of the bad samples since the last good one.
        gap: T,
        /// Whether an unknown time has passed since the last good sample.
        time_unknown: bool,
        /// Time since velocity and acceleration started at zero. It is constant once they have
        /// settled.
        age: T,
    }
    => {
        let negative = gap < T::ZERO || age < T::ZERO;
        let state = Self { last, turns, motion, gap, time_unknown, age };
        if negative {
            return Err(Error::OutOfRange("time"));
        }
        finite(state)
    }
}

crate::checked! {
    Rates<T>;

    fn longest_gap[](time_constant: T) -> T {
        let constants: T = of(LONGEST_GAP);
        constants * time_constant
    }

    /// An estimator with `time_constant > 0` \[s\].
    ///
    /// The longest gap is ten time constants. If the sample time is longer, use
    /// [`with_longest_gap`](Self::with_longest_gap). Otherwise, velocity and acceleration restart
    /// at every sample.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`.
    pub fn try_new(time_constant: T) {
        above_zero!(time_constant, "time_constant");
        let longest_gap = longest_gap(time_constant);
        must_be_finite!(longest_gap, "time_constant");
        let period = None;
        Ok(Rates { time_constant, longest_gap, period })
    }

    /// An estimator for a model that was fitted with the cut-off frequency `cutoff` \[Hz\].
    ///
    /// The fit smooths its derivatives with a corner at 2.5 times its cut-off frequency f_c. This
    /// filter has the same corner: `tau = 1/(2π·2.5·f_c)`. At f_c, the velocity has 93 % of its
    /// amplitude and a lag of 22°. The acceleration has 86 % of its amplitude and a lag of 44°. The
    /// delays are `0.064/f_c` and `0.127/f_c`. With these causal derivatives, the error of the
    /// model is larger than in the fit, which uses zero-phase derivatives. A shorter tau reduces
    /// the delay but increases the noise.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"cutoff"`. `OutOfRange` is also returned
    /// if the time constant is not a positive finite float.
    pub fn for_cutoff(cutoff: T) {
        above_zero!(cutoff, "cutoff");
        let corner: T = of(CORNER);
        let time_constant = T::ONE / (corner * cutoff);
        let longest_gap = longest_gap(time_constant);
        if time_constant > T::ZERO && longest_gap.is_finite() {
            let period = None;
            return Ok(Rates { time_constant, longest_gap, period });
        }
        Err(Error::OutOfRange("cutoff"))
    }

    /// Sets the period \[channel unit\] of positions that wrap, such as counter readings. The
    /// period must be positive.
    ///
    /// The position of the motion is unwrapped, so it continues when the counter wraps. Between two
    /// good samples, the axis must move by less than half a period. The condition
    /// `period > 2·|v|·longest_gap` ensures this for every gap. Beyond 2³¹ turns, the position is
    /// wrong by whole periods, but velocity and acceleration are still correct.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"period"`.
    pub fn with_period[self rates](period: T) {
        above_zero!(period, "period");
        let period = Some(period);
        Ok(Rates { period, ..rates })
    }

    /// Sets the longest gap \[s\], which must be positive.
    ///
    /// The longest gap must exceed the longest `dt` of the loop in normal operation.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_gap"`.
    pub fn with_longest_gap[self rates](longest_gap: T) {
        above_zero!(longest_gap, "longest_gap");
        Ok(Rates { longest_gap, ..rates })
    }
}

impl<T: Real> Rates<T> {
    /// The time constant \[s\], which is the delay of the velocity and half the delay of the
    /// acceleration.
    pub fn time_constant(&self) -> T {
        self.time_constant
    }

    /// The motion at a `position` \[channel unit\] measured `dt` \[s\] after the last call.
    ///
    /// `dt` is the time since the last call, even if the last sample was bad. `dt` must be
    /// positive, including at the first call. A bad sample leaves the state unchanged except for
    /// the elapsed time.
    #[inline]
    pub fn step(&self, state: &mut RatesState<T>, position: T, dt: T) -> RatesOutput<T> {
        let status = match self.advance(state, position, dt) {
            Ok((next, status)) => {
                *state = next;
                status
            }
            Err(fault) => {
                state.wait(dt);
                RateStatus::Held(fault)
            }
        };
        RatesOutput {
            motion: state.motion,
            status,
        }
    }

    /// The state after a good sample, or the fault of the sample.
    #[inline]
    fn advance(
        &self,
        state: &RatesState<T>,
        position: T,
        dt: T,
    ) -> Result<(RatesState<T>, RateStatus), Fault> {
        let fault = fault_of_dt(dt, T::HIGHEST);
        if let Some(fault) = fault.or_else(|| unless_finite(position, Fault::Position)) {
            return Err(fault);
        }
        let Some(last) = state.last else {
            let start = RatesState::start(position, 0, position);
            return Ok((start, RateStatus::Settling));
        };
        let elapsed = state.gap + dt;
        // An overflow is a gap too: the sum of two times that are finite.
        let bridged = elapsed <= self.longest_gap;
        let (moved, turns) = match self.moved(last, position, state.turns) {
            Some(moved) => moved,
            // The distance to the last position overflows, but the position itself is good.
            None if !bridged => (T::zero(), 0),
            None => return Err(Fault::Overflow),
        };
        let unwrapped = match self.period {
            Some(period) => reach(position + count::<T>(turns) * period)?,
            None => position,
        };
        if !bridged {
            let start = RatesState::start(position, turns, unwrapped);
            return Ok((start, RateStatus::Settling));
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
            return Ok((next, RateStatus::Resumed));
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
        if state.age > T::from_f64(SETTLING) * self.time_constant {
            return Ok((next, RateStatus::Good));
        }
        next.age = state.age + elapsed;
        Ok((next, RateStatus::Settling))
    }

    /// The distance from the last position to this one, and the turns at this one.
    #[inline]
    fn moved(&self, last: T, position: T, turns: i32) -> Option<(T, i32)> {
        let difference = position - last;
        if !difference.is_finite() {
            return None;
        }
        let Some(period) = self.period else {
            return Some((difference, turns));
        };
        let half = period * T::from_f64(0.5);
        if difference.abs() <= half {
            return Some((difference, turns));
        }
        // The counter has wrapped back while the axis continued.
        let periods = (difference / period).round();
        let moved = difference - periods * period;
        let turns = turns.saturating_sub(periods.to_i32()?);
        moved.is_finite().then_some((moved, turns))
    }
}

impl<T: Real> RatesState<T> {
    /// Initial state, before the first sample.
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }

    /// The motion at the last good sample, or zero before the first good sample.
    pub fn motion(&self) -> Motion<T> {
        self.motion
    }

    /// The time of the bad samples since the last good one \[s\].
    ///
    /// This time does not include unusable values of `dt`.
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

    /// Records the time of a bad sample.
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
fn reach<T: Real>(value: T) -> Result<T, Fault> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::Overflow)
    }
}

/// A count as a float.
#[inline]
fn count<T: Real>(turns: i32) -> T {
    <T as num_traits::NumCast>::from(turns).unwrap_or_else(T::zero)
}
