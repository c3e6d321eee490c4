//! What a residual says: blocks and their exact test, free curves, lines, whiteness, shares.

pub mod blocks;
pub mod dependences;
pub mod explains;
pub(crate) mod hats;
pub(crate) mod left_out;
pub(crate) mod tones;
pub(crate) mod whiteness;
