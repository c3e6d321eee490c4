//! New ways in and out from outside: limited rounds, traces, models on the next record.

mod program;
mod refused;
