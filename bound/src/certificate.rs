//! A certificate: a bound with its value, unit and assumptions.

/// The theorem behind a certificate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Kind {
    /// [`Theorem1`](super::Theorem1), as in Nguyen et al. (2018).
    Theorem1,
    /// [`Tightest`](super::Tightest): Theorem 1 with the best choice of its free constants.
    Tightest,
    /// [`Rms`](super::Rms).
    Rms,
    /// [`RmsSampled`](super::RmsSampled).
    RmsSampled,
    /// [`PeakContinuous`](super::PeakContinuous).
    PeakContinuous,
    /// [`PeakSampled`](super::PeakSampled): the box theorem.
    PeakSampled,
    /// [`PeakRounded`](super::PeakRounded): the box theorem with all rounding errors.
    PeakRounded,
    /// The bound from [`PerStep`](super::PerStep) for infinite time.
    PerStep,
}

/// A bound on the tracking error \[N·m\], with its assumptions.
///
/// ```
/// use bowden_bound::{Plant, Theorem1};
/// use bowden::control::Adaptive;
/// let plant = Plant::new(0.5, 7.0); // alpha [N·m/command unit], Delta [N·m]
/// let certificate = Theorem1::try_new(&Adaptive::paper(), &plant)?.certificate();
/// assert!((certificate.value - 1138.0_f64).abs() < 1.0); // vacuous
/// assert_eq!(certificate.unit(), "N·m");
/// for assumption in certificate.assumptions() {
///     println!("to check: {assumption}");
/// }
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Certificate<T> {
    /// The theorem behind the bound.
    pub kind: Kind,
    /// The bound \[N·m\].
    pub value: T,
}

impl<T> Certificate<T> {
    pub(super) const fn new(kind: Kind, value: T) -> Self {
        Self { kind, value }
    }

    /// The bounded quantity, for example "limsup |e|".
    #[must_use]
    pub fn bounds(&self) -> &'static str {
        match self.kind {
            Kind::Theorem1 | Kind::Tightest | Kind::PeakContinuous | Kind::PerStep => "limsup |e|",
            Kind::Rms | Kind::RmsSampled => "rms e, over a long time",
            Kind::PeakSampled | Kind::PeakRounded => "|e| at every sample",
        }
    }

    /// Unit of the value: "N·m".
    #[must_use]
    pub fn unit(&self) -> &'static str {
        "N·m"
    }

    /// Assumptions that the user must check. The constructors check all other assumptions.
    #[must_use]
    pub fn assumptions(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Theorem1 | Kind::Tightest | Kind::Rms | Kind::PeakContinuous => CONTINUOUS,
            Kind::PeakSampled => SAMPLED,
            Kind::PeakRounded => ROUNDED,
            Kind::PerStep | Kind::RmsSampled => PER_STEP,
        }
    }
}

const PLANT: &str = "the plant is y = alpha*u - theta'x - D: no dynamics between u and y";
const RANGES: &str = "alpha and theta are constant and lie in the stated intervals";
const DISTURBANCE: &str =
    "|D| <= delta at all times; D includes hysteresis, pretension and the error of any feed-forward";
const LIMITS: &str = "no limit on command, slew rate or z is active, and no sample is bad";
const FIXED: &str = "estimates that do not adapt are at their initial values";
const DELAY: &str =
    "each command acts within its sample: y is the response to u of the previous sample";
const RATES: &str =
    "|D(k+1) - D(k)| <= h*delta_rate and |x(k+1) - x(k)| <= h*rate on the true trajectory";
const REFERENCE: &str = "|y_r|, |x| and the change of y_r per sample are within the stated limits";

static CONTINUOUS: &[&str] = &[
    "continuous time: the law runs much faster than the dynamics of the loop, and there is no delay",
    "e' is known: the filter and the noise of its difference quotient are neglected",
    PLANT,
    RANGES,
    DISTURBANCE,
    "for y_r, x and D, a solution exists (no slack cable)",
    LIMITS,
    FIXED,
];

static SAMPLED: &[&str] = &[
    DELAY,
    PLANT,
    RANGES,
    DISTURBANCE,
    RATES,
    REFERENCE,
    "the next reference that the law receives is correct",
    "y and x are measured without noise (noise of y adds to D, and noise/h to the rate of D)",
    "the initial errors are in the box; otherwise the bound holds only in the limit",
    LIMITS,
    FIXED,
];

static ROUNDED: &[&str] = &[
    DELAY,
    PLANT,
    RANGES,
    "|D| <= delta at all times, where D includes the quantisation error of the sensor; y is the value that the controller reads",
    RATES,
    REFERENCE,
    "the next reference that the law receives is correct, and there is no feed-forward",
    "dt is the step of the form at every sample, and no sample is bad",
    "the initial errors are in the box, and the initial carry of each sum is within its bound",
    FIXED,
];

static PER_STEP: &[&str] = &[
    "all assumptions of the sampled peak certificate",
    "dt is the stated step at every sample, never shorter",
    "the initial errors are in the box of the sampled peak certificate",
];
