//! What a record could not show, and which record would: `power` and `plan`.

mod plan;
mod power;

use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::Record;
use bowden_lab::search::close;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

/// Closed with a Bouc-Wen transmission declared.
fn closed(record: &Record) -> (Prepared, Ledger) {
    let data = Prepared::new(record, Preparation::default()).unwrap();
    let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
    let ledger = close(&data, &declared, |_| ()).unwrap();
    (data, ledger)
}

/// White noise of that rms.
fn noise(rms: f64, seed: u64, samples: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let normal = Normal::new(0.0, rms).unwrap();
    (0..samples).map(|_| normal.sample(&mut rng)).collect()
}
