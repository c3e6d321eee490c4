//! Fourier transforms in double precision, for records of any length.
//!
//! This is a separate crate, because `rustfft` is generic: every crate that calls it compiles it
//! again.

use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

pub use rustfft::num_complex::Complex;

/// A transform of signals of one length.
pub struct Transform(Arc<dyn Fft<f64>>);

impl Transform {
    /// `X_k = Σ x_i exp(−2πj·ik/n)`.
    #[must_use]
    pub fn forward(n: usize) -> Self {
        Self(FftPlanner::new().plan_fft_forward(n))
    }

    /// `x_i = Σ X_k exp(2πj·ik/n)`: n times the signal.
    #[must_use]
    pub fn inverse(n: usize) -> Self {
        Self(FftPlanner::new().plan_fft_inverse(n))
    }

    /// Replaces a signal by its transform; the length must be the planned one.
    pub fn apply(&self, signal: &mut [Complex<f64>]) {
        self.0.process(signal);
    }
}
