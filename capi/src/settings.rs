//! The mark at the start of each settings struct, which its macro in the header sets.
//!
//! C sets each field that a designated initialiser does not name to zero, which for some settings
//! is valid but not the default. A struct without the mark is therefore refused, and the macro
//! gives each setting without a default an invalid value.

use crate::result::Refused;

/// The value of a choice or a count that must be set: no enum and no count uses it.
pub(crate) const UNSET: u32 = 0xffff_ffff;

/// CRC-32 of the struct's name, different for every type.
pub(crate) const fn mark(name: &str) -> u32 {
    crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(name.as_bytes())
}

/// A settings struct that starts from its macro.
///
/// # Safety
/// `Self` is `repr(C)`, its first field is a `u32`, and its other fields are numbers.
pub(crate) unsafe trait Marked: Copy {
    /// The first field of a struct that started from its macro.
    const MARK: u32;
    /// The text of the refusal of a struct that did not.
    const UNMARKED: &'static str;

    /// The refusal, unless this first field is the mark.
    fn is_marked(first: u32) -> Result<(), Refused> {
        if first == Self::MARK {
            return Ok(());
        }
        Err(Refused::unmarked(Self::UNMARKED))
    }
}

/// Declares that a struct starts from its macro.
macro_rules! marked {
    ($settings:ident) => {
        pastey::paste! {
            const _: () = assert!(core::mem::offset_of!($settings, init_mark) == 0);

            // SAFETY: `repr(C)` of numbers, the mark first.
            unsafe impl crate::settings::Marked for $settings {
                const MARK: u32 = crate::settings::mark(stringify!($settings));
                const UNMARKED: &'static str = concat!(
                    "settings not started from ",
                    stringify!([<$settings:upper _INIT>]),
                    ": assign it first, then set the fields",
                );
            }
        }
    };
}
pub(crate) use marked;
