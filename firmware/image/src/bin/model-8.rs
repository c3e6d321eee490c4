//! The image of a model with eight effects.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::EightEffects);
