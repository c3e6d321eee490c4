//! The model: any effects, any samples.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::model::check(data));
