//! The image of the PI on the simulated rig.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::closed_loop::ClosedLoop);
