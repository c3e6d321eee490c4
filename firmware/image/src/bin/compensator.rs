//! The image of the model turned round.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::Compensated);
