//! The adaptive law: any gains, any samples.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::adaptive::check(data));
