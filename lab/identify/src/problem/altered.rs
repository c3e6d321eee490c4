//! Records as they would be if a channel of one of them had been logged differently.

use super::Prepared;
use bowden::effect::Motion;

/// A possible alteration of the channels of one record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alteration {
    /// A channel has the opposite sign.
    Turned(usize),
    /// Two channels are swapped.
    Swapped(usize, usize),
}

impl Alteration {
    /// The channels that it affects.
    fn channels(self) -> impl Iterator<Item = usize> {
        let (first, second) = match self {
            Self::Turned(channel) => (channel, None),
            Self::Swapped(one, other) => (one, Some(other)),
        };
        std::iter::once(first).chain(second)
    }
}

fn turned(motion: Motion<f64>) -> Motion<f64> {
    Motion {
        position: -motion.position,
        velocity: -motion.velocity,
        acceleration: -motion.acceleration,
    }
}

impl Prepared {
    /// The same records with the channels of one of them altered.
    #[must_use]
    pub fn altered(&self, record: usize, alteration: Alteration) -> Self {
        let mut all = self.clone();
        let range = self.pieces[record].work.clone();
        match alteration {
            Alteration::Turned(channel) => {
                for motion in &mut all.channels[channel].motion[range] {
                    *motion = turned(*motion);
                }
            }
            Alteration::Swapped(one, other) => {
                all.channels[one].motion[range.clone()]
                    .copy_from_slice(&self.channels[other].motion[range.clone()]);
                all.channels[other].motion[range.clone()]
                    .copy_from_slice(&self.channels[one].motion[range]);
            }
        }
        let used = self.used();
        for index in alteration.channels() {
            all.channels[index].measure(used.iter().copied());
        }
        all
    }

    /// The samples on the work grid that belong to rows of the fit and selection segments.
    fn used(&self) -> Vec<usize> {
        let rows = self.split.fit.iter().chain(&self.split.selection);
        rows.filter_map(|row| {
            let piece = self.pieces.iter().find(|p| p.rows.contains(row))?;
            Some(piece.work.start + (row - piece.rows.start) * self.stride)
        })
        .collect()
    }
}
