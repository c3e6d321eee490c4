//! The image of a model with two effects, its numbers in the source.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::TwoConstant);
