//! Result of a function, and bad input of a sample.

use crate::object::read_text;
use core::ffi::{c_char, CStr};
use core_bowden::control::{Fault, Status};
use core_bowden::signal::RateStatus;
use core_bowden::Error;

/// Result of a function. Zero: success. Positive: the output was written, but the sample was bad or
/// the output is of limited validity. Negative: an error.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_result {
    /// Success. For a step: a good sample.
    Ok = 0,
    /// A good sample, but velocity and acceleration started from zero less than five time constants
    /// ago, or the position has not yet changed twice.
    Settling = 1,
    /// A good position, but the time since the last good one is unknown. Velocity and acceleration
    /// are held.
    Resumed = 2,
    /// Adaptive law: the term of a bad regressor was omitted, and the estimates did not change.
    /// Iterative learning: the error of this sample, or of the cell before a jump, was ignored.
    Degraded = 3,
    /// A bad sample. The state is unchanged, and the last good command or value is held.
    Held = 4,
    /// Too many bad samples. The safe command is applied until the fault is acknowledged.
    Safe = 5,
    /// There was no count for longer than the longest gap, so the velocity is zero.
    Stopped = 6,
    /// The sample is implausible, so the value is NaN.
    Implausible = 7,
    /// A pointer is null.
    ErrorNull = -1,
    /// A pointer is not aligned for its type.
    ErrorMisaligned = -2,
    /// The object is not initialised, or it has been overwritten.
    ErrorUninitialised = -3,
    /// A setting is NaN or infinite.
    ErrorNonFinite = -4,
    /// A setting is outside its range.
    ErrorOutOfRange = -5,
    /// The settings or arguments together violate a condition.
    ErrorInadmissible = -6,
    /// There are too many items, such as channels or cells.
    ErrorCapacity = -7,
    /// A setting has a value that is not in its enum.
    ErrorChoice = -8,
    /// The bytes of a model are damaged or too many, or the model is of the other precision or of
    /// another version, or has too many terms.
    ErrorModel = -9,
    /// The settings were not initialised with their macro NAME_INIT.
    ErrorSettings = -10,
}

/// Bad input of a sample.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_fault {
    /// No bad input.
    None = 0,
    /// dt is NaN or infinite.
    Dt = 1,
    /// dt is zero or negative.
    DtNotPositive = 2,
    /// dt exceeds `longest_dt` or the stability limit of the adaptive law.
    DtTooLong = 3,
    /// The reference, the next reference, or the desired output of a compensator.
    Reference = 4,
    /// The measured output.
    Measured = 5,
    /// The measured velocity.
    Velocity = 6,
    /// The feed-forward command.
    FeedForward = 7,
    /// The command to resume from, or the applied command for an observer.
    Command = 8,
    /// A regressor of the adaptive law, or an input of a model term. The output contains the index.
    Regressor = 9,
    /// An overflow: all inputs are finite, but the command is not.
    Overflow = 10,
    /// The position.
    Position = 11,
    /// Reserved for faults that a later version adds.
    Other = 12,
    /// The phase of the cycle is outside 0 to 1, or it has jumped.
    Phase = 13,
}

/// Name of the rejected setting, or violated condition.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct bowden_about {
    /// NUL-terminated ASCII text, such as "k_p" or "low < high", truncated to 127 characters.
    pub text: [c_char; 128],
}

impl bowden_about {
    fn of(text: &str) -> Self {
        let mut own = [0; 128];
        let (_, places) = own.split_last_mut().unwrap_or((&mut 0, &mut []));
        for (to, from) in places.iter_mut().zip(text.bytes()) {
            // The sign of a char differs from target to target.
            *to = if from.is_ascii() {
                from as c_char
            } else {
                b'?' as c_char
            };
        }
        Self { text: own }
    }
}

/// Error of a function: its code, and the name of the rejected setting.
pub(crate) struct Refused {
    code: bowden_result,
    about: &'static str,
}

impl From<bowden_result> for Refused {
    fn from(code: bowden_result) -> Self {
        Self { code, about: "" }
    }
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        let code = match error {
            Error::NonFinite(_) => bowden_result::ErrorNonFinite,
            Error::OutOfRange(_) => bowden_result::ErrorOutOfRange,
            Error::Capacity(_) => bowden_result::ErrorCapacity,
            // Inadmissible, and what a later version may add.
            _ => bowden_result::ErrorInadmissible,
        };
        Self {
            code,
            about: error.parameter(),
        }
    }
}

impl Refused {
    /// The error for settings without the mark of their macro.
    pub(crate) fn unmarked(about: &'static str) -> Self {
        Self {
            code: bowden_result::ErrorSettings,
            about,
        }
    }

    /// The error for a setting that has no default and was not set.
    pub(crate) fn unset(about: &'static str) -> Self {
        Self {
            code: bowden_result::ErrorOutOfRange,
            about,
        }
    }

    pub(crate) fn choice(about: &'static str) -> Self {
        Self {
            code: bowden_result::ErrorChoice,
            about,
        }
    }

    /// The error for a model; `is_whole` means that its checksum is correct.
    pub(crate) fn model(is_whole: bool) -> Self {
        let about = if is_whole {
            "precision, version or number of terms"
        } else {
            "checksum"
        };
        Self {
            code: bowden_result::ErrorModel,
            about,
        }
    }

