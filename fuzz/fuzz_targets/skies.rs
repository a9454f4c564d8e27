#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| navwalker_fuzz::skies(bytes));
