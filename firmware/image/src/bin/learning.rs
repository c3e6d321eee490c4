//! The image of iterative learning.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::learning::Loaded);
