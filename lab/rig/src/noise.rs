//! Noise from a seed, which is the same on every machine.

use bowden::Real;

/// Deterministic white Gaussian noise with unit variance.
///
/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014) generates the integers. The polar method
/// (Marsaglia, Bray 1964) converts them to normal deviates. Do not use this generator for
/// cryptography.
///
/// ```
/// use bowden_rig::Noise;
/// let (mut a, mut b) = (Noise::new(7), Noise::new(7));
/// assert_eq!(a.normal::<f64>(), b.normal::<f64>());
/// assert_ne!(a.normal::<f64>(), Noise::new(8).normal::<f64>());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Noise {
    state: u64,
    /// Deviates are generated in pairs; this state yields the second deviate of a pair.
    spare: Option<u64>,
}

/// Increment from one state to the next: 2^64 divided by the golden ratio.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

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
        self.state = self.state.wrapping_add(STEP);
        mixed(self.state)
    }

    /// A number with 53 bits, uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        uniform(self.bits())
    }

    /// A normal deviate with mean zero and variance one; its magnitude is at most 12.1.
    ///
    /// All arithmetic uses `T`. In `f32`, the deviate equals that in `f64` except for a rounding
    /// error of up to 3e-4 near zero. About once in ten million deviates, rounding moves a point
    /// across the edge of the circle of the polar method. From then on, the deviates in `f32` and
    /// `f64` differ.
    pub fn normal<T: Real>(&mut self) -> T {
        if let Some(state) = self.spare.take() {
            if let Some((_, second)) = pair(state) {
                return second;
            }
        }
        // Each pair fails with probability 1 − pi/4.
        for _ in 0..64 {
            self.state = self.state.wrapping_add(STEP.wrapping_mul(2));
            if let Some((first, _)) = pair(self.state) {
                self.spare = Some(self.state);
                return first;
            }
        }
        T::zero() // once in 1e43 calls
    }
}

/// The bits of a state.
fn mixed(state: u64) -> u64 {
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number in [0, 1), exact in `f64`.
fn uniform<T: Real>(bits: u64) -> T {
    T::from(bits >> 11).map_or_else(T::zero, |count| count * T::from_f64(0.5 * f64::EPSILON))
}

/// Two deviates of the last two states, where their point lies in the circle.
fn pair<T: Real>(state: u64) -> Option<(T, T)> {
    let place = |state: u64| T::from_f64(2.0) * uniform::<T>(mixed(state)) - T::one();
    let (x, y) = (place(state.wrapping_sub(STEP)), place(state));
    let square = x * x + y * y;
    (square > T::zero() && square < T::one()).then(|| {
        let factor = (T::from_f64(-2.0) * square.ln() / square).sqrt();
        (x * factor, y * factor)
    })
}