    pub(crate) fn capacity(about: &'static str) -> Self {
        Self {
            code: bowden_result::ErrorCapacity,
            about,
        }
    }
}

/// The result code of an attempt.
pub(crate) fn code(tried: Result<bowden_result, Refused>) -> bowden_result {
    tried.unwrap_or_else(|refused| refused.code)
}

/// The result code of an attempt. The function also writes the text of an error to `about`.
///
/// # Safety
/// `about` is null or points to memory of the size of its type.
pub(crate) unsafe fn told(tried: Result<(), Refused>, about: *mut bowden_about) -> bowden_result {
    let (code, text) = match tried {
        Ok(()) => (bowden_result::Ok, ""),
        Err(refused) => (refused.code, refused.about),
    };
    if !about.is_null() {
        // The attempt is over: a wrong alignment of the text must not turn its result into an error.
        // SAFETY: as of this function.
        unsafe { about.write_unaligned(bowden_about::of(text)) };
    }
    code
}

impl From<Fault> for bowden_fault {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Dt => Self::Dt,
            Fault::DtNotPositive => Self::DtNotPositive,
            Fault::DtTooLong => Self::DtTooLong,
            Fault::Reference => Self::Reference,
            Fault::Measured => Self::Measured,
            Fault::Velocity => Self::Velocity,
            Fault::FeedForward => Self::FeedForward,
            Fault::Command => Self::Command,
            Fault::Regressor(_) => Self::Regressor,
            Fault::Overflow => Self::Overflow,
            Fault::Phase => Self::Phase,
            Fault::Position => Self::Position,
            _ => Self::Other,
        }
    }
}

/// The result code of a controller step, the bad input, and the index of a bad regressor.
pub(crate) fn of_status(status: Status) -> (bowden_result, bowden_fault, u32) {
    let code = match status {
        Status::Good => bowden_result::Ok,
        Status::Degraded(_) => bowden_result::Degraded,
        Status::Held(_) => bowden_result::Held,
        Status::Safe(_) => bowden_result::Safe,
    };
    let Some(fault) = status.fault() else {
        return (code, bowden_fault::None, 0);
    };
    let regressor = match fault {
        Fault::Regressor(index) => u32::from(index),
        _ => 0,
    };
    (code, fault.into(), regressor)
}

/// The result code of a step of the velocity and acceleration estimates, and the bad input.
pub(crate) fn of_rates(status: RateStatus) -> (bowden_result, bowden_fault) {
    let code = match status {
        RateStatus::Good => bowden_result::Ok,
        RateStatus::Settling => bowden_result::Settling,
        RateStatus::Resumed => bowden_result::Resumed,
        RateStatus::Stopped => bowden_result::Stopped,
        RateStatus::Held(fault) => return (bowden_result::Held, fault.into()),
    };
    (code, bowden_fault::None)
}

/// Returns a description of a result for a log: static ASCII, never null.
#[no_mangle]
pub extern "C" fn bowden_result_text(result: i32) -> *const c_char {
    let text: &CStr = match result {
        0 => c"success",
        1 => c"a good sample, but the rates have not settled yet",
        2 => c"a good position after an unknown time: the rates are held",
        3 => c"a regressor was bad and its term is omitted; or an error was not learned",
        4 => c"a bad sample: the last good command or value is held",
        5 => c"too many bad samples: the safe command is applied until it is acknowledged",
        6 => c"no count for longer than the longest gap: the velocity is zero",
        7 => c"the sample is implausible: the value is NaN",
        -1 => c"a pointer is null",
        -2 => c"a pointer is misaligned",
        -3 => c"the object was not initialised, or was overwritten",
        -4 => c"a setting is NaN or infinite",
        -5 => c"a setting is out of range",
        -6 => c"two settings together violate a condition",
        -7 => c"more items than the capacity",
        -8 => c"a setting has a value that its enum does not have",
        -9 => c"the bytes of the model are damaged, too many, of the other precision or version, or have too many terms",
        -10 => c"the settings were not initialised with their macro NAME_INIT",
        _ => c"no result of this library",
    };
    text.as_ptr()
}

/// Returns a description of a bad input for a log: static ASCII, never null.
#[no_mangle]
pub extern "C" fn bowden_fault_text(fault: i32) -> *const c_char {
    let text: &CStr = match fault {
        0 => c"nothing",
        1 => c"dt is NaN or infinite",
        2 => c"dt is zero or negative",
        3 => c"dt is too long",
        4 => c"the reference is NaN or infinite",
        5 => c"the measured output is NaN or infinite",
        6 => c"the velocity is NaN or infinite",
        7 => c"the feed-forward is NaN or infinite",
        8 => c"the command to resume from is NaN or infinite",
        9 => c"a regressor, or an input of a term, is NaN, infinite or missing",
        10 => c"an overflow: the inputs are too large",
        11 => c"the position is NaN or infinite",
        13 => c"the phase is outside 0 to 1, or has jumped",
        _ => c"another fault",
    };
    text.as_ptr()
}

/// Returns the version of the library, such as "0.2.0": static, never null.
#[no_mangle]
pub extern "C" fn bowden_version() -> *const c_char {
    read_text(concat!(env!("CARGO_PKG_VERSION"), "\0")).as_ptr()
}
