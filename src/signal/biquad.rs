//! A second-order low-pass filter and a notch filter.

use super::Compensated;
use crate::error::above_zero;
use crate::real::{as_f64, of};
use crate::{Error, Real};

mod prewarped;

/// Second-order filter: a low-pass or a notch.
///
/// With `s` in units of `2π·frequency` and the quality factor `q`, the transfer functions are:
///
/// ```text
/// low-pass  1/(s² + s/q + 1)       q = 1/√2: Butterworth; q = 1/2: critically damped
/// notch     (s² + 1)/(s² + s/q + 1)   −3 dB width: frequency/q
/// ```
/// Both filters have a gain of 1 at zero frequency. If the input is constant, the output reaches
/// exactly this value.
///
/// **Design.** The filter uses the bilinear transform, prewarped for the sample time `T`. Its
/// response at `f` \[Hz\] is the transfer function at `s = i·tan(π·f·T)/tan(π·frequency·T)`. The
/// response at `frequency` is therefore exact. `dt` may vary. Each step integrates over its own
/// `dt` with the trapezoidal rule and with the prewarping for `T`. If `dt` is `(1 + e)·T`, the
/// relative error of the corner frequency is less than `|e|·(π·frequency·T)²`, to first order in
/// `e`.
///
/// **Form.** The filter is a state-variable filter with trapezoidal integrators (A. Simper,
/// *Solving the continuous SVF equations using trapezoidal integration*, 2013). In contrast to a
/// direct form, it remains accurate in `f32` for a corner below 1/1000 of the sample rate
/// (`tests/signal/filters.rs`).
///
/// **Bounds.** For a constant input `c`, the sum `band² + (low − c)²` never increases, for any
/// sequence of `dt`. Here, `band` and `low` are the values of the two integrators. The output of a
/// low-pass that starts at rest is therefore never further from `c` than at the start. If the
/// filter starts at rest and `dt` equals the sample time, two limits apply. The output of a
/// low-pass is at most `2 + 4·q/π` times the largest sample. The output of a notch is at most 3
/// times the largest sample. These limits were computed on a grid of `frequency` and `q`
/// (`tests/signal/filters.rs`).
///
/// ```
/// use bowden::signal::{Biquad, BiquadState};
/// // A resonance of the joint at 35 Hz, 7 Hz wide, in a loop of 1 kHz.
/// let notch = Biquad::notch(35.0_f32, 5.0, 0.001)?;
/// let mut state = BiquadState::new();
/// let mut last = 0.0_f32;
/// for k in 0..2000_u32 {
///     let vibration = (2.0 * core::f32::consts::PI * 0.035 * (k % 200) as f32).sin();
///     last = notch.step(&mut state, 3.0 + vibration, 0.001);
/// }
/// assert!((last - 3.0).abs() < 1e-4);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Biquad<T> {
    design: Design<T>,
    /// `tan(π·frequency·T)/T`. Multiplied by dt, it is the gain of an integrator.
    slope: T,
    /// `1/q`
    damping: T,
}

crate::data! {
    /// Design parameters of a filter.
    pub(super) struct Design<T> {
        response: Response,
        frequency: T,
        q: T,
        sample_time: T,
    }

    #[derive(Eq)]
    enum Response {
        LowPass,
        Notch,
    }
}

crate::checked::stored! {
    /// State of a [`Biquad`]: two integrators and the output, empty before the first good sample.
    #[derive(Default)]
    pub struct BiquadState<T> {
        value: Option<T>,
        /// The integrator of the band-pass, which is zero at rest.
        band: Compensated<T>,
        /// The integrator of the low-pass, which is the input at rest.
        low: Compensated<T>,
    }
}

