//! Capstan friction: friction grows with the tension and with the wrap angle.

use super::bounds::saturate;
use super::coulomb::sign;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Friction proportional to the tension, exponential in the wrap angle.
    ///
    /// Formula: `load·(exp(mu·x) − 1)/mu·tanh(v/v_e)`, where x is the wrap angle from its origin.
    /// With a gain of mu this is the Euler-Eytelwein law: friction adds the tension
    /// `load·(exp(mu·x) − 1)` along the wrap. As mu tends to zero, the regressor becomes
    /// `load·x·tanh(v/v_e)`. A wrap x_0 at the origin adds load friction,
    /// `load·(exp(mu·x_0) − 1)·tanh(v/v_e)`, and changes the gain to `mu·exp(mu·x_0)`. The wrap
    /// grows with x, so mu is positive.
    ///
    /// Source: L. Euler, 1762; J. A. Eytelwein, 1808; for tendons, M. Kaneko,
    /// T. Yamashita, K. Tanie, "Basic considerations on transmission characteristics
    /// for tendon drive robots", *ICAR*, 1991.
    ///
    /// ```
    /// use bowden::{effect::Capstan, Error};
    /// assert_eq!(Capstan::try_new(0.5, 0.2)?.mu(), 0.2);
    /// assert_eq!(Capstan::try_new(0.0, 0.2), Err(Error::OutOfRange("v_e")));
    /// assert_eq!(Capstan::try_new(0.5, 0.0), Err(Error::OutOfRange("mu")));
    /// # Ok::<(), Error>(())
    /// ```
    Capstan {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
        /// Friction coefficient of the wrap \[1/channel unit\].
        mu: Positive, Dimension { channel: -1, ..Dimension::ONE };
    }
}

impl<T: Real> Regressor<T> for Capstan<T> {
    const INFO: &'static Info = &Info {
        name: "capstan",
        family: Family::Capstan,
        formula: "load·(exp(mu·x)−1)/mu·tanh(v/v_e)",
        dimension: Dimension {
            channel: 1,
            load: 1,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Neither, Odd),
        reads: &[Quantity::Load, Quantity::Position, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.load * sign(at.motion.velocity, self.v_e) * growth(at.motion.position, self.mu)
    }
}

/// `(exp(mu·x) − 1)/mu`, or x itself if the two differ by less than rounding: there the product
/// may be subnormal or 0 and the quotient arbitrary.
#[inline]
fn growth<T: Real>(x: T, mu: T) -> T {
    let exponent = mu * x;
    if exponent.abs() < T::epsilon() {
        x
    } else {
        saturate(exponent.exp_m1() / mu)
    }
}
