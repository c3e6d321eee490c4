//! The linear algebra of the lab: each operation in one place, with its tolerance as a parameter.
//!
//! | question | answer |
//! |---|---|
//! | What of a column lies outside a set of columns, and the gains of the set | [`Span`], [`take_off`] |
//! | The least-norm solution of a system of any rank | [`least_norm`] |
//! | The inverse of a positive definite matrix, and a root of that | [`inverse`], [`whitening`] |
//! | The directions in which a positive semi-definite matrix has a size | [`directions`] |
//! | The line through points | [`line`] |
//! | A column of one file among several | [`Stretch`] |
//! | Sums and differences of columns | [`add`], [`subtract`], [`subtract_products`] |
//!
//! The sweep of Gram matrices, which grow by columns from round to round, is
//! [`Grams`](crate::search::gram::Grams).

mod lanes;
mod solve;
mod span;
mod stretch;

pub(crate) use lanes::{add, coefficients, dot, subtract, subtract_products};
pub(crate) use solve::{directions, inverse, least_norm, line, whitening};
pub(crate) use span::{imitated, take_off, Span};
pub use stretch::Stretch;
