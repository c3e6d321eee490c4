//! Loops over columns, compiled for the processor that they run on.
//!
//! Each element undergoes the operations of the plain loop in the same order, and none of them is
//! fused. The result is therefore identical, bit for bit, on every processor.

use pulp::{Arch, Simd, WithSimd};

/// `sum += other`, element by element.
pub(crate) fn add(sum: &mut [f64], other: &[f64]) {
    Arch::new().dispatch(Add(sum, other));
}

/// `from -= factor · other`, element by element.
pub(crate) fn subtract(from: &mut [f64], factor: f64, other: &[f64]) {
    Arch::new().dispatch(Subtract(from, factor, other));
}

/// Sum of the products of two columns of one length.
///
/// Eight sums run side by side and are added at the end, in the order of nalgebra's `dot`.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    Arch::new().dispatch(Dot(a, b))
}

/// `from -= a · b`, element by element.
pub(crate) fn subtract_products(from: &mut [f64], a: &[f64], b: &[f64]) {
    Arch::new().dispatch(SubtractProducts(from, a, b));
}

struct Add<'a>(&'a mut [f64], &'a [f64]);

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (sum, v) in self.0.iter_mut().zip(self.1) {
            *sum += v;
        }
    }
}

struct Subtract<'a>(&'a mut [f64], f64, &'a [f64]);

impl WithSimd for Subtract<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let factor = self.1;
        for (v, r) in self.0.iter_mut().zip(self.2) {
            *v -= factor * r;
        }
    }
}

struct Dot<'a>(&'a [f64], &'a [f64]);

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let (a, a_rest) = self.0.as_chunks::<8>();
        let (b, b_rest) = self.1.as_chunks::<8>();
        let mut sums = [0.0; 8];
        for (a, b) in a.iter().zip(b) {
            // By place: the iterators of the lanes would not be inlined here.
            for lane in 0..8 {
                sums[lane] += a[lane] * b[lane];
            }
        }
        let [a0, a1, a2, a3, b0, b1, b2, b3] = sums;
        let mut sum = (a0 + b0) + (a1 + b1) + (a2 + b2) + (a3 + b3);
        for (a, b) in a_rest.iter().zip(b_rest) {
            sum += a * b;
        }
        sum
    }
}

struct SubtractProducts<'a>(&'a mut [f64], &'a [f64], &'a [f64]);

impl WithSimd for SubtractProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for ((v, a), b) in self.0.iter_mut().zip(self.1).zip(self.2) {
            *v -= a * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVectorView;

    #[test]
    fn each_element_is_that_of_the_plain_loop_to_the_last_bit() {
        let of = |seed: f64| -> Vec<f64> {
            let value = |i: usize| ((i as f64 + seed) * 12.9898).sin() * 43758.5453;
            (0..37).map(value).collect()
        };
        let (a, b, c) = (of(0.1), of(0.2), of(0.3));
        let check = |own: Vec<f64>, plain: &dyn Fn(usize) -> f64| {
            for (i, v) in own.iter().enumerate() {
                assert_eq!(v.to_bits(), plain(i).to_bits());
            }
        };
        let mut own = a.clone();
        add(&mut own, &b);
        check(own, &|i| a[i] + b[i]);
        let mut own = a.clone();
        subtract(&mut own, 0.7, &b);
        check(own, &|i| a[i] - 0.7 * b[i]);
        let mut own = a.clone();
        subtract_products(&mut own, &b, &c);
        check(own, &|i| a[i] - b[i] * c[i]);
        for length in 0..=37 {
            let (a, b) = (&a[..length], &b[..length]);
            let plain = DVectorView::from_slice(a, length).dot(&DVectorView::from_slice(b, length));
            assert_eq!(dot(a, b).to_bits(), plain.to_bits(), "{length}");
        }
    }
}
