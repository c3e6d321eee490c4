//! The play operator, for backlash and for noise rejection upstream of a hysteresis.

use super::clamp;
use crate::error::not_below_zero;
use crate::{Error, Real};

crate::checked::stored! {
    /// Play operator with half-width r: the output follows the input at a distance of at most r.
    ///
    /// The output is `y⁺ = clamp(y, x - r, x + r)`. An oscillation of the input with a peak-to-peak
    /// amplitude of up to 2r does not change the output. Upstream of a hysteresis, a play therefore
    /// prevents false reversals caused by sensor noise. A half-width of four standard deviations of
    /// the noise is sufficient (see [`transmission`](crate::transmission)).
    ///
    /// Source: Krasnosel'skii & Pokrovskii, *Systems with Hysteresis*, 1989.
    ///
    /// ```
    /// use bowden::signal::{Play, PlayState};
    /// # fn main() -> Result<(), bowden::Error> {
    /// let play = Play::try_new(0.5)?;
    /// let mut state = PlayState::new();
    /// assert_eq!(play.step(&mut state, 2.0), 2.0); // the output starts at the first sample
    /// assert_eq!(play.step(&mut state, 3.0), 2.5);
    /// assert_eq!(play.step(&mut state, 2.1), 2.5);
    /// # Ok(())
    /// # }
    /// ```
    pub struct Play<T> {
        half_width: T,
    }
    => {
        Self::try_new(half_width)
    }
}

crate::checked::stored! {
    /// State of a [`Play`]: its output, if there was a good sample.
    #[derive(Default)]
    pub struct PlayState<T> {
        output: Option<T>,
    }
}

crate::checked! {
    Play<T>;

    /// A play with `half_width >= 0` [input unit]. With a half-width of zero, the output equals the
    /// input.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"half_width"`.
    pub fn try_new(half_width: T) {
        not_below_zero!(half_width, "half_width");
        Ok(Play { half_width })
    }
}

impl<T: Real> Play<T> {
    /// No play: the output equals the input.
    pub(crate) const NONE: Self = Self {
        half_width: T::ZERO,
    };

    /// The half-width [input unit].
    pub fn half_width(&self) -> T {
        self.half_width
    }

    /// The output [input unit] after one input sample [input unit].
    ///
    /// An input that is not finite leaves the output unchanged. Before the first good sample, the
    /// output is zero.
    #[inline]
    pub fn step(&self, state: &mut PlayState<T>, input: T) -> T {
        let output = state
            .output
            .unwrap_or(if input.is_finite() { input } else { T::zero() });
        if input.is_finite() {
            let low = input - self.half_width;
            let high = input + self.half_width;
            state.output = Some(clamp(output, low, high));
        }
        state.output.unwrap_or(output)
    }
}

impl<T: Real> PlayState<T> {
    /// A state whose output starts at the first good sample.
    #[inline]
    pub fn new() -> Self {
        Self { output: None }
    }

    /// The output [input unit], or `None` before the first good sample.
    pub fn output(&self) -> Option<T> {
        self.output
    }
}
