//! Constructors: any arguments, at run time and as a constant.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bowden_fuzz::constructors::check(data));
