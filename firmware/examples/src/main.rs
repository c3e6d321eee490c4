//! A torque loop as an RTIC task: one tick a millisecond, a watchdog, a log.
//!
//! The task's body is what a drive's firmware has: read the sensors, tick, drive, feed the
//! watchdog, log what is new. Here the sensors and the drive are those of a simulated
//! joint, and after ten seconds the emulation ends. `cargo xtask --torque-loop` builds it,
//! runs it in QEMU and compares its log with the host's.
#![no_std]
#![no_main]

mod board;

use core::panic::PanicInfo;
// The vector table and the log.
use cortex_m_rt as _;
use defmt_semihosting as _;

/// Nothing here panics; a firmware would switch the drive off and wait for the watchdog.
#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    semihosting::process::exit(3)
}

/// The tasks.
#[rtic::app(device = crate::board, peripherals = false)]
mod app {
    use super::board::{Watchdog, CLOCK};
    use bowden_firmware_examples::scenario::{Scenario, RATE};
    use bowden_firmware_examples::MODEL;
    use cortex_m::peripheral::syst::SystClkSource;
    use semihosting::process::exit;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        scenario: Scenario,
        watchdog: Watchdog,
    }

    #[init]
    fn init(start: init::Context) -> (Shared, Local) {
        let scenario = match Scenario::try_new(MODEL) {
            Ok(scenario) => scenario,
            Err(error) => {
                // The drive has never been on.
                defmt::error!("{}", error);
                exit(2)
            }
        };
        let mut timer = start.core.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(CLOCK / RATE - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
        let local = Local {
            scenario,
            // Twice 10 ms without a tick: start again, with the drive off.
            watchdog: Watchdog::start(CLOCK / 100),
        };
        (Shared {}, local)
    }

    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }

    #[task(binds = SysTick, local = [scenario, watchdog])]
    fn tick(task: tick::Context) {
        let Some(told) = task.local.scenario.tick() else {
            exit(0)
        };
        if told.action.feed {
            task.local.watchdog.feed();
        }
        if let Some(line) = told.line {
            if told.action.enabled {
                defmt::info!("{}", line);
            } else {
                defmt::warn!("{}", line);
            }
        }
    }
}
