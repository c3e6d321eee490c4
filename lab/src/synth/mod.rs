//! An independent generator of test records.
