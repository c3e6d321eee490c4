//! Tests of a residual: blocks with their exact test, free curves, tones, whiteness, shares.

pub mod autocorrelation;
pub mod binned;
pub mod blocks;
pub mod density;
pub mod dependences;
pub mod explains;
pub(crate) mod hats;
pub(crate) mod left_out;
pub mod ranges;
pub(crate) mod tones;
pub(crate) mod whiteness;
