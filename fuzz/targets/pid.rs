//! PID, PI and PIV: any settings, any samples.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::pid::check(data));
