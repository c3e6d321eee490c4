//! The C interface of bowden: `include/bowden.h`, a static and a shared library.
//!
//! Nothing allocates. Every object is a struct that the caller owns, with room for what Rust
//! keeps in it between two magic words; every function gives a [`bowden_result`]. This package
//! alone has unsafe code: all of it stands in `object.rs` and behind its functions, which read,
//! check and write what a pointer leads to.
//!
//! What a C caller must keep to is written once, at the head of the header: a pointer is null
//! or leads to memory of its type, and no object is used from two threads at once.
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
mod choices;
mod compensator;
mod hysteresis;
mod learning;
mod model;
mod object;
mod observer;
mod parts;
mod pid;
mod play;
mod rates;
mod result;

pub use adaptive::*;
pub use choices::*;
pub use compensator::*;
pub use hysteresis::*;
pub use learning::*;
pub use model::*;
pub use observer::*;
pub use parts::*;
pub use pid::*;
pub use play::*;
pub use rates::*;
pub use result::*;

/// Nothing in the library panics; the linker wants a handler in any case.
#[cfg(all(target_os = "none", not(test)))]
#[panic_handler]
fn stop(_: &core::panic::PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
