//! The stored form of the rates and their state, read through their checks.

use super::{Rates, RatesState};
use crate::error::finite;
use crate::signal::Motion;
use crate::{Error, Real};

#[derive(serde::Deserialize)]
// Without its period a turning shaft would show a jump: a misspelt period is refused.
#[serde(deny_unknown_fields)]
pub(super) struct Unchecked<T> {
    time_constant: T,
    longest_gap: T,
    period: Option<T>,
}

impl<T: Real> TryFrom<Unchecked<T>> for Rates<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        let rates = Self::try_new(raw.time_constant)?.with_longest_gap(raw.longest_gap)?;
        match raw.period {
            Some(period) => rates.with_period(period),
            None => Ok(rates),
        }
    }
}

impl<'de, T> serde::Deserialize<'de> for RatesState<T>
where
    T: Real + serde::Deserialize<'de>,
{
    /// Refuses numbers that are not finite and times that are negative.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(bound = "T: Real + serde::Deserialize<'de>")]
        struct Fields<T> {
            last: Option<T>,
            turns: i32,
            motion: Motion<T>,
            gap: T,
            time_unknown: bool,
            age: T,
        }
        let refused = <D::Error as serde::de::Error>::custom;
        let read = Fields::<T>::deserialize(from)?;
        let motion = read.motion;
        let numbers = [motion.position, motion.velocity, motion.acceleration];
        for number in numbers.into_iter().chain(read.last) {
            finite(number, "motion").map_err(refused)?;
        }
        for time in [read.gap, read.age] {
            if finite(time, "time").map_err(refused)? < T::zero() {
                return Err(refused(Error::OutOfRange("time")));
            }
        }
        Ok(Self {
            last: read.last,
            turns: read.turns,
            motion,
            gap: read.gap,
            time_unknown: read.time_unknown,
            age: read.age,
        })
    }
}
