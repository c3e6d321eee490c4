//! The nominal plant: the response to a command without friction.

use crate::effect::Motion;
use crate::error::{above_zero, finite, must_be_finite, not_below_zero};
use crate::{Error, Real};

crate::checked::stored! {
    /// The nominal plant from command to output, `P(s) = alpha/(s²/wn² + 2·zeta·s/wn + 1)`.
    ///
    /// For a motor with inertia J and damping c that acts through the cable on a stiffness K,
    /// `wn = √(K/J)` and `zeta = c/(2·√(K·J))`. alpha is the torque per command unit. If wn and
    /// alpha are uncertain, choose low values.
    ///
    /// ```
    /// use bowden::control::NominalPlant;
    /// use bowden::effect::Motion;
    /// // 0.6 N·m per unit, 0.2 kg·m², 2.7 N·m·s/rad, 130 N·m/rad.
    /// let plant = NominalPlant::of_mechanics(0.6_f64, 0.2, 2.7, 130.0)?;
    /// assert!((plant.natural_frequency() - 25.5).abs() < 0.01); // [rad/s]
    /// assert!((plant.damping_ratio() - 0.265).abs() < 0.001);
    /// let rest = Motion { position: 12.0, ..Motion::default() }; // [N·m], at rest
    /// assert!((plant.feed_forward(&rest) - 20.0).abs() < 1e-12); // [units]
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct NominalPlant<T> {
        gain: T,
        natural_frequency: T,
        damping_ratio: T,
    }
    => {
        Self::try_new(gain, natural_frequency, damping_ratio)
    }
}

crate::checked! {
    NominalPlant<T>;

    /// A plant with alpha ≠ 0 \[output unit/command unit\], wn > 0 \[rad/s\] and zeta ≥ 0.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"gain"`, `"natural_frequency"` or
    /// `"damping_ratio"`.
    pub fn try_new(gain: T, natural_frequency: T, damping_ratio: T) {
        must_be_finite!(gain, "gain");
        if gain == T::ZERO || !(T::ONE / gain).is_finite() {
            return Err(Error::OutOfRange("gain"));
        }
        above_zero!(natural_frequency, "natural_frequency");
        if !((T::ONE / natural_frequency) / natural_frequency).is_finite() {
            return Err(Error::OutOfRange("natural_frequency"));
        }
        not_below_zero!(damping_ratio, "damping_ratio");
        Ok(NominalPlant { gain, natural_frequency, damping_ratio })
    }
}

impl<T: Real> NominalPlant<T> {
    /// A plant from the drive's specification.
    ///
    /// - `gain` is the torque per command unit at rest. It must be nonzero.
    /// - `inertia` \[kg·m²\] must be positive.
    /// - `damping` \[N·m·s/rad\] is the viscous damping. It must not be negative.
    /// - `stiffness` \[N·m/rad\] is the stiffness of cable and load in series. It must be positive.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the name of the invalid argument or of an
    /// invalid derived parameter.
    pub fn of_mechanics(gain: T, inertia: T, damping: T, stiffness: T) -> Result<Self, Error> {
        for (value, name) in [(inertia, "inertia"), (stiffness, "stiffness")] {
            if finite(value, name)? <= T::ZERO {
                return Err(Error::OutOfRange(name));
            }
        }
        if finite(damping, "damping")? < T::ZERO {
            return Err(Error::OutOfRange("damping"));
        }
        let root = stiffness.sqrt() * inertia.sqrt();
        Self::try_new(
            gain,
            (stiffness / inertia).sqrt(),
            damping / (T::from_f64(2.0) * root),
        )
    }

    /// alpha \[output unit/command unit\].
    pub const fn gain(&self) -> T {
        self.gain
    }

    /// wn \[rad/s\].
    pub const fn natural_frequency(&self) -> T {
        self.natural_frequency
    }

    /// zeta.
    pub const fn damping_ratio(&self) -> T {
        self.damping_ratio
    }

    /// The command for which the output of the nominal plant follows the desired motion. The
    /// position is in \[output unit\]; the velocity and the acceleration are its time derivatives.
    ///
    /// To compensate for the latency of the command, pass the motion that is desired one latency
    /// later. If the motion is not finite, the result is not finite either, and a controller
    /// rejects it.
    #[inline]
    #[must_use]
    pub fn feed_forward(&self, wanted: &Motion<T>) -> T {
        let (rate, curvature) = self.terms();
        (wanted.position + rate * wanted.velocity + curvature * wanted.acceleration) / self.gain
    }

    /// `2·zeta/wn` \[s\] and `1/wn²` \[s²\].
    #[inline]
    fn terms(&self) -> (T, T) {
        let slow = self.natural_frequency.recip();
        (T::from_f64(2.0) * self.damping_ratio * slow, slow * slow)
    }
}
