//! The numbers of a state that was stored: one that is not finite might stay for ever.

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

/// The same of a number that there may be none of.
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

/// The longest dt of what was stored without one: any.
pub(super) fn any_dt<T: Real>() -> T {
    T::HIGHEST
}
