//! Evaluation of a search: the final refit, intervals, the verdict, shares and traces.

mod ballast;
pub mod by_file;
mod changes;
pub mod curve;
mod errors;
mod excitation;
pub mod files_apart;
pub mod final_fit;
pub mod finding;
pub mod findings;
pub mod intervals;
mod lacks;
pub mod line;
pub(crate) mod logged;
pub mod mechanisms;
mod no_model;
pub mod numbers;
pub mod resolution;
pub mod rivals;
mod shares;
pub mod signals;
pub(crate) mod signs;
mod term_name;
pub mod trace;
pub mod unneeded;
pub mod verdict;
mod without;
mod words;

pub use shares::Shares;
