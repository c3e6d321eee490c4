//! Zero exclusion: no zero of a function on the imaginary axis, for any plant of a range.

use super::plants::Plants;
use super::span::{Plane, Span};

/// Most boxes of a proof: a tenth of a second or so on a computer.
const MOST_BOXES: u32 = 400_000;

/// Most halvings of a box.
const MOST_HALVINGS: u32 = 60;

/// A closed loop, of which no zero may lie on the imaginary axis.
pub(super) trait Closed {
    /// A box around all values of its function at these frequencies.
    fn values(&self, frequency: Span, plants: &Plants) -> Plane;

    /// A frequency far below which the function hardly changes \[rad/s\].
    fn scale(&self) -> f64;
}

/// How many boxes it takes to show that no zero lies on the imaginary axis below a frequency
/// \[rad/s\], neither on the straight way from a nominal plant to the middle of a range nor for any plant
/// of the range; `None` where that could not be shown.
pub(super) fn excluded<C: Closed>(
    closed: &C,
    nominal: Plants,
    all: Plants,
    highest: f64,
) -> Option<u32> {
    let mut search = Search {
        closed,
        nominal,
        middle: all.middle(),
        boxes: 0,
    };
    let up_to = |high: f64| Span { low: 0.0, high };
    let sets = [Set::Way(up_to(1.0)), Set::All(all)];
    let shown = sets
        .iter()
        .all(|set| search.is_off_zero(up_to(highest), *set, MOST_HALVINGS));
    shown.then_some(search.boxes)
}

/// Plants that are looked at together.
#[derive(Clone, Copy)]
enum Set {
    /// Those of a part of the way from the nominal plant, from 0 to 1.
    Way(Span),
    /// All between bounds.
    All(Plants),
}

/// What is to be shown: the loop, its nominal plant without latency, one plant of the range, and
/// how many boxes it took so far.
struct Search<'a, C> {
    closed: &'a C,
    nominal: Plants,
    middle: Plants,
    boxes: u32,
}

impl<C: Closed> Search<'_, C> {
    /// Whether F is not zero for any of the plants at any of the frequencies.
    fn is_off_zero(&mut self, frequency: Span, set: Set, halvings: u32) -> bool {
        self.boxes = self.boxes.saturating_add(1);
        if self.boxes > MOST_BOXES {
            return false;
        }
        let plants = match set {
            Set::Way(part) => self.nominal.between(&self.middle, part),
            Set::All(plants) => plants,
        };
        if self.closed.values(frequency, &plants).is_off_zero() {
            return true;
        }
        let Some(left) = halvings.checked_sub(1) else {
            return false;
        };
        let (size, [first, second]) = match set {
            Set::Way(part) => (part.width(), part.halves().map(Set::Way)),
            Set::All(plants) => {
                let (size, halves) = plants.halves(frequency.high);
                (size, halves.map(Set::All))
            }
        };
        let scale = frequency.middle() + self.closed.scale();
        if frequency.width() >= size * scale {
            let [low, high] = frequency.halves();
            return self.is_off_zero(low, set, left) && self.is_off_zero(high, set, left);
        }
        self.is_off_zero(frequency, first, left) && self.is_off_zero(frequency, second, left)
    }
}
