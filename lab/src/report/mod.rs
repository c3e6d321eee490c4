//! What a run is told as: JSON for programs, tables for people.

pub mod certificates;
mod check;
pub mod control;
mod cost;
mod curve;
mod hand_over;
mod json;
mod power;
mod rounds;
mod several;
mod terminal;
pub mod terms;
mod words;

pub use check::{check_json, check_text, sentence as check_sentence};
pub use cost::{Cost, Meter, Stage};
pub use json::{json, Report};
pub use power::{power_json, power_text};
pub use terminal::text;
