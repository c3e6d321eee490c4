//! The native half of the Python package `bowden`. The other half, which documents the public
//! interface, is the folder `package/bowden`.
//!
//! This crate fits and computes nothing: records go to [`bowden_lab::facts`], JSON comes from
//! [`bowden_cli::view`] and pages from [`bowden_page`], so that Python and the program give the
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
