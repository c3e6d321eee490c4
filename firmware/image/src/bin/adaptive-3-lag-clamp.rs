//! The image of the adaptive law: 3 regressors, lag form, clamp.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LagClamp3);
