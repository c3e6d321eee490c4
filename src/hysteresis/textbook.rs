//! Parameters in other conventions: the textbook's seven, and the four of an actuator.
//!
//! The textbook writes `F = alpha·k·x + (1 - alpha)·D·k·z` with
//! `z' = (A·x' - beta·|x'|·|z|^(n-1)·z - gamma·x'·|z|^n)/D`. With the saturation
//! `z0 = (A/(beta + gamma))^(1/n)` and `z = z0·eta` it is the normalised form with
//! `rho = A/(D·z0)`, `sigma = beta/(beta + gamma)`, `kappa_x = alpha·k`,
//! `kappa_eta = (1 - alpha)·D·k·z0`. The seven numbers determine five: two are redundant, and
//! no experiment can identify them. Source: Ikhouane & Rodellar, *Systems with Hysteresis*,
//! Wiley 2007, chapter 2 (model, classes, normalised form).

use super::BoucWen;
use crate::error::finite;
use crate::{Error, Real};

/// The seven parameters of the textbook's Bouc-Wen model.
///
/// Here `x` is a displacement, and `F` is a force or torque.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Textbook<T> {
    /// A, the gain of the input.
    pub a: T,
    /// beta, the weight of `|x'|·|z|^(n-1)·z`.
    pub beta: T,
    /// gamma, the weight of `x'·|z|^n`.
    pub gamma: T,
    /// n, the sharpness of the knee.
    pub n: T,
    /// alpha, the ratio of the stiffness after yield to that before yield, in (0, 1).
    pub alpha: T,
    /// k, the stiffness before yield [output unit/input unit].
    pub k: T,
    /// D, the yield displacement [input unit].
    pub d: T,
}

/// Class of a Bouc-Wen model by the signs of A, beta + gamma and beta - gamma.
///
/// Classes I to V give a bounded output for a bounded input. Only class I is dissipative with a
/// hysteretic part that saturates, so only class I is a [`BoucWen`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Class {
    /// A > 0, beta + gamma > 0, beta >= gamma: bounded for every start.
    I,
    /// A > 0, 0 <= beta < gamma: bounded, but not dissipative.
    II,
    /// A < 0, beta > gamma, beta + gamma >= 0.
    III,
    /// A < 0, beta + gamma < 0, beta >= 0.
    IV,
    /// A = 0, beta + gamma > 0, beta >= gamma: the state only decays.
    V,
    /// Not bounded.
    Unbounded,
}

/// Shape parameters with their gains.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Loop<T> {
    /// The shape parameters.
    pub shape: BoucWen<T>,
    /// Linear gain [output unit/input unit].
    pub kappa_x: T,
    /// Hysteretic part at saturation [output unit].
    pub kappa_eta: T,
}

/// Conversion of the seven textbook parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TextbookReport<T> {
    /// The five numbers that an experiment can identify.
    pub normalised: Loop<T>,
    /// The class, always [`Class::I`] here.
    pub class: Class,
    /// The two redundant parameters, which may have any fixed value.
    pub redundant: [&'static str; 2],
    /// The same input-output map with both redundant parameters set to 1.
    pub equivalent: Textbook<T>,
}

/// Parameters of an actuator or joint from its specification.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Actuator<T> {
    /// Torque at yield or slip [N·m], positive.
    pub yield_torque: T,
    /// Stiffness before yield [N·m/rad], positive.
    pub stiffness: T,
    /// Ratio of the stiffness after yield to that before yield, in [0, 1).
    pub post_yield_ratio: T,
    /// Sharpness n of the knee, at least 1; above 20 the loop is nearly bilinear.
    pub knee: T,
}

impl<T: Real> Textbook<T> {
    /// The class by the signs of A, beta + gamma and beta - gamma.
    #[must_use]
    pub fn class(&self) -> Class {
        let zero = T::zero();
        let (sum, difference) = (self.beta + self.gamma, self.beta - self.gamma);
        if self.a > zero && sum > zero && difference >= zero {
            Class::I
        } else if self.a > zero && difference < zero && self.beta >= zero {
            Class::II
        } else if self.a < zero && difference > zero && sum >= zero {
            Class::III
        } else if self.a < zero && sum < zero && self.beta >= zero {
            Class::IV
        } else if self.a == zero && sum > zero && difference >= zero {
            Class::V
        } else {
            Class::Unbounded
        }
    }
}

