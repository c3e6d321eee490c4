//! The TOML forms: any text.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::forms::check(data));
