//! Zero exclusion: no zero of a function on the imaginary axis, for any plant of a range.

use super::halving::Halving;
use super::interval::{Plane, Span};
use super::PlantRange;

/// Maximum number of regions in a proof. A proof takes about a tenth of a second on a computer.
const MOST_BOXES: u32 = 400_000;

/// Maximum number of bisections of a region.
const DEEPEST: u32 = 60;

/// Number of regions in the proof that a function has no zero on the imaginary axis below the
/// frequency `highest` \[rad/s\]. The proof covers the straight path from a nominal plant to the
/// middle of a range, and every plant of the range. `None` if no proof was found.
///
/// `values` is a region that contains all values of the function at some frequencies \[rad/s\], for
/// some plants and observers with some latency \[s\]. The function hardly changes far below the
/// frequency `scale`. Along the path, the latency of the observer grows from zero to `observed`.
pub(super) fn excluded(
    values: impl Fn(Span, &PlantRange, Span) -> Plane,
    scale: f64,
    [nominal, all]: [PlantRange; 2],
    observed: f64,
    highest: f64,
) -> Option<u32> {
    let (zero, observed) = (Span::exactly(0.0), Span::exactly(observed));
    let middle = all.middle();
    let shows = |(frequency, set): &(Span, Set)| {
        let (plants, observed) = match set {
            Set::Way(part) => (
                nominal.between(middle, *part),
                zero.towards(observed, *part),
            ),
            Set::All(plants) => (*plants, observed),
        };
        values(*frequency, &plants, observed).is_off_zero()
    };
    let halves = |of: &(Span, Set)| halves(of, scale);
    let from_zero = |high: f64| Span { high, ..zero };
    let mut halving = Halving::at_most(MOST_BOXES);
    let mut shown = |set: Set| halving.all(&(from_zero(highest), set), DEEPEST, &shows, &halves);
    (shown(Set::Way(from_zero(1.0))) && shown(Set::All(all))).then_some(halving.boxes)
}

/// The first of the frequencies r, 2·r, 4·r, ... that is high enough.
pub(super) fn doubled(r: f64, is_enough: impl Fn(f64) -> bool) -> Option<f64> {
    let doubled = core::iter::successors(Some(r), |r| Some(2.0 * r));
    doubled.take(64).find(|r| is_enough(*r))
}

/// Plants that are examined together.
#[derive(Clone, Copy)]
enum Set {
    /// The plants of a part of the path from the nominal plant, from 0 to 1.
    Way(Span),
    /// All plants between bounds.
    All(PlantRange),
}

/// The two halves of the frequencies, or of the plants along the parameter that changes the
/// function most.
fn halves((frequency, set): &(Span, Set), scale: f64) -> [(Span, Set); 2] {
    let (size, halves) = match set {
        Set::Way(part) => (part.width(), part.halves().map(Set::Way)),
        Set::All(plants) => {
            let (size, halves) = plants.halves(frequency.high);
            (size, halves.map(Set::All))
        }
    };
    if frequency.width() >= size * (frequency.middle() + scale) {
        return frequency.halves().map(|half| (half, *set));
    }
    halves.map(|half| (*frequency, half))
}
