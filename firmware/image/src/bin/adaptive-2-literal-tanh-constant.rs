//! The image of the adaptive law over two regressors, literal form, tanh; its settings are constants.
#![no_std]
#![no_main]

bowden_image::image!(bowden_cases::adaptive::LiteralTanh2Constant);
