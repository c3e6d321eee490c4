//! The lab.
pub mod catalogue;
pub mod channels;
pub mod closing;
pub mod columns;
pub mod filter;
pub mod fit;
pub mod intervals;
pub mod record;
pub mod scan;
pub mod spectrum;
pub mod structure;
pub mod synth;
pub mod units;

/// Family of an effect by its own name; empty where there is none.
#[must_use]
pub fn synth_family(name: &str) -> &'static str {
    bowden::effect::CATALOGUE
        .iter()
        .find(|i| i.name == name)
        .map_or("", |i| i.family.name())
}
