//! Axes: from values to a share of the axis, with ticks at round numbers.

/// A linear or logarithmic axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    whole: bool,
}

/// A tick: its share of the axis and its label.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Share of the axis, 0 at its lower end.
    pub at: f64,
    /// The number at the tick.
    pub label: String,
}

impl Scale {
    /// A linear axis over all finite values, with a margin.
    #[must_use]
    pub fn linear(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = range(values);
        let margin = match high > low {
            true => 0.04 * (high - low),
            false => 0.5 * high.abs().max(1.0),
        };
        Self {
            low: low - margin,
            high: high + margin,
            logarithmic: false,
            whole: false,
        }
    }

    /// A linear axis from one to the last number, with ticks at whole numbers.
    #[must_use]
    pub fn counting(last: usize) -> Self {
        Self {
            low: 0.4,
            high: last.max(1) as f64 + 0.6,
            logarithmic: false,
            whole: true,
        }
    }

    /// A linear axis from one end to the other without a margin.
    #[must_use]
    pub fn exactly(low: f64, high: f64) -> Self {
        match low.is_finite() && high.is_finite() && high > low {
            true => Self {
                low,
                high,
                logarithmic: false,
                whole: false,
            },
            false => Self::linear([low, high]),
        }
    }

    /// A logarithmic axis over all finite values above zero.
    #[must_use]
    pub fn logarithmic(values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|v| *v > 0.0).map(f64::log10);
        let (low, high) = range(positive);
        let margin = if high > low { 0.03 * (high - low) } else { 0.5 };
        Self {
            low: low - margin,
            high: high + margin,
            logarithmic: true,
            whole: false,
        }
    }

    /// Share of the axis at which a value lies; `None` if the value is outside the axis.
    #[must_use]
    pub fn at(&self, value: f64) -> Option<f64> {
        let value = match self.logarithmic {
            true => value.log10(),
            false => value,
        };
        let share = (value - self.low) / (self.high - self.low);
        share.is_finite().then_some(share)
    }

    /// About that many ticks at round numbers.
    #[must_use]
    pub fn ticks(&self, about: usize) -> Vec<Tick> {
        let span = self.high - self.low;
        if self.logarithmic && span > 1.2 {
            let every = (span / about.max(1) as f64).ceil().max(1.0);
            return self.multiples(every, |v| power(v as i32));
        }
        if self.logarithmic {
            return self.few();
        }
        let least = if self.whole { 1.0 } else { 0.0 };
        let raw = (span / about.max(1) as f64).max(least);
        let unit = 10.0_f64.powf(raw.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0];
        let step = unit
            * steps
                .into_iter()
                .find(|s| s * unit >= 0.7 * raw)
                .unwrap_or(10.0);
        self.multiples(step, |v| round(v, step))
    }

    fn multiples(&self, step: f64, label: impl Fn(f64) -> String) -> Vec<Tick> {
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last)
            .map(|k| k as f64 * step)
            .map(|v| Tick {
                at: (v - self.low) / (self.high - self.low),
                label: label(v),
            })
            .collect()
    }

    /// Ticks of a logarithmic axis of about one decade: 1, 2 and 5.
    fn few(&self) -> Vec<Tick> {
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10.0_f64.powi(d)));
        all.filter_map(|v| {
            let at = self.at(v).filter(|at| (0.0..=1.0).contains(at))?;
            Some(Tick {
                at,
                label: round(v, 0.1 * v),
            })
        })
        .collect()
    }
}

/// The smallest and the largest finite value; 0 and 1 if there is none.
fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    if low > high {
        (0.0, 1.0)
    } else {
        (low, high)
    }
}

/// A multiple of a round step with the digits that the step needs.
fn round(value: f64, step: f64) -> String {
    let digits = (-step.log10()).ceil().clamp(0.0, 12.0) as usize;
    let text = match value.abs() {
        v if v < 0.5 * step => "0".to_owned(),
        v if v >= 1e6 || step < 1e-4 => format!("{value:.1e}").replace(".0e", "e"),
        _ => format!("{value:.digits$}"),
    };
    text.replace('-', "−")
}

/// A power of ten.
fn power(exponent: i32) -> String {
    match exponent {
        -3..=3 => round(10.0_f64.powi(exponent), 10.0_f64.powi(exponent)),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, about: usize) -> Vec<String> {
        scale.ticks(about).into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers_inside_of_the_axis() {
        let scale = Scale::exactly(-1.0, 1.0);
        assert_eq!(labels(scale, 4), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
        let at: Vec<f64> = scale.ticks(4).iter().map(|t| t.at).collect();
        assert_eq!(at, [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(labels(Scale::counting(3), 8), ["1", "2", "3"]);
        assert_eq!(
            labels(Scale::exactly(0.0, 61.0), 4),
            ["0", "20", "40", "60"]
        );
        assert_eq!(labels(Scale::exactly(2e-6, 4e-6), 2)[0], "2e−6");
        assert_eq!(
            labels(Scale::logarithmic([0.1, 100.0]), 4),
            ["0.1", "1", "10", "100"]
        );
        assert_eq!(
            labels(Scale::logarithmic([1.0, 6.0]), 4),
            ["1.0", "2.0", "5.0"]
        );
    }

    #[test]
    fn no_axis_is_without_a_length_and_no_place_is_without_a_number() {
        for values in [vec![], vec![3.0], vec![0.0, 0.0], vec![f64::NAN, 1.0]] {
            for scale in [
                Scale::linear(values.clone()),
                Scale::logarithmic(values.clone()),
                Scale::exactly(f64::NAN, 1.0),
            ] {
                assert!(scale.at(1.0).is_some_and(f64::is_finite), "{values:?}");
                assert!(scale.at(f64::NAN).is_none() && scale.at(f64::INFINITY).is_none());
                assert!(scale.ticks(5).len() < 20);
            }
        }
        assert_eq!(Scale::logarithmic([1.0, 10.0]).at(0.0), None);
    }
}
