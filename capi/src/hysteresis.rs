//! The hysteresis state, the transmission and its inverse.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use crate::settings::{marked, Marked, UNSET};
use core_bowden::hysteresis::{BoucWen, BoucWenState};
use core_bowden::transmission::{Inverse, Transmission};

/// Torque or displacement mode, which determines the input and output quantities.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum bowden_mode {
    /// Torque to torque, equation (6): y = gain*u - kappa_eta*eta - offset.
    Torque = 0,
    /// Displacement to force, equation (1): y = gain*u + kappa_eta*eta + offset.
    Displacement = 1,
}

/// Size of bowden_hysteresis_f32 in 64-bit words.
pub const BOWDEN_HYSTERESIS_F32_WORDS: usize = 8;
/// Size of bowden_hysteresis_f64 in 64-bit words.
pub const BOWDEN_HYSTERESIS_F64_WORDS: usize = 14;
/// Size of bowden_cable_f32 in 64-bit words.
pub const BOWDEN_CABLE_F32_WORDS: usize = 10;
/// Size of bowden_cable_f64 in 64-bit words.
pub const BOWDEN_CABLE_F64_WORDS: usize = 20;
/// Size of bowden_inverse_f32 in 64-bit words.
pub const BOWDEN_INVERSE_F32_WORDS: usize = 10;
/// Size of bowden_inverse_f64 in 64-bit words.
pub const BOWDEN_INVERSE_F64_WORDS: usize = 20;

/// The result of a step with one input: good or held.
fn good(is_good: bool) -> bowden_result {
    if is_good {
        bowden_result::Ok
    } else {
        bowden_result::Held
    }
}

