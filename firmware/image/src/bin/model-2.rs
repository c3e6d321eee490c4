//! The image of a model with two effects.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::TwoEffects);
