//! The hysteresis state along a record, with parameters that a user drags.
//!
//! The input comes from a trace, which has a few samples per shortest period. Between two samples
//! the input follows a cubic, so that its turning points stay where they were.

use crate::Answer;
use bowden::hysteresis::BoucWen;

/// Steps between two samples.
const STEPS: u32 = 8;

/// `bytes` are the input as little-endian 64-bit floats. The file `eta` of the answer is the state
/// at each of these samples, in the same format.
pub(crate) fn shape([rho, sigma, n, eta0]: [f64; 4], bytes: &[u8]) -> Result<Answer, String> {
    let shape = BoucWen::<f64>::try_new(rho, sigma, n).map_err(|e| e.to_string())?;
    let input: Vec<f64> = bytes
        .chunks_exact(8)
        .filter_map(|chunk| Some(f64::from_le_bytes(chunk.try_into().ok()?)))
        .collect();
    let mut answer = Answer::default();
    let states = states(&shape, eta0.clamp(-1.0, 1.0), &input);
    let bytes = states.iter().flat_map(|eta| eta.to_le_bytes()).collect();
    answer.files.push(("eta".to_owned(), bytes));
    Ok(answer)
}

fn states(shape: &BoucWen<f64>, eta0: f64, input: &[f64]) -> Vec<f64> {
    let mut eta = eta0;
    let mut all = Vec::with_capacity(input.len());
    for (index, &now) in input.iter().enumerate() {
        if index > 0 {
            let at = |index: usize| input.get(index).copied().unwrap_or(now);
            let before = input[index - 1];
            let ahead = [at(index.saturating_sub(2)), before, now, at(index + 1)];
            let mut last = before;
            for step in 1..=STEPS {
                let next = cubic(ahead, f64::from(step) / f64::from(STEPS));
                eta = shape.advance(eta, next - last);
                last = next;
            }
        }
        all.push(eta);
    }
    all
}

/// The cubic between the second and the third of four values, with slopes from their neighbours.
fn cubic([a, b, c, d]: [f64; 4], s: f64) -> f64 {
    let (before, after) = (0.5 * (c - a), 0.5 * (d - b));
    let (square, cube) = (s * s, s * s * s);
    b * (2.0 * cube - 3.0 * square + 1.0)
        + before * (cube - 2.0 * square + s)
        + c * (3.0 * square - 2.0 * cube)
        + after * (cube - square)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_few_samples_a_period_give_the_state_of_many() {
        let shape = BoucWen::<f64>::try_new(0.4, 2.0, 1.2).unwrap();
        let wave = |steps: u32| -> Vec<f64> {
            (0..=5 * steps)
                .map(|k| 10.0 * (std::f64::consts::TAU * f64::from(k) / f64::from(steps)).sin())
                .collect()
        };
        let (few, many) = (
            states(&shape, 0.0, &wave(12)),
            states(&shape, 0.0, &wave(1200)),
        );
        for (k, eta) in few.iter().enumerate() {
            // The error of the cubic is 1 % of the amplitude at the crests of a twelve-sample sine.
            assert!(
                (eta - many[100 * k]).abs() < 0.05,
                "{k}: {eta} {}",
                many[100 * k]
            );
        }
    }

    #[test]
    fn parameters_out_of_range_get_one_line() {
        let line = shape([0.4, 0.1, 1.0, 0.0], &[]).unwrap_err();
        assert!(line.contains("sigma"), "{line}");
    }
}
