//! The image of the Bouc-Wen step.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::cable::Hysteresis);
