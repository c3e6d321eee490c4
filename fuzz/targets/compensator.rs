//! The compensator: any model, any samples.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::compensator::check(data));
