//! The C interface of bowden: `include/bowden.h`, a static and a shared library.
//!
//! Nothing allocates. Every object is a struct that the caller owns: Rust's data between two magic
//! words. Every function returns a [`bowden_result`]. All unsafe code of this package is in
//! `object.rs` and behind its functions, which read, check and write the memory behind a pointer.
//!
//! The head of the header states the rules for a C caller: a pointer is null or points to memory of
//! its type, and no object is used from two threads at once.
// On bare metal no_std; elsewhere the static library needs std for its panic handler alone.
#![cfg_attr(target_os = "none", no_std)]
#![allow(non_camel_case_types)]
// The documentation is the header's: brackets hold units.
#![allow(rustdoc::broken_intra_doc_links)]
// The header states them once for all functions.
#![allow(clippy::missing_safety_doc)]

#[cfg(target_os = "none")]
extern crate core;

mod adaptive;
mod adaptive_settings;
mod choices;
mod compensator;
mod edges;
mod filters;
mod hysteresis;
mod learning;
mod model;
mod object;
mod observer;
mod parts;
mod pid;
mod pid_settings;
mod plausible;
mod play;
mod rates;
mod relay;
mod result;
mod settings;

pub use adaptive::*;
pub use adaptive_settings::*;
pub use choices::*;
pub use compensator::*;
pub use edges::*;
pub use filters::*;
pub use hysteresis::*;
pub use learning::*;
pub use model::*;
pub use observer::*;
pub use parts::*;
pub use pid::*;
pub use pid_settings::*;
pub use plausible::*;
pub use play::*;
pub use rates::*;
pub use relay::*;
pub use result::*;

/// Nothing in the library panics, but the linker needs a handler.
#[cfg(all(target_os = "none", not(test)))]
#[panic_handler]
fn stop(_: &core::panic::PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
