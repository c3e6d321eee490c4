//! The first-order low-pass of `lag` and `creep` over a whole record: the core takes the
//! exponential of one step at every sample, here it is taken once.

use bowden::Real;

/// `level += share·(input − level)`, `share = 1 − exp(−dt/tau)`: as the core has it.
pub(super) struct LowPass {
    share: f64,
    /// d share / d tau \[1/s\].
    by_tau: f64,
}

impl LowPass {
    /// Time constant and step \[s\].
    pub(super) fn new(tau: f64, dt: f64) -> Self {
        let share = -Real::exp_m1(-dt / tau);
        Self {
            share,
            by_tau: (share - 1.0) * dt / (tau * tau),
        }
    }

    /// The levels along a record, bit for bit those of the core. It begins settled at `start`,
    /// or without one at its first input. `None` where a level is not finite: the core
    /// saturates there.
    pub(super) fn levels(
        &self,
        start: Option<f64>,
        inputs: impl Iterator<Item = f64>,
    ) -> Option<Vec<f64>> {
        let mut level = start;
        let mut is_finite = true;
        let step = |input: f64| {
            let next = level.map_or(input, |before| before + self.share * (input - before));
            is_finite &= next.is_finite();
            level = Some(next);
            next
        };
        let levels = inputs.map(step).collect();
        is_finite.then_some(levels)
    }

    /// d level / d tau \[1/s\] along a record.
    pub(super) fn slope(&self, start: Option<f64>, inputs: impl Iterator<Item = f64>) -> Vec<f64> {
        let (mut level, mut slope) = (start, 0.0);
        let step = |input: f64| {
            if let Some(before) = level {
                slope += self.by_tau * (input - before) - self.share * slope;
            }
            let next = level.map_or(input, |before| before + self.share * (input - before));
            level = Some(next);
            slope
        };
        inputs.map(step).collect()
    }

    /// d level / d start along a record of so many samples.
    pub(super) fn forgets(&self, samples: usize) -> impl Iterator<Item = f64> + '_ {
        let mut left = 1.0;
        (0..samples).map(move |_| {
            left -= self.share * left;
            left
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowden::effect::{Effect, EffectState, Motion, Situation};

    fn inputs() -> Vec<f64> {
        let at = |i: usize| (0.1 * i as f64).sin() + 0.3 * (0.037 * i as f64).cos();
        (0..300).map(at).collect()
    }

    /// What the core makes of them: creep, which is the level itself.
    fn by_core(tau: f64, dt: f64, start: Option<f64>) -> Vec<f64> {
        let effect = Effect::try_from_name("creep", &[tau]).unwrap();
        let mut state = EffectState::default();
        let mut step = |position: f64| {
            let motion = Motion {
                position,
                ..Motion::default()
            };
            let at = Situation {
                dt,
                motion,
                ..Situation::default()
            };
            effect.regressor(&mut state, &at)
        };
        if let Some(x) = start {
            step(x);
        }
        inputs().into_iter().map(step).collect()
    }

    #[test]
    fn levels_are_those_of_the_core_bit_for_bit() {
        for tau in [1e-4, 0.02, 0.7, 1e3] {
            for start in [None, Some(-0.4)] {
                let low_pass = LowPass::new(tau, 0.01);
                let levels = low_pass.levels(start, inputs().into_iter());
                assert_eq!(levels, Some(by_core(tau, 0.01, start)), "{tau} {start:?}");
            }
        }
        let overflows = [1.0, f64::MAX, f64::NEG_INFINITY];
        let low_pass = LowPass::new(0.02, 0.01);
        assert_eq!(low_pass.levels(None, overflows.into_iter()), None);
    }

    #[test]
    fn slopes_are_the_limits_of_differences() {
        let (dt, h) = (0.01, 1e-6);
        for tau in [0.02, 0.7] {
            let own = LowPass::new(tau, dt);
            let slope = own.slope(Some(-0.4), inputs().into_iter());
            let moved = |tau: f64, start: f64| by_core(tau, dt, Some(start));
            let (up, down) = (moved(tau + h, -0.4), moved(tau - h, -0.4));
            let (above, below) = (moved(tau, -0.4 + h), moved(tau, -0.4 - h));
            for (i, left) in own.forgets(slope.len()).enumerate() {
                // Rounding of a difference of 1e-6: 1e-16/1e-6, at slopes up to 30.
                let expected = (up[i] - down[i]) / (2.0 * h);
                assert!((slope[i] - expected).abs() < 1e-7, "{tau} at {i}");
                let expected = (above[i] - below[i]) / (2.0 * h);
                assert!((left - expected).abs() < 1e-9, "{tau} at {i}");
            }
        }
    }
}
