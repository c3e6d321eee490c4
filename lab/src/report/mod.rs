//! What a run is told as: JSON for programs, tables for people.

mod json;
mod terminal;

pub use json::{json, Report};
pub use terminal::text;
