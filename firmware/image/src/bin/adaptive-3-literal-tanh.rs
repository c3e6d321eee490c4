//! The image of the adaptive law: 3 regressors, literal form, tanh.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LiteralTanh3);
