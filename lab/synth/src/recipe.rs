//! What to generate.

use std::fmt;

/// The input of the transmission. This type is separate from the lab's, to keep the generator
/// independent: see the crate's documentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// `tau_i` in, `tau_o` out, with the angles `phi_p` and `phi_d`.
    Torque,
    /// `x` in, `f` out.
    Displacement,
}

/// An effect to be added to the transmission.
#[derive(Clone, Debug, PartialEq)]
pub struct Planted {
    /// Its name, one of [`effects`](super::effects).
    pub effect: String,
    /// Rms of its contribution as a multiple of the noise's rms.
    pub strength: f64,
    /// The channel that it reads; each effect has a default.
    pub channel: Option<String>,
    /// The gain itself instead of the strength, so that several records can come from one rig. A
    /// delay or a lag has no gain.
    pub gain: Option<f64>,
    /// Origin of its position; `None` means the middle of its motion.
    pub origin: Option<f64>,
}

impl Planted {
    /// An effect at three times the noise on its usual channel.
    pub fn new(effect: &str) -> Self {
        Self {
            effect: effect.to_owned(),
            strength: 3.0,
            channel: None,
            gain: None,
            origin: None,
        }
    }

    /// An effect with this gain, independent of the motion and the noise.
    pub fn with_gain(effect: &str, gain: f64) -> Self {
        Self {
            gain: Some(gain),
            ..Self::new(effect)
        }
    }
}

/// Parameters of the transmission, as in Nguyen et al. (2018).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// B \[-\] in (6), or k_x \[N/mm\] in (1).
    pub gain: f64,
    /// kappa_eta \[N·m\] in (6), or k_eta \[N\] in (1).
    pub kappa_eta: f64,
    /// T0 \[N·m\], subtracted, or a force \[N\], added.
    pub offset: f64,
    /// rho \[1/(N·m)\] in (7), or \[1/mm\] in (2).
    pub rho: f64,
    /// sigma \[-\].
    pub sigma: f64,
    /// n \[-\].
    pub n: f64,
}

impl Base {
    /// A cable in the paper's range, for torque mode.
    pub const CABLE: Self = Self {
        gain: 0.95,
        kappa_eta: 4.0,
        offset: 0.05,
        rho: 0.3,
        sigma: 1.2,
        n: 1.6,
    };

    /// A spring with a loop, for displacement mode.
    pub const SPRING: Self = Self {
        gain: 2.0,
        kappa_eta: 8.0,
        offset: 0.3,
        rho: 0.5,
        sigma: 1.2,
        n: 1.6,
    };
}

/// What to generate; start from [`Recipe::new`].
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// The input of the transmission.
    pub mode: Mode,
    /// The effects that the baseline model will lack.
    pub effects: Vec<Planted>,
    /// Seed of all random choices.
    pub seed: u64,
    /// Length \[s\].
    pub seconds: f64,
    /// Sampling rate \[Hz\].
    pub rate: f64,
    /// Noise of the output, rms \[N·m or N\].
    pub noise: f64,
    /// Correlation of the noise from sample to sample, AR(1); 0 is white.
    pub colour: f64,
    /// Noise of the measured input, rms \[N·m or mm\]; white.
    pub input_noise: f64,
    /// Step of the converters of torque and force \[N·m or N\]; 0 is none.
    pub quantisation: f64,
    /// Step of the position sensors \[rad or mm\]; 0 is none.
    pub resolution: f64,
    /// Peak of the input about its bias \[N·m or mm\].
    pub amplitude: f64,
    /// Mean of the input \[N·m or mm\].
    pub bias: f64,
    /// Whether all motion stops for a second from time to time.
    pub holds: bool,
    /// Whether a temperature is recorded.
    pub temperature: bool,
    /// Whether a load is recorded (displacement mode).
    pub load: bool,
    /// The transmission; `None` means drawn from the seed.
    pub base: Option<Base>,
    /// Half-width of a play in series, between the input and the transmission
    /// \[N·m or mm\]; 0 is none.
    pub play: f64,
}

