//! Clock and stack pointer of the RISC-V board.

use core::arch::asm;

/// The counter of retired instructions: in QEMU the emulator's time.
pub(crate) struct Clock;

impl Clock {
    pub(crate) fn start() -> Self {
        Self
    }

    #[inline(always)]
    pub(crate) fn now(&self) -> u32 {
        let count: u32;
        // SAFETY: reads a counter. Not `nomem`: memory must not be moved across it.
        unsafe { asm!("csrr {}, minstret", out(reg) count, options(nostack)) };
        count
    }

    /// Ticks since `begun`.
    #[inline(always)]
    pub(crate) fn since(&self, begun: u32) -> u32 {
        self.now().wrapping_sub(begun)
    }
}

/// `loops` turns of two instructions.
#[inline(never)]
pub(crate) fn spin(loops: u32) {
    // SAFETY: touches its own register only.
    unsafe {
        asm!(
            "2:",
            "addi {left}, {left}, -1",
            "bnez {left}, 2b",
            left = inout(reg) loops => _,
            options(nomem, nostack),
        );
    }
}

#[inline(always)]
pub(crate) fn stack_pointer() -> usize {
    let pointer: usize;
    // SAFETY: reads a register.
    unsafe { asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack)) };
    pointer
}
