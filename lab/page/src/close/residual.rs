//! The residuals over each variable, over lags and over frequencies, and the unmodelled curve.

use crate::chart::scale::Scale;
use crate::chart::{Axis, Chart};
use crate::words::{in_brackets, quantity};
use bowden_lab::facts::{number, Bin, Dependence, Facts, Figures, UnknownFacts};
use maud::{html, Markup};

/// The points of one of the two residuals with their intervals.
fn points(bins: &[Bin], of: usize) -> Vec<([f64; 2], Option<[f64; 2]>)> {
    let own = bins.iter().filter_map(|bin| {
        let mean = bin.means.get(of)?;
        Some(([bin.at, mean.value], mean.ci95))
    });
    own.collect()
}

/// The ends of all intervals.
fn ends(one: &Dependence) -> impl Iterator<Item = f64> + '_ {
    let means = one.bins.iter().flat_map(|b| &b.means);
    means.flat_map(|mean| match mean.ci95 {
        Some([low, high]) => [low, high],
        None => [mean.value; 2],
    })
}

/// Bins whose interval leaves zero out, of those that have one.
fn off_zero(bins: &[Bin], of: usize) -> (usize, usize) {
    let intervals = bins.iter().filter_map(|b| b.means.get(of)?.ci95);
    intervals.fold((0, 0), |(off, all), [low, high]| {
        (off + usize::from(low > 0.0 || high < 0.0), all + 1)
    })
}

/// Share of the bins in which the residual of the last model differs from zero.
fn stands_out(one: &Dependence) -> f64 {
    let (off, all) = off_zero(&one.bins, 1);
    off as f64 / all.max(1) as f64
}

fn over_one(one: &Dependence, k: usize, unit: Option<&str>) -> Chart {
    let y = Axis {
        label: quantity("residual", unit),
        scale: Scale::linear(ends(one)),
    };
    let x = Axis {
        label: quantity(&one.words, one.unit.as_deref()),
        scale: Scale::linear(one.bins.iter().map(|b| b.at)),
    };
    let ((before, all), (after, _)) = (off_zero(&one.bins, 0), off_zero(&one.bins, 1));
    let caption = match all {
        0 => "no intervals, because each bin is one time interval".to_owned(),
        _ => format!("{before} → {after} of {all} bins differ from zero"),
    };
    let description = format!(
        "Mean residual in bins of {}, before → after, at the 95 % level: {caption}.",
        one.words
    );
    Chart::new(&format!("over-{k}"), &one.words, &description, x, y)
        .low()
        .level("zero", 0.0)
        .dots("before", &points(&one.bins, 0))
        .dots("final", &points(&one.bins, 1))
        .caption(&caption)
}

/// So many figures are shown before the others are folded: those in which most bins differ from zero.
const WORST: usize = 4;

/// Residuals over all variables, each on its own scale.
pub(crate) fn over_all(figures: &Figures, unit: Option<&str>) -> Markup {
    let [first, last] = &figures.signals.models;
    let mut ranked: Vec<&Dependence> = figures.over.iter().collect();
    ranked.sort_by(|a, b| stands_out(b).total_cmp(&stands_out(a)));
    let charts: Vec<Markup> = ranked
        .iter()
        .enumerate()
        .map(|(k, one)| over_one(one, k, unit).figure())
        .collect();
    let (worst, others) = charts.split_at(charts.len().min(WORST));
    html! {
        p {
            "Mean residual in bins with equal numbers of samples, with 95 % intervals that allow for correlation in time. "
            "Open: " (first.name) "; filled: " (last.name)
            ". If the filled dots form a curve, the model lacks an effect. By chance, about one bin in twenty differs from zero."
        }
        div class="grid-of" { @for chart in worst { (chart) } }
        @if !others.is_empty() {
            details {
                summary { (others.len()) " more variables" }
                div class="grid-of" { @for chart in others { (chart) } }
            }
        }
    }
}

pub(super) fn over_variables(facts: &Facts, figures: &Figures) -> Markup {
    over_all(figures, facts.record.unit.as_deref())
}

/// Whether the residual is white: its autocorrelation and its spectrum.
pub(super) fn noise(facts: &Facts, figures: &Figures) -> Markup {
    noise_of(figures, facts.record.unit.as_deref(), facts.record.cutoff)
}

/// Autocorrelation and spectrum of both residuals.
pub(crate) fn noise_of(figures: &Figures, unit: Option<&str>, cutoff: f64) -> Markup {
    html! {
        p {
            "After the filter, even white noise is correlated over lags of up to about 1.5/f_c, where f_c is the cut-off frequency. The grey band contains 95 % of the estimates for filtered white noise. If the autocorrelation stays inside the band, the residual is noise. Otherwise the model lacks an effect."
        }
        div class="pair" {
            (autocorrelation(figures).figure())
            (spectrum(figures, unit, cutoff).figure())
        }
    }
}

