//! The Bouc-Wen state: any shape, any input.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::hysteresis::check(data));
