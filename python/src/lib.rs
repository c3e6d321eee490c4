//! The native module of the Python package `bowden`. The folder `package/bowden` documents the
//! public interface.
//!
//! This crate fits and computes nothing. Records go to [`bowden_lab::facts`], JSON comes from
//! [`bowden_cli::view`] and pages from [`bowden_page`]. Python and the program therefore give the
//! same bytes.

mod beside;
mod check;
mod close;
mod code;
mod control;
mod failure;
mod lanes;
mod law;
mod model;
mod record;
mod relay;
mod rig;
mod run;
mod signal;

use pyo3::prelude::*;

#[pymodule]
mod _bowden {
    #[pymodule_export]
    use super::beside::{check_beside, nominal_feed_forward};
    #[pymodule_export]
    use super::check::{check, Checked};
    #[pymodule_export]
    use super::close::{close, Closed};
    #[pymodule_export]
    use super::control::Controllers;
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::record::{agree, record_of_columns, record_of_file, Record};
    #[pymodule_export]
    use super::relay::pi_gains;
    #[pymodule_export]
    use super::rig::{paper_reference, Rigs};
    #[pymodule_export]
    use super::signal::Blocks;
}
