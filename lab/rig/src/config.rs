//! Parameters of the rig.

use super::checked::finite;
use super::{Drift, MOST_DELAY};
use bowden::{Error, Real};

/// Parameters of a rig. Published results refer to [`RigConfig::reference`].
///
/// [`Rig::try_new`](super::Rig::try_new) checks the fields. All fields must be finite. Inertias,
/// stiffnesses, lags (except `velocity_lag`), ranges, counts, `sub_step` and `drift.time` must be
/// positive. Dampings, noise and `velocity_lag` must not be negative. rho, sigma and n are checked
/// by [`BoucWen::try_new`](bowden::hysteresis::BoucWen::try_new), and `delay` is at most
/// [`MOST_DELAY`](super::MOST_DELAY). The sub-step h must resolve the vibration of the cable:
/// `2·h·c/m + h²·k/m <= 1`. If the left side reaches 4, the integration becomes unstable.
///
/// ```
/// use bowden_rig::{Rig, RigConfig};
/// let quiet = RigConfig { noise: 0.02, ..RigConfig::<f64>::reference() };
/// assert!(Rig::<f64, 0>::try_new(quiet, &[]).is_ok());
/// let coarse = RigConfig { sub_step: 0.01, ..quiet };
/// assert!(Rig::<f64, 0>::try_new(coarse, &[]).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        default,
        deny_unknown_fields,
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct RigConfig<T> {
    /// Motor torque per command unit, N_A \[N·m/unit\].
    pub drive_gain: T,
    /// Time constant of the current loop, tau_c \[s\].
    pub drive_lag: T,
    /// Inertia of motor, gear and proximal pulley, th2 \[kg·m²\].
    pub motor_inertia: T,
    /// Viscous friction of motor, gear and proximal pulley, th1 \[N·m·s/rad\].
    pub motor_damping: T,
    /// Stiffness of the cable, K_c \[N·m/rad\].
    pub cable_stiffness: T,
    /// Damping of the cable, c_c \[N·m·s/rad\].
    pub cable_damping: T,
    /// Inertia of the distal pulley, J_d \[kg·m²\].
    pub joint_inertia: T,
    /// Damping of the distal pulley, c_d \[N·m·s/rad\].
    pub joint_damping: T,
    /// Stiffness of the springs that load the joint, K \[N·m/rad\].
    pub load_stiffness: T,
    /// Torque ratio B.
    pub b: T,
    /// Hysteresis torque at saturation, kappa_eta \[N·m\].
    pub kappa_eta: T,
    /// Preload T0 \[N·m\].
    pub t0: T,
    /// Bouc-Wen rho \[1/(N·m)\].
    pub rho: T,
    /// Bouc-Wen sigma. In a feedback loop, sigma must be at most `B/(2·kappa_eta·rho)`.
    pub sigma: T,
    /// Bouc-Wen n.
    pub n: T,
    /// Time constant of both torque sensors \[s\].
    pub sensor_lag: T,
    /// White noise on each sample of the distal torque \[N·m rms\].
    pub noise: T,
    /// White noise on each sample of the proximal torque \[N·m rms\].
    pub input_noise: T,
    /// Torque at which the A/D converter of the distal sensor saturates, in both
    /// directions \[N·m\].
    pub output_range: T,
    /// Torque at which the A/D converter of the proximal sensor saturates, in both
    /// directions \[N·m\].
    pub input_range: T,
    /// Counts of an A/D converter over its full range.
    pub converter_counts: T,
    /// Counts of an encoder per turn.
    pub encoder_counts: T,
    /// Time constant of the velocity filter, which smooths the differences of the encoder positions
    /// \[s\].
    pub velocity_lag: T,
    /// Samples between a command and its effect on the drive.
    pub delay: u8,
    /// Longest integration sub-step \[s\].
    pub sub_step: T,
    /// Drift of a moving conduit; `None` if the conduit is fixed.
    pub drift: Option<Drift<T>>,
}

