//! Arrays of any length for serde: lists of exactly `N` items.

use core::fmt;
use core::marker::PhantomData;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub(super) fn serialize<X, S, const N: usize>(items: &[X; N], to: S) -> Result<S::Ok, S::Error>
where
    X: Serialize,
    S: Serializer,
{
    items.as_slice().serialize(to)
}

pub(super) fn deserialize<'de, X, D, const N: usize>(from: D) -> Result<[X; N], D::Error>
where
    X: Deserialize<'de> + Copy + Default,
    D: Deserializer<'de>,
{
    from.deserialize_seq(Exactly(PhantomData))
}

struct Exactly<X, const N: usize>(PhantomData<[X; N]>);

impl<'de, X, const N: usize> Visitor<'de> for Exactly<X, N>
where
    X: Deserialize<'de> + Copy + Default,
{
    type Value = [X; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of {N} items")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Self::Value, A::Error> {
        let mut items = [X::default(); N];
        let mut count = 0;
        while let Some(item) = from.next_element()? {
            let Some(place) = items.get_mut(count) else {
                return Err(A::Error::invalid_length(count + 1, &self));
            };
            *place = item;
            count += 1;
        }
        if count < N {
            return Err(A::Error::invalid_length(count, &self));
        }
        Ok(items)
    }
}
