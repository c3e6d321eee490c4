//! Robust stability of a PI controller with a disturbance observer, over a range of plants.

use super::interval::{Plane, Span};
use super::zeros::{doubled, excluded};
use super::PlantRange;
use bowden::control::{DerivativeSource, DisturbanceObserver, Pid, PidSettings};
use bowden::{Error, Real};

/// Stability of a P or PI controller with a disturbance observer, for every plant of a range.
///
/// Let `C = k_p + k_i/s` and `Q = 1/(tau·s + 1)²`, and let `1/(L·s + 1)` be the latency of the
/// observer. The loop is stable if no zero of
///
/// ```text
/// F(s) = s·D~·((tau·s + 1)² − 1/(L·s + 1))
///        + f·alpha~·(1 + c/K·s)·e^(−theta·s)·((k_p·s + k_i)·(tau·s + 1)² + s·D/alpha)
/// ```
/// lies in the closed right half-plane. The cancelled factor `(L·s + 1)·(tau·s + 1)²` has no zero
/// there. `D = s²/wn² + 2·zeta·s/wn + 1` is the denominator of the nominal plant, and
/// `D~ = f·s²/wn² + (f·2·zeta/wn + c/K)·s + 1` is the denominator of the plant. For a P controller,
/// both terms are divided by s.
///
/// *Proof.* For the nominal plant and `L = 0`, `F = (tau·s + 1)²·(s·D + alpha·(k_p·s + k_i))`,
/// whose zeros are in the left half-plane by Routh's criterion. From there, the plant and L are
/// varied along a straight line to a plant of the range and to the latency of the observer. The
/// plant is then varied to any other plant of the range. In the right half-plane with `|s| >= r`,
/// the first term of F is the larger term along the whole path. A zero could therefore cross only
/// the imaginary axis below r. On this part of the axis, interval arithmetic on bisected regions,
/// rounded outwards, shows that F is not zero (zero exclusion). ∎
///
/// For single plants, the proved limit and the true stability limit agree to within a few per cent
/// (test `bound`). The proof may fail for a stable loop that is near the stability limit, or if the
/// path contains unstable plants.
///
/// Further assumptions:
/// - the plant has this form;
/// - the sample time is much shorter than tau and 1/wn (continuous time), and the latency of the
///   observer is at least one sample;
/// - the lags of the drive and the sensor act as a delay;
/// - neither the command nor the observer saturates;
/// - friction and load are bounded disturbances;
/// - the sine and cosine of libm have an error of less than 1e-12.
///
/// The certificate covers every constant slope f in the range. It does not cover a slope that
/// changes along the path, as the slope of a hysteresis does. No range can contain a cable whose
/// output falls while its input rises (f negative), because the loop oscillates with such a cable.
///
/// Source: J. Ackermann, *Robust Control: Systems with Uncertain Physical Parameters*, 1993 (zero
/// exclusion).
///
/// ```
/// use bowden_bound::{Interval, ObserverStability, PlantRange};
/// use bowden::control::{DisturbanceObserver, NominalPlant, Pid, PidSettings};
/// let plant = NominalPlant::try_new(0.6_f32, 25.5, 0.265)?;
/// let observer = DisturbanceObserver::try_new(plant, 0.0159, 30.0, 0.005)?.with_latency(0.003)?;
/// let pi = Pid::try_new(PidSettings::unlimited(12.0, 60.0))?;
/// let within = |x: f64, share: f64| Interval { low: x * (1.0 - share), high: x * (1.0 + share) };
/// let range = PlantRange {
///     gain: within(0.6, 0.12),
///     natural_frequency: within(25.5, 0.06),
///     damping_ratio: within(0.265, 0.12),
///     joint: within(0.0033, 0.12), // 0.5 N·m·s/rad over 150 N·m/rad
///     slope: Interval { low: 0.33, high: 1.0 },
///     latency: within(0.003, 0.12),
/// };
/// assert!(ObserverStability::try_new(&observer, &pi, &range).is_ok());
/// // With 30 ms the loop would oscillate on some of them.
/// let late = PlantRange { latency: Interval { low: 0.0026, high: 0.03 }, ..range };
/// assert!(ObserverStability::try_new(&observer, &pi, &late).is_err());
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverStability {
    /// The range of plants of the certificate.
    pub plants: PlantRange,
    /// Frequency r above which the first term of F is the larger term \[rad/s\].
    pub highest: f64,
    /// Number of regions of plants and frequencies in the proof below r.
    pub boxes: u32,
}

/// The numbers that all plants share.
struct Loop {
    k_p: f64,
    k_i: f64,
    /// tau of Q.
    filter: f64,
    /// The nominal plant, without latency, joint and hysteresis.
    nominal: PlantRange,
}

