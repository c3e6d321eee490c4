//! Choices in the settings of the adaptive law.

/// Treatment of the error rate in the adaptive law. The choice depends on the plant.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_form {
    /// For a plant with inertia: (23) as published. The error rate is a filtered difference.
    AsPublished = 0,
    /// For a plant that responds within one sample: the adaptive law solved for the error rate.
    FirstOrder = 1,
}

/// Smoothed sign function T(x) of (23) and (25).
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_smooth_sign {
    /// tanh(x), as in the paper.
    Tanh = 0,
    /// x clamped to [-1, 1]. This function is cheaper than tanh, and the maximum of x*(1 - T(x)) is
    /// smaller.
    Clamp = 1,
}

/// Leakage of an estimate towards its prior.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_leakage {
    /// No leakage: only the bounds limit the estimate.
    None = 0,
    /// Constant leakage at `leakage_rate`, the sigma of (24)-(26).
    Constant = 1,
    /// Leakage only if the distance from the prior exceeds `leakage_bound`. The leakage rate
    /// reaches `leakage_rate` at twice this distance.
    Switching = 2,
}

/// Response to a regressor that is not finite.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_on_missing {
    /// The sample is bad, and the command is held.
    Hold = 0,
    /// The term of the regressor is omitted, the estimates do not change, and the loop stays closed
    /// (BOWDEN_RESULT_DEGRADED).
    DropRegressor = 1,
}
