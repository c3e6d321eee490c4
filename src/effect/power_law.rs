//! Power-law drag: odd in the velocity, and growing slower than linearly (shear thinning).

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Drag that grows with a power of the velocity.
    ///
    /// Formula: `sgn(v)·|v/v_1|^a` with `v_1` = 1 channel unit/s. The regressor is dimensionless,
    /// and the gain is the force at 1 channel unit/s, in the output's unit. The same record gives a
    /// different gain in mm than in m, but the same exponent. For `0 < a < 1` the force rises
    /// steeply from standstill and then flattens. This range lies between Coulomb friction (the
    /// limit a → 0) and [`Viscous`](super::Viscous) (a = 1). The function is continuous at v = 0,
    /// where its slope is infinite.
    ///
    /// Oils with additives, greases, and (past yield) the fluids of magnetorheological dampers become
    /// thinner as the shear rate rises. The constructor accepts any a > 0. With a above 1 the fluid
    /// thickens; the formulas of [`DragQuadratic`](super::DragQuadratic) are the cases a = 2 and a = 3.
    ///
    /// Source: W. Ostwald, "Über die Geschwindigkeitsfunktion der Viskosität disperser Systeme. I",
    /// *Kolloid-Zeitschrift* 36, 1925, pp. 99–117; for dampers, `F = C·|v|^a·sgn(v)`: N. Makris,
    /// M. C. Constantinou, "Fractional-derivative Maxwell model for viscous dampers", *Journal of
    /// Structural Engineering* 117(9), 1991, and D. Lee, D. P. Taylor, "Viscous damper development and
    /// future trends", *The Structural Design of Tall Buildings* 10(5), 2001.
    ///
    /// ```
    /// use bowden::{effect::PowerLaw, Error};
    /// assert_eq!(PowerLaw::try_new(0.4)?.a(), 0.4);
    /// assert_eq!(PowerLaw::try_new(0.0), Err(Error::OutOfRange("a")));
    /// # Ok::<(), Error>(())
    /// ```
    PowerLaw {
        /// Exponent.
        a: Positive, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for PowerLaw<T> {
    const INFO: &'static Info = &Info {
        name: "power-law",
        family: Family::PowerLaw,
        formula: "sgn(v)·|v|^a",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let v = at.motion.velocity;
        let size = v.abs().short_pow(self.a);
        if v < T::zero() {
            -size
        } else {
            size
        }
    }
}
