//! The image of iterative learning with its numbers as a constant.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::learning::Constant);
