//! Effects with memory: backlash, presliding, degradation, creep, hardening, lag and delay.

use super::bounds::{add, saturate};
use super::declare::effect;
use super::{Dimension, EffectState, Inputs};
use crate::signal::clamp;
use crate::Real;

effect! {
    /// Backlash: the play operator with half-width `r`, minus its input.
    ///
    /// Formula: `play(x; r) − x`. The play starts in mid-gap. After each reversal, its output is
    /// constant over the distance 2·r.
    ///
    /// This effect equals [`Presliding`](super::Presliding) times −r, because `play(x; r) − x` is
    /// `−stop(x; r)`. No record can distinguish the two.
    ///
    /// Source: M. Nordin, P.-O. Gutman, "Controlling mechanical systems with backlash
    /// — a survey", *Automatica* 38(10), 2002; for the play, M. A. Krasnosel'skii,
    /// A. V. Pokrovskii, *Systems with Hysteresis*, 1989.
    ///
    /// ```
    /// use bowden::{effect::Backlash, Error};
    /// assert!(Backlash::try_new(0.5).is_ok());
    /// assert_eq!(Backlash::try_new(0.0), Err(Error::OutOfRange("r")));
    /// ```
    Backlash {
        /// Half-width of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
    "backlash" in "backlash": "play(x; r) − x", Dimension::POSITION, reads Position, memory;
    value(it, state, at) = {
        let x = at.motion.position;
        let before = state.memory.map_or(x, |[play, ..]| play);
        let play = clamp(before, x - it.r, x + it.r);
        state.memory = Some([play, T::zero(), T::zero(), T::zero()]);
        play - x
    };
}

effect! {
    /// Backlash between the measured input and the transmission.
    ///
    /// This effect is an input stage (see
    /// [`Effect::is_input_stage`](super::Effect::is_input_stage)). With a gain of 1, the
    /// transmission receives `play(x; r)` instead of x. A gain below 1 describes a gap that is
    /// partly bridged. The play starts in mid-gap.
    ///
    /// Formula: `play(x; r) − x, added to the input`. Source: see [`Backlash`](super::Backlash).
    ///
    /// ```
    /// use bowden::{effect::PlayInSeries, Error};
    /// assert!(PlayInSeries::try_new(0.5).is_ok());
    /// assert_eq!(PlayInSeries::try_new(0.0), Err(Error::OutOfRange("r")));
    /// ```
    PlayInSeries {
        /// Half-width of the gap \[input unit\].
        r: Positive, Dimension::POSITION;
    }
    "play-in-series" in "backlash": "play(x; r) − x, added to the input", Dimension::POSITION, stage Input, reads Position, memory;
    value(it, state, at) = Backlash { r: it.r }.value(state, at);
}

effect! {
    /// A spring with a gap around zero.
    ///
    /// Formula: `x − clamp(x, −r, r)`. Source: see [`Backlash`](super::Backlash).
    ///
    /// ```
    /// use bowden::{effect::DeadZone, Error};
    /// assert!(DeadZone::try_new(0.5).is_ok());
    /// assert_eq!(DeadZone::try_new(0.0), Err(Error::OutOfRange("r")));
    /// ```
    DeadZone {
        /// Half-width of the gap \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
    "dead-zone" in "backlash": "x − clamp(x, −r, r)", Dimension::POSITION, reads Position;
    value(it, _, at) = at.motion.position - clamp(at.motion.position, -it.r, it.r);
}

effect! {
    /// Presliding friction: the stop operator with half-width `r` and unit height.
    ///
    /// Formula: `s/r` with `s ← clamp(s + dx, −r, r)`, the elastic-perfectly plastic stop of
    /// Prandtl. The state starts at s = 0. The area of the loop is `4·(X − r)` for a cycle of
    /// amplitude X > r, and 0 for a smaller cycle. This effect equals [`Backlash`](super::Backlash)
    /// with the same r, divided by −r.
    ///
    /// Source: L. Prandtl, 1928; P. R. Dahl, *A Solid Friction Model*, 1968; for stops in parallel,
    /// F. Al-Bender, V. Lampaert, J. Swevers, "The generalized Maxwell-slip model", *IEEE
    /// Transactions on Automatic Control* 50(11), 2005.
    ///
    /// ```
    /// use bowden::{effect::Presliding, Error};
    /// assert!(Presliding::try_new(0.5).is_ok());
    /// assert_eq!(Presliding::try_new(0.0), Err(Error::OutOfRange("r")));
    /// ```
    Presliding {
        /// Displacement at which the spring slips \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
    "presliding" in "presliding": "stop(x; r)/r", Dimension::ONE, reads Position, memory;
    value(it, state, at) = {
        let x = at.motion.position;
        let [before, stretch, ..] = state.memory.unwrap_or(fresh(x));
        let stretch = clamp(stretch + (x - before), -it.r, it.r);
        state.memory = Some([x, stretch, T::zero(), T::zero()]);
        stretch / it.r
    };
}

effect! {
    /// Presliding friction with a gradual transition to slip: the Dahl model with length `r` and
    /// unit height.
    ///
    /// Formula: `dahl(x; r)`, the state z of Dahl's equation with exponent 1,
    /// `dz/dx = (1 − z·sgn dx)/r`. The state starts at `z = 0`. If x is monotonic between two
    /// samples, the step `z ← sgn dx + (z − sgn dx)·exp(−|dx|/r)` is exact for any dx. In a cycle
    /// of amplitude X, z moves between ±tanh(X/r), and the area of the loop is
    /// `4·(X − r·tanh(X/r))`.
    ///
    /// Source: see [`Presliding`](super::Presliding).
    ///
    /// ```
    /// use bowden::{effect::PreslidingDahl, Error};
    /// assert!(PreslidingDahl::try_new(0.5).is_ok());
    /// assert_eq!(PreslidingDahl::try_new(0.0), Err(Error::OutOfRange("r")));
    /// ```
    PreslidingDahl {
        /// Distance over which z completes 63 % of its change \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
    "presliding-dahl" in "presliding": "dahl(x; r)", Dimension::ONE, reads Position, memory;
    value(it, state, at) = {
        let x = at.motion.position;
        let [before, z, carry, _] = state.memory.unwrap_or(fresh(x));
        let change = x - before;
        let share = -(-change.abs() / it.r).exp_m1();
        let end = if change < T::zero() {
            -T::one()
        } else {
            T::one()
        };
        let [z, carry] = add([z, carry], (end - z) * share);
        // Rounding alone stays within ±1; a stored state may not.
        let z = clamp(z, -T::one(), T::one());
        state.memory = Some([x, z, carry, T::zero()]);
        z
    };
}

/// The memory at the first sample: the spring is not deflected.
fn fresh<T: Real>(x: T) -> [T; 4] {
    [x, T::zero(), T::zero(), T::zero()]
}

effect! {
    /// A hysteresis loop that changes with the accumulated work and then settles.
    ///
    /// Formula: `eta·(1 − exp(−W/w_c))` with `W = ∫|eta|·|dx|`, where x is the transmission's
    /// input, whatever the source of the term. The integral uses the trapezoidal rule and starts at
    /// the first sample. For W ≪ w_c the regressor is approximately `eta·W/w_c`. For large W, it
    /// approaches `eta`, so the loop stays bounded after running-in.
    ///
    /// Source: T. T. Baber, Y.-K. Wen, "Random vibration of hysteretic, degrading systems",
    /// *Journal of the Engineering Mechanics Division* 107(6), 1981 (linear in the work).
    ///
    /// ```
    /// use bowden::{effect::Degradation, Error};
    /// assert!(Degradation::try_new(40.0).is_ok());
    /// assert_eq!(Degradation::try_new(0.0), Err(Error::OutOfRange("w_c")));
    /// ```
    Degradation {
        /// Work after which the change reaches 63 % \[input unit\].
        w_c: Positive, Dimension { input: 1, ..Dimension::ONE };
    }
    "degradation" in "degradation": "eta·(1−exp(−∫|eta|·|dx|/w_c))", Dimension::ONE, reads Eta Input, memory;
    value(it, state, at) = {
        let (x, eta) = (at.input.position, at.eta);
        let fresh = [x, eta, T::zero(), T::zero()];
        let [x_before, eta_before, work, carry] = state.memory.unwrap_or(fresh);
        let path = (x - x_before).abs();
        let mean = eta.abs() * T::from_f64(0.5) + eta_before.abs() * T::from_f64(0.5);
        let [work, carry] = add([work, carry], saturate(mean * path));
        state.memory = Some([x, eta, work, carry]);
        -eta * (-work / it.w_c).exp_m1()
    };
}

effect! {
    /// Creep: x, filtered by a first-order low-pass.
    ///
    /// Formula: `lowpass(x; tau)`, a Kelvin-Voigt element. The initial state is the first x.
    /// Several elements with time constants a decade apart approximate the logarithmic creep of
    /// polymers and piezo stacks. In `f32`, rounding errors limit the useful tau/dt, as for a
    /// [`Lag`](super::Lag).
    ///
    /// Source: P. Krejčí, K. Kuhnen, "Inverse control of systems with hysteresis and
    /// creep", *IEE Proceedings — Control Theory and Applications* 148(3), 2001.
    ///
    /// ```
    /// use bowden::{effect::Creep, Error};
    /// assert!(Creep::try_new(0.5).is_ok());
    /// assert_eq!(Creep::try_new(0.0), Err(Error::OutOfRange("tau")));
    /// ```
    Creep {
        /// Time constant \[s\].
        tau: Positive, Dimension::TIME;
    }
    "creep" in "creep": "lowpass(x; tau)", Dimension::POSITION, reads Position Dt, memory;
    value(it, state, at) = low_pass(state, at.motion.position, || it.share(at.dt));

    #[inline]
    fn share(&self, dt: T) -> T {
        held_share(self.tau, dt)
    }

    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, share: T) -> T {
        low_pass(state, at.motion.position, || share)
    }
}

/// The reciprocal of the channel unit.
const PER_POSITION: Dimension = Dimension {
    channel: -1,
    ..Dimension::ONE
};

effect! {
    /// Hardening hysteresis, whose slope increases with its state.
    ///
    /// Formula: `w(x; g, beta)`. While the state w moves away from zero, `dw/dx = 1 + g·|w|`. While
    /// w returns to zero, `dw/dx = 1 + (g + 2·beta)·|w|`. At the first sample, w = 0. The state w
    /// has the unit of x, so the gain is the initial stiffness.
    ///
    /// In the Bouc-Wen form `z' = A·x' − b·|x'|·|z|^(n−1)·z − c·x'·|z|^n`, this effect has n = 1,
    /// `z = A·w`, `b = beta` and `b + c = −g`. A [`BoucWen`](crate::hysteresis::BoucWen) has
    /// `b + c > 0` and `sigma = b/(b + c)`.
    ///
    /// # Bounds
    /// - For `b + c > 0` (a `BoucWen`), `|z| ≤ (A/(b + c))^(1/n)` for any motion.
    /// - For `b + c < 0`, only a limited stroke bounds w. If x stays within a range of length R,
    ///   `|w| ≤ (exp(g·R) − 1)/g` for any distance travelled. Proof: the curve
    ///   `U(x) = (exp(g·(x − x_min)) − 1)/g` has `U' = 1 + g·U`. At w = U, the state rises with the
    ///   same slope and falls with the steeper slope `1 + (g + 2·beta)·w`. Therefore w never
    ///   exceeds U. The same holds for negative w. The proof requires `beta > 0`: with `beta < 0`,
    ///   small reversals would increase w without limit.
    /// - A cycle generates no energy, because the return branch lies below the outward branch.
    ///
    /// If x is monotonic between two samples, the step is exact for any dx.
    ///
    /// Source: Y. K. Wen, "Method for random vibration of hysteretic systems", *Journal of the
    /// Engineering Mechanics Division* 102(2), 1976; F. Ikhouane, J. Rodellar, *Systems with
    /// Hysteresis*, 2007, table 2.1 (classes). The benchmark of J. P. Noël, M. Schoukens,
    /// "Hysteretic benchmark with a dynamic nonlinearity", *Workshop on Nonlinear System
    /// Identification Benchmarks*, 2016, has A = 5e4 N/m, b = 800 1/m and c = −1100 1/m. The
    /// corresponding parameters are `g = 300` and `beta = 800` in 1/m.
    ///
    /// ```
    /// use bowden::{effect::Hardening, Error};
    /// assert!(Hardening::try_new(300.0, 800.0).is_ok());
    /// assert_eq!(Hardening::try_new(300.0, -800.0), Err(Error::OutOfRange("beta")));
    /// ```
    Hardening {
        /// Increase of the slope with the state \[1/channel unit\].
        g: Positive, PER_POSITION;
        /// Half of the additional increase while w returns to zero \[1/channel unit\].
        beta: Positive, PER_POSITION;
    }
    "hardening" in "hardening": "w(x; g, beta)", Dimension::POSITION, reads Position, memory;
    value(it, state, at) = {
        let (zero, x) = (T::zero(), at.motion.position);
        let [before, w, ..] = state.memory.unwrap_or([x, zero, zero, zero]);
        let change = saturate(x - before);
        // Along the motion: negative on the return, positive away from zero.
        let sense = if change < zero { -T::one() } else { T::one() };
        let (along, path) = (sense * w, change.abs());
        let next = if along < zero {
            let back = it.g + it.beta + it.beta;
            // The path to zero, from `da/dp = −(1 + back·a)`.
            let home = (back * -along).ln_1p() / back;
            if path < home {
                -grown(-along, back, -path)
            } else {
                grown(zero, it.g, path - home)
            }
        } else {
            grown(along, it.g, path)
        };
        let w = saturate(sense * saturate(next));
        state.memory = Some([x, w, zero, zero]);
        w
    };
}

/// The solution of `da/dp = 1 + rate·a` from a ≥ 0 after a path p ≥ 0.
#[inline]
fn grown<T: Real>(a: T, rate: T, p: T) -> T {
    let growth = (rate * p).exp_m1();
    a + growth * (a + T::one() / rate)
}

effect! {
    /// First-order lag of the output.
    ///
    /// Formula: `lowpass(output; tau) − output`. With a gain of 1, the new output is the filtered
    /// output. The initial state is the first output. The filter uses a zero-order hold, so its
    /// step response is exact for any dt. Because of rounding errors, the state does not quite
    /// reach its target. The relative error is up to `tau/dt` times half the machine epsilon. In
    /// `f32`, this error is 0.06 % at a tau/dt of 10^4 and 6 % at 10^6.
    ///
    /// This effect is an output stage: it reads the sum of all terms before it.
    ///
    /// Source: K. J. Åström, R. M. Murray, *Feedback Systems*, 2008, chapter 8.
    ///
    /// ```
    /// use bowden::{effect::Lag, Error};
    /// assert!(Lag::try_new(0.5).is_ok());
    /// assert_eq!(Lag::try_new(0.0), Err(Error::OutOfRange("tau")));
    /// ```
    Lag {
        /// Time constant \[s\].
        tau: Positive, Dimension::TIME;
    }
    "lag" in "lag": "lowpass(output; tau) − output", Dimension::OUTPUT, reads Output Dt, memory;
    value(it, state, at) = low_pass(state, at.output, || it.share(at.dt)) - at.output;

    #[inline]
    fn share(&self, dt: T) -> T {
        held_share(self.tau, dt)
    }

    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, share: T) -> T {
        low_pass(state, at.output, || share) - at.output
    }
}

/// Fraction of the distance to a constant input that a first-order low-pass covers in one step:
/// `1 − exp(−dt/tau)`.
#[inline]
fn held_share<T: Real>(tau: T, dt: T) -> T {
    -(-dt / tau).exp_m1()
}

/// First-order low-pass with a zero-order hold: `level += share·(input − level)`.
#[inline]
fn low_pass<T: Real>(state: &mut EffectState<T>, input: T, share: impl FnOnce() -> T) -> T {
    let level = match state.memory {
        None => input,
        Some([level, ..]) => saturate(level + share() * saturate(input - level)),
    };
    state.memory = Some([level, T::zero(), T::zero(), T::zero()]);
    level
}

effect! {
    /// A pure delay of the output, which widens the loop as the frequency rises.
    ///
    /// The gain is the delay T \[s\]. The output passes through the first-order all-pass filter
    /// `z_k = y_{k−1} + c·(y_k − z_{k−1})` with `c = (dt − T)/(dt + T)`. The filter has magnitude 1
    /// at every frequency, and is exact for `T = dt`. At a low angular frequency w, the relative
    /// error of the delay is at most `(w·T)²/12` or, if T is less than dt, `(w·dt)²/12`. The first
    /// sample is not delayed. A negative T advances the output by the first-order term of its
    /// Taylor series.
    ///
    /// The regressor is the derivative with respect to T at T = 0, `−d(output)/dt`, computed as a
    /// backward difference. This effect is an output stage: it reads the sum of all terms before
    /// it.
    ///
    /// Source: J. P. Thiran, "Recursive digital filters with maximally flat group delay", *IEEE
    /// Transactions on Circuit Theory* 18(6), 1971 (order 1); for the regressor, the Taylor
    /// expansion `y(t − T) = y − T·dy/dt`, K. J. Åström, R. M. Murray, *Feedback Systems*, 2008,
    /// chapter 9.
    Delay;
    "delay" in "delay": "−d(output)/dt", Dimension { output: 1, time: -1, ..Dimension::ONE }, reads Output Dt, memory;
    value(_, state, at) = {
        let Some([before, ..]) = state.memory else {
            state.memory = Some([at.output, at.output, T::zero(), T::zero()]);
            return T::zero();
        };
        if at.dt == T::zero() {
            return T::zero();
        }
        state.memory = Some([at.output, at.output, T::zero(), T::zero()]);
        (before - at.output) / at.dt
    };

    /// The delayed output minus the output.
    #[inline]
    fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let late = match state.memory {
            Some([before, late, ..]) if gain > T::zero() => {
                if at.dt == T::zero() {
                    return late - before;
                }
                let c = (at.dt - gain) / (at.dt + gain);
                saturate(before + c * saturate(at.output - late))
            }
            _ => return gain * saturate(self.value(state, at)),
        };
        state.memory = Some([at.output, late, T::zero(), T::zero()]);
        late - at.output
    }
}
