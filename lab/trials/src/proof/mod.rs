//! The proof for the user's own gains. The proof covers the shipped step with all rounding errors.

pub(crate) mod designed;
mod form;
mod mend;
mod written;

pub(crate) use bowden_bound::Named;
pub use form::Float;
pub use written::{coq, gappa};

use super::gains::{is_of_design, message, GainsFile};
use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Limits};
use bowden::{Error, Real};
use bowden_bound::{Dyadic, Inequality, Interval, Kind, Known, PeakRounded, Plant};
use form::Form;
use serde::Serialize;
use std::path::Path;

/// The proof for given gains, or the inequality that fails.
///
/// Each number is exact, as `mantissa*2^exponent`, and is accompanied by the nearest `f64`. The
/// JSON has the schema `bowden.certificate/1`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Proof {
    /// `bowden.certificate/1`.
    pub schema: &'static str,
    /// Whether all inequalities hold. Three inequalities may replace the inequality of the command.
    pub proved: bool,
    /// Whether the command may reach its limit within the bounds.
    pub may_meet_the_limit: bool,
    /// The controller's float.
    pub float: Float,
    /// The gains in the float type of the controller.
    pub gains: Exact,
    /// The known ranges of the plant.
    pub plant: ExactPlant,
    /// The regressors.
    pub regressors: Vec<ExactRegressor>,
    /// S \[N·m\]: bound on `|s|`.
    pub s: Number,
    /// Z \[N·m·s\]: bound on `|z|`.
    pub z: Number,
    /// S + lambda·Z \[N·m\]: bound on `|e|` at every sample.
    pub error: Number,
    /// W \[N·m\].
    pub w: Number,
    /// Xi \[N·m/s\].
    pub xi: Number,
    /// Smallest and largest g = alpha·beta_hat.
    pub g: [Number; 2],
    /// Rounding errors of one step.
    pub roundings: Rounded,
    /// The nine inequalities.
    pub inequalities: Vec<Sides>,
    /// The inequalities that replace that of the command if it fails.
    pub at_the_limit: Vec<Sides>,
    /// The inequality for an inactive slew-rate limit; `None` if there is no such limit.
    pub slew: Option<Sides>,
    /// The first inequality that does not hold, and a change that would satisfy it.
    pub refused: Option<Refusal>,
    /// The assumptions that the user must check.
    pub assumptions: Vec<&'static str>,
}

/// An exact number, and the nearest `f64`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Number {
    /// `mantissa*2^exponent`.
    pub exact: String,
    /// The nearest `f64`.
    pub value: f64,
    /// The largest `f64` that is not above the number.
    #[serde(skip)]
    pub low: f64,
    /// The smallest `f64` that is not below the number.
    #[serde(skip)]
    pub high: f64,
}

impl From<Dyadic> for Number {
    fn from(number: Dyadic) -> Self {
        let value = number.as_f64();
        let nearest = Dyadic::of(value);
        Self {
            exact: number.to_string(),
            value,
            // A number beyond the floats has an infinite nearest one.
            low: if nearest > number || value.is_infinite() {
                value.next_down()
            } else {
                value
            },
            high: if nearest < number {
                value.next_up()
            } else {
                value
            },
        }
    }
}

/// The gains of the controller.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exact {
    /// Control gain.
    pub k: String,
    /// \[1/s\]
    pub lambda: String,
    /// \[s\]
    pub step: String,
    /// \[N·m\]
    pub epsilon: String,
    /// \[N·m·s\]
    pub z_limit: String,
    /// \[command unit\]
    pub command: String,
    /// Slew-rate limit \[command unit/s\]; `None` if there is none.
    pub slew: Option<String>,
    /// Bounds on beta_hat.
    pub beta: [String; 2],
    /// Bounds on delta_hat \[N·m\].
    pub delta: [String; 2],
    /// Largest adaptation gain of an estimate.
    pub adaptation: String,
    /// Largest leakage of an estimate \[1/s\].
    pub leakage: String,
}

/// The known ranges of the plant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExactPlant {
    /// \[N·m/command unit\]
    pub alpha: [String; 2],
    /// \[N·m\]
    pub disturbance: String,
    /// \[N·m/s\]
    pub disturbance_rate: String,
    /// \[N·m\]
    pub reference: String,
    /// \[N·m/s\]
    pub reference_rate: String,
}

/// The known ranges of a regressor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExactRegressor {
    /// Bounds on the estimate.
    pub theta_hat: [String; 2],
    /// Range of the true value.
    pub theta: [String; 2],
    /// Largest magnitude.
    pub magnitude: String,
    /// Largest rate \[1/s\].
    pub rate: String,
}

