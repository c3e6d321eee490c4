//! Products and sums over columns as plain slices: half the instructions of a matrix library's,
//! whose columns have strides.

/// Numbers that are summed side by side.
const ABREAST: usize = 8;

/// The sum of products.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; ABREAST];
    let (whole, others) = (a.chunks_exact(ABREAST), b.chunks_exact(ABREAST));
    let rest: f64 = whole
        .remainder()
        .iter()
        .zip(others.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in whole.zip(others) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    rest + sums.iter().sum::<f64>()
}

/// The root of the sum of squares.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `column −= by·other`.
pub(crate) fn subtract(column: &mut [f64], by: f64, other: &[f64]) {
    for (value, own) in column.iter_mut().zip(other) {
        *value -= by * own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_any_length_are_exact_on_small_integers() {
        for n in [0, 1, 7, 8, 9, 40] {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let squares: f64 = (0..n).map(|i| f64::from(i * i)).sum();
            assert_eq!(dot(&a, &a), squares);
            assert_eq!(norm(&a), squares.sqrt());
            let mut left = a.clone();
            subtract(&mut left, 1.0, &a);
            assert!(left.iter().all(|v| *v == 0.0));
        }
    }
}
