//! `bowden certify FILE`: what it prints and writes, and what checkers of other people say of it.

mod checked;
mod forms;
