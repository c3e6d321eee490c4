//! The image of the disturbance observer with its numbers as a constant.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::observer::Constant);
