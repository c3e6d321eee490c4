//! Stored forms of a model, read and written without a heap.
//!
//! In a human-readable format, a model has the schema `bowden.model/1`. In any other format it has
//! the form of [`Parts`]. Reading calls the constructors, which check the values.

use super::{Model, Source, Term};
use crate::effect::{Effect, CATALOGUE};
use crate::hysteresis::BoucWen;
use crate::list::List;
use crate::transmission::{Mode, Transmission};
use crate::{Error, Real};
use core::fmt;
use serde::de::{Error as _, IgnoredAny, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

const SCHEMA: &str = "bowden.model/1";

/// More shape parameters than any effect has.
const MOST_SHAPES: usize = 4;

/// Largest number of channels, from the type of the index in [`Source::Channel`].
const MOST_CHANNELS: usize = 256;

/// The form of a model in a format without names.
#[derive(Serialize, Deserialize)]
#[serde(
    rename = "Model",
    bound(
        serialize = "T: Real + Serialize",
        deserialize = "T: Real + Deserialize<'de>"
    )
)]
struct Parts<T, const N: usize> {
    #[serde(default = "Option::default")]
    transmission: Option<Transmission<T>>,
    terms: List<Term<T>, N>,
}

impl<T: Real + Serialize, const N: usize> Serialize for Model<T, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        if to.is_human_readable() {
            return write(self, to);
        }
        let parts = Parts::<T, N> {
            transmission: self.transmission,
            terms: List::of(self.terms().iter().copied()),
        };
        parts.serialize(to)
    }
}

impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for Model<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        if from.is_human_readable() {
            return read(from);
        }
        let parts = Parts::<T, N>::deserialize(from)?;
        Self::try_new(parts.transmission, parts.terms.items()).map_err(D::Error::custom)
    }
}

/// Reads a text and converts it by a function.
struct Text<F>(&'static str, F);

impl<X, F: FnOnce(&str) -> Option<X>> Visitor<'_> for Text<F> {
    type Value = X;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<X, E> {
        let expected = self.0;
        (self.1)(text).ok_or_else(|| E::custom(format_args!("{text:?} is not {expected}")))
    }
}

/// Types that are read from a text.
macro_rules! texts {
    ($($(#[$attr:meta])* struct $name:ident($kind:ty) = $expected:literal: $known:expr;)+) => {$(
        $(#[$attr])*
        struct $name($kind);

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let known: fn(&str) -> Option<$kind> = $known;
                from.deserialize_str(Text($expected, known)).map(Self)
            }
        }
    )+};
}

texts! {
    /// The schema, which must be the known one.
    #[derive(Serialize)]
    struct Schema(&'static str) = "the schema \"bowden.model/1\"":
        |text| (text == SCHEMA).then_some(SCHEMA);

    /// An effect's name, from the catalogue.
    #[derive(Clone, Copy, Default, Serialize)]
    struct EffectName(&'static str) = "an effect of the catalogue": |text| {
        let mut names = CATALOGUE.iter().map(|info| info.name);
        names.find(|name| *name == text)
    };

    /// The name of a shape parameter, from the catalogue.
    #[derive(Clone, Copy, Default, Serialize)]
    struct ShapeName(&'static str) = "a shape's name": |text| {
        let mut names = CATALOGUE.iter().flat_map(|info| info.shapes).map(|shape| shape.name);
        // An unknown name matches none.
        Some(names.find(|name| *name == text).unwrap_or(""))
    };

    /// A name of any length, stored as 64 bits (FNV-1a): there is no room for the names of all
    /// channels. Two channels with the same hash are an error, so they cannot be confused.
    #[derive(Clone, Copy, Default, PartialEq)]
    struct Name(u64) = "a name": |text| Some(hash(text));
}

fn hash(text: &str) -> u64 {
    let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, mix)
}

/// The transmission's numbers.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Transmission", deny_unknown_fields)]
struct Figures<T> {
    gain: T,
    kappa_eta: T,
    offset: T,
    rho: T,
    sigma: T,
    n: T,
}

impl<T: Real> Figures<T> {
    fn of(transmission: &Transmission<T>) -> Self {
        let shape = transmission.shape();
        Self {
            gain: transmission.gain(),
            kappa_eta: transmission.kappa_eta(),
            offset: transmission.offset(),
            rho: shape.rho(),
            sigma: shape.sigma(),
            n: shape.n(),
        }
    }

    fn transmission(&self, mode: Mode) -> Result<Transmission<T>, Error> {
        let shape = BoucWen::try_new(self.rho, self.sigma, self.n)?;
        let build = match mode {
            Mode::Torque => Transmission::torque,
            Mode::Displacement => Transmission::displacement,
        };
        build(self.gain, self.kappa_eta, self.offset, shape)
    }
}

/// One shape parameter of a term.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Shape<T> {
    name: ShapeName,
    value: T,
}

