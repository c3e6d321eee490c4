//! Fewer points that look the same: the extremes of each column of pixels, or one point for each
//! cell of a plane.

use std::collections::BTreeSet;

/// Keeps the lowest and the highest point of each column of the unit interval, in order, and both
/// ends. The points must have ascending x in 0..=1.
#[must_use]
pub fn columns(points: &[[f64; 2]], columns: usize) -> Vec<[f64; 2]> {
    if points.len() <= 2 * columns {
        return points.to_vec();
    }
    let column = |p: &[f64; 2]| (p[0] * columns as f64) as usize;
    let mut kept = Vec::with_capacity(2 * columns + 2);
    kept.extend(points.first());
    for own in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_y = |(_, a): &(usize, &[f64; 2]), (_, b): &(usize, &[f64; 2])| a[1].total_cmp(&b[1]);
        let least = own.iter().enumerate().min_by(by_y).map(|(k, _)| k);
        let most = own.iter().enumerate().max_by(by_y).map(|(k, _)| k);
        let mut ends: Vec<usize> = least.into_iter().chain(most).collect();
        ends.sort_unstable();
        ends.dedup();
        kept.extend(ends.into_iter().map(|k| own[k]));
    }
    kept.extend(points.last());
    kept
}

/// The lines of a path through the unit square, without repetitions: a point is kept if its cell is
/// new. The cells are enlarged until the number of points is at most the given one.
#[must_use]
pub fn cells(points: &[[f64; 2]], most: usize) -> Vec<Vec<[f64; 2]>> {
    let mut size = 1.0 / 800.0;
    loop {
        let lines = over_cells(points, size);
        if lines.iter().map(Vec::len).sum::<usize>() <= most || size > 0.1 {
            return lines;
        }
        size *= 1.5;
    }
}

fn over_cells(points: &[[f64; 2]], size: f64) -> Vec<Vec<[f64; 2]>> {
    let mut seen = BTreeSet::new();
    let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut skipped: Option<[f64; 2]> = None;
    let mut open = false;
    for point in points {
        let cell = point.map(|v| (v / size).floor() as i64);
        if !seen.insert(cell) {
            skipped = Some(*point);
            // Within its own cell a path goes on; elsewhere it has been before.
            let last = lines.last().and_then(|line| line.last());
            open &= last.is_some_and(|p| p.map(|v| (v / size).floor() as i64) == cell);
            continue;
        }
        if !open {
            lines.push(skipped.into_iter().collect());
            open = true;
        }
        if let Some(line) = lines.last_mut() {
            line.push(*point);
        }
    }
    lines
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_of_one_sample_among_a_million_stays() {
        let n = 1_000_000;
        let mut points: Vec<[f64; 2]> = (0..n)
            .map(|i| {
                let x = f64::from(i) / f64::from(n);
                [x, (1000.0 * x).sin()]
            })
            .collect();
        points[123_456][1] = 40.0;
        points[654_321][1] = -30.0;
        let thin = columns(&points, 900);
        assert!(thin.len() <= 1802, "{}", thin.len());
        assert!(thin.contains(&points[123_456]) && thin.contains(&points[654_321]));
        assert!(thin.windows(2).all(|w| w[0][0] <= w[1][0]));
        assert_eq!(
            (thin[0], *thin.last().unwrap()),
            (points[0], points[999_999])
        );
        assert_eq!(columns(&points[..50], 900), points[..50]);
    }

    #[test]
    fn a_loop_that_is_run_through_again_is_drawn_once() {
        let turn = |laps: usize| -> Vec<[f64; 2]> {
            (0..400 * laps)
                .map(|i| std::f64::consts::TAU * i as f64 / 400.0)
                .map(|a| [0.5 + 0.4 * a.cos(), 0.5 + 0.4 * a.sin()])
                .collect()
        };
        let count = |laps| cells(&turn(laps), 4000).iter().map(Vec::len).sum::<usize>();
        // The second lap differs in the last digit of a few points.
        assert!(count(50) <= count(1) + 20, "{} {}", count(50), count(1));
        // Whatever fills the plane is bounded.
        let wild: Vec<[f64; 2]> = (0..300_000)
            .map(|i| {
                [
                    (f64::from(i) * 0.618_034).fract(),
                    (f64::from(i) * 0.414_214).fract(),
                ]
            })
            .collect();
        assert!(cells(&wild, 4000).iter().map(Vec::len).sum::<usize>() <= 4000);
    }
}
