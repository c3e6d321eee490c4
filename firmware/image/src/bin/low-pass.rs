//! The image of the first-order low-pass.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::conditioning::Smooth);
