//! The image of a model with eight effects that was loaded.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::EightLoaded);
