//! Robust stability of a PI with a disturbance observer, over a whole range of plants.

use super::plant::ordered;
use super::Interval;
use crate::control::{Damping, DisturbanceObserver, Pid};
use crate::{Error, Real};
use span::{Plane, Span};

mod span;

/// Where the plant between command and measured output lies: a data sheet with its tolerances.
///
/// ```text
/// P~(s) = f·alpha·e^(−theta·s)/(1 + f·(s²/wn² + 2·zeta·s/wn)/(1 + c/K·s))
/// ```
/// With `f = 1` and `c/K = 0` it is the [`NominalPlant`](crate::control::NominalPlant) behind a delay. A
/// damping c of the joint beside the stiffness K that it works against leads: 3 ms of it make up
/// for 3 ms of latency, and a rig may be stable by that alone. Where the cable's output changes by f
/// times as much as its input, as along the loop of its hysteresis, the motor works against a
/// stiffness of K/f.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlantRange {
    /// alpha \[output unit/command unit\], of the sign of the nominal one.
    pub gain: Interval<f64>,
    /// wn \[rad/s\], above zero.
    pub natural_frequency: Interval<f64>,
    /// zeta, that of the drive alone; not below zero.
    pub damping_ratio: Interval<f64>,
    /// c/K of the joint \[s\], not below zero.
    pub joint: Interval<f64>,
    /// f, above zero: 1 without a hysteresis; with one, in torque, with kappa_eta above zero and sigma
    /// not below, from `1 − kappa_eta·rho·max(1, 2·sigma)/B` to 1.
    pub slope: Interval<f64>,
    /// theta \[s\], not below zero: samples of delay, half a sample of hold, the lags of drive and
    /// sensor.
    pub latency: Interval<f64>,
}

/// A P or PI with a disturbance observer that is stable with every plant of a range.
///
/// With `C = k_p + k_i/s`, `Q = 1/(tau·s + 1)²` and the observer's latency as `1/(L·s + 1)`, the
/// loop is stable where no zero of
///
/// ```text
/// F(s) = s·D~·((tau·s + 1)² − 1/(L·s + 1))
///        + f·alpha~·(1 + c/K·s)·e^(−theta·s)·((k_p·s + k_i)·(tau·s + 1)² + s·D/alpha)
/// ```
/// lies in the closed right half-plane (what was cancelled, `(L·s + 1)·(tau·s + 1)²`, has none there),
/// `D = s²/wn² + 2·zeta·s/wn + 1` of the nominal plant and
/// `D~ = f·s²/wn² + (f·2·zeta/wn + c/K)·s + 1` of the plant (both divided by s for a P).
///
/// *Proof.* For the nominal plant and `L = 0`, `F = (tau·s + 1)²·(s·D + alpha·(k_p·s + k_i))`, whose
/// zeros are on the left by Routh. From there all numbers of the plant and L go along a straight
/// line to a plant of the range and to the observer's latency, then the plant to any other of the
/// range. For `|s| >= r` on the right the first term of F is the greater one, on all that way; so a
/// zero could come over the imaginary axis alone, below r. There F is shown not to be zero, by
/// intervals that are rounded outwards and halved until they show it (zero exclusion). ∎
///
/// For single plants what is proved and what swings lie within a few per cent (test `bound`). Near the
/// edge, and where the way leads through plants that swing, nothing is shown of a loop that is stable.
///
/// Assumed beside: a plant of that form; continuous time, so samples much shorter than tau and 1/wn,
/// and an observer's latency of at least one of them; lags of drive and sensor that act as a delay;
/// neither a limit of the command nor that of the observer is met; friction and load are
/// disturbances that stay bounded. The range of f covers each slope of a hysteresis by itself, which is
/// no proof for one that changes along the path: a cable whose output falls while its input rises (f
/// below zero) can be in no range, and with it the loop does swing. libm's sine and cosine err by
/// less than 1e-12.
///
/// Source: J. Ackermann, *Robust Control: Systems with Uncertain Physical Parameters*, 1993 (zero
/// exclusion).
///
/// ```
/// use bowden::bound::{Interval, ObserverStability, PlantRange};
/// use bowden::control::{DisturbanceObserver, NominalPlant, Pid, PidSettings};
/// let plant = NominalPlant::try_new(0.6_f32, 25.5, 0.265)?;
/// let observer = DisturbanceObserver::try_new(plant, 0.0159, 30.0, 0.005)?.with_latency(0.003)?;
/// let pi = Pid::try_new(PidSettings::unlimited(12.0, 60.0))?;
/// let within = |x: f64, share: f64| Interval { low: x * (1.0 - share), high: x * (1.0 + share) };
/// let range = PlantRange {
///     gain: within(0.6, 0.12),
///     natural_frequency: within(25.5, 0.06),
///     damping_ratio: within(0.265, 0.12),
///     joint: within(0.0033, 0.12), // 0.5 N·m·s/rad beside 150 N·m/rad
///     slope: Interval { low: 0.33, high: 1.0 },
///     latency: within(0.003, 0.12),
/// };
/// assert!(ObserverStability::try_new(&observer, &pi, &range).is_ok());
/// // With 30 ms some of them would swing.
/// let late = PlantRange { latency: Interval { low: 0.0026, high: 0.03 }, ..range };
/// assert!(ObserverStability::try_new(&observer, &pi, &late).is_err());
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverStability {
    /// The plants that it holds for.
    pub plants: PlantRange,
    /// Frequency r above which the first term is the greater one \[rad/s\].
    pub highest: f64,
    /// How many boxes of plants and frequencies it took below.
    pub boxes: u32,
}