crate::checked! {
    Biquad<T>;

    fn designed[](design: Design<T>) -> Result<Biquad<T>, Error> {
        let (frequency, q, sample_time) = (design.frequency, design.q, design.sample_time);
        above_zero!(frequency, "frequency");
        above_zero!(q, "q");
        above_zero!(sample_time, "sample_time");
        if frequency * sample_time >= of(0.5) {
            return Err(Error::Inadmissible("frequency < 1/(2·sample_time)"));
        }
        let slope: T = of(prewarped::slope(as_f64(frequency), as_f64(sample_time)));
        let damping = T::ONE / q;
        if !slope.is_finite() {
            return Err(Error::OutOfRange("frequency"));
        }
        if !damping.is_finite() {
            return Err(Error::OutOfRange("q"));
        }
        Ok(Biquad { design, slope, damping })
    }

    /// A low-pass with its corner at `frequency` \[Hz\], for a sampling period of
    /// `sample_time` \[s\].
    ///
    /// All three arguments must be positive, and `frequency` must be below half the sample rate. At
    /// `frequency`, the gain is `q` and the phase is −90°. A `q` above `1/√2` gives a resonance.
    ///
    /// The prewarping is computed in `f64`. On a microcontroller without `f64` hardware, use
    /// [`constant!`](crate::constant) to avoid this code.
    ///
    /// ```
    /// use bowden::constant;
    /// use bowden::signal::Biquad;
    /// // Butterworth at 80 Hz in a loop of 1 kHz.
    /// static SMOOTH: Biquad<f32> = constant!(Biquad::<f32>::low_pass(80.0, 0.7071, 0.001));
    /// assert_eq!(SMOOTH, Biquad::low_pass(80.0, 0.7071, 0.001)?);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"frequency"`, `"q"` or
    /// `"sample_time"`; [`Error::Inadmissible`] unless `frequency < 1/(2·sample_time)`.
    pub fn low_pass(frequency: T, q: T, sample_time: T) {
        let response = Response::LowPass;
        designed(Design { response, frequency, q, sample_time })
    }

    /// A notch at `frequency` \[Hz\] with a width of `frequency/q` \[Hz\], for a sampling period of
    /// `sample_time` \[s\].
    ///
    /// All three arguments must be positive, and `frequency` must be below half the sample rate.
    /// The width is the distance between the two frequencies with a gain of `1/√2`.
    ///
    /// # Errors
    /// The same as [`low_pass`](Self::low_pass).
    pub fn notch(frequency: T, q: T, sample_time: T) {
        let response = Response::Notch;
        designed(Design { response, frequency, q, sample_time })
    }
}

impl<T: Real> Biquad<T> {
    /// The output \[signal unit\] for a sample taken `dt` \[s\] after the last one.
    ///
    /// The filter starts at rest at the first good sample, and the output then equals this sample.
    /// A sample is bad if it is not finite, or if `dt` is not positive and finite. A bad sample
    /// leaves the state unchanged and returns the last output, or zero before the first good
    /// sample. If the next state would overflow, the filter restarts at rest at this sample.
    #[inline]
    pub fn step(&self, state: &mut BiquadState<T>, sample: T, dt: T) -> T {
        if sample.is_finite() && dt.is_finite() && dt > T::ZERO {
            *state = self.after(state, sample, dt);
        }
        state.value()
    }

    #[inline]
    fn after(&self, state: &BiquadState<T>, sample: T, dt: T) -> BiquadState<T> {
        if state.value.is_none() {
            return BiquadState::at(sample);
        }
        let (band, low) = (state.band, state.low);
        let g = self.slope * dt;
        let pull = (sample - low.value) - low.carry;
        let pace = g + self.damping;
        // v1 - band, v1 and v2 - low of the source; v1 and v2 are at the middle of the step.
        let push = g * (pull - pace * band.value) / (T::ONE + g * pace);
        let middle = band.value + (band.carry + push);
        let rise = g * middle;
        let value = match self.design.response {
            Response::LowPass => low.value + (low.carry + rise),
            Response::Notch => sample - self.damping * middle,
        };
        let next = BiquadState {
            value: Some(value),
            band: band.plus(push + push),
            low: low.plus(rise + rise),
        };
        if next.is_finite() {
            next
        } else {
            BiquadState::at(sample)
        }
    }
}

impl<T: Real> BiquadState<T> {
    /// A state that starts at rest at the first good sample.
    #[inline]
    pub const fn new() -> Self {
        Self {
            value: None,
            band: Compensated::new(T::ZERO),
            low: Compensated::new(T::ZERO),
        }
    }

    /// A state at rest at the given value \[signal unit\].
    #[inline]
    pub const fn at(value: T) -> Self {
        Self {
            value: Some(value),
            band: Compensated::new(T::ZERO),
            low: Compensated::new(value),
        }
    }

    /// A state with any numbers.
    #[cfg(kani)]
    pub(crate) fn of(value: Option<T>, [band, band_carry, low, low_carry]: [T; 4]) -> Self {
        let sum = |value, carry| Compensated { value, carry };
        Self {
            value,
            band: sum(band, band_carry),
            low: sum(low, low_carry),
        }
    }

    /// The output \[signal unit\]; zero before the first good sample.
    pub fn value(&self) -> T {
        self.value.unwrap_or(T::ZERO)
    }

    /// The same as [`Finite`](crate::checked::Finite), in fewer instructions.
    #[inline]
    fn is_finite(&self) -> bool {
        let integrators = self.band.value.is_finite() && self.low.value.is_finite();
        let carries = self.band.carry.is_finite() && self.low.carry.is_finite();
        integrators && carries && self.value().is_finite()
    }
}

crate::checked::stored_as! { Biquad<T> as Design<T>: |filter| filter.design, designed }
