//! Controllers on the simulated rig, and how well each tracks the paper's reference.
//!
//! [`lineup`] lists the controllers, [`trial`] runs one of them, and [`table`] combines the seeds.
//! [`found`] adds an undeclared effect to the rig, identifies it from the rig's bench record
//! ([`mod@bench`]), and uses the found terms as a feed-forward ([`feed`]) or as a regressor.
//! [`mod@design`] derives gains from an identified model; [`gains`] is their file.

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
mod question;
pub mod setup;
mod setup_file;
pub mod table;
pub mod tolerance;
pub mod trial;
pub mod undeclared;