/// Most boxes of a proof: a tenth of a second or so on a computer.
const MOST_BOXES: u32 = 400_000;

/// Most halvings of a box.
const MOST_HALVINGS: u32 = 60;

/// What is the same for every plant.
struct Loop {
    k_p: f64,
    k_i: f64,
    /// tau of Q.
    filter: f64,
    gain: f64,
    /// `1/wn²` and `2·zeta/wn` of the nominal plant.
    curvature: Span,
    rate: Span,
}

/// Plants between bounds of every number, and the observer's latency beside them.
#[derive(Clone, Copy)]
struct Plants {
    gain: Span,
    natural_frequency: Span,
    damping_ratio: Span,
    joint: Span,
    slope: Span,
    latency: Span,
    observed: Span,
}

/// Plants that are looked at together.
#[derive(Clone, Copy)]
enum Set {
    /// Those of a part of the way from the nominal plant, from 0 to 1.
    Way(Span),
    /// All between bounds.
    All(Plants),
}

impl Plants {
    /// `f/wn²` and `f·2·zeta/wn + c/K`.
    fn denominator(&self) -> (Span, Span) {
        let slow = self.natural_frequency.recip();
        let rate = Span::at(2.0) * self.damping_ratio * slow;
        (self.slope * slow.square(), self.slope * rate + self.joint)
    }

