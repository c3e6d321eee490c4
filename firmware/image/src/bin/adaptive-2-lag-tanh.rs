//! The image of the adaptive law: 2 regressors, lag form, tanh.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LagTanh2);
