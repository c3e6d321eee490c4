//! The image of the adaptive law: 2 regressors, literal form, clamp.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LiteralClamp2);