/// Rounding errors of one step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rounded {
    /// Rounding error of s \[N·m\].
    pub s: Number,
    /// Rounding error of the command \[command unit\].
    pub command: Number,
    /// Rounding error of z \[N·m·s\].
    pub z: Number,
    /// Largest carry of the sum of z \[N·m·s\].
    pub carry_error_z: Number,
    /// Largest carry of the sum of the command \[command unit\].
    pub owed_by_command: Number,
}

/// An inequality with both sides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sides {
    /// `step`, `steepness`, …
    pub name: Named,
    /// The inequality in symbols.
    pub text: &'static str,
    /// Upper bound on the left side.
    pub left: Number,
    /// Lower bound on the right side.
    pub right: Number,
    /// Whether the inequality holds.
    pub holds: bool,
}

impl From<&Inequality> for Sides {
    fn from(inequality: &Inequality) -> Self {
        Self {
            name: inequality.name,
            text: inequality.name.text(),
            left: inequality.left.into(),
            right: inequality.right.into(),
            holds: inequality.holds(),
        }
    }
}

/// The reason why gains are not proved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Refusal {
    /// The violated inequality.
    pub text: &'static str,
    /// A change that would satisfy the inequality.
    pub mend: String,
}

/// Largest adaptation gain and leakage rate \[1/s\] for which no overflow is proved. A gains file
/// specifies neither, and practical values are much smaller.
const MOST_ADAPTATION: f64 = 1_073_741_824.0;

/// Reads a file of gains and examines them.
///
/// # Errors
/// A message with file, line, column and the allowed values.
pub fn prove(path: &Path) -> Result<Proof, String> {
    let label = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| format!("{label}: {e}"))?;
    parse(&text, &label)
}

/// The error for a file of gains without a plant.
const NO_PLANT: &str = "has no [plant]; add a [plant] table with alpha = [least, greatest], disturbance, disturbance_rate, reference and reference_rate";

/// Reads the text of a file of gains and examines the gains. `label` is the name of the file.
///
/// # Errors
/// The same as [`prove`].
pub fn parse(text: &str, label: &str) -> Result<Proof, String> {
    if is_of_design(text) {
        let gains = GainsFile::parse(text, label)?;
        return designed::prove(&gains).map_err(|e| format!("{label}: {e}"));
    }
    let table = toml::from_str::<toml::Table>(text);
    if table.is_ok_and(|table| table.contains_key("lambda") && !table.contains_key("plant")) {
        return Err(format!("{label}: {NO_PLANT}"));
    }
    let form: Form = toml::from_str(text).map_err(|e| message(&e, text, label))?;
    of_form(&form).map_err(|e| format!("{label}: {e}"))
}

fn of_form(form: &Form) -> Result<Proof, String> {
    match form.float {
        Float::F32 => of_any::<f32>(form),
        Float::F64 => of_any::<f64>(form),
    }
}

fn of_any<T: Real>(form: &Form) -> Result<Proof, String> {
    match form.regressor.len() {
        0 => of::<T, 0>(form),
        1 => of::<T, 1>(form),
        2 => of::<T, 2>(form),
        3 => of::<T, 3>(form),
        4 => of::<T, 4>(form),
        5 => of::<T, 5>(form),
        6 => of::<T, 6>(form),
        7 => of::<T, 7>(form),
        8 => of::<T, 8>(form),
        many => Err(format!(
            "{many} regressors are too many; at most 8 are allowed"
        )),
    }
}

fn of<T: Real, const N: usize>(form: &Form) -> Result<Proof, String> {
    let settings = settings::<T, N>(form).map_err(|e| e.to_string())?;
    let plant = plant::<N>(form);
    let examined = PeakRounded::examine(&settings, &plant).map_err(|e| e.to_string())?;
    // What is proved is of a controller that exists.
    if examined.is_proved() {
        Adaptive::try_new(settings)
            .map_err(|e| format!("the controller rejects these settings: {e}"))?;
    }
    Ok(proof(form, &settings, &plant, &examined))
}

/// The settings in the nearest floats. The upper bound on alpha is rounded up.
fn settings<T: Real, const N: usize>(form: &Form) -> Result<AdaptiveSettings<T, N>, Error> {
    let moving = |[low, high]: [f64; 2]| {
        let low = T::from_f64(low);
        let box_of = Estimator {
            prior: low,
            ..Estimator::free(low).within(low, T::from_f64(high))
        };
        if box_of.low == box_of.high {
            box_of
        } else {
            // The estimate is anywhere in its box; the greatest overflow first.
            let most = T::from_f64(MOST_ADAPTATION);
            box_of.adapting(most, most)
        }
    };
    let mut plant_gain = T::from_f64(form.plant.alpha.0[1]);
    if plant_gain.as_f64() < form.plant.alpha.0[1] {
        plant_gain *= T::ONE + T::epsilon();
    }
    let lag = bowden::control::Form::FirstOrder {
        step: T::from_f64(form.step.0),
        plant_gain,
    };
    let command = T::from_f64(form.command.0);
    let mut theta = [Estimator::fixed(T::ZERO); N];
    for (estimator, regressor) in theta.iter_mut().zip(&form.regressor) {
        *estimator = moving(regressor.theta_hat.0);
    }
    let (k, lambda, epsilon) = (form.k.0, form.lambda.0, form.epsilon.0);
    Ok(AdaptiveSettings {
        beta: moving(form.beta.0),
        delta: moving(form.delta.0),
        theta,
        z_limit: T::from_f64(form.z_limit.0),
        limits: match form.slew {
            Some(slew) => Limits::try_new(-command, command)?.with_slew(T::from_f64(slew.0))?,
            None => Limits::try_new(-command, command)?,
        },
        ..AdaptiveSettings::unlimited(
            lag,
            T::from_f64(k),
            T::from_f64(lambda),
            T::from_f64(epsilon),
        )
    })
}

