//! The image of the transmission.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::cable::Forward);
