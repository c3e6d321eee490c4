//! The image of the inverse of the transmission.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::cable::Inverse);
