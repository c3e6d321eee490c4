//! The image of the relay experiment.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::relay::Relay);
