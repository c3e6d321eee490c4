//! What a setting of the adaptive law chooses among.

/// How the error's rate enters the law: each form is for one kind of plant.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_form {
    /// (23) as it stands, with a filtered difference of the error: for a plant with inertia.
    Literal = 0,
    /// The error's rate solved for: for a plant that answers within a sample.
    Lag = 1,
}

/// Which smooth sign stands in (23) and (25).
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_smooth_sign {
    /// tanh(x), as the paper has it.
    Tanh = 0,
    /// x within [-1, 1]: cheaper, and leaves less.
    Clamp = 1,
}

/// How an estimate leaks back to its prior.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_leakage {
    /// Not at all: the box alone holds the estimate.
    None = 0,
    /// At `leakage_rate` always: the sigma of (24)-(26).
    Constant = 1,
    /// Only where it is further than `leakage_bound` from its prior; at twice that, at
    /// `leakage_rate`.
    Switching = 2,
}

/// What a regressor that is not finite does.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_missing {
    /// A bad sample: the command is held.
    Hold = 0,
    /// Its term is left out, the estimates wait, the loop stays closed:
    /// BOWDEN_RESULT_DEGRADED.
    Drop = 1,
}
