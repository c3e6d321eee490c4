//! Choices for settings of the adaptive law.

/// Treatment of the error's rate in the law: each form is for one kind of plant.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_form {
    /// (23) as published, with a filtered difference of the error: for a plant with inertia.
    AsPublished = 0,
    /// The law solved for the error's rate: for a plant that responds within a sample.
    FirstOrder = 1,
}

/// The smooth sign in (23) and (25).
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_smooth_sign {
    /// tanh(x), as in the paper.
    Tanh = 0,
    /// x within [-1, 1]: cheaper, with a smaller residual.
    Clamp = 1,
}

/// Leakage of an estimate to its prior.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_leakage {
    /// No leakage: only the bounds limit the estimate.
    None = 0,
    /// Leakage at `leakage_rate` at all times: the sigma of (24)-(26).
    Constant = 1,
    /// Leakage only if the estimate is further than `leakage_bound` from its prior; the rate
    /// reaches `leakage_rate` at twice this distance.
    Switching = 2,
}

/// Response to a regressor that is not finite.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_on_missing {
    /// A bad sample: the command is held.
    Hold = 0,
    /// Its term is omitted, the estimates do not change, and the loop stays closed:
    /// BOWDEN_RESULT_DEGRADED.
    DropRegressor = 1,
}
