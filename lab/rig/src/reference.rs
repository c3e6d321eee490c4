//! Torque references for the joint, with their derivatives.

use bowden::effect::Motion;
use bowden::Real;

/// A torque reference: a mean and two sinusoids (Nguyen et al., 2018), or the push-off of a gait. A
/// ramp at the start is optional.
///
/// The reference of the paper is `25 + 10·sin(2·pi·0.25·t) + 3·sin(2·pi·0.2·sqrt(3)·t)` \[N·m\]
/// (section 4.2, Figure 7). Its maximum is 38 N·m.
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
    /// The resting value or the mean \[N·m\].
    mean: T,
    task: Task<T>,
    ramp: T,
}

/// The part that is added to the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Task<T> {
    /// Amplitude \[N·m\] and angular frequency \[rad/s\].
    Tones([(T, T); 2]),
    /// A push-off of this height once per second \[N·m\].
    Push(T),
}

/// Start, peak and end of a push-off \[s\], in a cycle of one second.
const PUSH: [f64; 3] = [0.2, 0.5, 0.65];

impl<T: Real> Reference<T> {
    /// The reference of Nguyen et al. (2018), with its full value from the first sample.
    #[must_use]
    pub fn paper() -> Self {
        let turn = 2.0 * core::f64::consts::PI;
        Self {
            mean: T::from_f64(25.0),
            task: Task::Tones([
                (T::from_f64(10.0), T::from_f64(turn * 0.25)),
                (
                    T::from_f64(3.0),
                    T::from_f64(turn * 0.2 * Real::sqrt(3.0_f64)),
                ),
            ]),
            ramp: T::zero(),
        }
    }

    /// The gait of an ankle with one step per second: 5 N·m, plus a push-off of 30 N·m. The
    /// push-off rises from 0.2 to 0.5 of the cycle and ends at 0.65. It follows fifth-order
    /// polynomials with continuous first and second derivatives.
    ///
    /// ```
    /// use bowden_rig::Reference;
    /// let gait = Reference::<f64>::gait();
    /// assert_eq!((gait.at(3.1), gait.at(3.5), gait.at(3.7)), (5.0, 35.0, 5.0));
    /// assert_eq!((gait.period(), Reference::<f64>::paper().period()), (Some(1.0), None));
    /// ```
    #[must_use]
    pub fn gait() -> Self {
        Self {
            mean: T::from_f64(5.0),
            task: Task::Push(T::from_f64(30.0)),
            ramp: T::zero(),
        }
    }

    /// Period \[s\], or `None` for the reference of Nguyen et al. (2018), which is not periodic.
    #[must_use]
    pub fn period(&self) -> Option<T> {
        match self.task {
            Task::Tones(_) => None,
            Task::Push(_) => Some(T::one()),
        }
    }

    /// The reference with a smooth rise from zero in the first `seconds` \[s\].
    ///
    /// The factor is `x²·(3 − 2·x)`, where x is the fraction of this time. If `seconds` is not
    /// positive, there is no ramp.
    #[must_use]
    pub fn with_ramp(self, seconds: T) -> Self {
        let ramp = if seconds > T::zero() && seconds.is_finite() {
            seconds
        } else {
            T::zero()
        };
        Self { ramp, ..self }
    }

    /// The reference, shifted and scaled to the range from `low` to `high` \[N·m\].
    ///
    /// If the two values are not finite or not in ascending order, the reference does not change.
    ///
    /// ```
    /// use bowden_rig::Reference;
    /// let small = Reference::<f64>::paper().between(-4.0, 9.0);
    /// assert!((small.at(0.0) - 2.5).abs() < 1e-12 && (small.maximum() - 9.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn between(&self, low: T, high: T) -> Self {
        let half = T::from_f64(0.5) * (high - low);
        let factor = half / (T::from_f64(0.5) * (self.maximum() - self.minimum()));
        let (mean, task) = match self.task {
            Task::Tones(tones) => {
                let tones = tones.map(|(amplitude, w)| (factor * amplitude, w));
                (low + half, Task::Tones(tones))
            }
            Task::Push(height) => (low, Task::Push(factor * height)),
        };
        if !(half > T::zero() && mean.is_finite() && factor.is_finite()) {
            return *self;
        }
        Self {
            mean,
            task,
            ..*self
        }
    }

    /// The largest value \[N·m\].
    #[must_use]
    pub fn maximum(&self) -> T {
        match &self.task {
            Task::Tones(tones) => tones.iter().fold(self.mean, |sum, (a, _)| sum + *a),
            Task::Push(height) => self.mean + *height,
        }
    }

    /// The smallest value \[N·m\].
    fn minimum(&self) -> T {
        match &self.task {
            Task::Tones(tones) => tones.iter().fold(self.mean, |sum, (a, _)| sum - *a),
            Task::Push(_) => self.mean,
        }
    }

    /// The largest magnitude \[N·m\].
    ///
    /// ```
    /// use bowden_rig::Reference;
    /// let pulled = Reference::<f64>::paper().between(-50.0, -10.0);
    /// assert!((pulled.maximum() + 10.0).abs() < 1e-12 && (pulled.magnitude() - 50.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn magnitude(&self) -> T {
        self.maximum().abs().max(self.minimum().abs())
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
        match self.task {
            Task::Tones(tones) => {
                for (amplitude, w) in tones {
                    let (s, c) = ((w * t).sin(), (w * t).cos());
                    full.position += amplitude * s;
                    full.velocity += amplitude * w * c;
                    full.acceleration -= amplitude * w * w * s;
                }
            }
            Task::Push(height) => {
                let push = push(t);
                full.position += height * push.position;
                full.velocity = height * push.velocity;
                full.acceleration = height * push.acceleration;
            }
        }
        if t >= self.ramp {
            return full;
        }
        let x = (t / self.ramp).max(T::zero());
        let (two, three, six) = (T::from_f64(2.0), T::from_f64(3.0), T::from_f64(6.0));
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

/// A push-off of height one, in a cycle of one second.
fn push<T: Real>(t: T) -> Motion<T> {
    let [start, highest, end] = PUSH.map(T::from_f64);
    let into = t - t.floor();
    let (since, length) = if into < highest {
        (into - start, highest - start)
    } else {
        (end - into, end - highest)
    };
    let x = (since / length).max(T::zero());
    // `10·x³ - 15·x⁴ + 6·x⁵` from 0 to 1; the second half runs backwards.
    let (one, two) = (T::one(), T::from_f64(2.0));
    let sign = if into < highest { one } else { -one };
    let rate = T::from_f64(30.0) * x * x * (one - x) * (one - x) / length;
    let curvature = T::from_f64(60.0) * x * (one - x) * (one - two * x) / (length * length);
    Motion {
        position: x * x * x * (T::from_f64(10.0) - x * (T::from_f64(15.0) - T::from_f64(6.0) * x)),
        velocity: sign * rate,
        acceleration: curvature,
    }
}
