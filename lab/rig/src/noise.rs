//! Noise from a seed: the rig's own generator, the same on every machine.

use bowden::Real;

/// White Gaussian noise of unit variance, deterministic.
///
/// Integers from SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), normal deviates from the
/// polar form of Box and Muller (Marsaglia, Bray 1964). Not for secrets.
///
/// ```
/// use bowden_rig::Noise;
/// let (mut a, mut b) = (Noise::new(7), Noise::new(7));
/// assert_eq!(a.normal::<f64>(), b.normal::<f64>());
/// assert_ne!(a.normal::<f64>(), Noise::new(8).normal::<f64>());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Noise {
    state: u64,
    /// Deviates come in pairs; the second one waits here.
    spare: Option<f64>,
}

/// Pairs to try before giving up; each fails with probability 1 − pi/4.
const MOST_TRIES: u32 = 64;

impl Noise {
    /// A generator that starts from `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            state: seed,
            spare: None,
        }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), 53 bits.
    #[allow(clippy::cast_precision_loss)] // 53 bits are exact
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Normal with mean zero and variance one, finite: at most 8.6 away from zero.
    pub fn normal<T: Real>(&mut self) -> T {
        if let Some(spare) = self.spare.take() {
            return T::of(spare);
        }
        for _ in 0..MOST_TRIES {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let factor = Real::sqrt(-2.0 * Real::ln(square) / square);
                self.spare = Some(y * factor);
                return T::of(x * factor);
            }
        }
        T::zero() // once in 1e43 calls
    }
}
