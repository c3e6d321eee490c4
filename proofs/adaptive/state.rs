//! Arbitrary estimators.

use super::super::{Estimator, Leakage};

/// Any leakage.
pub(super) fn leakage() -> Leakage<f32> {
    let rate = kani::any();
    match kani::any::<u8>() {
        0 => Leakage::None,
        1 => Leakage::Constant { rate },
        _ => Leakage::Switching {
            rate,
            bound: kani::any(),
        },
    }
}

/// Any estimator.
pub(super) fn estimator(leakage: Leakage<f32>) -> Estimator<f32> {
    Estimator {
        initial: kani::any(),
        low: kani::any(),
        high: kani::any(),
        gain: kani::any(),
        leakage,
        prior: kani::any(),
    }
}
