//! The mark at the start of each settings struct.
//!
//! In C, a designated initialiser sets the fields that it does not name to zero. For some settings
//! zero is valid but not the default. A struct without the mark of its macro is therefore rejected.
//! The macro gives each setting without a default an invalid value.

use crate::result::Refused;

/// The value of a choice or a count that must be set. No enum and no valid count has this value.
pub(crate) const UNSET: u32 = 0xffff_ffff;

/// CRC-32 of the name of the struct, different for every type.
pub(crate) const fn mark(name: &str) -> u32 {
    crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(name.as_bytes())
}

/// A settings struct that its macro initialises.
///
/// # Safety
/// `Self` is `repr(C)`, its first field is a `u32`, and its other fields are numbers.
pub(crate) unsafe trait Marked: Copy {
    /// The first field of an initialised struct.
    const MARK: u32;
    /// The error text for a struct without the mark.
    const UNMARKED: &'static str;

    /// Returns an error unless `first` is the mark.
    fn is_marked(first: u32) -> Result<(), Refused> {
        if first == Self::MARK {
            return Ok(());
        }
        Err(Refused::unmarked(Self::UNMARKED))
    }
}

/// Implements [`Marked`] for a settings struct.
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
