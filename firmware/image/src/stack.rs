//! How deep a step goes into the stack: paint it before, look what is left after.

use core::ptr;

const PAINT: u32 = 0x5a5a_c3c3;
const WORD: usize = size_of::<u32>();

/// Paints the `depth` bytes below `base`.
#[inline(always)]
pub(crate) fn paint(base: usize, depth: usize) {
    for place in 1..=depth / WORD {
        // SAFETY: below the stack pointer of `measure`, which calls this inlined, nothing
        // lives; the boards have megabytes of RAM there, and no interrupt is enabled.
        unsafe { ptr::write_volatile((base - place * WORD) as *mut u32, PAINT) };
    }
}

/// The bytes between `base` and the deepest word that is no longer paint.
#[inline(always)]
pub(crate) fn used(base: usize, depth: usize) -> u32 {
    let mut words = depth / WORD;
    // SAFETY: as in `paint`; every word was written there.
    while words > 0 && unsafe { ptr::read_volatile((base - words * WORD) as *const u32) } == PAINT {
        words -= 1;
    }
    (words * WORD) as u32
}
