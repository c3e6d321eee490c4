//! Controllers on the simulated rig: who tracks the paper's reference, and how well.
//!
//! [`lineup`] says who runs, [`trial`] runs one of them, [`table`] puts seeds together.
//! [`found`] closes the loop through the controller: an undeclared effect is switched on
//! in the rig, the lab's own path identifies it from the rig's bench record ([`mod@bench`]),
//! and what was found becomes a feed-forward ([`feed`]) or a regressor. [`mod@design`] goes
//! from an identified model to gains, which are a file of their own ([`gains`]).

pub mod bench;
pub mod certificates;
pub mod data_sheet;
mod decimal;
pub mod design;
pub mod facts;
pub mod feed;
pub mod found;
pub mod gains;
pub mod heading;
pub mod learned;
pub mod limited;
pub mod lineup;
mod observed;
pub mod own_rig;
pub mod proof;
pub mod setup;
mod setup_file;
pub mod table;
pub mod tolerance;
pub mod trial;
pub mod undeclared;
