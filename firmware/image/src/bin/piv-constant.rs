//! The image of the PIV; its settings are constants.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::PivConstant);
