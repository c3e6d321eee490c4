//! The terms of a piecewise linear curve.

use super::{Source, Term};
use crate::effect::{CurvePosition, CurveVelocity, Effect, Offset, Quantity};
use crate::error::finite;
use crate::{Error, Real};

impl<T: Real> Term<T> {
    /// The terms of a piecewise linear [curve](crate::effect::CurvePosition) through the points
    /// `(x, f)`, which is constant beyond its ends.
    ///
    /// The first term is an offset equal to the first f. Each other term is the segment between two
    /// neighbouring points.
    ///
    /// `over` is [`Quantity::Position`] or [`Quantity::Velocity`] of the source. For a function of
    /// the load, use the load's channel as the source. Each x has the unit of `over`, and the
    /// values of x must increase. Each f has the output unit. A curve that is odd in the velocity
    /// needs points on both sides of zero.
    ///
    /// ```
    /// use bowden::effect::{Motion, Quantity};
    /// use bowden::model::{Model, ModelState, Sample, Source, Term};
    ///
    /// let points = [(-2.0, -3.0), (-0.1, -2.5), (0.1, 2.5), (2.0, 3.0)]; // friction as measured
    /// let friction = Term::curve(Quantity::Velocity, Source::Input, points)?;
    /// let model = Model::<f64, 4>::try_new(None, &friction)?;
    /// let at = |velocity| {
    ///     let input = Motion { position: 0.0, velocity, acceleration: 0.0 };
    ///     model.step(&mut ModelState::new(), &Sample { dt: 0.001, input, load: 0.0, channels: &[] })
    /// };
    /// assert_eq!([at(-9.0), at(0.0), at(2.0), at(9.0)], [-3.0, 0.0, 3.0, 3.0]);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::NonFinite`] if a number of a point, or the difference between two neighbouring
    ///   points, is not finite.
    /// - [`Error::OutOfRange`] with `"width"` if x does not increase, or with `"over"` for a
    ///   quantity other than position and velocity.
    pub fn curve<const N: usize>(
        over: Quantity,
        source: Source,
        points: [(T, T); N],
    ) -> Result<[Self; N], Error> {
        let mut terms = [Self::default(); N];
        let mut before = None;
        for (term, (x, f)) in terms.iter_mut().zip(points) {
            let (from, level) = before.unwrap_or((x, T::zero()));
            let effect = match (before, over) {
                (None, Quantity::Position | Quantity::Velocity) => Effect::from(Offset),
                (_, Quantity::Position) => CurvePosition::try_new(from, x - from)?.into(),
                (_, Quantity::Velocity) => CurveVelocity::try_new(from, x - from)?.into(),
                _ => return Err(Error::OutOfRange("over")),
            };
            *term = Self {
                effect,
                source,
                gain: finite(f - level, "f")?,
                origin: T::zero(),
            };
            before = Some((finite(x, "x")?, f));
        }
        Ok(terms)
    }
}
