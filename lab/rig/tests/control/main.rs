//! Controllers of the core on the rig: what is promised of them, and anti-windup.
#![allow(clippy::unwrap_used)]

mod anti_windup;
mod certificates;

/// Nominal step \[s\].
const DT: f64 = 1e-3;

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
}
