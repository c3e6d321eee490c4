//! The model as a file, schema `bowden.model/1`: read and written without a heap.
//!
//! The content of every human-readable format; the compact form is in `serial.rs`.

use super::serial::{Fill, List};
use super::{padding, Model, Source, Term};
use crate::effect::{Effect, CATALOGUE};
use crate::hysteresis::BoucWen;
use crate::transmission::{Mode, Transmission};
use crate::{Error, Real};
use core::fmt;
use core::marker::PhantomData;
use serde::de::{Error as _, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

const SCHEMA: &str = "bowden.model/1";

/// More shapes than any effect has.
const MOST_SHAPES: usize = 4;

/// As many channels as a [`Source::Channel`] can number.
const MOST_CHANNELS: usize = 256;

/// Reads a text and converts it by a function.
struct Text<F>(&'static str, F);

impl<X, F: FnOnce(&str) -> Option<X>> Visitor<'_> for Text<F> {
    type Value = X;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<X, E> {
        let expected = self.0;
        (self.1)(text)
            .ok_or_else(|| E::custom(format_args!("{text:?} where {expected} was expected")))
    }
}

/// The schema, which must be the known one.
struct Schema;

impl<'de> Deserialize<'de> for Schema {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let known = |text: &str| (text == SCHEMA).then_some(Self);
        from.deserialize_str(Text("the schema \"bowden.model/1\"", known))
    }
}

/// An effect's name, from the catalogue.
struct EffectName(&'static str);

impl<'de> Deserialize<'de> for EffectName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let known = |text: &str| {
            let info = CATALOGUE.iter().find(|info| info.name == text);
            info.map(|info| Self(info.name))
        };
        from.deserialize_str(Text("an effect of the catalogue", known))
    }
}

/// A name of any length, stored as 64 bits (FNV-1a): there is no room for the names of all
/// channels. Two channels with the same hash are refused, so they cannot be confused.
#[derive(Clone, Copy, PartialEq)]
struct Name(u64);

impl Name {
    fn of(text: &str) -> Self {
        let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        Self(text.bytes().fold(0xcbf2_9ce4_8422_2325, mix))
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_str(Text("a name", |text: &str| Some(Self::of(text))))
    }
}

/// The channels in the order of the sample.
struct Channels {
    names: [Name; MOST_CHANNELS],
    count: usize,
}

impl Channels {
    fn source(&self, name: Name) -> Option<Source> {
        let mut names = self.names.iter().take(self.count);
        if name == Name::of("input") {
            return Some(Source::Input);
        }
        let place = names.position(|channel| *channel == name)?;
        u8::try_from(place).ok().map(Source::Channel)
    }
}

impl<'de> Deserialize<'de> for Channels {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Names;

        impl<'de> Visitor<'de> for Names {
            type Value = Channels;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "the names of at most {MOST_CHANNELS} channels")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Channels, A::Error> {
                let mut channels = Channels {
                    names: [Name(0); MOST_CHANNELS],
                    count: 0,
                };
                while let Some(name) = from.next_element::<Name>()? {
                    let known = channels.names.iter().take(channels.count);
                    if known.into_iter().any(|other| *other == name) {
                        return Err(A::Error::custom("two channels have one name"));
                    }
                    let place = channels.names.get_mut(channels.count);
                    *place.ok_or_else(|| A::Error::custom(Error::Capacity("channels")))? = name;
                    channels.count += 1;
                }
                Ok(channels)
            }
        }

        from.deserialize_seq(Names)
    }
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

/// A shape parameter's name, up to the length of the longest; a longer name matches none.
struct ShapeName {
    bytes: [u8; 16],
    len: usize,
}

impl ShapeName {
    fn of(text: &str) -> Self {
        let mut bytes = [0; 16];
        bytes
            .iter_mut()
            .zip(text.bytes())
            .for_each(|(to, from)| *to = from);
        Self {
            bytes,
            len: text.len(),
        }
    }

    fn is(&self, name: &str) -> bool {
        self.bytes.get(..self.len) == Some(name.as_bytes())
    }
}

impl<'de> Deserialize<'de> for ShapeName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_str(Text("a shape's name", |text: &str| Some(Self::of(text))))
    }
}

/// One shape parameter of a term.
#[derive(Deserialize)]
#[serde(rename = "BoucWen", deny_unknown_fields)]
struct NamedValue<T> {
    name: ShapeName,
    value: T,
}

/// One term, before its source and its effect are known.
#[derive(Deserialize)]
#[serde(
    rename = "Term",
    deny_unknown_fields,
    bound(deserialize = "T: Real + Deserialize<'de>")
)]
struct Line<T> {
    effect: EffectName,
    source: Name,
    #[serde(default)]
    origin: T,
    gain: T,
    #[serde(default = "Shapes::none")]
    shapes: Shapes<T>,
}

type Shapes<T> = List<NamedValue<T>, MOST_SHAPES>;
type Lines<T, const N: usize> = List<Line<T>, N>;

impl<T: Real> Shapes<T> {
    fn free() -> NamedValue<T> {
        NamedValue {
            name: ShapeName::of(""),
            value: T::zero(),
        }
    }

    fn none() -> Self {
        Self::of(Self::free)
    }
}

impl<'de, T: Real + Deserialize<'de>> Deserialize<'de> for Shapes<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Fill(Self::free, PhantomData))
    }
}

impl<T: Real> Line<T> {
    fn free() -> Self {
        Self {
            effect: EffectName("offset"),
            source: Name::of("input"),
            origin: T::zero(),
            gain: T::zero(),
            shapes: Shapes::none(),
        }
    }

