//! The image of the disturbance observer.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::observer::Loaded);
