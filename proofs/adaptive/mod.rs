//! Proofs of the adaptive law: K1, K2, K4, K5, K9, K12 over its own states.

mod estimates;
mod samples;
mod state;
mod tracking;
