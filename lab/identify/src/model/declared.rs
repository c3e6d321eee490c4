//! The meaning of a `--baseline` list.

use super::effects::{entry, first_of, Declared, Zero};
use super::kind::{kind, Kind};
use super::structure::{FitTerm, Structure};
use crate::problem::{Prepared, MOST_RECORDS};
use crate::record::{nearest, Mode};
use bowden::effect::{Effect, CATALOGUE};
use bowden::model::Source;

/// The effect that a name in `--baseline` means: the name of an effect, or of a family, which means
/// its first member. Shapes start at the record's scale.
///
/// # Errors
/// A message with the allowed effects.
pub fn declared(name: &str, data: &Prepared) -> Result<FitTerm, String> {
    let (name, given) = match name.split_once('@') {
        None => (name, None),
        Some((name, channel)) => {
            let index = data.channels.iter().position(|c| c.name == channel);
            let source = match index {
                Some(i) => Source::Channel(i as u8),
                None if channel == data.input.name => Source::Input,
                None => {
                    let names = data.channels.iter().map(|c| c.name.as_str());
                    let all: Vec<&str> = names.chain([data.input.name.as_str()]).collect();
                    return Err(format!(
                        "--baseline {name}@{channel}: no such channel; the channels are {}{}",
                        all.join(", "),
                        nearest(channel, all.iter().copied())
                    ));
                }
            };
            (name, Some(source))
        }
    };
    let unknown = || {
        let known = families().join(", ");
        let effects = CATALOGUE.iter().map(|info| info.name);
        let mut names: Vec<&str> = effects.chain(["bouc-wen"]).chain(families()).collect();
        names.sort_unstable();
        names.dedup();
        let near = nearest(name, names);
        format!("--baseline {name}: no such effect{near}; allowed are bouc-wen, {known}, and any single effect of these families, such as play-in-series")
    };
    let entry = entry(name).or_else(|| first_of(name)).ok_or_else(unknown)?;
    let source = match (given, entry.declared) {
        (Some(source), _) => source,
        (None, Declared::OnStretch) => stretch(data).ok_or_else(|| {
            format!("--baseline {name}: the record has no stretch channel; --channel stretch=phi_p-phi_d adds one")
        })?,
        (None, _) => default_source(data),
    };
    let channel = data.channel(source).unwrap_or(&data.input);
    let (scales, source, origin) = match (entry.declared, entry.zero) {
        (Declared::OnChannel(scales), Zero::Channel) => (scales, source, channel.origin),
        (Declared::OnChannel(scales), Zero::Sensor) => (scales, source, 0.0),
        (Declared::OnStretch, _) => (&[][..], source, channel.origin),
        (Declared::OnInput(scales), _) => (scales, Source::Input, 0.0),
        (Declared::Never, _) => {
            return Err(format!(
                "--baseline {name}: only the search can add this effect; omit it"
            ))
        }
    };
    let shapes: Vec<f64> = scales.iter().map(|scale| scale.on(data, channel)).collect();
    let effect = Effect::try_from_name(entry.name, &shapes).map_err(|_| unknown())?;
    Ok(FitTerm {
        effect,
        source,
        origin,
        start: [0.0; MOST_RECORDS],
    })
}

/// The families whose first effect can be part of the baseline model.
fn families() -> Vec<&'static str> {
    let can = |name: &&str| first_of(name).is_some_and(|entry| entry.declared != Declared::Never);
    let mut names: Vec<&'static str> = CATALOGUE
        .iter()
        .map(|info| info.family)
        .filter(can)
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The structure that a `--baseline` list means.
///
/// # Errors
/// A message if a name is unknown or repeated.
pub fn structure(list: &[String], data: &Prepared) -> Result<Structure, String> {
    let mut structure = Structure::default();
    for name in list {
        if name == "bouc-wen" {
            structure.hysteresis = true;
        } else {
            let term = declared(name, data)?;
            if structure
                .terms
                .iter()
                .any(|t| t.effect.name() == term.effect.name() && t.source == term.source)
            {
                return Err(format!("--baseline {name}: named twice"));
            }
            structure.terms.push(term);
        }
    }
    if structure.hysteresis {
        // The transmission brings its own constant.
        structure.terms.retain(|t| t.effect.name() != "offset");
    }
    Ok(structure)
}

/// The first channel that is the stretch of a cable.
fn stretch(data: &Prepared) -> Option<Source> {
    let sources = (0..data.channels.len()).map(|i| Source::Channel(i as u8));
    let mut named = sources.zip(&data.channels);
    let found = named.find(|(source, c)| kind(data.mode, *source, c) == Kind::Stretch);
    found.map(|(source, _)| source)
}

/// In torque mode motion effects read the distal angle, otherwise the proximal one.
fn default_source(data: &Prepared) -> Source {
    if data.mode == Mode::Displacement {
        return Source::Input;
    }
    let named = |name: &str| data.channels.iter().position(|c| c.name == name);
    named("phi_d")
        .or_else(|| named("phi_p"))
        .map_or(Source::Input, |i| Source::Channel(i as u8))
}
