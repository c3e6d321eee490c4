//! Nominal parameters with tolerances of the plant between command and measured output.

use super::interval::{Plane, Span};
use super::Interval;
use crate::checked::not_negative;
use bowden::Error;

/// Range of the plant between command and measured output: nominal parameters with tolerances.
///
/// ```text
/// P~(s) = f·alpha·e^(−theta·s)/(1 + f·(s²/wn² + 2·zeta·s/wn)/(1 + c/K·s))
/// ```
/// With `f = 1` and `c/K = 0` the plant is the [`NominalPlant`](bowden::control::NominalPlant) with
/// a delay. A damping c of the joint, parallel to its stiffness K, provides phase lead. A c/K of
/// 3 ms compensates for 3 ms of latency. Along a hysteresis loop, the output of the cable changes
/// by f times the change of its input, so the motor drives a stiffness of K/f.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlantRange {
    /// alpha \[output unit/command unit\], with the sign of the nominal alpha.
    pub gain: Interval<f64>,
    /// wn \[rad/s\], positive.
    pub natural_frequency: Interval<f64>,
    /// zeta of the drive by itself, not negative.
    pub damping_ratio: Interval<f64>,
    /// c/K of the joint \[s\], not negative.
    pub joint: Interval<f64>,
    /// f, positive. Without hysteresis, f is 1. With hysteresis in torque mode and a positive
    /// kappa_eta, f ranges from `1 − 2·kappa_eta·sigma·rho/B` to 1.
    pub slope: Interval<f64>,
    /// theta \[s\], not negative: the sum of the delay, half a sample for the zero-order hold, and
    /// the lags of the drive and the sensor.
    pub latency: Interval<f64>,
}

impl PlantRange {
    pub(super) fn check(&self) -> Result<(), Error> {
        self.gain.ordered("gain")?;
        if self.gain.low <= 0.0 && self.gain.high >= 0.0 {
            return Err(Error::OutOfRange("gain"));
        }
        self.natural_frequency.above_zero("natural_frequency")?;
        self.slope.above_zero("slope")?;
        for (interval, name) in [
            (&self.damping_ratio, "damping_ratio"),
            (&self.joint, "joint"),
            (&self.latency, "latency"),
        ] {
            interval.ordered(name)?;
            not_negative(interval.low, name)?;
        }
        Ok(())
    }

    /// The parameters, in the order of the fields.
    fn parameters(&mut self) -> [&mut Span; 6] {
        [
            &mut self.gain,
            &mut self.natural_frequency,
            &mut self.damping_ratio,
            &mut self.joint,
            &mut self.slope,
            &mut self.latency,
        ]
    }

    /// The range whose parameters are `of` the parameters of this range and of another.
    fn with(mut self, mut other: Self, of: impl Fn(Span, Span) -> Span) -> Self {
        for (own, other) in self.parameters().into_iter().zip(other.parameters()) {
            *own = of(*own, *other);
        }
        self
    }

    /// The plants without latency, joint and hysteresis.
    pub(super) fn plain(self) -> Self {
        let zero = Span::exactly(0.0);
        Self {
            joint: zero,
            slope: Span::exactly(1.0),
            latency: zero,
            ..self
        }
    }

    /// The plant in the middle of the range.
    pub(super) fn middle(self) -> Self {
        self.with(self, |own, _| Span::exactly(own.middle()))
    }

    /// These plants, the other plants, and all plants between them.
    pub(super) fn hull(self, other: Self) -> Self {
        self.with(other, |a, b| Span {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        })
    }

    /// Between two plants, at a fraction of the path.
    pub(super) fn between(self, other: Self, part: Span) -> Self {
        self.with(other, |a, b| a.towards(b, part))
    }

    /// `f/wn²` and `f·2·zeta/wn + c/K`.
    pub(super) fn denominator(&self) -> (Span, Span) {
        let slow = self.natural_frequency.recip();
        let rate = Span::exactly(2.0) * self.damping_ratio * slow;
        (self.slope * slow.square(), self.slope * rate + self.joint)
    }

    /// D~ at the frequencies w.
    pub(super) fn drive(&self, w: Span) -> Plane {
        let (curvature, rate) = self.denominator();
        Plane::new(Span::exactly(1.0) - curvature * w.square(), rate * w)
    }

    /// `f·alpha~·(1 + c/K·s)·e^(−theta·s)` at the frequencies w.
    pub(super) fn cable(&self, w: Span) -> Plane {
        let joint = Plane::new(Span::exactly(1.0), self.joint * w);
        (joint * Plane::late(self.latency * w)).times(self.gain * self.slope)
    }

    /// Lower bound on `|D~|/|s|²` and upper bound on `f·alpha~·|1 + c/K·s|/|s|²`, for all
    /// `|s| >= 1/x` in the right half-plane.
    pub(super) fn shares(&self, x: Span) -> (Span, Span) {
        let (curvature, rate) = self.denominator();
        let gain = Span::exactly(self.gain.magnitude()) * Span::exactly(self.slope.high);
        let least = Span::exactly(curvature.low) - x * (Span::exactly(rate.high) + x);
        (least, gain * x * (Span::exactly(self.joint.high) + x))
    }

    /// The two halves along the parameter that changes F most, and the size of this change.
    pub(super) fn halves(&self, frequency: f64) -> (f64, [Self; 2]) {
        let share = |span: Span| span.width() / span.middle().abs();
        self.largest([
            share(self.gain),
            2.0 * share(self.natural_frequency),
            self.damping_ratio.width(),
            self.joint.width() * frequency,
            share(self.slope),
            self.latency.width() * frequency,
        ])
    }

    /// The two halves along the parameter with the largest size, and that size.
    pub(super) fn largest(&self, sizes: [f64; 6]) -> (f64, [Self; 2]) {
        let most = sizes.iter().fold(0.0_f64, |m, x| m.max(*x));
        let widest = sizes.iter().position(|x| *x >= most).unwrap_or(5);
        let (mut first, mut second) = (*self, *self);
        let (own, other) = (first.parameters(), second.parameters());
        let split = own.into_iter().zip(other).nth(widest);
        if let Some((low, high)) = split {
            [*low, *high] = low.halves();
        }
        (most, [first, second])
    }

    /// Routh's criterion for `s·D~ + alpha~·(k_p·s + k_i)`, or for `D~ + alpha~·k_p`: plants
    /// without latency, joint and hysteresis, with a P or PI.
    pub(super) fn is_stable_with(&self, k_p: f64, k_i: f64) -> bool {
        let (curvature, rate) = self.denominator();
        let one = Span::exactly(1.0) + self.gain * Span::exactly(k_p);
        let integral = self.gain * Span::exactly(k_i);
        let margin = rate * one - curvature * integral;
        let holds = rate.low > 0.0 && one.low > 0.0;
        holds && (k_i == 0.0 || (integral.low > 0.0 && margin.low > 0.0))
    }
}
