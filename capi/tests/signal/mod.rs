//! Random numbers and bad samples, the same in every run.

/// A signal with bad samples of every kind.
pub struct Signal(u64);

impl Signal {
    pub fn new() -> Self {
        Self(7)
    }

    /// Uniform within ±`most`, in steps that `f32` has.
    pub fn next(&mut self, most: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let share = (self.0 >> 44) as f64 / (1u64 << 20) as f64;
        most * (2.0 * share - 1.0)
    }

    /// A good time, but for a few.
    pub fn dt(&mut self, k: u32) -> f64 {
        match k {
            300 => f64::NAN,
            310 => 0.0,
            320 => -0.001,
            330 => f64::INFINITY,
            340 => 4295.0,
            _ => 0.001,
        }
    }

    /// A good number, but for single ones, five in a row, and a hundred in a row.
    pub fn measured(&mut self, k: u32) -> f64 {
        let good = self.next(3.0);
        match k {
            500 => f64::NAN,
            510 => f64::INFINITY,
            520 => f64::NEG_INFINITY,
            1500..=1504 | 2500..=2599 => f64::NAN,
            _ => good,
        }
    }
}
