//! The lab: finds what a baseline model lacks, from measured data.
//!
//! A record passes through the modules in this order, and a module uses only those before it:
//!
//! | room | what happens there |
//! |---|---|
//! | [`scale`] | the marks that all rooms share: what is a trace, a part, a half, noise |
//! | `algebra` | the linear algebra of all others: spans, systems, directions |
//! | [`record`] | reading and checking of a file, and its defects: the crate `bowden-record` |
//! | [`alteration`] | how a record may have been logged differently |
//! | [`problem`] | uniform time, one zero-phase smoother for all columns and the output, the split |
//! | [`model`] | effects that may be missing, terms and their parameters, their columns |
//! | [`fit`] | variable projection: gains by QR, shapes by Levenberg-Marquardt |
//! | [`score`] | tests of a residual: blocks and their exact test, free curves, lines, whiteness |
//! | [`ledger`] | the results table: rounds, rejections, unmodelled dependences |
//! | [`search`] | which effects are missing: the search that fills the results table |
//! | [`conclude`] | final refit, intervals, verdict, shares, traces |
//! | [`foresight`] | what the record would have missed, and which motion to record next |
//! | [`export`] | the exported model for firmware |
//! | [`check`] | whether a model still holds on another record |
//! | [`facts`] | the answer to each question of the program, as plain data |
//!
//! Every column of the regression is computed by the core crate, so the fitted functions are those
//! that run in firmware. The package `bowden-synth` makes test records and shares no code with any
//! of these.

pub(crate) mod algebra;
pub mod alteration;
pub mod check;
pub mod conclude;
pub mod export;
pub mod facts;
pub mod fit;
pub mod foresight;
pub mod ledger;
pub mod model;
pub mod problem;
pub mod scale;
pub mod score;
pub mod search;

pub use bowden_record as record;
