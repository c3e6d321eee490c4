//! What a residual says: candidates scored on blocks, free curves, whiteness, shares.

pub mod explains;
pub(crate) mod hats;
pub mod scan;
pub(crate) mod whiteness;
