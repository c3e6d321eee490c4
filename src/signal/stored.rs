//! Checks the numbers of a stored state, because a number that is not finite could persist
//! indefinitely.

use crate::{Error, Real};
use serde::de::{Deserialize, Deserializer, Error as _};

/// A finite number; any other refuses the state.
pub(super) fn number<'de, T, D>(from: D) -> Result<T, D::Error>
where
    T: Real + Deserialize<'de>,
    D: Deserializer<'de>,
{
    let number = T::deserialize(from)?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err(D::Error::custom(Error::NonFinite("state")))
    }
}

/// The same for an optional number.
pub(super) fn optional<'de, T, D>(from: D) -> Result<Option<T>, D::Error>
where
    T: Real + Deserialize<'de>,
    D: Deserializer<'de>,
{
    let number = Option::<T>::deserialize(from)?;
    if number.is_none_or(T::is_finite) {
        Ok(number)
    } else {
        Err(D::Error::custom(Error::NonFinite("state")))
    }
}

/// Default longest dt of a stored form: any.
pub(super) fn any_dt<T: Real>() -> T {
    T::HIGHEST
}
