//! The results of `bowden` as one HTML page, and individual figures as SVG.
//!
//! A page is a view: it reads [`bowden_lab::facts`] and [`bowden_trials::facts`] and computes
//! nothing. A page is self-contained (styles and figures are inline, nothing is loaded, no script
//! runs), follows the reader's colour scheme, can be printed, and works with a keyboard and a
//! screen reader. Numbers are `data` elements whose `value` is the number in the JSON, digit by
//! digit. The same facts give the same bytes.

mod chart;
mod check;
mod close;
mod compare;
mod document;
mod words;

pub use check::Check;
pub use close::Close;
pub use compare::Compare;
pub use document::Provenance;

use bowden_lab::facts::Figures;

/// A figure that can be drawn individually.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Output versus input.
    Loop,
    /// Both residuals over time.
    Residual,
    /// The output and both models over time.
    Trace,
    /// The size of each part of the model.
    Shares,
}

/// One figure as an SVG file; with several records, that of the first one.
#[must_use]
pub fn figure(figures: &Figures, figure: Figure) -> String {
    let signals = &figures.signals;
    let chart = match (figure, signals.files.first()) {
        (Figure::Loop, Some(file)) => close::hysteresis_loop(signals, file, "loop"),
        (Figure::Residual, Some(file)) => close::residual_over_time(signals, file, "residual"),
        (Figure::Trace, Some(file)) => close::trace(signals, file, "trace"),
        (Figure::Shares, _) | (_, None) => close::shares(signals, "shares"),
    };
    chart.file()
}
