//! Nominal parameters with tolerances of the plant between command and measured output.

use super::plant::ordered;
use super::span::Span;
use super::Interval;
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
    /// kappa_eta, f ranges from `1 − kappa_eta·rho·max(1, 2·sigma)/B` to 1.
    pub slope: Interval<f64>,
    /// theta \[s\], not negative: the sum of the delay, half a sample for the zero-order hold, and
    /// the lags of the drive and the sensor.
    pub latency: Interval<f64>,
}

/// Plants between bounds of every number, together with the observer's latency.
#[derive(Clone, Copy)]
pub(super) struct Plants {
    pub(super) gain: Span,
    pub(super) natural_frequency: Span,
    pub(super) damping_ratio: Span,
    pub(super) joint: Span,
    pub(super) slope: Span,
    pub(super) latency: Span,
    pub(super) observed: Span,
}

impl Plants {
    /// `f/wn²` and `f·2·zeta/wn + c/K`.
    pub(super) fn denominator(&self) -> (Span, Span) {
        let slow = self.natural_frequency.recip();
        let rate = Span::at(2.0) * self.damping_ratio * slow;
        (self.slope * slow.square(), self.slope * rate + self.joint)
    }

    /// The two halves along the parameter that changes F most, and the size of this change.
    pub(super) fn halves(&self, frequency: f64) -> (f64, [Self; 2]) {
        let share = |span: Span| span.width() / span.middle().abs();
        let sizes = [
            share(self.gain),
            2.0 * share(self.natural_frequency),
            self.damping_ratio.width(),
            self.joint.width() * frequency,
            share(self.slope),
            self.latency.width() * frequency,
        ];
        self.largest(sizes)
    }

    /// The two halves along the parameter with the largest size, and that size. The order is that
    /// of the fields of [`PlantRange`].
    pub(super) fn largest(&self, sizes: [f64; 6]) -> (f64, [Self; 2]) {
        let most = sizes.iter().fold(0.0_f64, |m, x| m.max(*x));
        let [gain, natural_frequency, damping_ratio, joint, slope, _] = sizes.map(|x| x >= most);
        let (mut first, mut second) = (*self, *self);
        let split = |low: &mut Span, high: &mut Span| [*low, *high] = low.halves();
        if gain {
            split(&mut first.gain, &mut second.gain);
        } else if natural_frequency {
            split(&mut first.natural_frequency, &mut second.natural_frequency);
        } else if damping_ratio {
            split(&mut first.damping_ratio, &mut second.damping_ratio);
        } else if joint {
            split(&mut first.joint, &mut second.joint);
        } else if slope {
            split(&mut first.slope, &mut second.slope);
        } else {
            split(&mut first.latency, &mut second.latency);
        }
        (most, [first, second])
    }

    /// Routh's criterion for `s·D~ + alpha~·(k_p·s + k_i)`, or for `D~ + alpha~·k_p`: plants
    /// without latency, joint and hysteresis, with a P or PI.
    pub(super) fn is_stable_with(&self, k_p: f64, k_i: f64) -> bool {
        let (curvature, rate) = self.denominator();
        let one = Span::at(1.0) + self.gain * Span::at(k_p);
        let integral = self.gain * Span::at(k_i);
        let margin = rate * one - curvature * integral;
        let holds = rate.low > 0.0 && one.low > 0.0;
        holds && (k_i == 0.0 || (integral.low > 0.0 && margin.low > 0.0))
    }

    /// The plant in the middle of the range.
    pub(super) fn middle(&self) -> Self {
        let middle = |span: Span| Span::at(span.middle());
        Self {
            gain: middle(self.gain),
            natural_frequency: middle(self.natural_frequency),
            damping_ratio: middle(self.damping_ratio),
            joint: middle(self.joint),
            slope: middle(self.slope),
            latency: middle(self.latency),
            observed: self.observed,
        }
    }

    /// These plants, the other plants, and all plants between them.
    pub(super) fn hull(&self, other: &Self) -> Self {
        let hull = |a: Span, b: Span| Span {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        };
        Self {
            gain: hull(self.gain, other.gain),
            natural_frequency: hull(self.natural_frequency, other.natural_frequency),
            damping_ratio: hull(self.damping_ratio, other.damping_ratio),
            joint: hull(self.joint, other.joint),
            slope: hull(self.slope, other.slope),
            latency: hull(self.latency, other.latency),
            observed: hull(self.observed, other.observed),
        }
    }

    /// Between two plants, at a fraction of the path.
    pub(super) fn between(&self, other: &Self, part: Span) -> Self {
        let mix = |a: Span, b: Span| a + (b - a) * part;
        Self {
            gain: mix(self.gain, other.gain),
            natural_frequency: mix(self.natural_frequency, other.natural_frequency),
            damping_ratio: mix(self.damping_ratio, other.damping_ratio),
            joint: mix(self.joint, other.joint),
            slope: mix(self.slope, other.slope),
            latency: mix(self.latency, other.latency),
            observed: mix(self.observed, other.observed),
        }
    }
}

impl PlantRange {
    pub(super) fn check(&self) -> Result<(), Error> {
        ordered(&self.gain, "gain")?;
        if self.gain.low <= 0.0 && self.gain.high >= 0.0 {
            return Err(Error::OutOfRange("gain"));
        }
        ordered(&self.natural_frequency, "natural_frequency")?;
        if self.natural_frequency.low <= 0.0 {
            return Err(Error::OutOfRange("natural_frequency"));
        }
        ordered(&self.slope, "slope")?;
        if self.slope.low <= 0.0 {
            return Err(Error::OutOfRange("slope"));
        }
        for (interval, name) in [
            (&self.damping_ratio, "damping_ratio"),
            (&self.joint, "joint"),
            (&self.latency, "latency"),
        ] {
            ordered(interval, name)?;
            if interval.low < 0.0 {
                return Err(Error::OutOfRange(name));
            }
        }
        Ok(())
    }

    /// The whole range, with an observer of this latency.
    pub(super) fn all(&self, observed: f64) -> Plants {
        let span = |of: &Interval<f64>| Span {
            low: of.low,
            high: of.high,
        };
        Plants {
            gain: span(&self.gain),
            natural_frequency: span(&self.natural_frequency),
            damping_ratio: span(&self.damping_ratio),
            joint: span(&self.joint),
            slope: span(&self.slope),
            latency: span(&self.latency),
            observed: Span::at(observed),
        }
    }
}
