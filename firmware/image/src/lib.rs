//! Measures one step on an emulated chip: instructions, stack, outputs.
//!
//! An image holds the runtime, this loop, the tables of samples and one step; what it has
//! more than the image of the empty step is the step with all that it pulls in. Therefore
//! nothing here formats, panics or computes with floats: a step that does brings its own.
//!
//! What an image prints is read by `xtask`:
//!
//! ```text
//! clock LOOPS TICKS            the time of LOOPS turns of a loop of two instructions
//! run SIGNAL
//! VALUE STATUS TICKS STACK     one line a sample; all numbers hexadecimal
//! end
//! ```
#![no_std]

#[cfg(target_arch = "arm")]
#[path = "arm.rs"]
mod chip;
#[cfg(target_arch = "riscv32")]
#[path = "riscv32.rs"]
mod chip;
mod console;
mod stack;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

use bowden_cases::{Case, Output, Sample, Signal};
use console::Line;
use core::hint::black_box;
use core::panic::PanicInfo;
use semihosting::process::exit;

/// The program of one image.
#[macro_export]
macro_rules! image {
    ($case:ty) => {
        /// Measures the step.
        #[$crate::entry]
        fn main() -> ! {
            $crate::measure::<$case>()
        }
    };
}

/// Exit status where the case was refused by its constructor.
const REFUSED: i32 = 2;
/// Exit status where the step goes deeper into the stack than is watched.
const TOO_DEEP: i32 = 4;
/// Exit status of a panic.
const PANICKED: i32 = 3;

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    exit(PANICKED)
}

/// Runs the case on each signal, prints the measurements and ends the emulation.
pub fn measure<C: Case>() -> ! {
    let clock = chip::Clock::start();
    for loops in [1000, 3000] {
        let begun = clock.now();
        chip::spin(loops);
        let ticks = clock.since(begun);
        Line::new().text("clock ").hex(loops).hex(ticks).print();
    }
    for signal in Signal::ALL {
        Line::new().text("run ").text(signal.name()).print();
        let Ok(mut case) = C::try_new() else {
            exit(REFUSED)
        };
        let base = chip::stack_pointer();
        for sample in signal.samples().iter().take(C::SAMPLES) {
            let mut output = Output::default();
            stack::paint(base, C::STACK);
            let begun = clock.now();
            step(&mut case, sample, &mut output);
            let ticks = clock.since(begun);
            let used = stack::used(base, C::STACK);
            if used as usize == C::STACK {
                exit(TOO_DEEP)
            }
            Line::new()
                .hex(output.value.to_bits())
                .hex(output.status)
                .hex(ticks)
                .hex(used)
                .print();
        }
    }
    Line::new().text("end").print();
    exit(0)
}

/// The step between two looks at the clock; never inlined, so that nothing moves across.
#[inline(never)]
fn step<C: Case>(case: &mut C, sample: &Sample, output: &mut Output) {
    *black_box(output) = case.step(black_box(sample));
}
