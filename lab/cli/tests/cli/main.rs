//! The program `bowden` from outside, and the texts and files that it writes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod certificates;
mod compare;
mod compiler;
mod cost;
mod design;
mod dictionary;
mod foresight;
mod hand_over;
mod json;
mod layout;
mod page;
mod pages;
mod program;
mod reading;
mod rows;
mod sentences;
mod several;
mod shell;
mod shell_pages;
mod tutorials;
mod unknown;
mod ways;
