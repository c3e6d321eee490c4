//! The certificates: their figures, their algebra, and adversaries that try to break them.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod adversary;
mod continuous;
mod dyadic;
mod figures;
mod learning;
mod observer;
mod refused;
mod rounded;
mod sampled;
mod simulated;
mod step;

/// xorshift64*: uniform, the same in every run.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        #[allow(clippy::cast_precision_loss)]
        let unit = bits as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// -1, or 1.
    fn sign(&mut self) -> f64 {
        if self.within(-1.0, 1.0) < 0.0 {
            -1.0
        } else {
            1.0
        }
    }
}
