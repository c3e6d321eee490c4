//! A property of every point of a region, proved by bisection of the region.

/// The maximum number of regions, and the number so far.
pub(super) struct Halving {
    most_boxes: u32,
    most_halvings: u32,
    /// Number of examined regions.
    pub(super) boxes: u32,
}

impl Halving {
    pub(super) const fn at_most(most_boxes: u32, most_halvings: u32) -> Self {
        Self {
            most_boxes,
            most_halvings,
            boxes: 0,
        }
    }

    /// Whether `shows` holds for each part of a region; `false` if the limit was reached.
    pub(super) fn all<B>(
        &mut self,
        of: &B,
        shows: &impl Fn(&B) -> bool,
        halves: &impl Fn(&B) -> [B; 2],
    ) -> bool {
        self.within(of, self.most_halvings, shows, halves)
    }

    fn within<B>(
        &mut self,
        of: &B,
        halvings: u32,
        shows: &impl Fn(&B) -> bool,
        halves: &impl Fn(&B) -> [B; 2],
    ) -> bool {
        self.boxes = self.boxes.saturating_add(1);
        if self.boxes > self.most_boxes {
            return false;
        }
        if shows(of) {
            return true;
        }
        let Some(left) = halvings.checked_sub(1) else {
            return false;
        };
        let [first, second] = halves(of);
        self.within(&first, left, shows, halves) && self.within(&second, left, shows, halves)
    }
}
