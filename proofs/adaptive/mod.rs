//! Proofs of the adaptive law over its own states: K4, K5, K9.

mod estimates;
mod state;
