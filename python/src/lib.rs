//! The native half of the Python package `bowden`: what is written in Python stands in the
//! folder `bowden` beside this one, and what a user sees is documented there.
//!
//! Nothing is fitted or computed here: records go to [`bowden_lab::facts`], JSON comes from
//! [`bowden_cli::view`] and pages from [`bowden_page`], so that Python and the program give the
//! same bytes.

mod beside;
mod check;
mod close;
mod control;
mod failure;
mod model;
mod record;
mod rig;
mod run;

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
    use super::rig::{paper_reference, Rigs};
}
