//! Reads the columns of MATLAB's `.mat` files of versions 5 and 7.3.
//!
//! Version 5 has its own reader here. The crates `matfile` and `mat5` read neither structures nor
//! cells, and `matrw` panics on damaged files. The crate `hdf5-reader` reads version 7.3, which is
//! HDF5.

mod elements;
mod hdf5;

use super::error::RecordError;
use super::vectors::{vectors, Vector};

/// The columns of a file of version 5, each with a unique name.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Vector>, RecordError> {
    vectors(elements::variables(bytes))
}

/// The columns of a file of version 7.3, each with a unique name.
pub(super) fn read_hdf5(bytes: &[u8]) -> Result<Vec<Vector>, RecordError> {
    vectors(hdf5::variables(bytes))
}
