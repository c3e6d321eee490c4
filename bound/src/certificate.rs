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
const RANGES: &str = "alpha and theta lie in the stated intervals and do not change";
const DISTURBANCE: &str =
    "|D| <= delta at every time, D with hysteresis, pretension and any feed-forward's error";
const LIMITS: &str = "no output limit, slew rate or limit of z is met, and no sample is bad";
const FIXED: &str = "estimates that do not adapt are at their initial values";

static CONTINUOUS: &[&str] = &[
    "continuous time: the law runs much faster than the loop, nothing is delayed",
    "e' is known: neither the filter nor the noise of its difference counts",
    PLANT,
    RANGES,
    DISTURBANCE,
    "y_r, x and D are such that a solution exists (no slack cable)",
    LIMITS,
    FIXED,
];

static SAMPLED: &[&str] = &[
    "each command acts within its sample: y at a sample is of the u of the one before",
    PLANT,
    "alpha lies in its interval and does not change; neither does theta",
    DISTURBANCE,
    "|D(k+1) - D(k)| <= h*delta_rate and |x(k+1) - x(k)| <= h*rate along the true path",
    "|y_r|, its change from sample to sample and |x| stay within what is stated",
    "the next reference given to the law is the one that comes",
    "y and x are measured without noise (noise of y adds to D and, over h, to its rate)",
    "the errors start in the box: else the bound holds in the limit",
    LIMITS,
    FIXED,
];

static ROUNDED: &[&str] = &[
    "each command acts within its sample: y at a sample is of the u of the one before",
    PLANT,
    "alpha lies in its interval and does not change; neither does theta",
    "|D| <= delta at every time, with what the sensor rounds; y is what the controller reads",
    "|D(k+1) - D(k)| <= h*delta_rate and |x(k+1) - x(k)| <= h*rate along the true path",
    "|y_r|, its change from sample to sample and |x| stay within what is stated",
    "the next reference given to the law is the one that comes; no feed-forward",
    "dt is the step of the form at every sample; no sample is bad",
    "the errors start in the box, and no sum owes more than it may",
    FIXED,
];

static PER_STEP: &[&str] = &[
    "all that the sampled peak certificate assumes",
    "every sample takes the stated step, no shorter one",
    "the errors start in the box of the sampled peak certificate",
];
