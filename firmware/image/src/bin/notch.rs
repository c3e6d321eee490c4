//! The image of the second-order notch.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::conditioning::Notch);
