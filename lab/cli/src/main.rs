//! The program `bowden`.

use std::hint::black_box;
use std::process::ExitCode;

/// Size of a block that is allocated and freed at the start \[bytes\]: above the vectors of a
/// record of some ten thousand samples. With 31 MiB their search needs a quarter more memory.
const FREED: usize = 4 << 20;

fn main() -> ExitCode {
    // A search allocates and frees vectors at every evaluation. By default glibc returns them to
    // the kernel, which clears their pages anew: half of the processor time of the first command.
    // Once a larger block has been freed, smaller ones stay in the heap (mallopt(3), "dynamic
    // mmap threshold"). Other allocators are not affected.
    drop(black_box(Vec::<u8>::with_capacity(FREED)));
    match bowden_cli::run() {
        Ok(status) => status,
        Err(line) => {
            anstream::eprintln!("bowden: {line}");
            ExitCode::from(2)
        }
    }
}
