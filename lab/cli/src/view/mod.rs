//! Reports of a run, as JSON and as text.

mod braille;
pub mod certificates;
mod check;
pub mod compare;
mod compare_found;
mod compare_rows;
mod cost;
mod curve;
pub mod design;
mod hand_over;
mod json;
mod layout;
mod plan;
mod power;
pub mod proof;
mod several;
mod terminal;
pub mod terms;
mod words;

pub use braille::loop_text;
pub use check::{check_json, check_text};
pub use cost::cost_line;
pub use json::json;
pub use layout::{Report, Width};
pub use plan::plan_text;
pub use power::{power_json, power_text};
pub use terminal::text;
pub use words::terminal_width;
