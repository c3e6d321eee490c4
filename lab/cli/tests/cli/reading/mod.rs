//! What a record may be written as: each form gives the same answer, or one line.

mod forms;
mod record;
mod refused;
