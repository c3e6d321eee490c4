//! The program `bowden`.

use std::hint::black_box;
use std::process::ExitCode;

/// Size of a block that is allocated and freed at the start \[bytes\]: just below the largest
/// that glibc draws a conclusion from (32 MiB).
const FREED: usize = 31 << 20;

fn main() -> ExitCode {
    // A search allocates and frees vectors of a megabyte at every evaluation. By default glibc
    // maps and unmaps each of them, and the kernel clears its pages anew: half of the processor
    // time of the first command. Once a larger block has been freed, smaller ones stay in the
    // heap (mallopt(3), "dynamic mmap threshold"). Other allocators are not affected.
    drop(black_box(Vec::<u8>::with_capacity(FREED)));
    match bowden_cli::run() {
        Ok(status) => status,
        Err(line) => {
            anstream::eprintln!("bowden: {line}");
            ExitCode::from(2)
        }
    }
}
