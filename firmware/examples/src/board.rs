//! What the task needs of the board: Arm's MPS2 with the FPGA image AN386.
//!
//! On a chip of your own the crate of its registers takes the place of this file.

use core::ptr;

/// Bits of an interrupt's priority; RTIC reads it.
pub const NVIC_PRIO_BITS: u8 = 3;
/// Clock of the core and its timer \[Hz\].
pub const CLOCK: u32 = 25_000_000;

const WATCHDOG: usize = 0x4000_8000;
const LOAD: *mut u32 = WATCHDOG as *mut u32;
const CONTROL: *mut u32 = (WATCHDOG + 0x08) as *mut u32;
const CLEAR: *mut u32 = (WATCHDOG + 0x0c) as *mut u32;
const LOCK: *mut u32 = (WATCHDOG + 0xc00) as *mut u32;
const UNLOCKED: u32 = 0x1acc_e551;
const INTERRUPT_AND_RESET: u32 = 3;

/// Restarts the chip where it is not fed: the second time that it has counted to zero.
pub struct Watchdog;

impl Watchdog {
    /// Starts it with half of the time after which it restarts the chip \[ticks\].
    pub fn start(half: u32) -> Self {
        // SAFETY: the board has these registers there, and nobody else uses them.
        unsafe {
            ptr::write_volatile(LOCK, UNLOCKED);
            ptr::write_volatile(LOAD, half);
            ptr::write_volatile(CONTROL, INTERRUPT_AND_RESET);
        }
        Self
    }

    /// Counts from the start again.
    pub fn feed(&mut self) {
        // SAFETY: as in `start`.
        unsafe { ptr::write_volatile(CLEAR, 1) };
    }
}
