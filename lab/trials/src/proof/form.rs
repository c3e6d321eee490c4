//! The TOML form of one's own gains, `examples/data/gains_own.toml`.

use serde::{Deserialize, Serialize};

/// Gains of the lag form and what is known of their plant.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Form {
    /// Float of the controller.
    pub(super) float: Float,
    pub(super) k: Positive,
    /// \[1/s\]
    pub(super) lambda: Positive,
    /// Sample time \[s\].
    pub(super) step: Positive,
    /// \[N·m\]
    pub(super) epsilon: Positive,
    /// \[N·m·s\]
    pub(super) z_limit: Positive,
    /// Limit of the command's magnitude \[command unit\].
    pub(super) command: Positive,
    /// Box of beta_hat, above zero.
    pub(super) beta: Above,
    /// Box of delta_hat \[N·m\], not below zero.
    pub(super) delta: NotBelow,
    pub(super) plant: Plant,
    #[serde(default)]
    pub(super) regressor: Vec<Regressor>,
}

/// What is known of the plant.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plant {
    pub(super) alpha: Above,
    pub(super) disturbance: NotNegative,
    pub(super) disturbance_rate: NotNegative,
    pub(super) reference: NotNegative,
    pub(super) reference_rate: NotNegative,
}

/// One regressor: its estimate's box, its truth, its motion.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Regressor {
    pub(super) theta_hat: Range,
    pub(super) theta: Range,
    pub(super) magnitude: NotNegative,
    pub(super) rate: NotNegative,
}

/// The controller's float.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Float {
    /// 24 bits.
    F32,
    /// 53 bits.
    F64,
}

impl Float {
    /// "f32" or "f64".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// A checked type over what serde reads; a refusal has the value's line and column.
macro_rules! checked {
    ($name:ident, $raw:ty, $literal:literal, $what:literal, $ok:expr) => {
        #[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
        #[serde(try_from = $literal)]
        pub(super) struct $name(pub(super) $raw);

        impl TryFrom<$raw> for $name {
            type Error = String;
            fn try_from(raw: $raw) -> Result<Self, String> {
                let ok: fn($raw) -> bool = $ok;
                if ok(raw) {
                    Ok(Self(raw))
                } else {
                    Err(format!("{raw:?}: {} was expected", $what))
                }
            }
        }
    };
}
checked!(Positive, f64, "f64", "a finite number above zero", |x| x
    .is_finite()
    && x > 0.0);
checked!(
    NotNegative,
    f64,
    "f64",
    "a finite number, zero or above",
    |x| x.is_finite() && x >= 0.0
);
checked!(
    Range,
    [f64; 2],
    "[f64; 2]",
    "a box of two finite numbers, the lower one first",
    ordered
);
checked!(
    Above,
    [f64; 2],
    "[f64; 2]",
    "a box of two numbers above zero, the lower one first",
    |x| ordered(x) && x[0] > 0.0
);
checked!(
    NotBelow,
    [f64; 2],
    "[f64; 2]",
    "a box of two numbers not below zero, the lower one first",
    |x| ordered(x) && x[0] >= 0.0
);

fn ordered([low, high]: [f64; 2]) -> bool {
    low.is_finite() && high.is_finite() && low <= high
}
