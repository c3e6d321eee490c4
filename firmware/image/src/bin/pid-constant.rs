//! The image of the PID; its settings are constants.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::PidConstant);
