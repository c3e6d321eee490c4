//! What a run is told as: JSON for programs, tables for people.

pub mod certificates;
pub mod control;
mod json;
mod terminal;

pub use json::{json, Report};
pub use terminal::text;
