//! What a missing force depends on, and how: six mechanisms, coarser than the effects and more
//! repeatable from record to record.

use bowden::effect::Family;

/// A group of effects that one record cannot always tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mechanism {
    /// A function of a velocity, and what lags behind a motion.
    Friction,
    /// A function of a position or a load.
    Elastic,
    /// A function of an acceleration.
    Inertia,
    /// A memory of the travel since a reversal, or of the time at a position.
    ContactMemory,
    /// A loop whose shape differs from the Bouc-Wen loop.
    HysteresisShape,
    /// A change during the record that no motion explains.
    Time,
}

impl Mechanism {
    /// The mechanism of an effect, by its name and its family.
    #[must_use]
    pub fn of(name: &str, family: Family) -> Self {
        match family {
            // These three are functions of the state of the hysteresis.
            _ if [
                "position-hysteresis",
                "asymmetry-eta",
                "asymmetry-eta-squared",
            ]
            .contains(&name) =>
            {
                Self::HysteresisShape
            }
            // A characteristic with a gap, without memory.
            _ if name == "dead-zone" => Self::Elastic,
            Family::Viscous
            | Family::Coulomb
            | Family::Stribeck
            | Family::Drag
            | Family::PowerLaw
            | Family::Asymmetry
            | Family::PositionFriction
            | Family::LoadFriction
            | Family::Capstan
            | Family::Direction
            | Family::Rate
            | Family::Lag
            | Family::Delay => Self::Friction,
            Family::Inertia => Self::Inertia,
            Family::Presliding | Family::Backlash | Family::Creep => Self::ContactMemory,
            Family::Pinching => Self::HysteresisShape,
            Family::Drift
            | Family::Pretension
            | Family::Degradation
            | Family::Temperature
            | Family::Tone => Self::Time,
            _ => Self::Elastic,
        }
    }

    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Elastic => "elastic",
            Self::Inertia => "inertia",
            Self::ContactMemory => "contact-memory",
            Self::HysteresisShape => "hysteresis-shape",
            Self::Time => "time",
        }
    }
}