impl Recipe {
    /// Twenty seconds at 1 kHz with nothing planted, and the paper's sensors.
    pub fn new(mode: Mode) -> Self {
        let turn = 2.0 * std::f64::consts::PI;
        let (amplitude, resolution) = match mode {
            Mode::Torque => (16.0, turn / 16384.0),
            Mode::Displacement => (10.0, 1e-3),
        };
        Self {
            mode,
            effects: Vec::new(),
            seed: 1,
            seconds: 20.0,
            rate: 1000.0,
            noise: 0.05,
            colour: 0.0,
            input_noise: 0.0,
            quantisation: 200.0 / 65536.0,
            resolution,
            amplitude,
            bias: 0.0,
            holds: false,
            temperature: false,
            load: false,
            base: None,
            play: 0.0,
        }
    }

    /// A record of one rig, [`Base::CABLE`] or [`Base::SPRING`]: the seed changes motion and
    /// noise alone.
    pub fn of_one_rig(mode: Mode, seed: u64) -> Self {
        let base = match mode {
            Mode::Torque => Base::CABLE,
            Mode::Displacement => Base::SPRING,
        };
        Self {
            base: Some(base),
            seed,
            ..Self::new(mode)
        }
    }

    pub(super) fn check(&self) -> Result<(), RecipeError> {
        let positive = [
            ("seconds", self.seconds),
            ("rate", self.rate),
            ("amplitude", self.amplitude),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value <= 1e6) {
                return refuse(format!(
                    "{name} {value} must be positive and at most 1000000"
                ));
            }
        }
        let sizes = [
            ("noise", self.noise),
            ("input noise", self.input_noise),
            ("quantisation", self.quantisation),
            ("resolution", self.resolution),
            ("play", self.play),
        ];
        for (name, value) in sizes {
            if !(0.0..=1e6).contains(&value) {
                return refuse(format!("{name} {value} must be from 0 to 1000000"));
            }
        }
        if !(0.0..1.0).contains(&self.colour) {
            return refuse(format!(
                "colour {} must be at least 0 and below 1",
                self.colour
            ));
        }
        if self.bias.is_nan() || self.bias.abs() > 1e6 {
            return refuse(format!("bias {} must be finite", self.bias));
        }
        if !(10.0..=1e7).contains(&(self.seconds * self.rate)) {
            return refuse("seconds times rate must be 10 to 10000000 samples".to_owned());
        }
        if let Some(planted) = self
            .effects
            .iter()
            .find(|p| !(p.strength > 0.0 && p.strength <= 1e6))
        {
            let (name, strength) = (&planted.effect, planted.strength);
            return refuse(format!(
                "strength {strength} of {name} must be positive and at most 1000000"
            ));
        }
        let given = |p: &Planted| {
            p.gain
                .into_iter()
                .chain(p.origin)
                .any(|v| v.is_nan() || v.abs() > 1e6)
        };
        if let Some(planted) = self.effects.iter().find(|p| given(p)) {
            let name = &planted.effect;
            return refuse(format!("the gain and the origin of {name} must be finite"));
        }
        match &self.base {
            Some(base) if !base.is_sound() => refuse(
                "base: the parameters must be finite, with rho > 0, sigma >= 1/2 and n >= 1"
                    .to_owned(),
            ),
            _ => Ok(()),
        }
    }
}

impl Base {
    fn is_sound(&self) -> bool {
        let sizes = [
            self.gain,
            self.kappa_eta,
            self.offset,
            self.rho,
            self.sigma,
            self.n,
        ];
        let finite = sizes.iter().all(|value| value.abs() <= 1e6);
        finite && self.rho > 0.0 && self.sigma >= 0.5 && self.n >= 1.0
    }
}

/// Why a recipe cannot be followed, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecipeError(String);

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for RecipeError {}

pub(super) fn refuse<T>(message: String) -> Result<T, RecipeError> {
    Err(RecipeError(message))
}
