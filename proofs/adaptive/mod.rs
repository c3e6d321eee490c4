//! Proofs of the adaptive law over its own states: K1, K2, K4, K5, K9.

mod estimates;
mod samples;
mod state;
mod tracking;
