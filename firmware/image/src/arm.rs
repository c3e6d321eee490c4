//! Clock and stack pointer of the Cortex-M board.

use core::arch::asm;
use core::ptr;

/// Timer 0 of the CMSDK, which counts down at 25 MHz of the emulator's time.
///
/// QEMU emulates no cycle counter of the core, and its SysTick has 24 bits only.
const TIMER: usize = 0x4000_0000;
const CONTROL: *mut u32 = TIMER as *mut u32;
const VALUE: *mut u32 = (TIMER + 4) as *mut u32;
const RELOAD: *mut u32 = (TIMER + 8) as *mut u32;

pub(crate) struct Clock;

impl Clock {
    pub(crate) fn start() -> Self {
        // SAFETY: the board has this timer there, and nobody else uses it.
        unsafe {
            ptr::write_volatile(RELOAD, u32::MAX);
            ptr::write_volatile(VALUE, u32::MAX);
            ptr::write_volatile(CONTROL, 1);
        }
        Self
    }

    #[inline(always)]
    pub(crate) fn now(&self) -> u32 {
        // SAFETY: as in `start`.
        unsafe { ptr::read_volatile(VALUE) }
    }

    /// Ticks since `begun`.
    #[inline(always)]
    pub(crate) fn since(&self, begun: u32) -> u32 {
        begun.wrapping_sub(self.now())
    }
}

/// `loops` turns of two instructions.
#[inline(never)]
pub(crate) fn spin(loops: u32) {
    // SAFETY: touches its own register and the flags only.
    unsafe {
        asm!(
            "2:",
            "subs {left}, {left}, #1",
            "bne 2b",
            left = inout(reg) loops => _,
            options(nomem, nostack),
        );
    }
}

#[inline(always)]
pub(crate) fn stack_pointer() -> usize {
    let pointer: usize;
    // SAFETY: reads a register.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack)) };
    pointer
}
