//! What the joint is to do: the paper's torque reference, and its rates.

use bowden::effect::Motion;
use bowden::Real;

/// A torque reference: a mean and two sines, ramped in if wanted.
///
/// The paper's is `25 + 10·sin(2·pi·0.25·t) + 3·sin(2·pi·0.2·sqrt(3)·t)` \[N·m\] (section
/// 4.2, Figure 7); at most 38.
///
/// ```
/// use bowden_rig::Reference;
/// let reference = Reference::<f64>::paper();
/// assert_eq!((reference.at(0.0), reference.maximum()), (25.0, 38.0));
/// assert_eq!(reference.with_ramp(1.0).at(0.0), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reference<T> {
    mean: T,
    /// Amplitude \[N·m\] and angular frequency \[rad/s\].
    tones: [(T, T); 2],
    ramp: T,
}

impl<T: Real> Reference<T> {
    /// The paper's, at its full value from the first sample on.
    #[must_use]
    pub fn paper() -> Self {
        let turn = 2.0 * core::f64::consts::PI;
        Self {
            mean: T::of(25.0),
            tones: [
                (T::of(10.0), T::of(turn * 0.25)),
                (T::of(3.0), T::of(turn * 0.2 * Real::sqrt(3.0_f64))),
            ],
            ramp: T::zero(),
        }
    }

    /// The same, rising smoothly from zero in the first `seconds` \[s\].
    ///
    /// The factor is `x²·(3 − 2·x)`; a number that is not positive means no ramp.
    #[must_use]
    pub fn with_ramp(self, seconds: T) -> Self {
        let ramp = if seconds > T::zero() && seconds.is_finite() {
            seconds
        } else {
            T::zero()
        };
        Self { ramp, ..self }
    }

    /// The same, moved and stretched to stay between two values \[N·m\].
    ///
    /// Numbers that are not finite, or not in order, change nothing.
    ///
    /// ```
    /// use bowden_rig::Reference;
    /// let small = Reference::<f64>::paper().between(-4.0, 9.0);
    /// assert!((small.at(0.0) - 2.5).abs() < 1e-12 && (small.maximum() - 9.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn between(&self, low: T, high: T) -> Self {
        let half = T::of(0.5) * (high - low);
        let own = self.maximum() - self.mean;
        let (mean, factor) = (low + half, half / own);
        if !(half > T::zero() && mean.is_finite() && factor.is_finite()) {
            return *self;
        }
        let tones = self.tones.map(|(amplitude, w)| (factor * amplitude, w));
        Self {
            mean,
            tones,
            ..*self
        }
    }

    /// The greatest value \[N·m\].
    #[must_use]
    pub fn maximum(&self) -> T {
        self.tones
            .iter()
            .fold(self.mean, |sum, (amplitude, _)| sum + *amplitude)
    }

    /// The greatest magnitude \[N·m\], whatever its sign.
    ///
    /// ```
    /// use bowden_rig::Reference;
    /// let pulled = Reference::<f64>::paper().between(-50.0, -10.0);
    /// assert!((pulled.maximum() + 10.0).abs() < 1e-12 && (pulled.magnitude() - 50.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn magnitude(&self) -> T {
        let tones = self.tones.iter();
        tones.fold(self.mean.abs(), |sum, (amplitude, _)| sum + amplitude.abs())
    }

    /// The reference \[N·m\] at time `t` \[s\].
    #[must_use]
    pub fn at(&self, t: T) -> T {
        self.motion(t).position
    }

    /// The reference \[N·m\] with its two time derivatives.
    #[must_use]
    pub fn motion(&self, t: T) -> Motion<T> {
        let mut full = Motion {
            position: self.mean,
            velocity: T::zero(),
            acceleration: T::zero(),
        };
        for (amplitude, w) in self.tones {
            let (s, c) = ((w * t).sin(), (w * t).cos());
            full.position += amplitude * s;
            full.velocity += amplitude * w * c;
            full.acceleration -= amplitude * w * w * s;
        }
        if t >= self.ramp {
            return full;
        }
        let x = (t / self.ramp).max(T::zero());
        let (two, three, six) = (T::of(2.0), T::of(3.0), T::of(6.0));
        let f = x * x * (three - two * x);
        let df = six * x * (T::one() - x) / self.ramp;
        let ddf = six * (T::one() - two * x) / (self.ramp * self.ramp);
        Motion {
            position: f * full.position,
            velocity: f * full.velocity + df * full.position,
            acceleration: f * full.acceleration + two * df * full.velocity + ddf * full.position,
        }
    }
}
