//! A compensator for a model that cannot be turned round as it is.

use super::Compensator;
use crate::model::{Model, Term};
use crate::{Error, Real};

/// A parameter before and after.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lowered<T> {
    /// As identified.
    pub from: T,
    /// As inverted.
    pub to: T,
}

/// In what a [`Compensator`] differs from the model that it was made of.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Changed<T, const N: usize> {
    /// Sigma, where it was lowered.
    pub sigma: Option<Lowered<T>>,
    /// Rho \[1/input unit\], where sigma = 1/2 was not enough.
    pub rho: Option<Lowered<T>>,
    left_out: [bool; N],
}

impl<T: Real, const N: usize> Changed<T, N> {
    /// Whether the compensator is the model's own, as of [`Compensator::try_new`].
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        self.sigma.is_none() && self.rho.is_none() && self.left_out().next().is_none()
    }

    /// The terms that are not fed forward, by their place in [`Model::terms`].
    pub fn left_out(&self) -> impl Iterator<Item = usize> + '_ {
        let places = self.left_out.iter().enumerate();
        places.filter_map(|(term, &is_left_out)| is_left_out.then_some(term))
    }
}

/// What cannot be subtracted from the desired output.
fn is_stage<T: Real>(term: &Term<T>) -> bool {
    term.effect.is_output_stage() || term.effect.is_input_stage()
}

impl<T: Real, const N: usize> Compensator<T, N> {
    /// Turns the nearest model round that can be, and tells what it changed.
    ///
    /// The transmission becomes
    /// [`Transmission::nearest_invertible`](crate::transmission::Transmission::nearest_invertible):
    /// sigma is lowered to `|gain|/(2·|kappa_eta|·rho)`; where that is below 1/2, sigma
    /// becomes 1/2 and rho `|gain|/|kappa_eta|`. Output stages (delay, lag) and input
    /// stages (a play in series) are left out; the other terms keep their places, so a
    /// [`Fault::Regressor`](crate::control::Fault::Regressor) still counts as in the model.
    ///
    /// What it costs is the error of the true model behind the command: a feed-forward is
    /// best judged by running the one behind the other, as `examples/nearest.rs` does. A
    /// model that was fitted within the bound from the start costs less than one that was
    /// lowered to it.
    ///
    /// ```
    /// use bowden::control::Compensator;
    /// use bowden::effect::Effect;
    /// use bowden::hysteresis::Shape;
    /// use bowden::model::{Model, Source, Term};
    /// use bowden::transmission::Transmission;
    ///
    /// let cable = Transmission::torque(0.952, 2.29, 0.05, Shape::try_new(0.382, 2.97, 1.02)?)?;
    /// let term = |effect, gain| Term { effect, source: Source::Channel(0), origin: 0.0, gain };
    /// let terms = [term(Effect::Viscous, -0.264), term(Effect::Delay, 0.002_f32)];
    /// let model = Model::<f32, 2>::try_new(Some(cable), &terms)?;
    ///
    /// assert!(Compensator::try_new(&model).is_err());
    /// let (_compensator, changed) = Compensator::try_nearest(&model)?;
    /// assert!(changed.sigma.is_some_and(|sigma| sigma.from == 2.97 && sigma.to < 0.545));
    /// assert_eq!((changed.rho, changed.left_out().next()), (None, Some(1)));
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the model has no transmission or its gain is zero;
    /// [`Error::OutOfRange`] with `"rho"` where no float is small enough for it.
    pub fn try_nearest(model: &Model<T, N>) -> Result<(Self, Changed<T, N>), Error> {
        let identified = *model
            .transmission()
            .ok_or(Error::Inadmissible("the model has a transmission"))?;
        let transmission = identified.nearest_invertible()?;
        let lowered = |from: T, to: T| (from != to).then_some(Lowered { from, to });
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
