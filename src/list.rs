//! Lists of fixed capacity for serde, which does not support arrays of arbitrary length `N`.

use crate::Error;
use core::fmt;
use core::marker::PhantomData;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// At most `N` items; the free slots hold the default.
#[derive(Clone, Copy)]
pub(crate) struct List<X, const N: usize> {
    items: [X; N],
    len: usize,
}

impl<X, const N: usize> List<X, N> {
    /// The items of an iterator, up to the capacity.
    pub(crate) fn of(items: impl Iterator<Item = X>) -> Self
    where
        X: Default,
    {
        let mut list = Self::default();
        for (place, item) in list.items.iter_mut().zip(items) {
            *place = item;
            list.len += 1;
        }
        list
    }

    /// The items, without the free slots.
    pub(crate) fn items(&self) -> &[X] {
        self.items.get(..self.len).unwrap_or(&self.items)
    }
}

impl<X: Default, const N: usize> Default for List<X, N> {
    fn default() -> Self {
        Self {
            items: core::array::from_fn(|_| X::default()),
            len: 0,
        }
    }
}

impl<X: Serialize, const N: usize> Serialize for List<X, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.items().serialize(to)
    }
}

impl<'de, X: Deserialize<'de> + Default, const N: usize> Deserialize<'de> for List<X, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Items(PhantomData))
    }
}

struct Items<X, const N: usize>(PhantomData<[X; N]>);

impl<'de, X: Deserialize<'de> + Default, const N: usize> Visitor<'de> for Items<X, N> {
    type Value = List<X, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of at most {N} items")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Self::Value, A::Error> {
        let mut list = List::default();
        while let Some(item) = from.next_element()? {
            let place = list.items.get_mut(list.len);
            *place.ok_or_else(|| A::Error::custom(Error::Capacity("items")))? = item;
            list.len += 1;
        }
        Ok(list)
    }
}

pub(crate) fn serialize<X, S, const N: usize>(items: &[X; N], to: S) -> Result<S::Ok, S::Error>
where
    X: Serialize,
    S: Serializer,
{
    items.as_slice().serialize(to)
}

/// Exactly `N` items.
pub(crate) fn deserialize<'de, X, D, const N: usize>(from: D) -> Result<[X; N], D::Error>
where
    X: Deserialize<'de> + Default,
    D: Deserializer<'de>,
{
    let list = List::<X, N>::deserialize(from)?;
    match list.len == N {
        true => Ok(list.items),
        false => Err(D::Error::custom(format_args!(
            "the list must have {N} items"
        ))),
    }
}

/// At most `N` items; the free slots hold the default.
pub(crate) fn padded<'de, X, D, const N: usize>(from: D) -> Result<[X; N], D::Error>
where
    X: Deserialize<'de> + Default,
    D: Deserializer<'de>,
{
    Ok(List::deserialize(from)?.items)
}
