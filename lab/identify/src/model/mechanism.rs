//! What a missing force depends on, and how: six mechanisms, coarser than the effects and more
//! repeatable from record to record.

use super::kind::{kind, Kind};
use super::term::FitTerm;
use super::variable::Variable;
use crate::problem::Prepared;
use bowden::model::Source;

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
    /// All of them; what only time explains comes last.
    pub const ALL: [Self; 6] = [
        Self::Friction,
        Self::Elastic,
        Self::Inertia,
        Self::ContactMemory,
        Self::HysteresisShape,
        Self::Time,
    ];

    /// The mechanism of a term.
    pub(crate) fn of_term(term: &FitTerm) -> Self {
        Self::of(term.effect.name(), term.effect.info().family)
    }

    /// The mechanism of a curve over a variable.
    pub(crate) fn of_variable(data: &Prepared, variable: Variable) -> Self {
        let source = variable.source();
        let kind = data.channel(source).map(|c| kind(data.mode, source, c));
        match (variable, kind) {
            // A torque has no mass: its rates are those of a lag.
            (Variable::Acceleration(_), Some(Kind::Torque)) => Self::Friction,
            // It neither moves nor loads anything.
            (Variable::Position(_), Some(Kind::Temperature | Kind::Other)) => Self::Time,
            (Variable::Velocity(_), _)
            | (Variable::DirectedPosition(_), _)
            | (Variable::DirectedLoad(_), _) => Self::Friction,
            (Variable::Position(_), _) => Self::Elastic,
            (Variable::Acceleration(_), _) => Self::Inertia,
            (Variable::ReversalDistance(_) | Variable::ReversalTime(_), _) => Self::ContactMemory,
            (Variable::Eta, _) => Self::HysteresisShape,
            (Variable::Time, _) => Self::Time,
        }
    }

    /// The variable over which its force is plotted.
    pub(crate) fn variable(self, source: Source) -> Variable {
        match self {
            Self::Friction => Variable::Velocity(source),
            Self::Elastic => Variable::Position(source),
            Self::Inertia => Variable::Acceleration(source),
            Self::ContactMemory => Variable::ReversalDistance(source),
            Self::HysteresisShape => Variable::Eta,
            Self::Time if source == Source::Input => Variable::Time,
            Self::Time => Variable::Position(source),
        }
    }

    /// The mechanism of an effect, by its name and its family.
    #[must_use]
    pub fn of(name: &str, family: &'static str) -> Self {
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
            _ if name == "curve-velocity" => Self::Friction,
            // A characteristic with a gap, without memory.
            _ if name == "dead-zone" => Self::Elastic,
            "viscous" | "coulomb" | "stribeck" | "drag" | "power-law" | "asymmetry"
            | "position-friction" | "load-friction" | "capstan" | "direction" | "rate" | "lag"
            | "delay" => Self::Friction,
            "inertia" => Self::Inertia,
            "presliding" | "backlash" | "creep" => Self::ContactMemory,
            "pinching" => Self::HysteresisShape,
            "drift" | "pretension" | "degradation" | "temperature" | "tone" => Self::Time,
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