impl ObserverStability {
    /// Proves that the loop is stable for every plant of the range.
    ///
    /// # Errors
    /// - [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the range.
    /// - [`Error::Inadmissible`] if the controller is not P or PI, or if the nominal loop without
    ///   latency is not stable.
    /// - [`Error::Inadmissible`] if no proof was found. Some plant may be unstable, or near the
    ///   stability limit.
    pub fn try_new<T: Real>(
        observer: &DisturbanceObserver<T>,
        law: &Pid<T>,
        plants: &PlantRange,
    ) -> Result<Self, Error> {
        plants.check()?;
        let (k_p, k_i) = proportional_and_integral(law.settings())?;
        let nominal = observer.plant();
        let closed = Loop {
            k_p,
            k_i,
            filter: observer.time_constant().as_f64(),
            nominal: PlantRange {
                gain: Span::exactly(nominal.gain().as_f64()),
                natural_frequency: Span::exactly(nominal.natural_frequency().as_f64()),
                damping_ratio: Span::exactly(nominal.damping_ratio().as_f64()),
                ..plants.plain()
            },
        };
        let nominal = closed.nominal;
        if (nominal.gain.low > 0.0) != (plants.gain.low > 0.0) {
            return Err(Error::Inadmissible(
                "gain and nominal gain must have the same sign",
            ));
        }
        if !nominal.is_stable_with(k_p, k_i) {
            return Err(Error::Inadmissible(
                "the nominal loop without latency must be stable",
            ));
        }
        let shown =
            Error::Inadmissible("no plant of the range may come near the edge of stability");
        let highest = closed.highest(&nominal.hull(*plants)).ok_or(shown)?;
        let latency = observer.latency().as_f64();
        let values = |w, plants: &PlantRange, observed| closed.values(w, plants, observed);
        // At frequencies far below 1/tau, F hardly changes.
        let scale = 0.1 / closed.filter;
        let boxes = excluded(values, scale, [nominal, *plants], latency, highest).ok_or(shown)?;
        Ok(Self {
            plants: *plants,
            highest,
            boxes,
        })
    }
}

/// k_p and k_i of a P or PI controller.
pub(super) fn proportional_and_integral<T: Real>(
    law: &PidSettings<T>,
) -> Result<(f64, f64), Error> {
    if law.k_d != T::ZERO || matches!(law.damping, DerivativeSource::Velocity) {
        return Err(Error::Inadmissible("the law must be a P or a PI"));
    }
    Ok((law.k_p.as_f64(), law.k_i.as_f64()))
}

impl Loop {
    /// A frequency r above which the first term of F is the larger term. This holds at all
    /// `|s| >= r` in the right half-plane, for all plants on the path from the first plant. Both
    /// terms are divided by `|s|⁵`. Then one term decreases and the other increases with `1/|s|`.
    fn highest(&self, hull: &PlantRange) -> Option<f64> {
        let (filter, two) = (Span::exactly(self.filter), Span::exactly(2.0));
        doubled(self.filter.recip(), |r| {
            let x = Span::exactly(r).recip();
            let (plant, answer) = hull.shares(x);
            let less_one = filter.square() - two * x * (filter + x);
            let law = Span::exactly(self.k_p.abs()) + Span::exactly(self.k_i.abs()) * x;
            let (curvature, rate) = self.nominal.denominator();
            let inverse = curvature + x * (rate + x);
            let gain = Span::exactly(self.nominal.gain.magnitude());
            let both = law * (filter + x).square() + inverse * gain.recip();
            let first = plant * less_one;
            plant.low > 0.0 && less_one.low > 0.0 && first.low > (answer * both).high
        })
    }

    /// A region that contains all values of F at these frequencies, or of F/s for a P controller.
    fn values(&self, w: Span, plants: &PlantRange, observed: Span) -> Plane {
        let (one, filter) = (Span::exactly(1.0), Span::exactly(self.filter));
        let (plant, delayed) = (plants.drive(w), plants.cable(w));
        let square = filter.square() * w.square();
        let filter = Plane::new(one - square, Span::exactly(2.0) * filter * w);
        // 1 − 1/(1 + jx) = (x² + jx)/(1 + x²).
        let x = observed * w;
        let below = (one + x.square()).recip();
        let less_one = Plane::new(x.square() * below - square, filter.im + x * below);
        let inverse = self.nominal.drive(w).times(self.nominal.gain.recip());
        let first = plant * less_one;
        let k_p = Span::exactly(self.k_p);
        if self.k_i == 0.0 {
            return first + delayed * (filter.times(k_p) + inverse);
        }
        let law = Plane::new(Span::exactly(self.k_i), k_p * w);
        first.turned(w) + delayed * (law * filter + inverse.turned(w))
    }
}
