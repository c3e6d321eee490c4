//! A compensator for a model without an exact inverse.

use super::Compensator;
use crate::model::{Model, Term};
use crate::{Error, Real};

/// The differences between the model of a [`Compensator`] and the identified model.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Changed<T, const N: usize> {
    /// Sigma of the identified model and of the compensator, if sigma was lowered.
    pub sigma: Option<(T, T)>,
    /// Rho of the identified model and of the compensator \[1/input unit\], if rho was lowered.
    pub rho: Option<(T, T)>,
    left_out: [bool; N],
}

impl<T: Real, const N: usize> Changed<T, N> {
    /// Whether the model is unchanged. The compensator then equals the result of
    /// [`Compensator::try_new`].
    pub fn is_nothing(&self) -> bool {
        self.sigma.is_none() && self.rho.is_none() && self.left_out().next().is_none()
    }

    /// The indices in [`Model::terms`] of the terms that the feed-forward omits.
    pub fn left_out(&self) -> impl Iterator<Item = usize> + '_ {
        let places = self.left_out.iter().enumerate();
        places.filter_map(|(term, &is_left_out)| is_left_out.then_some(term))
    }
}

/// The terms that cannot be subtracted from the desired output.
fn is_stage<T: Real>(term: &Term<T>) -> bool {
    term.effect.is_output_stage() || term.effect.is_input_stage()
}

impl<T: Real, const N: usize> Compensator<T, N> {
    /// Inverts the nearest invertible model and returns the changes.
    ///
    /// The transmission becomes
    /// [`Transmission::nearest_invertible`](crate::transmission::Transmission::nearest_invertible):
    /// - sigma is lowered to `|gain|/(2·|kappa_eta|·rho)`;
    /// - if this value is below 1/2, sigma becomes 1/2 and rho becomes `|gain|/|kappa_eta|`.
    ///
    /// The feed-forward omits output stages (delay, lag) and input stages (a play in series). The
    /// other terms keep their indices, so a [`Fault::Regressor`](crate::control::Fault::Regressor)
    /// still refers to the model's indices.
    ///
    /// For the resulting command, the output of the identified model is only approximately the
    /// desired output. To measure the error, run the feed-forward and the identified model in
    /// series, as `examples/nearest.rs` does. A model that is fitted with this constraint on sigma
    /// usually has a smaller error than a model that is changed afterwards.
    ///
    /// ```
    /// use bowden::control::Compensator;
    /// use bowden::effect::{Delay, Viscous};
    /// use bowden::hysteresis::BoucWen;
    /// use bowden::model::{Model, Source, Term};
    /// use bowden::transmission::Transmission;
    ///
    /// let cable = Transmission::torque(0.952, 2.29, 0.05, BoucWen::try_new(0.382, 2.97, 1.02)?)?;
    /// let term = |effect, gain| Term { effect, source: Source::Channel(0), origin: 0.0, gain };
    /// let terms = [term(Viscous.into(), -0.264), term(Delay.into(), 0.002_f32)];
    /// let model = Model::<f32, 2>::try_new(Some(cable), &terms)?;
    ///
    /// assert!(Compensator::try_new(&model).is_err());
    /// let (_compensator, changed) = Compensator::try_nearest(&model)?;
    /// assert!(changed.sigma.is_some_and(|sigma| sigma.0 == 2.97 && sigma.1 < 0.545));
    /// assert_eq!((changed.rho, changed.left_out().next()), (None, Some(1)));
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if the model has no transmission or its gain is zero;
    /// [`Error::OutOfRange`] with `"rho"` if the required rho is too small for the float type.
    pub fn try_nearest(model: &Model<T, N>) -> Result<(Self, Changed<T, N>), Error> {
        let identified = *model
            .transmission()
            .ok_or(Error::Inadmissible("the model must have a transmission"))?;
        let transmission = identified.nearest_invertible()?;
        let lowered = |from: T, to: T| (from != to).then_some((from, to));
        let (before, after) = (identified.shape(), transmission.shape());
        let mut left_out = [false; N];
        for (is_left_out, term) in left_out.iter_mut().zip(model.terms()) {
            *is_left_out = is_stage(term);
        }
        let compensator = Self::of(transmission, model.without_terms(is_stage))?;
        let changed = Changed {
            sigma: lowered(before.sigma(), after.sigma()),
            rho: lowered(before.rho(), after.rho()),
            left_out,
        };
        Ok((compensator, changed))
    }
}
