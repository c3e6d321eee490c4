//! The rig: closed forms, published figures, noise, determinism.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod anti_windup;
mod figures;
mod mechanics;
mod random;
mod robust;
