//! Backlash and dead zone: nothing is transmitted over a distance.
//!
//! Formulas: `play(x; r) − x`, the difference that a gap of half-width r makes (the
//! play is flat over the distance 2·r after each reversal), and
//! `x − clamp(x, −r, r)`, a spring with a gap around zero.
//!
//! Source: M. Nordin, P.-O. Gutman, "Controlling mechanical systems with backlash
//! — a survey", *Automatica* 38(10), 2002; for the play, M. A. Krasnosel'skii,
//! A. V. Pokrovskii, *Systems with Hysteresis*, 1989.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Symmetry::{Even, Neither, Odd};
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::signal::clamp;
use crate::Real;

shaped! {
    /// The play of half-width `r`, less its input; it starts in mid-gap.
    ///
    /// ```
    /// use bowden::{effect::backlash::Backlash, Error};
    /// assert_eq!(Backlash::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(Backlash::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    Backlash {
        /// Half of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for Backlash<T> {
    const INFO: &'static Info = &Info {
        name: "backlash",
        family: Family::Backlash,
        formula: "play(x; r) − x",
        dimension: Dimension::POSITION,
        parity: Parity::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T {
        let x = at.motion.position;
        let before = state.memory.map_or(x, |[play, ..]| play);
        let play = clamp(before, x - self.r, x + self.r);
        state.memory = Some([play, T::zero(), T::zero(), T::zero()]);
        play - x
    }
}

shaped! {
    /// A spring with a gap around zero.
    ///
    /// ```
    /// use bowden::{effect::backlash::DeadZone, Error};
    /// assert_eq!(DeadZone::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(DeadZone::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    DeadZone {
        /// Half of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for DeadZone<T> {
    const INFO: &'static Info = &Info {
        name: "dead-zone",
        family: Family::Backlash,
        formula: "x − clamp(x, −r, r)",
        dimension: Dimension::POSITION,
        parity: Parity::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.motion.position - clamp(at.motion.position, -self.r, self.r)
    }
}
