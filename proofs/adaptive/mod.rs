//! Proofs of the adaptive law over its own states: K1, K4, K5, K9.

mod estimates;
mod samples;
mod state;
