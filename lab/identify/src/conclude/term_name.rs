//! The names of terms.

use crate::model::effects::{entry, ToldBy};
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use bowden::model::Source;

/// The name of a term: that of the effect, with the channel if it reads another than the input.
#[must_use]
pub fn term_name(data: &Prepared, term: &FitTerm) -> String {
    match term.source {
        Source::Input => term.effect.name().to_owned(),
        Source::Channel(_) => format!(
            "{}@{}",
            term.effect.name(),
            data.channel(term.source).map_or("?", |c| c.name.as_str())
        ),
    }
}

/// The name of a term in words: with the order of a ripple or the frequency of a tone, which
/// distinguishes two of them.
#[must_use]
pub fn term_title(data: &Prepared, term: &FitTerm) -> String {
    let name = term_name(data, term);
    let told_by = entry(term.effect.name()).map_or(ToldBy::Name, |entry| entry.told_by);
    match (told_by, term.effect.shape(0)) {
        (ToldBy::Name, _) | (_, None) => name,
        (ToldBy::Frequency, Some(f)) => format!("{name} ({f:.3} Hz)"),
        (ToldBy::Order, Some(k)) => {
            let unit = data.channel(term.source).and_then(|c| c.unit.as_deref());
            let of_an_angle = |k: f64| format!("{name} (order {k:.2})");
            match unit {
                None | Some("rad") => of_an_angle(k),
                Some("deg" | "°") => of_an_angle(k.to_degrees()),
                Some(unit) => format!("{name} (period {:.3} {unit})", std::f64::consts::TAU / k),
            }
        }
    }
}
