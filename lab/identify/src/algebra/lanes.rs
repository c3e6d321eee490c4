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

/// Coefficients of the least-squares fit of the last of `size` columns to the others, by a Cholesky
/// factorisation of their products. Only the lower triangle of `products`, which is stored by
/// columns, is read, and it is overwritten. `None` if the other columns are dependent.
pub(crate) fn coefficients(products: &mut [f64], size: usize) -> Option<Vec<f64>> {
    Arch::new().dispatch(Coefficients(products, size))
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

struct Coefficients<'a>(&'a mut [f64], usize);

impl WithSimd for Coefficients<'_> {
    type Output = Option<Vec<f64>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self(products, size) = self;
        let last = size - 1;
        for k in 0..last {
            let (done, rest) = products.split_at_mut((k + 1) * size);
            let column = &mut done[k * size + k..];
            if column[0] <= 0.0 || column[0].is_nan() {
                return None;
            }
            let root = column[0].sqrt();
            for v in column.iter_mut() {
                *v /= root;
            }
            for (i, other) in rest.chunks_exact_mut(size).enumerate() {
                let own = &column[i + 1..];
                let factor = own[0];
                for (v, l) in other[k + 1 + i..].iter_mut().zip(own) {
                    *v -= factor * l;
                }
            }
        }
        // The last row now holds the right-hand side of a triangular system.
        let mut solution = vec![0.0; last];
        for k in (0..last).rev() {
            let column = &products[k * size + k..(k + 1) * size];
            let known = solution[k + 1..].iter().zip(&column[1..]);
            let known: f64 = known.map(|(x, l)| x * l).sum();
            solution[k] = (column[last - k] - known) / column[0];
        }
        Some(solution)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector, DVectorView};

    #[test]
    fn a_column_is_fitted_to_independent_columns_and_to_no_others() {
        for size in [1, 2, 7, 8, 9, 40] {
            let of = |i: usize, j: usize| ((3 * i + 7 * j + i * j) % 11) as f64;
            let columns = DMatrix::from_fn(50, size, |i, j| of(i, j) + f64::from(u8::from(i == j)));
            let x = DVector::from_fn(size, |i, _| i as f64 - 3.0);
            let mut all = columns.clone().insert_columns(size, 1, 0.0);
            all.set_column(size, &(&columns * &x));
            let products = all.tr_mul(&all);
            let own = coefficients(products.clone().as_mut_slice(), size + 1).unwrap();
            // Squared singular values from about 1 to 1e5, so rounding errors of about 1e-11.
            assert!((DVector::from_vec(own) - x).amax() < 1e-7, "{size}");
            for wrong in [-1.0, 0.0, f64::NAN] {
                let mut products = products.clone();
                products[(size - 1, size - 1)] = wrong;
                assert_eq!(coefficients(products.as_mut_slice(), size + 1), None);
            }
        }
    }

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