impl<T: Real> BoucWen<T> {
    /// Converts the seven textbook parameters to shape parameters and gains, with a report.
    ///
    /// ```
    /// use bowden::hysteresis::{BoucWen, Textbook};
    /// # fn main() -> Result<(), bowden::Error> {
    /// let report = BoucWen::from_textbook(Textbook {
    ///     a: 2.0, beta: 1.5, gamma: 0.5, n: 1.0, alpha: 0.25, k: 8.0, d: 0.5_f64,
    /// })?;
    /// let normalised = report.normalised;
    /// assert_eq!((normalised.shape.rho(), normalised.shape.sigma()), (4.0, 0.75));
    /// assert_eq!((normalised.kappa_x, normalised.kappa_eta), (2.0, 3.0));
    /// assert_eq!(report.redundant, ["A", "D"]);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the parameter's name, and
    /// [`Error::Inadmissible`] for every class but I.
    pub fn from_textbook(textbook: Textbook<T>) -> Result<TextbookReport<T>, Error> {
        let Textbook {
            a,
            beta,
            gamma,
            n,
            alpha,
            k,
            d,
        } = textbook;
        let (zero, one) = (T::zero(), T::one());
        finite(a, "A")?;
        finite(beta, "beta")?;
        finite(gamma, "gamma")?;
        if finite(n, "n")? < one {
            return Err(Error::OutOfRange("n"));
        }
        if finite(alpha, "alpha")? <= zero || alpha >= one {
            return Err(Error::OutOfRange("alpha"));
        }
        if finite(k, "k")? <= zero {
            return Err(Error::OutOfRange("k"));
        }
        if finite(d, "D")? <= zero {
            return Err(Error::OutOfRange("D"));
        }
        let class = textbook.class();
        if class != Class::I {
            return Err(Error::Inadmissible(
                "A > 0, beta + gamma > 0, beta >= gamma (class I)",
            ));
        }
        let saturation = (a / (beta + gamma)).pow(one / n);
        let shape = Self::try_new(a / (d * saturation), beta / (beta + gamma), n)?;
        let kappa_x = finite(alpha * k, "k")?;
        let kappa_eta = finite((one - alpha) * d * k * saturation, "D")?;
        let power = shape.rho().pow(n);
        let stiffness = kappa_x + kappa_eta * shape.rho();
        Ok(TextbookReport {
            normalised: Loop {
                shape,
                kappa_x,
                kappa_eta,
            },
            class,
            redundant: ["A", "D"],
            equivalent: Textbook {
                a: one,
                beta: shape.sigma() * power,
                gamma: (one - shape.sigma()) * power,
                n,
                alpha: kappa_x / stiffness,
                k: stiffness,
                d: one,
            },
        })
    }

    /// Shape parameters and gains of an actuator that yields and unloads elastically.
    ///
    /// `rho = stiffness/yield_torque` [1/rad], `sigma = 1/2` (unloading with the
    /// initial stiffness), `kappa_x = ratio·stiffness`, `kappa_eta = (1 - ratio)·yield_torque`.
    ///
    /// ```
    /// use bowden::hysteresis::{Actuator, BoucWen};
    /// # fn main() -> Result<(), bowden::Error> {
    /// let joint = BoucWen::from_actuator(Actuator {
    ///     yield_torque: 2.0, stiffness: 100.0, post_yield_ratio: 0.25, knee: 4.0_f64,
    /// })?;
    /// assert_eq!((joint.shape.rho(), joint.kappa_x, joint.kappa_eta), (50.0, 25.0, 1.5));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the parameter's name.
    pub fn from_actuator(actuator: Actuator<T>) -> Result<Loop<T>, Error> {
        let Actuator {
            yield_torque,
            stiffness,
            post_yield_ratio,
            knee,
        } = actuator;
        let (zero, one) = (T::zero(), T::one());
        if finite(yield_torque, "yield_torque")? <= zero {
            return Err(Error::OutOfRange("yield_torque"));
        }
        if finite(stiffness, "stiffness")? <= zero {
            return Err(Error::OutOfRange("stiffness"));
        }
        if finite(post_yield_ratio, "post_yield_ratio")? < zero || post_yield_ratio >= one {
            return Err(Error::OutOfRange("post_yield_ratio"));
        }
        if finite(knee, "knee")? < one {
            return Err(Error::OutOfRange("knee"));
        }
        Ok(Loop {
            shape: Self::try_new(stiffness / yield_torque, T::from_f64(0.5), knee)?,
            kappa_x: post_yield_ratio * stiffness,
            kappa_eta: (one - post_yield_ratio) * yield_torque,
        })
    }
}