fn plant<const N: usize>(form: &Form) -> Plant<f64, N> {
    let interval = |[low, high]: [f64; 2]| Interval { low, high };
    let mut regressors = [Known::default(); N];
    for (known, regressor) in regressors.iter_mut().zip(&form.regressor) {
        *known = Known {
            theta: interval(regressor.theta.0),
            magnitude: regressor.magnitude.0,
            rate: regressor.rate.0,
        };
    }
    let plant = &form.plant;
    Plant {
        alpha: interval(plant.alpha.0),
        delta: plant.disturbance.0,
        delta_rate: plant.disturbance_rate.0,
        regressors,
        reference: plant.reference.0,
        reference_rate: plant.reference_rate.0,
    }
}

fn proof<T: Real, const N: usize>(
    form: &Form,
    settings: &AdaptiveSettings<T, N>,
    plant: &Plant<f64, N>,
    examined: &PeakRounded,
) -> Proof {
    let float = |x: T| Dyadic::of(x).to_string();
    let real = |x: f64| Dyadic::of(x).to_string();
    let number = |x: bowden_bound::Enclosure| Number::from(x.high);
    let range = |estimator: &Estimator<T>| [float(estimator.low), float(estimator.high)];
    let pairs = settings.theta.iter().zip(&plant.regressors);
    let rounded = &examined.roundings;
    Proof {
        schema: "bowden.certificate/1",
        proved: examined.is_proved(),
        may_meet_the_limit: examined.may_meet_the_limit(),
        float: form.float,
        gains: Exact {
            k: float(settings.gain),
            lambda: float(settings.lambda),
            step: float(T::from_f64(form.step.0)),
            epsilon: float(settings.epsilon),
            z_limit: float(settings.z_limit),
            command: float(settings.limits.high()),
            slew: settings.limits.slew().map(float),
            beta: range(&settings.beta),
            delta: range(&settings.delta),
            adaptation: real(MOST_ADAPTATION),
            leakage: real(MOST_ADAPTATION),
        },
        plant: ExactPlant {
            alpha: [plant.alpha.low, plant.alpha.high].map(real),
            disturbance: real(plant.delta),
            disturbance_rate: real(plant.delta_rate),
            reference: real(plant.reference),
            reference_rate: real(plant.reference_rate),
        },
        regressors: pairs
            .map(|(estimator, known)| ExactRegressor {
                theta_hat: range(estimator),
                theta: [known.theta.low, known.theta.high].map(real),
                magnitude: real(known.magnitude),
                rate: real(known.rate),
            })
            .collect(),
        s: number(examined.s),
        z: number(examined.z),
        error: number(examined.error),
        w: number(examined.w),
        xi: number(examined.xi),
        g: [examined.g[0].low.into(), examined.g[1].high.into()],
        roundings: Rounded {
            s: number(rounded.s),
            command: number(rounded.command),
            z: number(rounded.z),
            carry_error_z: number(rounded.carry_error_z),
            owed_by_command: number(rounded.owed_by_command),
        },
        inequalities: examined.inequalities.iter().map(Sides::from).collect(),
        at_the_limit: examined.at_the_limit.iter().map(Sides::from).collect(),
        slew: examined.slew.as_ref().map(Sides::from),
        refused: examined.refused().map(|inequality| Refusal {
            text: inequality.name.text(),
            mend: mend::words(form, inequality),
        }),
        assumptions: assumptions(),
    }
}

/// The assumptions of the theorem, and the assumptions on the adaptation, which a file does not
/// state.
fn assumptions() -> Vec<&'static str> {
    let kind = Kind::PeakRounded;
    let certificate = bowden_bound::Certificate { kind, value: 0.0 };
    let mut all = certificate.assumptions().to_vec();
    all.push(
        "the adaptation gains and the leakage rates [1/s] are at most 2^30, and each prior is within its bounds",
    );
    all
}
