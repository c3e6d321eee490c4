//! The measured loop in braille dots, for a terminal.
//!
//! Alternatives: `textplots` draws its own frame, axes and colours around the plot; `drawille`,
//! which it uses, would save only the few lines that set dots.

use bowden_lab::facts::{Segment, Signals};
use std::fmt::Write as _;

/// Size of the drawing in characters, each of two by four dots.
const SIZE: [usize; 2] = [56, 12];
/// The bit of each dot of a character, by column and row.
const DOTS: [[u8; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Output versus input of the first record; `None` if nothing moves.
#[must_use]
pub fn loop_text(signals: &Signals) -> Option<String> {
    let rows = signals.files.first()?.rows.clone();
    let rows = rows.filter(|&row| signals.segments[row] != Segment::Dropped);
    let (input, output) = (&signals.input, &signals.measured);
    let points: Vec<[f64; 2]> = rows.map(|r| [input.values[r], output.values[r]]).collect();
    let dots = [2 * SIZE[0] - 1, 4 * SIZE[1] - 1];
    let ends: [[f64; 2]; 2] = [0, 1].map(|axis| {
        let own = points.iter().map(|p| p[axis]);
        own.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v), high.max(v)]
        })
    });
    if !ends.iter().all(|[low, high]| high > low) {
        return None;
    }
    let place = |p: &[f64; 2]| -> [f64; 2] {
        [0, 1].map(|a| (p[a] - ends[a][0]) / (ends[a][1] - ends[a][0]) * dots[a] as f64)
    };
    let mut cells = vec![[0_u8; SIZE[0]]; SIZE[1]];
    for pair in points.windows(2) {
        let [from, to] = [place(&pair[0]), place(&pair[1])];
        let steps = (to[0] - from[0]).abs().max((to[1] - from[1]).abs()).ceil() as usize + 1;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let [x, y] = [0, 1].map(|a| (from[a] + share * (to[a] - from[a])).round() as usize);
            let y = dots[1] - y.min(dots[1]);
            let x = x.min(dots[0]);
            cells[y / 4][x / 2] |= DOTS[x % 2][y % 4];
        }
    }
    let named = |name: &str, unit: Option<&str>| match unit {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    };
    let mut out = format!(" {}\n", named(&output.name, output.unit.as_deref()));
    for line in &cells {
        let line: String = line
            .iter()
            .filter_map(|bits| char::from_u32(0x2800 + u32::from(*bits)))
            .collect();
        let _ = writeln!(out, " {}", line.trim_end_matches('\u{2800}'));
    }
    let label = named(&input.name, input.unit.as_deref());
    let _ = writeln!(out, " {label:>width$}", width = SIZE[0]);
    Some(out)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use bowden_lab::facts::{Column, File};

    fn column(name: &str, values: Vec<f64>) -> Column {
        Column {
            name: name.to_owned(),
            unit: Some("N".to_owned()),
            values,
        }
    }

    fn signals(input: Vec<f64>, output: Vec<f64>) -> Signals {
        let n = input.len();
        Signals {
            files: vec![File {
                path: String::new(),
                rows: 0..n,
                worst: None,
            }],
            step: 0.1,
            segments: vec![Segment::Fit; n],
            models: ["a", "b"].map(|name| column(name, output.clone())),
            input: column("x", input),
            channels: Vec::new(),
            measured: column("f", output),
            residuals: [vec![0.0; n], vec![0.0; n]],
            parts: Vec::new(),
        }
    }

    #[test]
    fn a_line_goes_from_the_lower_left_to_the_upper_right() {
        let text = loop_text(&signals(vec![0.0, 1.0], vec![-3.0, 5.0])).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), SIZE[1] + 2);
        assert_eq!((lines[0], lines[SIZE[1] + 1].trim()), (" f [N]", "x [N]"));
        // The upper right dot is the eighth of its character's right column, the lower left is 7.
        assert_eq!(lines[1].chars().count(), SIZE[0] + 1);
        let last = lines[SIZE[1]].trim_start();
        assert!(last
            .chars()
            .next()
            .is_some_and(|c| (c as u32 - 0x2800) & 0x40 != 0));
        let dots: u32 = text
            .chars()
            .filter(|c| ('\u{2800}'..='\u{28ff}').contains(c))
            .map(|c| (c as u32 - 0x2800).count_ones())
            .sum();
        // One dot for each of the 112 columns, in places two.
        assert!((112..230).contains(&dots), "{dots}");
    }

    #[test]
    fn what_does_not_move_is_not_drawn() {
        assert_eq!(loop_text(&signals(vec![1.0; 9], vec![2.0; 9])), None);
        assert_eq!(loop_text(&signals(Vec::new(), Vec::new())), None);
        assert_eq!(
            loop_text(&signals(vec![f64::NAN; 3], vec![1.0, 2.0, 3.0])),
            None
        );
    }
}
