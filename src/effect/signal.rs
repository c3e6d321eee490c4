//! Effects that are simple functions of one signal, such as offset, inertia and drift.

use super::declare::effect;
use super::Dimension;
use core::f64::consts::TAU;

effect! {
    /// A constant offset of the sensor or of the load.
    ///
    /// Formula: `1`.
    ///
    /// Source: L. Ljung, *System Identification*, 1999.
    Offset;
    "offset" in "offset": "1", Dimension::ONE, reads;
    value(_, _, _) = T::one();
}

effect! {
    /// A gain error: an output proportional to the load.
    ///
    /// Formula: `load`.
    ///
    /// Source: L. Ljung, *System Identification*, 1999.
    Gain;
    "gain" in "gain": "load", Dimension::LOAD, reads Load;
    value(_, _, at) = at.load;
}

effect! {
    /// Inertia: an output proportional to the acceleration.
    ///
    /// Formula: `a`.
    ///
    /// Source: I. Newton, *Principia*, 1687; as an identification regressor,
    /// W. Khalil, E. Dombre, *Modeling, Identification and Control of Robots*, 2002.
    Inertia;
    "inertia" in "inertia": "a", Dimension { channel: 1, time: -2, ..Dimension::ONE }, reads Acceleration;
    value(_, _, at) = at.motion.acceleration;
}

effect! {
    /// Drift: an output proportional to the time since the start.
    ///
    /// Formula: `t`.
    ///
    /// Source: J. S. Bendat, A. G. Piersol, *Random Data*, 2010, chapter 10 (trend
    /// removal).
    Drift;
    "drift" in "drift": "t", Dimension::TIME, reads Time;
    value(_, _, at) = at.time;
}

effect! {
    /// A sinusoid in time, independent of the measured signals.
    ///
    /// Formula: `sin(2·pi·f·t + psi)`.
    ///
    /// Source: J. S. Bendat, A. G. Piersol, *Random Data*, 2010, chapter 5.
    ///
    /// ```
    /// use bowden::{effect::Tone, Error};
    /// assert!(Tone::try_new(0.5, 2.0).is_ok());
    /// assert_eq!(Tone::try_new(0.0, 2.0), Err(Error::OutOfRange("f")));
    /// ```
    Tone {
        /// Frequency \[Hz\].
        f: Positive, Dimension { time: -1, ..Dimension::ONE };
        /// Phase at t = 0 \[rad\].
        psi: Finite, Dimension::ONE;
    }
    "tone" in "tone": "sin(2·pi·f·t + psi)", Dimension::ONE, reads Time;
    value(it, _, at) = {
        let turns = it.f * at.time;
        (T::from_f64(TAU) * turns + it.psi).sin()
    };
}

effect! {
    /// A preload step at the time `t_s`.
    ///
    /// Formula: `1` if `t ≥ t_s`, otherwise 0.
    ///
    /// Source: for the effect of the preload, V. Agrawal, W. J. Peine, B. Yao, "Modeling
    /// of transmission characteristics across a cable-conduit system", *IEEE
    /// Transactions on Robotics* 26(5), 2010.
    ///
    /// ```
    /// use bowden::{effect::Pretension, Error};
    /// assert!(Pretension::try_new(0.5).is_ok());
    /// assert_eq!(Pretension::try_new(f64::NAN), Err(Error::NonFinite("t_s")));
    /// ```
    Pretension {
        /// Time of the step \[s\].
        t_s: Finite, Dimension::TIME;
    }
    "pretension" in "pretension": "1 where t ≥ t_s", Dimension::ONE, reads Time;
    value(it, _, at) = {
        if at.time >= it.t_s {
            T::one()
        } else {
            T::zero()
        }
    };
}

effect! {
    /// A linear dependence on the temperature.
    ///
    /// Formula: `x − t_ref`, where the channel x must be a temperature.
    ///
    /// Source: L. Simoni, M. Beschi, G. Legnani, A. Visioli, "Friction modeling with
    /// temperature effects for industrial robot manipulators", *IROS*, 2015.
    ///
    /// ```
    /// use bowden::{effect::Temperature, Error};
    /// assert!(Temperature::try_new(0.5).is_ok());
    /// assert_eq!(Temperature::try_new(f64::NAN), Err(Error::NonFinite("t_ref")));
    /// ```
    Temperature {
        /// Reference temperature \[channel unit\].
        t_ref: Finite, Dimension::POSITION;
    }
    "temperature" in "temperature": "x − t_ref", Dimension::POSITION, reads Position;
    value(it, _, at) = at.motion.position - it.t_ref;
}

effect! {
    /// Crosstalk: an output proportional to another channel.
    ///
    /// Formula: `x` of the other channel.
    ///
    /// Source: L. Ljung, *System Identification*, 1999 (systems with several inputs).
    Crosstalk;
    "crosstalk" in "crosstalk": "x of another channel", Dimension::POSITION, reads Position;
    value(_, _, at) = at.motion.position;
}
