//! Effects that the catalogue does not list, which the search must report as "unknown".
//!
//! A local bump is caused by a single bad tooth, a kinked cable or a worn spot of a guide; a spike
//! after each reversal is caused by a part that knocks against its stop.

use super::regressor::{Extent, Regressor, Sense};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// A bump in the place of the usual motion, a bump in the transmitted load, and a spike
/// of one sign for both directions over the first path after each reversal of the input.
pub(super) const NAMES: [&str; 3] = ["bump-position", "bump-load", "reversal-spike"];

/// Names of effects that can be planted but that the catalogue does not list.
pub fn outsiders() -> &'static [&'static str] {
    &NAMES
}

pub(super) fn build(
    effect: &str,
    extent: &Extent,
    input: &Extent,
    rng: &mut ChaCha8Rng,
) -> Option<Regressor> {
    let regressor = match effect {
        "bump-position" | "bump-load" => {
            let place = extent.quantile(rng.random_range(0.3..0.7));
            let width = rng.random_range(0.06..0.1) * extent.reach;
            Regressor::new(Sense::Either, move |_, m| {
                (-0.5 * ((m.x - place) / width).powi(2)).exp()
            })
            .with("place", extent.mean + place)
            .with("width", width)
        }
        "reversal-spike" => spike(rng.random_range(0.04..0.08) * input.reach),
        _ => return None,
    };
    Some(regressor)
}

/// exp(−d/length) of the distance d that the input has moved since it turned.
fn spike(length: f64) -> Regressor {
    let (mut rising, mut since) = (true, 0.0);
    Regressor::new(Sense::Either, move |at, _| {
        let v = at.input.v;
        if (v > 0.0) != rising && v != 0.0 {
            rising = v > 0.0;
            since = 0.0;
        }
        since += v.abs() * at.dt;
        (-since / length).exp()
    })
    .with("length", length)
}