impl<T: Real> RigConfig<T> {
    /// The reference rig: the first parameter set of Nguyen et al. (2018) with sigma = 1/2 and
    /// noise of 0.28 N·m.
    ///
    /// The identified sigma of 98 is not admissible in a feedback loop, because the output would
    /// fall while the input rises. The encoders have 4096 lines with four counts each.
    #[must_use]
    pub fn reference() -> Self {
        let of = T::from_f64;
        Self {
            drive_gain: of(0.6),
            drive_lag: of(0.0005),
            motor_inertia: of(0.2),
            motor_damping: of(2.7),
            cable_stiffness: of(1000.0),
            cable_damping: of(3.0),
            joint_inertia: of(0.004),
            joint_damping: of(0.5),
            load_stiffness: of(150.0),
            b: of(0.9978),
            kappa_eta: of(7.004),
            t0: of(0.05174),
            rho: of(0.09582),
            sigma: of(0.5),
            n: of(3.871),
            sensor_lag: of(0.001),
            noise: of(0.28),
            input_noise: of(0.28),
            output_range: of(100.0),
            input_range: of(200.0),
            converter_counts: of(65536.0),
            encoder_counts: of(16384.0),
            velocity_lag: of(0.010),
            delay: 1,
            sub_step: of(25e-6),
            drift: None,
        }
    }

    /// The reference rig with a moving conduit.
    #[must_use]
    pub fn varying() -> Self {
        Self {
            drift: Some(Drift::reference()),
            ..Self::reference()
        }
    }

    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the field's name, [`Error::Inadmissible`]
    /// if the sub-step is too long.
    pub(super) fn check(&self) -> Result<(), Error> {
        for (value, name) in [
            (self.drive_lag, "drive_lag"),
            (self.motor_inertia, "motor_inertia"),
            (self.cable_stiffness, "cable_stiffness"),
            (self.joint_inertia, "joint_inertia"),
            (self.load_stiffness, "load_stiffness"),
            (self.sensor_lag, "sensor_lag"),
            (self.output_range, "output_range"),
            (self.input_range, "input_range"),
            (self.converter_counts, "converter_counts"),
            (self.encoder_counts, "encoder_counts"),
            (self.sub_step, "sub_step"),
            (self.drift.map_or(T::one(), |d| d.time), "drift.time"),
        ] {
            if finite(value, name)? <= T::zero() {
                return Err(Error::OutOfRange(name));
            }
        }
        for (value, name) in [
            (self.motor_damping, "motor_damping"),
            (self.cable_damping, "cable_damping"),
            (self.joint_damping, "joint_damping"),
            (self.noise, "noise"),
            (self.input_noise, "input_noise"),
            (self.velocity_lag, "velocity_lag"),
        ] {
            if finite(value, name)? < T::zero() {
                return Err(Error::OutOfRange(name));
            }
        }
        for (value, name) in [
            (self.drive_gain, "drive_gain"),
            (self.b, "b"),
            (self.kappa_eta, "kappa_eta"),
            (self.t0, "t0"),
            (self.drift.map_or(T::zero(), |d| d.b), "drift.b"),
            (
                self.drift.map_or(T::zero(), |d| d.kappa_eta),
                "drift.kappa_eta",
            ),
            (self.drift.map_or(T::zero(), |d| d.t0), "drift.t0"),
        ] {
            finite(value, name)?;
        }
        if usize::from(self.delay) > MOST_DELAY {
            return Err(Error::OutOfRange("delay"));
        }
        let (h, two) = (self.sub_step, T::from_f64(2.0));
        let both = self.motor_inertia.recip() + self.joint_inertia.recip();
        let damping = self.cable_damping * both
            + self.joint_damping / self.joint_inertia
            + self.motor_damping / self.motor_inertia;
        let stiffness = self.cable_stiffness * both + self.load_stiffness / self.joint_inertia;
        if two * h * damping + h * h * stiffness <= T::one() {
            Ok(())
        } else {
            Err(Error::Inadmissible(
                "sub_step must resolve the cable: 2·h·c/m + h²·k/m <= 1",
            ))
        }
    }
}

impl<T: Real> Default for RigConfig<T> {
    /// The reference rig.
    fn default() -> Self {
        Self::reference()
    }
}
