//! The fraction of a trial in which the command is at a limit. The limits, and not the gains, then
//! determine the behaviour of the loop.

use bowden::control::Limits;
use serde::Serialize;

/// Fraction of the samples from which a limit is reported. A command may reach a limit
/// occasionally.
pub const TOLD: f64 = 0.2;

/// Fractions of the samples of the steady part.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct AtLimit {
    /// Fraction at an end of the range.
    pub range: f64,
    /// Fraction at the slew-rate limit.
    pub slew: f64,
}

impl AtLimit {
    /// The fractions in words, if one of them exceeds [`TOLD`].
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let told = |share: f64, limit: &str| {
            (share > TOLD).then(|| format!("{limit} in {:.0} % of the samples", 100.0 * share))
        };
        let both = [
            told(self.slew, "at its slew-rate limit"),
            told(self.range, "at a limit of its range"),
        ];
        let both: Vec<String> = both.into_iter().flatten().collect();
        (!both.is_empty()).then(|| both.join(" and "))
    }
}

/// Counts the samples of one trial.
pub(super) struct Counted {
    limits: Limits<f64>,
    range: f64,
    slew: f64,
    count: f64,
}

impl Counted {
    pub(super) fn new(limits: Limits<f64>) -> Self {
        Self {
            limits,
            range: 0.0,
            slew: 0.0,
            count: 0.0,
        }
    }

    /// Adds one step of the control law, from the previous command to the new one.
    pub(super) fn add(&mut self, before: f64, command: f64, dt: f64) {
        let Self { limits, .. } = *self;
        self.count += 1.0;
        if command >= limits.high() || command <= limits.low() {
            self.range += 1.0;
        }
        // A sum of floats need not reach the limit.
        let reach = limits.slew().map(|slew| slew * dt * (1.0 - 1e-9));
        if reach.is_some_and(|reach| (command - before).abs() >= reach) {
            self.slew += 1.0;
        }
    }

    pub(super) fn shares(&self) -> AtLimit {
        let count = self.count.max(1.0);
        AtLimit {
            range: self.range / count,
            slew: self.slew / count,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::{AtLimit, Counted};
    use bowden::control::Limits;

    #[test]
    fn ends_of_the_range_and_whole_steps_of_the_slew_rate_are_counted_each_by_itself() {
        let limits = Limits::try_new(-1.0, 2.0).unwrap().with_slew(3.0).unwrap();
        let mut counted = Counted::new(limits);
        // In steps of 0.1 s the slew rate is 0.3.
        let commands = [0.0, 0.3, 0.5, 0.2, -0.1, -0.4, -0.7, -1.0, -1.0, -0.9];
        for pair in commands.windows(2) {
            counted.add(pair[0], pair[1], 0.1);
        }
        let shares = counted.shares();
        assert!((shares.range - 2.0 / 9.0).abs() < 1e-12, "{shares:?}");
        assert!((shares.slew - 6.0 / 9.0).abs() < 1e-12, "{shares:?}");
        assert_eq!(
            shares.words().unwrap(),
            "at its slew-rate limit in 67 % of the samples and at a limit of its range in 22 % of the samples"
        );
        assert!(AtLimit::default().words().is_none());
    }
}