    /// The term, or its error.
    fn term<E: serde::de::Error>(&self, channels: &Channels) -> Result<Term<T>, E> {
        let EffectName(name) = self.effect;
        let mut values = [T::zero(); MOST_SHAPES];
        let given = self.shapes.items();
        let places = values.iter_mut().zip(given);
        places.for_each(|(value, shape)| *value = shape.value);
        let values = values.get(..given.len()).unwrap_or(&[]);
        let effect = Effect::try_from_name(name, values)
            .map_err(|error| E::custom(format_args!("term {name}: {error}")))?;
        for (shape, expected) in given.iter().zip(effect.info().shapes) {
            if !shape.name.is(expected.name) {
                return Err(E::custom(format_args!(
                    "term {name}: another shape where {} was expected",
                    expected.name
                )));
            }
        }
        let source = channels.source(self.source);
        Ok(Term {
            effect,
            source: source.ok_or_else(|| {
                E::custom(format_args!("term {name}: no channel of its source's name"))
            })?,
            origin: self.origin,
            gain: self.gain,
        })
    }
}

impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for Lines<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Fill(Line::free, PhantomData))
    }
}

/// The file.
#[derive(Deserialize)]
#[serde(
    rename = "Model",
    deny_unknown_fields,
    bound(deserialize = "T: Real + Deserialize<'de>")
)]
struct File<T, const N: usize> {
    #[serde(rename = "schema")]
    _schema: Schema,
    mode: Mode,
    channels: Channels,
    #[serde(default = "Option::default")]
    transmission: Option<Figures<T>>,
    #[serde(default = "no_lines")]
    terms: Lines<T, N>,
    #[serde(default, rename = "about")]
    _about: IgnoredAny,
}

fn no_lines<T: Real, const N: usize>() -> Lines<T, N> {
    List::of(Line::free)
}

/// Reads a model in the form of a file.
pub(super) fn read<'de, T, D, const N: usize>(from: D) -> Result<Model<T, N>, D::Error>
where
    T: Real + Deserialize<'de>,
    D: Deserializer<'de>,
{
    let file = File::<T, N>::deserialize(from)?;
    let transmission = file
        .transmission
        .map(|figures| figures.transmission(file.mode));
    let transmission = transmission
        .transpose()
        .map_err(|error| D::Error::custom(format_args!("transmission: {error}")))?;
    let mut terms = [padding(); N];
    let lines = file.terms.items();
    for (term, line) in terms.iter_mut().zip(lines) {
        *term = line.term(&file.channels)?;
    }
    let terms = terms.get(..lines.len()).unwrap_or(&[]);
    Model::try_new(transmission, terms).map_err(D::Error::custom)
}

/// The file for output: channels are named by their numbers.
#[derive(Serialize)]
#[serde(rename = "Model", bound = "T: Real + Serialize")]
struct FileView<'a, T> {
    schema: &'static str,
    mode: Mode,
    channels: Numbered,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmission: Option<Figures<T>>,
    terms: Terms<'a, T>,
}

/// The names of this number of channels.
struct Numbered(usize);

impl Serialize for Numbered {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq((0..self.0).map(ChannelName))
    }
}

struct ChannelName(usize);

impl Serialize for ChannelName {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(&format_args!("channel_{}", self.0))
    }
}

struct Terms<'a, T>(&'a [Term<T>]);

impl<T: Real + Serialize> Serialize for Terms<'_, T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(self.0.iter().map(|term| LineView {
            effect: term.effect.name(),
            source: SourceView(term.source),
            origin: term.origin,
            gain: term.gain,
            shapes: ShapesView(&term.effect),
        }))
    }
}

#[derive(Serialize)]
#[serde(rename = "Term", bound = "T: Real + Serialize")]
struct LineView<'a, T> {
    effect: &'static str,
    source: SourceView,
    origin: T,
    gain: T,
    shapes: ShapesView<'a, T>,
}

struct SourceView(Source);

impl Serialize for SourceView {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Source::Input => to.serialize_str("input"),
            Source::Channel(index) => ChannelName(usize::from(index)).serialize(to),
        }
    }
}

struct ShapesView<'a, T>(&'a Effect<T>);

#[derive(Serialize)]
#[serde(rename = "BoucWen")]
struct ShapeView<T> {
    name: &'static str,
    value: T,
}

impl<T: Real + Serialize> Serialize for ShapesView<'_, T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let shapes = self.0.info().shapes.iter().enumerate();
        to.collect_seq(shapes.filter_map(|(index, shape)| {
            let (name, value) = (shape.name, self.0.shape(index)?);
            Some(ShapeView { name, value })
        }))
    }
}

/// Writes a model in the form of a file.
pub(super) fn write<T, S, const N: usize>(model: &Model<T, N>, to: S) -> Result<S::Ok, S::Error>
where
    T: Real + Serialize,
    S: Serializer,
{
    let counted = |term: &Term<T>| match term.source {
        Source::Input => 0,
        Source::Channel(index) => usize::from(index) + 1,
    };
    let transmission = model.transmission();
    FileView {
        schema: SCHEMA,
        // Without a transmission a mode has no meaning.
        mode: transmission.map_or(Mode::Displacement, Transmission::mode),
        channels: Numbered(model.terms().iter().map(counted).max().unwrap_or(0)),
        transmission: transmission.map(Figures::of),
        terms: Terms(model.terms()),
    }
    .serialize(to)
}
