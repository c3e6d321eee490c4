//! Zero exclusion: no zero of a function on the imaginary axis, for any plant of a range.

use super::halving::Halving;
use super::interval::{Plane, Span};
use super::PlantRange;

/// Maximum number of regions in a proof. A proof takes about a tenth of a second on a computer.
const MOST_BOXES: u32 = 400_000;

/// Maximum number of bisections of a region.
const MOST_HALVINGS: u32 = 60;

/// A closed loop whose function must not have a zero on the imaginary axis.
pub(super) trait Closed {
    /// A region that contains all values of its function at these frequencies, with an observer of
    /// this latency.
    fn values(&self, frequency: Span, plants: &PlantRange, observed: Span) -> Plane;

    /// A frequency far below which the function hardly changes \[rad/s\].
    fn scale(&self) -> f64;
}

/// Number of regions in the proof that no zero lies on the imaginary axis below a frequency
/// \[rad/s\]. The proof covers the straight path from a nominal plant to the middle of a range,
/// and every plant of the range. `None` if no proof was found.
///
/// Along the path, the latency of the observer grows from zero to `observed` \[s\].
pub(super) fn excluded<C: Closed>(
    closed: &C,
    nominal: PlantRange,
    all: PlantRange,
    observed: f64,
    highest: f64,
) -> Option<u32> {
    let (zero, observed) = (Span::exactly(0.0), Span::exactly(observed));
    let shows = |(frequency, set): &(Span, Set)| {
        let (plants, observed) = match set {
            Set::Way(part) => (
                nominal.between(all.middle(), *part),
                zero.towards(observed, *part),
            ),
            Set::All(plants) => (*plants, observed),
        };
        closed.values(*frequency, &plants, observed).is_off_zero()
    };
    let halves = |of: &(Span, Set)| halves(of, closed.scale());
    let from_zero = |high: f64| Span { high, ..zero };
    let mut halving = Halving::at_most(MOST_BOXES, MOST_HALVINGS);
    let mut shown = |set: Set| halving.all(&(from_zero(highest), set), &shows, &halves);
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
