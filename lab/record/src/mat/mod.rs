//! MATLAB's `.mat` files of versions 5 and 7.3: bytes in, columns out.
//!
//! The reader of version 5 is our own: of the crates, `matfile` and `mat5` read neither structures
//! nor cells, and `matrw` panics on damaged files. Version 7.3 is HDF5, which the crate
//! `hdf5-reader` reads; `docs/reference/records.md` compares other crates.

mod elements;
mod hdf5;

use super::error::RecordError;
use super::vectors::{vectors, Vector};

/// The columns of a file of version 5, each with a unique name.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Vector>, RecordError> {
    vectors(elements::variables(bytes))
}

/// The same of a file of version 7.3.
pub(super) fn read_hdf5(bytes: &[u8]) -> Result<Vec<Vector>, RecordError> {
    vectors(hdf5::variables(bytes))
}
