//! The image of the adaptive law over two regressors, lag form, clamp; its settings are constants.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LagClamp2Constant);
