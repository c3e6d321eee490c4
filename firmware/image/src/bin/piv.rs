//! The image of the PIV.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::Piv);