    /// Two halves, along the number that moves F most, and by how much that does.
    fn halves(&self, frequency: f64) -> (f64, [Self; 2]) {
        let share = |span: Span| span.width() / span.middle().abs();
        let sizes = [
            share(self.gain),
            2.0 * share(self.natural_frequency),
            self.damping_ratio.width(),
            self.joint.width() * frequency,
            share(self.slope),
            self.latency.width() * frequency,
        ];
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

    /// One in their middle.
    fn middle(&self) -> Self {
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

    /// These, others, and all between.
    fn hull(&self, other: &Self) -> Self {
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

    /// Between the one and the other, at a part of the way.
    fn between(&self, other: &Self, part: Span) -> Self {
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

/// What is to be shown: the loop, its nominal plant without latency, one plant of the range, and
/// how many boxes it took so far.
struct Search {
    closed: Loop,
    nominal: Plants,
    middle: Plants,
    boxes: u32,
}

impl Search {
    /// Whether F is not zero for any of the plants at any of the frequencies.
    fn is_off_zero(&mut self, frequency: Span, set: Set, halvings: u32) -> bool {
        self.boxes = self.boxes.saturating_add(1);
        if self.boxes > MOST_BOXES {
            return false;
        }
        let plants = match set {
            Set::Way(part) => self.nominal.between(&self.middle, part),
            Set::All(plants) => plants,
        };
        if self.closed.values(frequency, &plants).is_off_zero() {
            return true;
        }
        let Some(left) = halvings.checked_sub(1) else {
            return false;
        };
        let (size, [first, second]) = match set {
            Set::Way(part) => (part.width(), part.halves().map(Set::Way)),
            Set::All(plants) => {
                let (size, halves) = plants.halves(frequency.high);
                (size, halves.map(Set::All))
            }
        };
        // Far below 1/tau F hardly changes.
        let scale = frequency.middle() + 0.1 / self.closed.filter;
        if frequency.width() >= size * scale {
            let [low, high] = frequency.halves();
            return self.is_off_zero(low, set, left) && self.is_off_zero(high, set, left);
        }
        self.is_off_zero(frequency, first, left) && self.is_off_zero(frequency, second, left)
    }
}

impl ObserverStability {
    /// Shows that the loop is stable with every plant of the range.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with what is wrong with the range;
    /// [`Error::Inadmissible`] where the law is no P or PI, where the nominal loop without latency is
    /// not stable, or where nothing could be shown: some plant is at the edge of stability, beyond it,
    /// or nearly.
    pub fn try_new<T: Real>(
        observer: &DisturbanceObserver<T>,
        law: &Pid<T>,
        plants: &PlantRange,
    ) -> Result<Self, Error> {
        plants.check()?;
        let settings = law.settings();
        let damps = settings.k_d != T::ZERO || matches!(settings.damping, Damping::Velocity);
        if damps {
            return Err(Error::Inadmissible("the law is a P or a PI"));
        }
        let nominal = observer.plant();
        let first = Plants {
            gain: Span::at(nominal.gain().as_f64()),
            natural_frequency: Span::at(nominal.natural_frequency().as_f64()),
            damping_ratio: Span::at(nominal.damping_ratio().as_f64()),
            joint: Span::at(0.0),
            slope: Span::at(1.0),
            latency: Span::at(0.0),
            observed: Span::at(0.0),
        };
        let (curvature, rate) = first.denominator();
        let closed = Loop {
            k_p: settings.k_p.as_f64(),
            k_i: settings.k_i.as_f64(),
            filter: observer.time_constant().as_f64(),
            gain: nominal.gain().as_f64(),
            curvature,
            rate,
        };
        if closed.gain * plants.gain.low <= 0.0 {
            return Err(Error::Inadmissible("gain and nominal gain have one sign"));
        }
        if !closed.is_stable_at_first() {
            return Err(Error::Inadmissible(
                "the nominal loop without latency is stable",
            ));
        }
        let shown = Error::Inadmissible("no plant of the range comes near the edge of stability");
        let all = plants.all(observer.latency().as_f64());
        let highest = closed.highest(&first, &all).ok_or(shown)?;
        let frequencies = Span {
            low: 0.0,
            high: highest,
        };
        let mut search = Search {
            closed,
            nominal: first,
            middle: all.middle(),
            boxes: 0,
        };
        let way = Span {
            low: 0.0,
            high: 1.0,
        };
        for set in [Set::Way(way), Set::All(all)] {
            if !search.is_off_zero(frequencies, set, MOST_HALVINGS) {
                return Err(shown);
            }
        }
        let boxes = search.boxes;
        Ok(Self {
            plants: *plants,
            highest,
            boxes,
        })
    }
}

impl PlantRange {
    fn check(&self) -> Result<(), Error> {
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

    /// All of it, beside an observer of this latency.
    fn all(&self, observed: f64) -> Plants {
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

impl Loop {
    /// Routh's criterion of `s·D + alpha·(k_p·s + k_i)`, or of `D + alpha·k_p`.
    fn is_stable_at_first(&self) -> bool {
        let gain = Span::at(self.gain);
        let one = Span::at(1.0) + gain * Span::at(self.k_p);
        let (rate, integral) = (self.rate, gain * Span::at(self.k_i));
        let margin = rate * one - self.curvature * integral;
        let holds = rate.low > 0.0 && one.low > 0.0;
        holds && (self.k_i == 0.0 || (integral.low > 0.0 && margin.low > 0.0))
    }

    /// A frequency r so that for all `|s| >= r` on the right the first term of F is the
    /// greater one, for all plants on the way from the first one. Both are divided by `|s|⁵`; then
    /// the one falls and the other grows with `1/|s|`.
    fn highest(&self, first: &Plants, all: &Plants) -> Option<f64> {
        let hull = first.hull(all);
        let (curvature, rate) = hull.denominator();
        let (least, most) = (Span::at(curvature.low), Span::at(rate.high));
        let gain =
            Span::at(hull.gain.high.abs().max(hull.gain.low.abs())) * Span::at(hull.slope.high);
        let joint = Span::at(hull.joint.high);
        let (filter, two) = (Span::at(self.filter), Span::at(2.0));
        let mut r = self.filter.recip();
        for _ in 0..64 {
            let x = Span::at(r).recip();
            let plant = least - x * (most + x);
            let less_one = filter.square() - two * x * (filter + x);
            let law = Span::at(self.k_p.abs()) + Span::at(self.k_i.abs()) * x;
            let inverse = self.curvature + x * (self.rate + x);
            let both = law * (filter + x).square() + inverse * Span::at(self.gain.abs()).recip();
            let second = x * gain * (joint + x) * both;
            if plant.low > 0.0 && less_one.low > 0.0 && (plant * less_one).low > second.high {
                return Some(r);
            }
            r *= 2.0;
        }
        None
    }

    /// A box around all values of F at these frequencies; of F/s for a P.
    fn values(&self, w: Span, plants: &Plants) -> Plane {
        let (one, two) = (Span::at(1.0), Span::at(2.0));
        let square = w.square();
        let (curvature, rate) = plants.denominator();
        let plant = Plane {
            re: one - curvature * square,
            im: rate * w,
        };
        let filter = Plane {
            re: one - Span::at(self.filter).square() * square,
            im: two * Span::at(self.filter) * w,
        };
        // 1 − 1/(1 + jx) = (x² + jx)/(1 + x²).
        let x = plants.observed * w;
        let below = (one + x.square()).recip();
        let less_one = Plane {
            re: x.square() * below - Span::at(self.filter).square() * square,
            im: filter.im + x * below,
        };
        let own = Span::at(self.gain).recip();
        let inverse = Plane {
            re: (one - self.curvature * square) * own,
            im: self.rate * w * own,
        };
        let joint = Plane {
            re: one,
            im: plants.joint * w,
        };
        let delayed = (joint * Plane::late(plants.latency * w)).times(plants.gain * plants.slope);
        let first = plant * less_one;
        let k_p = Span::at(self.k_p);
        if self.k_i == 0.0 {
            return first + delayed * (filter.times(k_p) + inverse);
        }
        let law = Plane {
            re: Span::at(self.k_i),
            im: k_p * w,
        };
        first.turned(w) + delayed * (law * filter + inverse.turned(w))
    }
}
