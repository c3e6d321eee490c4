//! The format of a number in all sentences and tables.

/// A number with as many digits as its interval justifies.
#[must_use]
pub fn number(value: f64, half_width: Option<f64>) -> String {
    let digits = match half_width {
        Some(w) if w > 0.0 && w.is_finite() => (1.0 - w.log10().floor()).clamp(0.0, 12.0) as usize,
        _ if value == 0.0 => 0,
        _ => (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize,
    };
    if value.abs() >= 1e7 || (value != 0.0 && value.abs() < 1e-5) {
        format!("{value:.3e}")
    } else {
        format!("{value:.digits$}")
    }
}

/// "1.10 ± 0.01", or the value alone if it has no interval.
#[must_use]
pub fn with_interval(value: f64, ci95: Option<[f64; 2]>) -> String {
    match ci95 {
        Some([low, high]) => {
            let half = 0.5 * (high - low);
            format!(
                "{} ± {}",
                number(value, Some(half)),
                number(half, Some(half))
            )
        }
        None => number(value, None),
    }
}

/// A share in per cent with two digits, "1.3 %".
#[must_use]
pub fn share(share: f64) -> String {
    format!("{} %", number(100.0 * share, Some(5.0 * share)))
}
