//! Zero exclusion: no zero of a function on the imaginary axis, for any plant of a range.

use super::halving::Halving;
use super::plants::Plants;
use super::span::{Plane, Span};

/// Maximum number of regions in a proof. A proof takes about a tenth of a second on a computer.
const MOST_BOXES: u32 = 400_000;

/// Maximum number of bisections of a region.
const MOST_HALVINGS: u32 = 60;

/// A closed loop whose function must not have a zero on the imaginary axis.
pub(super) trait Closed {
    /// A region that contains all values of its function at these frequencies.
    fn values(&self, frequency: Span, plants: &Plants) -> Plane;

    /// A frequency far below which the function hardly changes \[rad/s\].
    fn scale(&self) -> f64;
}

/// Number of regions in the proof that no zero lies on the imaginary axis below a frequency
/// \[rad/s\]. The proof covers the straight path from a nominal plant to the middle of a range,
/// and every plant of the range. `None` if no proof was found.
pub(super) fn excluded<C: Closed>(
    closed: &C,
    nominal: Plants,
    all: Plants,
    highest: f64,
) -> Option<u32> {
    let middle = all.middle();
    let shows = |(frequency, set): &(Span, Set)| {
        let plants = match set {
            Set::Way(part) => nominal.between(&middle, *part),
            Set::All(plants) => *plants,
        };
        closed.values(*frequency, &plants).is_off_zero()
    };
    let halves = |of: &(Span, Set)| halves(of, closed.scale());
    let frequency = Span {
        low: 0.0,
        high: highest,
    };
    let way = Set::Way(Span {
        low: 0.0,
        high: 1.0,
    });
    let mut halving = Halving::at_most(MOST_BOXES, MOST_HALVINGS);
    let mut shown = |set: Set| halving.all(&(frequency, set), &shows, &halves);
    (shown(way) && shown(Set::All(all))).then_some(halving.boxes)
}

/// Plants that are examined together.
#[derive(Clone, Copy)]
enum Set {
    /// The plants of a part of the path from the nominal plant, from 0 to 1.
    Way(Span),
    /// All plants between bounds.
    All(Plants),
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
