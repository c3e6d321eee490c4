//! Degradation: the loop shrinks or grows with the work done.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::sum::add;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// A loop that changes with the work done and then settles.
    ///
    /// Formula: `eta·(1 − exp(−W/w_c))`, `W = ∫|eta|·|dx|` along the transmission's input
    /// (trapezoids, from the first sample on), for any channel. For W ≪ w_c it is the linear
    /// `eta·W/w_c`. Its limit is `eta`, so the loop stays bounded after running-in. The sum is
    /// compensated, so small steps count even in `f32`.
    ///
    /// Source: T. T. Baber, Y.-K. Wen, "Random vibration of hysteretic, degrading systems", *Journal of
    /// the Engineering Mechanics Division* 107(6), 1981, where the change is linear in the work; here
    /// the exponential bounds the change.
    ///
    /// ```
    /// use bowden::{effect::Degradation, Error};
    /// assert_eq!(Degradation::try_new(40.0)?.w_c(), 40.0);
    /// assert_eq!(Degradation::try_new(0.0), Err(Error::OutOfRange("w_c")));
    /// # Ok::<(), Error>(())
    /// ```
    Degradation {
        /// Work after which the change reaches 63 % \[input unit\].
        w_c: Positive, Dimension { input: 1, ..Dimension::ONE };
    }
}

impl<T: Real> Regressor<T> for Degradation<T> {
    const INFO: &'static Info = &Info {
        name: "degradation",
        family: Family::Degradation,
        formula: "eta·(1−exp(−∫|eta|·|dx|/w_c))",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Eta, Quantity::Input],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let (x, eta) = (at.input.position, at.eta);
        let fresh = [x, eta, T::zero(), T::zero()];
        let [x_before, eta_before, work, carry] = state.memory.unwrap_or(fresh);
        let path = (x - x_before).abs();
        let mean = eta.abs() * T::from_f64(0.5) + eta_before.abs() * T::from_f64(0.5);
        let [work, carry] = add([work, carry], saturate(mean * path));
        state.memory = Some([x, eta, work, carry]);
        -eta * (-work / self.w_c).exp_m1()
    }
}
