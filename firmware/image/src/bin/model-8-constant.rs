//! The image of a model with eight effects, its numbers in the source.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::EightConstant);
