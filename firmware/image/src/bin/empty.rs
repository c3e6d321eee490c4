//! The image of no step at all.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::Empty);
