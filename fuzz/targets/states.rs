//! States that were stored: any bytes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::states::check(data));
