//! The image of a model with a curve through eight points, its numbers in the source.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::model::CurveConstant);
