//! What a run is told as: JSON for programs, tables for people.

pub mod certificates;
pub mod control;
mod curve;
mod hand_over;
mod json;
mod power;
mod several;
mod terminal;

pub use json::{json, Report};
pub use power::{power_json, power_text};
pub use terminal::text;
