//! The TOML form of the user's own gains, `examples/data/gains_own.toml`.

use serde::{Deserialize, Serialize};

/// Gains of the first-order form and the known ranges of their plant.
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
    /// Slew rate \[command unit/s\], if there is one.
    pub(super) slew: Option<Positive>,
    /// Bounds on beta_hat, positive.
    pub(super) beta: Above,
    /// Bounds on delta_hat \[N·m\], not negative.
    pub(super) delta: NotBelow,
    pub(super) plant: Plant,
    #[serde(default)]
    pub(super) regressor: Vec<Regressor>,
}

/// The known ranges of the plant.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plant {
    pub(super) alpha: Above,
    pub(super) disturbance: NotNegative,
    pub(super) disturbance_rate: NotNegative,
    pub(super) reference: NotNegative,
    pub(super) reference_rate: NotNegative,
}

/// One regressor: the bounds on its estimate, the range of the true value, and the range of the
/// signal.
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
    /// Single precision, with a mantissa of 24 bits.
    F32,
    /// Double precision, with a mantissa of 53 bits.
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

/// A checked number. An error contains its line and column.
macro_rules! number {
    ($name:ident, $what:literal, $ok:expr) => {
        #[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub(super) struct $name(pub(super) f64);

        impl TryFrom<f64> for $name {
            type Error = String;
            fn try_from(x: f64) -> Result<Self, String> {
                let ok: fn(f64) -> bool = $ok;
                if x.is_finite() && ok(x) {
                    Ok(Self(x))
                } else {
                    Err(format!("{x} must be {}", $what))
                }
            }
        }
    };
}
number!(Positive, "a finite positive number", |x| x > 0.0);
number!(NotNegative, "a finite number, zero or positive", |x| x
    >= 0.0);

/// A checked range. It is read as a list of any length, because an array of two would accept the
/// first two of three values.
macro_rules! range {
    ($name:ident, $what:literal, $ok:expr) => {
        #[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
        #[serde(try_from = "Vec<f64>")]
        pub(super) struct $name(pub(super) [f64; 2]);

        impl TryFrom<Vec<f64>> for $name {
            type Error = String;
            fn try_from(list: Vec<f64>) -> Result<Self, String> {
                let ok: fn(f64) -> bool = $ok;
                match list[..] {
                    [low, high]
                        if low.is_finite() && high.is_finite() && low <= high && ok(low) =>
                    {
                        Ok(Self([low, high]))
                    }
                    _ => Err(format!("{list:?} must be {}", $what)),
                }
            }
        }
    };
}
range!(
    Range,
    "a pair of finite numbers, the lower one first",
    |_| true
);
range!(
    Above,
    "a pair of finite positive numbers, the lower one first",
    |low| low > 0.0
);
range!(
    NotBelow,
    "a pair of finite numbers, zero or positive, the lower one first",
    |low| low >= 0.0
);
