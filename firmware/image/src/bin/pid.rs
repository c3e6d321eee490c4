//! The image of the PID.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::pid::Pid);
