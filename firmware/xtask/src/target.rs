//! The targets, and the machine that runs each of them.

use std::process::Command;

/// A target and the emulator for it.
pub struct Target {
    /// As rustc calls it.
    pub triple: &'static str,
    /// The program that emulates it.
    pub emulator: &'static str,
    /// The board.
    pub machine: &'static [&'static str],
    /// Ticks of the board's clock in which one instruction passes, as a fraction; of another
    /// release of the emulator, likewise.
    pub ticks: &'static [(u64, u64)],
}

/// 2^7 ns of the emulator's time pass with each instruction. The Cortex-M board's timer
/// has ticks of 40 ns: an instruction is 3.2 of them, so that a count of ticks, which may
/// be one off at either end, tells the count of instructions exactly.
pub const SHIFT: &str = "shift=7";

/// A Cortex-M4F, with the image for a Cortex-M0+ (the same board: ARMv6-M is a part of
/// ARMv7E-M), and a RISC-V core without a float unit, as the ESP32-C3 has it.
pub const TARGETS: [Target; 3] = [
    Target {
        triple: "thumbv7em-none-eabihf",
        emulator: "qemu-system-arm",
        machine: &["-M", "mps2-an386", "-cpu", "cortex-m4"],
        ticks: &[(16, 5)],
    },
    Target {
        triple: "thumbv6m-none-eabi",
        emulator: "qemu-system-arm",
        machine: &["-M", "mps2-an386", "-cpu", "cortex-m4"],
        ticks: &[(16, 5)],
    },
    Target {
        triple: "riscv32imc-unknown-none-elf",
        emulator: "qemu-system-riscv32",
        machine: &["-M", "virt", "-bios", "none"],
        // QEMU 7 counts the nanoseconds of SHIFT in the counter of instructions.
        ticks: &[(1, 1), (1 << 7, 1)],
    },
];

impl Target {
    /// Whether the compiler has a core library for it.
    pub fn is_installed(&self) -> bool {
        let folder = Command::new("rustc")
            .args(["--print", "target-libdir", "--target", self.triple])
            .output();
        let Ok(folder) = folder else { return false };
        let folder = String::from_utf8_lossy(&folder.stdout).trim().to_owned();
        std::fs::read_dir(folder).is_ok_and(|mut files| {
            files.any(|file| {
                file.is_ok_and(|file| file.file_name().to_string_lossy().starts_with("libcore-"))
            })
        })
    }

    /// Whether its emulator can be run.
    pub fn has_emulator(&self) -> bool {
        let version = Command::new(self.emulator).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    }
}
