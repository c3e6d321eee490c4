//! A property of every point of a region, proved by bisection of the region.

/// The maximum number of regions, and the number so far.
pub(super) struct Halving {
    most_boxes: u32,
    /// Number of examined regions.
    pub(super) boxes: u32,
}

impl Halving {
    pub(super) const fn at_most(most_boxes: u32) -> Self {
        let boxes = 0;
        Self { most_boxes, boxes }
    }

    /// Whether `shows` holds for each part of a region, after at most `halvings` bisections of it;
    /// `false` if a limit was reached.
    pub(super) fn all<B>(
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
        halves(of)
            .iter()
            .all(|half| self.all(half, left, shows, halves))
    }
}
