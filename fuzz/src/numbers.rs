//! Numbers out of the fuzzer's bytes.
//!
//! A byte says of what kind a number is, so that one mutated byte turns a sensor's value
//! into NaN, into the largest float or back.

use bowden::control::{Applied, Fallback, Limits};
use bowden::effect::{Effect, Motion, CATALOGUE};
use bowden::hysteresis::BoucWen;
use bowden::model::{Source, Term};
use bowden::transmission::Transmission;
use bowden::Real;

/// The bytes that are left.
pub struct Numbers<'a>(&'a [u8]);

impl<'a> Numbers<'a> {
    /// All of `data`.
    #[must_use]
    pub fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// The next byte; `None` ends a run.
    pub fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*first)
    }

    /// Yes or no.
    pub fn flag(&mut self) -> Option<bool> {
        self.byte().map(|byte| byte & 1 == 1)
    }

    /// Any bit pattern; a value that a sensor could give in half of the cases.
    pub fn any<T: Real>(&mut self) -> Option<T> {
        const EDGES: [f64; 16] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.001,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f32::MAX as f64,
            -f32::MAX as f64,
            f64::MAX,
            f64::MIN,
            f32::MIN_POSITIVE as f64,
            1e-45,
            f64::MIN_POSITIVE,
            5e-324,
        ];
        let kind = self.byte()?;
        Some(T::from_f64(match kind {
            0..=63 => EDGES[usize::from(kind % 16)],
            64..=95 => f64::from(f32::from_bits(u32::from_le_bytes(self.bytes()?))),
            96..=127 => f64::from_bits(u64::from_le_bytes(self.bytes()?)),
            _ => return self.ordinary(),
        }))
    }

    /// Any bit pattern, or none.
    pub fn any_or_none<T: Real>(&mut self) -> Option<Option<T>> {
        match self.flag()? {
            true => self.any().map(Some),
            false => Some(None),
        }
    }

    /// Within ±32.768, in thousandths.
    pub fn ordinary<T: Real>(&mut self) -> Option<T> {
        let thousandths = i16::from_le_bytes(self.bytes()?);
        Some(T::from_f64(f64::from(thousandths) / 1000.0))
    }

    /// A step in time that a loop could have, or now and then anything.
    pub fn dt<T: Real>(&mut self) -> Option<T> {
        match self.byte()? {
            0..=191 => Some(T::from_f64(0.001)),
            byte @ 192..=239 => Some(T::from_f64(f64::from(byte - 191) * 5e-4)),
            _ => self.any(),
        }
    }

    /// Position, velocity and acceleration.
    pub fn motion<T: Real>(&mut self) -> Option<Motion<T>> {
        Some(Motion {
            position: self.any()?,
            velocity: self.any()?,
            acceleration: self.any()?,
        })
    }

    /// Limits that their constructors accept; none where they refuse.
    pub fn limits(&mut self) -> Option<Limits<f32>> {
        if self.flag()? {
            return Some(Limits::unlimited());
        }
        let range = Limits::try_new(self.any()?, self.any()?).unwrap_or(Limits::unlimited());
        Some(if self.flag()? {
            range.with_slew(self.any()?).unwrap_or(range)
        } else {
            range
        })
    }

    /// A fallback; to hold where its constructor refuses.
    pub fn fallback(&mut self) -> Option<Fallback<f32>> {
        let after = u32::from(self.byte()? % 4);
        Some(Fallback::try_new(after, self.any()?).unwrap_or(Fallback::hold_indefinitely()))
    }

    /// What a drive did.
    pub fn applied<T: Real>(&mut self) -> Option<Applied<T>> {
        Some(match self.byte()? % 4 {
            0 => Applied::AsCommanded,
            1 => Applied::AtUpperLimit,
            2 => Applied::AtLowerLimit,
            _ => Applied::Command(self.any()?),
        })
    }

    /// A shape that its constructor accepts.
    pub fn shape<T: Real>(&mut self) -> Option<BoucWen<T>> {
        BoucWen::try_new(self.any()?, self.any()?, self.any()?).ok()
    }

    /// A transmission that its constructor accepts, of either mode.
    pub fn transmission<T: Real>(&mut self) -> Option<Transmission<T>> {
        let shape = self.shape()?;
        let build = if self.flag()? {
            Transmission::torque
        } else {
            Transmission::displacement
        };
        build(self.any()?, self.any()?, self.any()?, shape).ok()
    }

    /// One of the catalogue, with shapes that it accepts.
    pub fn effect<T: Real>(&mut self) -> Option<Effect<T>> {
        let name = CATALOGUE[usize::from(self.byte()?) % CATALOGUE.len()].name;
        let mut shapes = [T::zero(); 4];
        for count in 0..shapes.len() {
            if let Ok(effect) = Effect::try_from_name(name, &shapes[..count]) {
                return Some(effect);
            }
            shapes[count] = self.any()?;
        }
        Effect::try_from_name(name, &shapes).ok()
    }

    /// A term with any effect, source, origin and gain.
    pub fn term<T: Real>(&mut self) -> Option<Term<T>> {
        let effect = self.effect()?;
        let source = match self.byte()? % 4 {
            0 => Source::Channel(0),
            1 => Source::Channel(7),
            _ => Source::Input,
        };
        Some(Term {
            effect,
            source,
            origin: self.any()?,
            gain: self.any()?,
        })
    }
}