macro_rules! hysteresis {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Parameters of a transmission, equations (1), (2), (6) and (7).
            ///
            /// By default `offset` and `eta` are 0. You must set all other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_cable_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Mode of the transmission, one of bowden_mode.
                pub mode: u32,
                /// B of (6) or k_x of (1) [output unit/input unit].
                pub gain: $f,
                /// Hysteresis gain [output unit].
                pub kappa_eta: $f,
                /// T0 of (6) or the offset added to (1) [output unit]; 0 by default.
                pub offset: $f,
                /// rho [1/input unit], positive: initial slope of eta.
                pub rho: $f,
                /// sigma, at least 1/2. The slope after a reversal is 2*sigma*rho.
                pub sigma: $f,
                /// n, at least 1: sharpness of the knee.
                pub n: $f,
                /// Initial hysteresis state, from -1 to 1; 0 if unknown.
                pub eta: $f,
            }

            marked!([<bowden_cable_settings_ $f>]);

            impl [<bowden_cable_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        mode: UNSET,
                        gain: $f::MAX,
                        kappa_eta: $f::MAX,
                        offset: 0.0,
                        rho: 0.0,
                        sigma: 0.0,
                        n: 0.0,
                        eta: 0.0,
                    }
                }
            }

            impl [<bowden_cable_settings_ $f>] {
                fn parts(&self) -> Result<(Transmission<$f>, BoucWenState<$f>), Refused> {
                    for (value, name) in [(self.gain, "gain"), (self.kappa_eta, "kappa_eta")] {
                        if value == $f::MAX {
                            return Err(Refused::unset(name));
                        }
                    }
                    let shape = BoucWen::try_new(self.rho, self.sigma, self.n)?;
                    let build = match self.mode {
                        m if m == bowden_mode::Torque as u32 => Transmission::torque,
                        m if m == bowden_mode::Displacement as u32 => Transmission::displacement,
                        _ => return Err(Refused::choice("mode")),
                    };
                    let cable = build(self.gain, self.kappa_eta, self.offset, shape)?;
                    Ok((cable, BoucWenState::with_eta(self.eta)?))
                }
            }

            /// Settings of a hysteresis model, equations (2) and (7).
            ///
            /// By default `eta` is 0. You must set all other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_hysteresis_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// rho [1/input unit], positive: initial slope of eta.
                pub rho: $f,
                /// sigma, at least 1/2. The slope after a reversal is 2*sigma*rho.
                pub sigma: $f,
                /// n, at least 1: sharpness of the knee.
                pub n: $f,
                /// Initial hysteresis state, from -1 to 1; 0 if unknown.
                pub eta: $f,
            }

            marked!([<bowden_hysteresis_settings_ $f>]);

            impl [<bowden_hysteresis_settings_ $f>] {
                /// Returns the defaults.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        rho: 0.0,
                        sigma: 0.0,
                        n: 0.0,
                        eta: 0.0,
                    }
                }
            }

            /// Hysteresis model, equations (2) and (7), with its state.
            #[repr(C)]
            pub struct [<bowden_hysteresis_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_HYSTERESIS_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_hysteresis_ $f>] {
                type Inner = (BoucWen<$f>, BoucWenState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Transmission, equations (1) and (6), with its state.
            #[repr(C)]
            pub struct [<bowden_cable_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_CABLE_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_cable_ $f>] {
                type Inner = (Transmission<$f>, BoucWenState<$f>);
                const MAGIC: u64 = $magic + 1;
            }

            /// Inverse of a transmission, equations (1) and (6), with its state.
            #[repr(C)]
            pub struct [<bowden_inverse_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_INVERSE_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_inverse_ $f>] {
                type Inner = (Inverse<$f>, BoucWenState<$f>);
                const MAGIC: u64 = $magic + 2;
            }

            /// Checks the settings and initialises a hysteresis model. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_hysteresis_init_ $f>](
                hysteresis: *mut [<bowden_hysteresis_ $f>],
                settings: *const [<bowden_hysteresis_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    // SAFETY: the caller's rule of pointers.
                    let s = unsafe { read_settings(settings)? };
                    Ok((BoucWen::try_new(s.rho, s.sigma, s.n)?, BoucWenState::with_eta(s.eta)?))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(hysteresis, inner)?)), about) }
            }

            /// Processes one input sample [input unit]. `eta` receives the hysteresis state, from
            /// -1 to 1. The first sample only initialises the input. If the input is not finite,
            /// the last state is held (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_hysteresis_step_ $f>](
                hysteresis: *mut [<bowden_hysteresis_ $f>],
                input: $f,
                eta: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(eta)?;
                    let (shape, state) = kept(hysteresis)?;
                    let value = shape.step(state, input);
                    write(eta, value)?;
                    Ok(good(input.is_finite()))
                })())
            }

            /// Checks the parameters and initialises a transmission. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_cable_init_ $f>](
                cable: *mut [<bowden_cable_ $f>],
                settings: *const [<bowden_cable_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.parts())
                        .and_then(|parts| Ok(start(cable, parts)?));
                    told(tried, about)
                }
            }

            /// Processes one input sample [input unit]. `output` receives the output [output unit].
            /// If the input is not finite, the last output is held (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_cable_step_ $f>](
                cable: *mut [<bowden_cable_ $f>],
                input: $f,
                output: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(output)?;
                    let (transmission, state) = kept(cable)?;
                    let value = transmission.step(state, input);
                    write(output, value)?;
                    Ok(good(input.is_finite()))
                })())
            }

            /// Initialises the inverse of the transmission that has these parameters. `about` may
            /// be null.
            ///
            /// The transmission has no inverse (BOWDEN_RESULT_ERROR_INADMISSIBLE) if the gain is
            /// zero, or if the hysteresis opposes the gain and sigma exceeds
            /// |gain|/(2*|kappa_eta|*rho).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_inverse_init_ $f>](
                inverse: *mut [<bowden_inverse_ $f>],
                settings: *const [<bowden_cable_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let tried = read_settings(settings)
                        .and_then(|settings| settings.parts())
                        .and_then(|(cable, state)| {
                            Ok(start(inverse, (cable.inverse()?, state))?)
                        });
                    told(tried, about)
                }
            }

            /// Processes one desired output [output unit]. `input` receives the input [input unit]
            /// that produces this output. If the desired output is not finite, the last input is
            /// held (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_inverse_step_ $f>](
                inverse: *mut [<bowden_inverse_ $f>],
                desired: $f,
                input: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(input)?;
                    let (cable, state) = kept(inverse)?;
                    let value = cable.step(state, desired);
                    write(input, value)?;
                    Ok(good(desired.is_finite()))
                })())
            }
        }
    };
}
hysteresis!(f32, 0x6879_7374_6633_3210);
hysteresis!(f64, 0x6879_7374_6636_3410);
