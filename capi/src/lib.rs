//! C interface of bowden: the header `include/bowden.h`, a static library and a shared library.
//!
//! Nothing allocates memory. Every object is a struct that the caller owns. It contains Rust data
//! between two magic words. The unsafe code reads, checks and writes memory through the functions
//! of `object.rs`.
//!
//! The comment at the top of the header states the rules for C callers.
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

/// Required by the linker. No function of the library panics.
#[cfg(all(target_os = "none", not(test)))]
#[panic_handler]
fn stop(_: &core::panic::PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
