//! Velocity of a slow encoder, from the time between its counts.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_rates, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{EdgeVelocity, EdgeVelocityState};

/// Size of a bowden_edge_velocity_f32 in 64-bit words.
pub const BOWDEN_EDGE_VELOCITY_F32_WORDS: usize = 8;
/// Size of a bowden_edge_velocity_f64 in 64-bit words.
pub const BOWDEN_EDGE_VELOCITY_F64_WORDS: usize = 13;

macro_rules! edges {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// A velocity from counts with its state; initialised by bowden_edge_velocity_init.
            #[repr(C)]
            pub struct [<bowden_edge_velocity_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_EDGE_VELOCITY_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_edge_velocity_ $f>] {
                type Inner = (EdgeVelocity<$f>, EdgeVelocityState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of a velocity from the time between counts, see bowden_edge_velocity_step.
            ///
            /// Start from NAME_INIT. By default the position does not wrap; all other fields must be
            /// set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_edge_velocity_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Size of one count, above zero [channel unit]: positions change by multiples of
                /// it.
                pub count: $f,
                /// Time over which counts that come faster are averaged; above zero [s].
                pub time_constant: $f,
                /// Time without a count after which the velocity is zero; above zero [s]. A speed
                /// below count/longest_gap reads as zero.
                pub longest_gap: $f,
                /// Period of a position that wraps, such as a counter's, above zero [channel unit];
                /// 0 for none.
                pub period: $f,
            }

            marked!([<bowden_edge_velocity_settings_ $f>]);

            impl [<bowden_edge_velocity_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        count: 0.0,
                        time_constant: 0.0,
                        longest_gap: 0.0,
                        period: 0.0,
                    }
                }
            }

            /// Output of a step of a velocity from counts.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_edge_velocity_output_ $f>] {
                /// Velocity [channel unit/s]: finite, and zero until two counts are known.
                pub velocity: $f,
                /// Status of the step, equal to its return value.
                pub result: bowden_result,
                /// The bad input, if there is one.
                pub fault: bowden_fault,
            }

            /// Checks the settings and starts a velocity from counts. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_edge_velocity_init_ $f>](
                edges: *mut [<bowden_edge_velocity_ $f>],
                settings: *const [<bowden_edge_velocity_settings_ $f>],
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    // SAFETY: the caller's rule of pointers.
                    let s = unsafe { read_settings(settings)? };
                    let mut own = EdgeVelocity::try_new(s.count, s.time_constant, s.longest_gap)?;
                    if s.period != 0.0 {
                        own = own.with_period(s.period)?;
                    }
                    Ok((own, EdgeVelocityState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(edges, inner)?)), about) }
            }

            /// The velocity at a position [channel unit], `dt` [s] after the last call, whether
            /// that sample was good or bad. With M counts in a time T since the sample with the
            /// last count:
            ///
            ///     v+ = v + (1 - exp(-T/time_constant))*(M*count/T - v)   at a sample with counts
            ///     |v| <= count/(time since the last count)               at every other sample
            ///
            /// The result is BOWDEN_RESULT_SETTLING until two counts are known, and
            /// BOWDEN_RESULT_STOPPED after `longest_gap` without a count. A bad sample holds the
            /// velocity: BOWDEN_RESULT_HELD. `out` is written if the result is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_edge_velocity_step_ $f>](
                edges: *mut [<bowden_edge_velocity_ $f>],
                position: $f,
                dt: $f,
                out: *mut [<bowden_edge_velocity_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(edges)?;
                    let output = own.step(state, position, dt);
                    let (result, fault) = of_rates(output.status);
                    let velocity = output.velocity;
                    write(out, [<bowden_edge_velocity_output_ $f>] { velocity, result, fault })?;
                    Ok(result)
                })())
            }
        }
    };
}
edges!(f32, 0x6564_6765_6633_3220);
edges!(f64, 0x6564_6765_6636_3420);
