//! The image of the PI; its settings are constants.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::PiConstant);