fn autocorrelation(figures: &Figures) -> Chart {
    let of = &figures.autocorrelation;
    let [first, last] = &figures.signals.models;
    let at = |lag: usize| lag as f64 * of.step;
    let all = of.residuals.iter().flatten().copied();
    let outside: Vec<String> = of
        .residuals
        .iter()
        .map(|r| format!("{:.0} %", 100.0 * of.outside(r)))
        .collect();
    let description = format!(
        "Autocorrelation of the residuals over lags up to {} s. Lags outside the noise band: {} ({} → {}).",
        number(at(of.white.len().saturating_sub(1)), Some(0.01)),
        outside.join(" → "),
        first.name,
        last.name
    );
    let x = Axis {
        label: "lag [s]".to_owned(),
        scale: Scale::exactly(0.0, at(of.white.len().saturating_sub(1))),
    };
    let y = Axis {
        label: "autocorrelation".to_owned(),
        scale: Scale::linear(all.chain([1.0, -0.5])),
    };
    let lines = of.white.iter().zip(&of.half_width).enumerate();
    let band = lines.map(|(lag, (w, h))| [at(lag), w - h, w + h]);
    let mut chart = Chart::new(
        "autocorrelation",
        "Autocorrelation of the residual",
        &description,
        x,
        y,
    )
    .band("band", band)
    .level("zero", 0.0);
    for (class, residual) in ["before", "final"].into_iter().zip(&of.residuals) {
        let points = residual.iter().enumerate();
        chart = chart.line(class, points.map(|(lag, r)| [at(lag), *r]));
    }
    chart
        .key("before", &first.name)
        .key("final", &last.name)
        .key("band", "noise, 95 %")
        .caption(&format!("Lags outside the band: {}.", outside.join(" → ")))
}

fn spectrum(figures: &Figures, unit: Option<&str>, cutoff: f64) -> Chart {
    let of = &figures.spectrum;
    let [first, last] = &figures.signals.models;
    let inside = |values: &[f64]| {
        let pairs = of.frequency.iter().zip(values);
        // The filter's own fall beyond the cut-off would take up the axis.
        let own = pairs.filter(|(f, _)| **f <= 1.1 * cutoff).map(|(_, v)| *v);
        own.collect::<Vec<f64>>()
    };
    let seen: Vec<f64> = of
        .residuals
        .iter()
        .chain([&of.floor])
        .flat_map(|v| inside(v))
        .collect();
    let x = Axis {
        label: "frequency [Hz]".to_owned(),
        scale: Scale::logarithmic(of.frequency.iter().copied()),
    };
    let y = Axis {
        label: match unit {
            Some(unit) => format!("density [{unit}/√Hz]"),
            None => "density [1/√Hz]".to_owned(),
        },
        scale: Scale::logarithmic(seen),
    };
    let description = format!(
        "Square root of the power spectral density of the residuals on the fit segment. The vertical line is the cut-off frequency of the filter, {cutoff} Hz. The dotted line is the sensor noise, estimated from the record."
    );
    let pairs = |values: &[f64]| -> Vec<[f64; 2]> {
        let own = of.frequency.iter().zip(values);
        own.map(|(f, v)| [*f, *v]).collect()
    };
    let mut chart = Chart::new("spectrum", "Spectrum of the residual", &description, x, y)
        .moment("zero", cutoff)
        .line("floor", pairs(&of.floor));
    for (class, residual) in ["before", "final"].into_iter().zip(&of.residuals) {
        chart = chart.line(class, pairs(residual));
    }
    let chart = chart.key("before", &first.name).key("final", &last.name);
    match of.floor.is_empty() {
        true => chart,
        false => chart.key("floor", "sensor noise"),
    }
    .caption("The vertical line is the cut-off frequency of the filter.")
}

/// The curve of what no effect in the catalogue explains.
pub(super) fn unknown(facts: &Facts, unknown: &UnknownFacts) -> Markup {
    let unit = facts.record.unit.as_deref();
    let knots = &unknown.curve;
    let ends = knots.iter().flat_map(|k| k.ci95.unwrap_or([k.value; 2]));
    let x = Axis {
        label: quantity(&unknown.words, unknown.unit.as_deref()),
        scale: Scale::linear(knots.iter().map(|k| k.at)),
    };
    let y = Axis {
        label: quantity("adds", unit),
        scale: Scale::linear(ends.chain([0.0])),
    };
    let description = format!(
        "The unmodelled dependence as a free-form curve versus {}, with 95 % intervals.",
        unknown.words
    );
    let band = knots.iter().filter_map(|k| {
        let [low, high] = k.ci95?;
        Some([k.at, low, high])
    });
    let chart = Chart::new(
        "unknown-curve",
        "The unmodelled dependence as a curve",
        &description,
        x,
        y,
    )
    .level("zero", 0.0)
    .band("interval", band)
    .line("final", knots.iter().map(|k| [k.at, k.value]))
    .key("final", "curve")
    .key("interval", "95 %");
    html! {
        p {
            (unknown.sentence) " A free-form curve removes " (format!("{:.1}", 100.0 * unknown.share))
            " % of the squared error (p " (format!("{:.1e}", unknown.p)) "); " (unknown.kept)
            (in_brackets(unit)) "."
        }
        (chart.figure())
    }
}