/// One term. `S` is the type of its source.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(
    rename = "Term",
    deny_unknown_fields,
    bound(deserialize = "T: Real + Deserialize<'de>, S: Deserialize<'de>")
)]
struct Line<T, S> {
    effect: EffectName,
    source: S,
    #[serde(default)]
    origin: T,
    gain: T,
    #[serde(default)]
    shapes: List<Shape<T>, MOST_SHAPES>,
}

/// The file, with these channels and terms.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Model", deny_unknown_fields)]
struct File<T, C, L> {
    schema: Schema,
    mode: Mode,
    channels: C,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmission: Option<Figures<T>>,
    #[serde(default)]
    terms: L,
    #[serde(default, skip_serializing, rename = "about")]
    _about: IgnoredAny,
}

impl<T: Real> Line<T, Name> {
    /// The term, or its error.
    fn term<E: serde::de::Error>(&self, channels: &[Name]) -> Result<Term<T>, E> {
        let EffectName(name) = self.effect;
        let given = self.shapes.items();
        let mut values = [T::zero(); MOST_SHAPES];
        for (value, shape) in values.iter_mut().zip(given) {
            *value = shape.value;
        }
        let values = values.get(..given.len()).unwrap_or(&[]);
        let effect = Effect::try_from_name(name, values)
            .map_err(|error| E::custom(format_args!("term {name}: {error}")))?;
        for (shape, expected) in given.iter().zip(effect.info().shapes) {
            if shape.name.0 != expected.name {
                return Err(E::custom(format_args!(
                    "term {name}: a shape must be named {}",
                    expected.name
                )));
            }
        }
        let place = || channels.iter().position(|channel| *channel == self.source);
        let source = match self.source == Name(hash("input")) {
            true => Some(Source::Input),
            false => place().and_then(|place| u8::try_from(place).ok().map(Source::Channel)),
        };
        Ok(Term {
            effect,
            source: source.ok_or_else(|| {
                E::custom(format_args!(
                    "term {name}: no channel has the name of its source"
                ))
            })?,
            origin: self.origin,
            gain: self.gain,
        })
    }
}

/// Reads a model in the form of a file.
fn read<'de, T, D, const N: usize>(from: D) -> Result<Model<T, N>, D::Error>
where
    T: Real + Deserialize<'de>,
    D: Deserializer<'de>,
{
    type Channels = List<Name, MOST_CHANNELS>;
    let file = File::<T, Channels, List<Line<T, Name>, N>>::deserialize(from)?;
    let channels = file.channels.items();
    for (place, name) in channels.iter().enumerate() {
        if channels.iter().take(place).any(|other| other == name) {
            return Err(D::Error::custom("two channels have the same name"));
        }
    }
    let transmission = file.transmission;
    let transmission = transmission
        .map(|figures| figures.transmission(file.mode))
        .transpose()
        .map_err(|error| D::Error::custom(format_args!("transmission: {error}")))?;
    let mut terms = [Term::default(); N];
    let lines = file.terms.items();
    for (term, line) in terms.iter_mut().zip(lines) {
        *term = line.term(channels)?;
    }
    let terms = terms.get(..lines.len()).unwrap_or(&[]);
    Model::try_new(transmission, terms).map_err(D::Error::custom)
}

/// A source for output. The name of a channel contains its index.
#[derive(Clone, Copy, Default)]
struct Numbered(Option<u8>);

impl Serialize for Numbered {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            None => to.serialize_str("input"),
            Some(index) => to.collect_str(&format_args!("channel_{index}")),
        }
    }
}

/// Writes a model in the form of a file.
fn write<T, S, const N: usize>(model: &Model<T, N>, to: S) -> Result<S::Ok, S::Error>
where
    T: Real + Serialize,
    S: Serializer,
{
    let number = |term: &Term<T>| match term.source {
        Source::Input => None,
        Source::Channel(index) => Some(index),
    };
    let line = |term: &Term<T>| {
        let shapes = term.effect.info().shapes.iter().enumerate();
        Line {
            effect: EffectName(term.effect.name()),
            source: Numbered(number(term)),
            origin: term.origin,
            gain: term.gain,
            shapes: List::of(shapes.filter_map(|(index, shape)| {
                let (name, value) = (ShapeName(shape.name), term.effect.shape(index)?);
                Some(Shape { name, value })
            })),
        }
    };
    let transmission = model.transmission();
    let terms = model.terms().iter();
    let channels = terms.clone().filter_map(number).max();
    let numbered = (0..=u8::MAX).take_while(|index| Some(*index) <= channels);
    let file = File {
        schema: Schema(SCHEMA),
        // Without a transmission a mode has no meaning.
        mode: transmission.map_or(Mode::Displacement, Transmission::mode),
        channels: List::<_, MOST_CHANNELS>::of(numbered.map(|index| Numbered(Some(index)))),
        transmission: transmission.map(Figures::of),
        terms: List::<_, N>::of(terms.map(line)),
        _about: IgnoredAny,
    };
    file.serialize(to)
}
