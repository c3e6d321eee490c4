//! The image of the velocity between counts.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::conditioning::Slow);
