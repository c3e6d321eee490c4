//! The motion of one channel at one instant.

/// Position, velocity and acceleration of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion<T> {
    /// x \[channel unit\]
    pub position: T,
    /// v \[channel unit/s\]
    pub velocity: T,
    /// a \[channel unit/s²\]
    pub acceleration: T,
}
