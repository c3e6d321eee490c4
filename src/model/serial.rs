//! Models and their states in serde: the terms as one list.
//!
//! In a human-readable format a model has the form of a model file (`file.rs`). In every other
//! format it has the derived form of its parts, without names. serde has no arrays of arbitrary
//! length `N`; here they are lists of at most `N`. Reading uses the constructors and their checks.
//! If the list of a state is shorter, the omitted memories start as new.

use super::{file, padding, Model, ModelState, Term};
use crate::effect::EffectState;
use crate::error::finite;
use crate::hysteresis::BoucWenState;
use crate::signal::Compensated;
use crate::transmission::Transmission;
use crate::{Error, Real};
use core::fmt;
use core::marker::PhantomData;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// At most `N` items.
pub(super) struct List<X, const N: usize> {
    items: [X; N],
    len: usize,
}

impl<X, const N: usize> List<X, N> {
    /// An empty list; `free` gives the filler of its slots.
    pub(super) fn of(mut free: impl FnMut() -> X) -> Self {
        Self {
            items: core::array::from_fn(|_| free()),
            len: 0,
        }
    }

    /// The items that were read.
    pub(super) fn items(&self) -> &[X] {
        self.items.get(..self.len).unwrap_or(&self.items)
    }
}

/// Reads a list into existing slots.
pub(super) struct Fill<X, F, const N: usize>(pub(super) F, pub(super) PhantomData<[X; N]>);

impl<'de, X, F, const N: usize> Visitor<'de> for Fill<X, F, N>
where
    X: Deserialize<'de>,
    F: FnMut() -> X,
{
    type Value = List<X, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of at most {N} items")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Self::Value, A::Error> {
        let mut list = List::of(self.0);
        while let Some(item) = from.next_element()? {
            let place = list.items.get_mut(list.len);
            *place.ok_or_else(|| A::Error::custom(Error::Capacity("items")))? = item;
            list.len += 1;
        }
        Ok(list)
    }
}

impl<'de, T, const N: usize> Deserialize<'de> for List<Term<T>, N>
where
    T: Real + Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Fill(padding::<T>, PhantomData))
    }
}

impl<'de, T, const N: usize> Deserialize<'de> for List<EffectState<T>, N>
where
    T: Real + Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Fill(EffectState::<T>::new, PhantomData))
    }
}

#[derive(Serialize)]
#[serde(rename = "Model", bound = "T: Real + Serialize")]
struct ModelView<'a, T> {
    transmission: Option<&'a Transmission<T>>,
    terms: &'a [Term<T>],
}

#[derive(Deserialize)]
#[serde(rename = "Model", bound = "T: Real + Deserialize<'de>")]
struct ModelFields<T, const N: usize> {
    #[serde(default = "Option::default")]
    transmission: Option<Transmission<T>>,
    terms: List<Term<T>, N>,
}

impl<T: Real + Serialize, const N: usize> Serialize for Model<T, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        if to.is_human_readable() {
            return file::write(self, to);
        }
        let view = ModelView {
            transmission: self.transmission(),
            terms: self.terms(),
        };
        view.serialize(to)
    }
}

impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for Model<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        if from.is_human_readable() {
            return file::read(from);
        }
        let fields = ModelFields::<T, N>::deserialize(from)?;
        Self::try_new(fields.transmission, fields.terms.items()).map_err(D::Error::custom)
    }
}

#[derive(Serialize)]
#[serde(rename = "ModelState", bound = "T: Real + Serialize")]
struct StateView<'a, T> {
    hysteresis: &'a BoucWenState<T>,
    effects: &'a [EffectState<T>],
    started: bool,
    time: T,
    carry: T,
    output: T,
}

#[derive(Deserialize)]
#[serde(rename = "ModelState", bound = "T: Real + Deserialize<'de>")]
struct StateFields<T, const N: usize> {
    hysteresis: BoucWenState<T>,
    effects: List<EffectState<T>, N>,
    started: bool,
    time: T,
    carry: T,
    output: T,
}

impl<T: Real + Serialize, const N: usize> Serialize for ModelState<T, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self {
            hysteresis,
            effects,
            started,
            time,
            output,
        } = self;
        let (started, time, carry, output) = (*started, time.value, time.carry, *output);
        StateView {
            hysteresis,
            effects,
            started,
            time,
            carry,
            output,
        }
        .serialize(to)
    }
}

impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for ModelState<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let fields = StateFields::<T, N>::deserialize(from)?;
        Ok(Self {
            hysteresis: fields.hysteresis,
            effects: fields.effects.items,
            started: fields.started,
            time: Compensated {
                value: finite(fields.time, "time").map_err(D::Error::custom)?,
                carry: finite(fields.carry, "carry").map_err(D::Error::custom)?,
            },
            output: finite(fields.output, "output").map_err(D::Error::custom)?,
        })
    }
}
