//! A record that is fine, as text.

/// A record that is fine: 400 samples at 100 Hz in three columns.
pub fn rows() -> Vec<String> {
    let row = |i: i32| {
        let t = f64::from(i) * 0.01;
        format!(
            "{t:.2},{:.6},{:.6}",
            10.0 * (3.0 * t).sin(),
            25.0 * (3.0 * t + 0.2).sin()
        )
    };
    (0..400).map(row).collect()
}

pub fn csv(header: &str, rows: &[String]) -> String {
    format!("{header}\n{}\n", rows.join("\n"))
}

/// The record with one line (numbered as an editor does) replaced.
pub fn with_line(line: usize, text: &str) -> String {
    let mut rows = rows();
    rows[line - 2] = text.to_owned();
    csv("t,x,f", &rows)
}
