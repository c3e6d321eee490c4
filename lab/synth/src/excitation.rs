//! Smooth motion with analytic derivatives.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// A quantity with its first and second derivative in time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    pub(super) x: f64,
    pub(super) v: f64,
    pub(super) a: f64,
}

impl Motion {
    pub(super) fn plus(self, other: Self, factor: f64) -> Self {
        let Self { x, v, a } = other;
        Self {
            x: self.x + factor * x,
            v: self.v + factor * v,
            a: self.a + factor * a,
        }
    }
}

/// One sine whose amplitude itself goes up and down slowly.
struct Tone {
    amplitude: f64,
    omega: f64,
    phase: f64,
    depth: f64,
    slow: f64,
    slow_phase: f64,
}

impl Tone {
    fn at(&self, t: f64) -> Motion {
        let (s, c) = (self.omega * t + self.phase).sin_cos();
        let (ms, mc) = (self.slow * t + self.slow_phase).sin_cos();
        let (w, m) = (self.omega, self.slow);
        let envelope = self.amplitude * (1.0 + self.depth * ms);
        let rate = self.amplitude * self.depth * m * mc;
        let bend = -self.amplitude * self.depth * m * m * ms;
        Motion {
            x: envelope * s,
            v: rate * s + envelope * w * c,
            a: bend * s + 2.0 * rate * w * c - envelope * w * w * s,
        }
    }
}

/// A sum of tones about a mean.
pub(super) struct Tones {
    tones: Vec<Tone>,
    bias: f64,
}

impl Tones {
    /// Tones spread over `low..high` \[Hz\], no two in a simple ratio, with a
    /// peak of `amplitude` about `bias` within `seconds`.
    pub(super) fn draw(
        rng: &mut ChaCha8Rng,
        (low, high): (f64, f64),
        count: usize,
        (amplitude, bias): (f64, f64),
        seconds: f64,
    ) -> Self {
        let tone = |k: usize| {
            let place = (k as f64 + rng.random_range(0.15..0.85)) / count as f64;
            let frequency = low * (high / low).powf(place);
            Tone {
                amplitude: (low / frequency).sqrt() * rng.random_range(0.8..1.2),
                omega: TAU * frequency,
                phase: rng.random_range(0.0..TAU),
                depth: rng.random_range(0.3..0.6),
                slow: TAU * rng.random_range(0.03..0.09),
                slow_phase: rng.random_range(0.0..TAU),
            }
        };
        let mut tones = Self {
            tones: (0..count).map(tone).collect(),
            bias: 0.0,
        };
        let points = ((seconds * high * 64.0) as usize).clamp(1000, 1_000_000);
        let peak = (0..=points).fold(0.0_f64, |peak, k| {
            peak.max(tones.at(seconds * k as f64 / points as f64).x.abs())
        });
        tones
            .tones
            .iter_mut()
            .for_each(|tone| tone.amplitude *= amplitude / peak);
        tones.bias = bias;
        tones
    }

    pub(super) fn at(&self, t: f64) -> Motion {
        let rest = Motion {
            x: self.bias,
            ..Motion::default()
        };
        self.tones
            .iter()
            .fold(rest, |sum, tone| sum.plus(tone.at(t), 1.0))
    }
}

/// Internal time of the motion, which stops smoothly during holds.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    pub(super) holds: bool,
}

impl Pace {
    /// Own time with its derivatives by the time `t`.
    pub(super) fn at(self, t: f64) -> Motion {
        if !self.holds {
            return Motion {
                x: t,
                v: 1.0,
                a: 0.0,
            };
        }
        let (moves, brake, hold) = (3.0, 0.25, 1.0);
        let cycle = moves + 2.0 * brake + hold;
        let whole = (t / cycle).floor();
        let q = t - whole * cycle;
        let start = whole * (moves + brake);
        // Raised cosine from full pace to rest; its integral is half the time.
        let braking = |q: f64| {
            let (s, c) = (PI * q / brake).sin_cos();
            (
                0.5 * q + brake / (2.0 * PI) * s,
                0.5 * (1.0 + c),
                -0.5 * PI / brake * s,
            )
        };
        let (x, v, a) = if q < moves {
            (q, 1.0, 0.0)
        } else if q < moves + brake {
            let (x, v, a) = braking(q - moves);
            (moves + x, v, a)
        } else if q < moves + brake + hold {
            (moves + 0.5 * brake, 0.0, 0.0)
        } else {
            let (x, v, a) = braking(cycle - q);
            (moves + brake - x, v, -a)
        };
        Motion { x: start + x, v, a }
    }

    /// A motion in internal time, converted to real time (chain rule).
    pub(super) fn of(own: Motion, motion: Motion) -> Motion {
        Motion {
            x: motion.x,
            v: motion.v * own.v,
            a: motion.a * own.v * own.v + motion.v * own.a,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn derivatives_agree_with_differences_also_in_holds() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let tones = Tones::draw(&mut rng, (0.15, 1.2), 4, (16.0, 2.0), 20.0);
        let pace = Pace { holds: true };
        let at = |t: f64| {
            let own = pace.at(t);
            Pace::of(own, tones.at(own.x))
        };
        let h = 1e-5;
        for k in -200..2000 {
            let t = f64::from(k) * 0.01 + 0.003;
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            assert!(
                ((after.x - before.x) / (2.0 * h) - now.v).abs() < 1e-4,
                "v at {t}"
            );
            assert!(
                ((after.v - before.v) / (2.0 * h) - now.a).abs() < 1e-2,
                "a at {t}"
            );
        }
    }
}
