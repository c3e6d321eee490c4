//! Tests of the step with a wrong power function, and of the number of powers that it evaluates.
//!
//! The bounds must not depend on the power function. The number of powers determines the cost of a
//! step.

use super::bounded::Constants;
use super::number::Number;
use super::{bounded, path};
use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

extern crate std;

std::thread_local! {
    /// Number of correct powers, counted separately for each test.
    static POWERS: Cell<u32> = const { Cell::new(0) };
}

/// A float that counts its exponentials, or whose exponential returns a hash of the bits of its
/// argument.
#[derive(Debug, Clone, Copy)]
struct Fake<const LIES: bool>(f32);

impl<const LIES: bool> Add for Fake<LIES> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl<const LIES: bool> Sub for Fake<LIES> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl<const LIES: bool> Mul for Fake<LIES> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl<const LIES: bool> Div for Fake<LIES> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl<const LIES: bool> Neg for Fake<LIES> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const LIES: bool> Number for Fake<LIES> {
    type Float = f32;
    fn constant(value: f32) -> Self {
        Self(value)
    }
    fn value(self) -> f32 {
        self.0
    }
    fn scale(self, by: f32) -> Self {
        Self(self.0 * by)
    }
    fn shift(self, by: f32) -> Self {
        Self(self.0 + by)
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn exp(self) -> Self {
        if !LIES {
            POWERS.set(POWERS.get() + 1);
            return Self(libm::expf(self.0));
        }
        let bits = self.0.to_bits().wrapping_mul(2_654_435_769);
        Self(match bits % 5 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => -3.0,
            // Any bit pattern, subnormals and more NaNs included.
            3 => f32::from_bits(bits),
            _ => libm::expf(self.0),
        })
    }
    fn ln(self) -> Self {
        Self(libm::logf(self.0))
    }
    fn sqrt(self) -> Self {
        Self(libm::sqrtf(self.0))
    }
    fn log2(self) -> Self {
        Self(libm::log2f(self.0))
    }
    fn exp2(self) -> Self {
        self.exp()
    }
    fn coarse_log2(self) -> Self {
        Self(libm::log2f(self.0))
    }
    fn coarse_power(self, exponent: Self) -> Self {
        Self(exponent.0 * libm::log2f(self.0)).exp()
    }
}

/// The bounded-time step, with the same parameters as the other step.
fn in_one_go<N: Number>(zeta: N, p: N, c: N, n: N) -> N {
    bounded::follow(zeta, p, &Constants::of(c, n))
}

#[test]
fn a_lying_power_function_cannot_push_the_state_out_or_back() {
    let mut bits = 1_u32;
    let mut uniform = || {
        bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (bits >> 8) as f32 / (1 << 24) as f32
    };
    for _ in 0..30_000 {
        let zeta = 2.0 * uniform() - 1.0;
        // From 1e-8 to 1e2: below, at and above the saturating path.
        let p = libm::powf(10.0, 10.0 * uniform() - 8.0);
        let c = libm::powf(10.0, 8.0 * uniform() - 2.0);
        let n = 1.0 + 9.0 * uniform();
        for follow in [path::follow::<Fake<true>>, in_one_go] {
            let next = follow(Fake(zeta), Fake(p), Fake(c), Fake(n)).0;
            assert!(
                next >= zeta && next <= 1.0,
                "{zeta} went to {next} over {p}, c {c}, n {n}"
            );
        }
    }
}

/// The step on numbers that count.
type Step = fn(Fake<false>, Fake<false>, Fake<false>, Fake<false>) -> Fake<false>;

/// Number of powers that the path from `zeta` needs.
fn powers(follow: Step, zeta: f32, p: f32, sigma: f32, n: f32) -> u32 {
    POWERS.set(0);
    let _ = follow(Fake(zeta), Fake(p), Fake(2.0 * sigma - 1.0), Fake(n));
    POWERS.get()
}

#[test]
fn a_sample_takes_one_power_and_a_full_reversal_a_few_dozen() {
    let powers = |zeta, p, sigma, n| powers(path::follow, zeta, p, sigma, n);
    assert_eq!(powers(0.5, 1e-3, 98.36, 3.871), 1);
    assert_eq!(powers(-0.5, 1e-3, 98.36, 3.871), 1);
    // From full saturation to full saturation, the jump that costs most.
    let most = |sigma| [1.1, 2.5, 3.871, 20.0].map(|n| powers(-1.0, 39.0, sigma, n));
    assert!(most(0.6).into_iter().all(|count| count <= 30));
    assert!(most(98.36).into_iter().all(|count| count <= 55));
    assert!(most(1e6).into_iter().all(|count| count <= 100));
}

#[test]
fn in_bounded_time_any_path_takes_one_power_and_at_most_two_coarse_ones() {
    for zeta in [-1.0, -0.9, -0.1, -1e-6, 0.0, 1e-6, 0.5, 1.0] {
        for p in [0.0, 1e-6, 1e-2, 0.3, 1.0, 3.0, 39.0, f32::INFINITY] {
            for (sigma, n) in [(0.5, 1.0), (0.6, 3.871), (98.36, 3.871), (1e9, 20.0)] {
                let count = powers(in_one_go, zeta, p, sigma, n);
                assert!((1..=3).contains(&count), "{count} from {zeta} over {p}");
            }
        }
    }
}
