//! The transmission turned round: any transmission, any output.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::inverse::check(data));
