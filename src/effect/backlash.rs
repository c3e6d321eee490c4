//! Backlash and dead zone: a gap in which nothing is transmitted.

use super::info::{Info, Regressor, Stage};
use super::shaped::shaped;
use super::Parity::{Even, Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::signal::clamp;
use crate::Real;

shaped! {
    /// The play operator of half-width `r` minus its input; it starts in mid-gap.
    ///
    /// Formulas: `play(x; r) − x`, the effect of a gap of half-width r, and `x − clamp(x, −r, r)`,
    /// a spring with a gap around zero. After each reversal the play output is constant over the
    /// distance 2·r. In series, the same play acts on the transmission's input: the hysteresis and
    /// the gain then act on `play(x; r)` instead of x.
    ///
    /// `play(x; r) − x` is `−stop(x; r)`, which is [`Presliding`](super::Presliding) times −r. No
    /// record can distinguish the two.
    ///
    /// Source: M. Nordin, P.-O. Gutman, "Controlling mechanical systems with backlash
    /// — a survey", *Automatica* 38(10), 2002; for the play, M. A. Krasnosel'skii,
    /// A. V. Pokrovskii, *Systems with Hysteresis*, 1989.
    ///
    /// ```
    /// use bowden::{effect::Backlash, Error};
    /// assert_eq!(Backlash::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(Backlash::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    Backlash {
        /// Half-width of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for Backlash<T> {
    const INFO: &'static Info = &Info {
        name: "backlash",
        family: Family::Backlash,
        formula: "play(x; r) − x",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let x = at.motion.position;
        let before = state.memory.map_or(x, |[play, ..]| play);
        let play = clamp(before, x - self.r, x + self.r);
        state.memory = Some([play, T::zero(), T::zero(), T::zero()]);
        play - x
    }
}

shaped! {
    /// Play in series: slack between the measured input and the transmission.
    ///
    /// This effect is an input stage (see
    /// [`Effect::is_input_stage`](super::Effect::is_input_stage)). With a gain of 1, the
    /// transmission receives `play(x; r)`; with a lower gain, part of the gap is bridged. The play
    /// starts in mid-gap.
    ///
    /// Formula: `play(x; r) − x, added to the input`; source: [`Backlash`](super::Backlash).
    ///
    /// ```
    /// use bowden::{effect::PlayInSeries, Error};
    /// assert_eq!(PlayInSeries::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(PlayInSeries::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    PlayInSeries {
        /// Half-width of the gap \[input unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for PlayInSeries<T> {
    const INFO: &'static Info = &Info {
        name: "play-in-series",
        formula: "play(x; r) − x, added to the input",
        ..*<Backlash<T> as Regressor<T>>::INFO
    };
    const STAGE: Stage = Stage::Input;

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        Backlash { r: self.r }.value(state, at)
    }
}

shaped! {
    /// A spring with a gap around zero.
    ///
    /// Formula: `x − clamp(x, −r, r)`; source: [`Backlash`](super::Backlash).
    ///
    /// ```
    /// use bowden::{effect::DeadZone, Error};
    /// assert_eq!(DeadZone::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(DeadZone::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    DeadZone {
        /// Half-width of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for DeadZone<T> {
    const INFO: &'static Info = &Info {
        name: "dead-zone",
        family: Family::Backlash,
        formula: "x − clamp(x, −r, r)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position - clamp(at.motion.position, -self.r, self.r)
    }
}
