//! The lab: closes the loop between a declared model and measured data.
//!
//! A record walks through the rooms in this order: [`record`] (read and check),
//! [`channels`] (uniform time, one zero-phase smoother for all columns and the output),
//! [`fit`] (variable projection), [`scan`] (which effect is missing?), [`closing`] (the
//! loop and its ledger), [`final_fit`], [`verdict`], [`report`], [`hand_over`] and [`export`]. Every column of the
//! regression is computed by the core crate, so that what is fitted here is what runs
//! in firmware. [`compare`] puts controllers on the core's simulated rig, [`power`] says
//! what a run could have missed, [`plan`] which experiment would tell what this record
//! cannot. [`synth`] makes test records and shares no code with any of these.

mod attempt;
pub mod by_file;
pub mod catalogue;
pub mod causal;
pub mod channels;
pub mod check;
pub mod cli;
pub mod clockwork;
pub mod closing;
pub mod columns;
pub mod compare;
mod duel;
mod excitation;
pub mod explains;
pub mod export;
pub mod filter;
pub mod final_fit;
pub mod fit;
mod gates;
pub mod hand_over;
pub mod intervals;
pub mod invertible;
mod joint;
pub mod plan;
pub mod power;
mod projection;
pub mod record;
pub mod report;
mod revisit;
pub mod scan;
pub mod search;
pub mod solution;
pub mod spectrum;
pub mod structure;
pub mod synth;
mod tones;
pub mod trace;
pub mod units;
pub mod unknown;
pub mod unneeded;
pub mod verdict;
mod whiteness;
