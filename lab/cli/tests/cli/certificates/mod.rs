//! `bowden certify GAINS.toml`: what is proved of one's own gains, and who checks it.

mod checked;
mod foreign;
mod forms;
