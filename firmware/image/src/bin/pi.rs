//! The image of the PI.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::Pi);
