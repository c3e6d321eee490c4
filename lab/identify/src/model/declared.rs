//! What a `--declare` list means.

use super::structure::{FitTerm, Structure};
use crate::problem::{Prepared, MOST_RECORDS};
use crate::record::Mode;
use bowden::effect::Effect;
use bowden::model::Source;

/// The effect that a user means by a name in `--declare`: an effect's own name, or a
/// family's, which stands for its first member. Shapes start at the record's scale.
///
/// # Errors
/// One sentence that lists what can be declared.
pub fn declared(name: &str, data: &Prepared) -> Result<FitTerm, String> {
    let (name, source) = match name.split_once('@') {
        None => (name, default_source(data)),
        Some((name, channel)) => {
            let index = data.channels.iter().position(|c| c.name == channel);
            let source = match index {
                Some(i) => Source::Channel(i as u8),
                None if channel == data.input.name => Source::Input,
                None => {
                    return Err(format!(
                        "--declare {name}@{channel}: no channel of that name in the record"
                    ))
                }
            };
            (name, source)
        }
    };
    let own = match name {
        "drag" => "drag-quadratic",
        "asymmetry" => "asymmetry-viscous",
        "direction" => "drive-friction",
        "stiffness" => "stiffness-linear",
        "saturation" => "saturation-upper",
        other => other,
    };
    let channel = data.channel(source).unwrap_or(&data.input);
    let shapes: &[f64] = match own {
        "capstan" => &[0.05 * channel.speed, 0.2 / channel.reach],
        "degradation" => &[data.path.last().copied().unwrap_or(1.0)],
        "coulomb"
        | "position-friction"
        | "load-friction"
        | "drive-friction"
        | "back-drive-friction" => &[0.05 * channel.speed],
        "stribeck" => &[0.3 * channel.speed, 1.0],
        "backlash" | "play-in-series" | "dead-zone" | "presliding" => &[0.1 * channel.reach],
        "lag" => &[channel.reach / channel.speed.max(1e-300)],
        "creep" => &[1.0],
        "pinching" => &[0.3],
        "hinge" | "saturation-upper" | "saturation-lower" | "gravity" => &[0.0],
        "temperature" => &[channel.middle],
        _ => &[],
    };
    let whole = matches!(
        own,
        "offset" | "gain" | "delay" | "lag" | "drift" | "play-in-series"
    );
    let (source, origin) = if whole {
        (Source::Input, 0.0)
    } else {
        (
            source,
            if own == "gravity" || own == "temperature" {
                0.0
            } else {
                channel.origin
            },
        )
    };
    let effect = Effect::try_from_name(own, shapes).map_err(|_| {
        format!("--declare {name}: not an effect that can be declared; known: bouc-wen, offset, gain, viscous, drag, coulomb, stribeck, asymmetry, load-friction, capstan, direction, inertia, stiffness, gravity, position-friction, backlash, play-in-series, delay, lag, creep, rate, presliding, pinching, degradation, drift, temperature, saturation, crosstalk")
    })?;
    Ok(FitTerm {
        effect,
        source,
        origin,
        start: [0.0; MOST_RECORDS],
    })
}

/// The structure that a `--declare` list means.
///
/// # Errors
/// One sentence where a name is not known or comes twice.
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
                return Err(format!("--declare {name}: named twice"));
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

/// In torque mode motion effects read the distal angle, else the proximal one.
fn default_source(data: &Prepared) -> Source {
    if data.mode == Mode::Displacement {
        return Source::Input;
    }
    let named = |name: &str| data.channels.iter().position(|c| c.name == name);
    named("phi_d")
        .or_else(|| named("phi_p"))
        .map_or(Source::Input, |i| Source::Channel(i as u8))
}
