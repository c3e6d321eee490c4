//! Statuses and faults as small numbers, one byte per sample. The Python package gives their names.

use bowden::control::{Fault, Status};
use bowden::signal::{Implausible, RateStatus};

/// A status and its fault; zero if there is none.
pub type Codes = (u8, u8);

/// 0 good, 1 degraded, 2 held, 3 safe. A larger number is a worse status.
pub fn status(status: Status) -> Codes {
    let code = match status {
        Status::Good => 0,
        Status::Degraded(_) => 1,
        Status::Held(_) => 2,
        Status::Safe(_) => 3,
    };
    (code, status.fault().map_or(0, fault))
}

/// The bad input of a step.
pub fn fault(fault: Fault) -> u8 {
    match fault {
        Fault::Dt => 1,
        Fault::DtNotPositive => 2,
        Fault::DtTooLong => 3,
        Fault::Reference => 4,
        Fault::Measured => 5,
        Fault::Velocity => 6,
        Fault::FeedForward => 7,
        Fault::Command => 8,
        Fault::Overflow => 9,
        Fault::Phase => 10,
        Fault::Position => 12,
        Fault::Regressor(index) => 16_u8.saturating_add(index),
        // The core may learn of more; it is then a fault without a name here.
        _ => 11,
    }
}

/// 0 good, 1 settling, 2 resumed or (for counts) stopped, 3 held.
pub fn rates(status: RateStatus) -> Codes {
    match status {
        RateStatus::Good => (0, 0),
        RateStatus::Settling => (1, 0),
        RateStatus::Resumed | RateStatus::Stopped => (2, 0),
        RateStatus::Held(bad) => (3, fault(bad)),
    }
}

/// Zero if a sample is plausible.
pub fn implausible(fault: Option<Implausible>) -> u8 {
    match fault {
        None => 0,
        Some(Implausible::NotFinite) => 1,
        Some(Implausible::OutOfRange) => 2,
        Some(Implausible::TooFast) => 3,
        Some(Implausible::Stuck) => 4,
        Some(_) => 5,
    }
}
