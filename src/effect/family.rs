//! The families of the catalogue and their names.

use crate::Error;
use core::fmt;

macro_rules! families {
    ($($variant:ident = $name:literal),* $(,)?) => {
        /// The families of the catalogue; the names are part of the public interface.
        ///
        /// ```
        /// use bowden::effect::Family;
        /// assert_eq!(Family::from_name("load-friction"), Ok(Family::LoadFriction));
        /// assert_eq!(Family::LoadFriction.name(), "load-friction");
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum Family {
            $(#[doc = concat!("`", $name, "`")] $variant),*
        }

        impl Family {
            /// All families, in the order of the catalogue.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The name in the catalogue.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),*
                }
            }
        }
    };
}

families! {
    Offset = "offset",
    Gain = "gain",
    Viscous = "viscous",
    Drag = "drag",
    Coulomb = "coulomb",
    Stribeck = "stribeck",
    Asymmetry = "asymmetry",
    LoadFriction = "load-friction",
    Capstan = "capstan",
    Direction = "direction",
    Inertia = "inertia",
    Stiffness = "stiffness",
    Gravity = "gravity",
    Ripple = "ripple",
    PositionFriction = "position-friction",
    Backlash = "backlash",
    Delay = "delay",
    Lag = "lag",
    Creep = "creep",
    Rate = "rate",
    Presliding = "presliding",
    Degradation = "degradation",
    Pinching = "pinching",
    Drift = "drift",
    Pretension = "pretension",
    Temperature = "temperature",
    Saturation = "saturation",
    Tone = "tone",
    Crosstalk = "crosstalk",
    Stretch = "stretch",
    Hardening = "hardening",
    PowerLaw = "power-law",
    Curve = "curve",
}

impl Family {
    /// The family with this name.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the catalogue has no such family.
    pub fn from_name(name: &str) -> Result<Self, Error> {
        let found = Self::ALL.iter().find(|family| family.name() == name);
        found.copied().ok_or(Error::OutOfRange("family name"))
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
