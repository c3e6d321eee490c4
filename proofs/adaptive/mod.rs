//! Proofs of the adaptive law over its own states: K1, K2, K4, K5, K9, K10, K12.

mod estimates;
mod hand_over;
mod samples;
mod state;
mod tracking;
