//! What is fitted: terms, their parameters and their columns.

pub mod catalogue;
pub mod columns;
pub mod declared;
pub(crate) mod effects;
pub(crate) mod kind;
pub mod mechanism;
mod parameter;
mod range;
pub mod structure;
mod table;
mod term;
mod terms;
pub mod units;
mod variable;

pub use table::Table;
pub(crate) use variable::turns;
pub use variable::Variable;
