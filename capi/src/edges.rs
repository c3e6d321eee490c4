//! Velocity of a slow encoder from the time between its counts.

use crate::object::{kept, read_settings, start, writable, write, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_rates, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::signal::{EdgeVelocity, EdgeVelocityState};

/// Size of bowden_edge_velocity_f32 in 64-bit words.
pub const BOWDEN_EDGE_VELOCITY_F32_WORDS: usize = 8;
/// Size of bowden_edge_velocity_f64 in 64-bit words.
pub const BOWDEN_EDGE_VELOCITY_F64_WORDS: usize = 13;

macro_rules! edges {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Velocity estimator for encoder counts, with its state.
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

            /// Settings of a velocity estimator for encoder counts; see bowden_edge_velocity_step.
            ///
            /// By default the position does not wrap. You must set all other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_edge_velocity_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Size of one count [channel unit], positive. Positions change by multiples of
                /// this size.
                pub count: $f,
                /// Time constant [s], positive, of the average over counts at shorter intervals.
                pub time_constant: $f,
                /// Time without a count [s], positive, after which the velocity is zero. A speed
                /// below count/longest_gap is therefore reported as zero.
                pub longest_gap: $f,
                /// Period [channel unit] of a position that wraps, such as a counter reading; 0 if
                /// the position does not wrap.
                pub period: $f,
            }

            marked!([<bowden_edge_velocity_settings_ $f>]);

            impl [<bowden_edge_velocity_settings_ $f>] {
                /// Returns the defaults.
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

            /// Output of bowden_edge_velocity_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_edge_velocity_output_ $f>] {
                /// Velocity [channel unit/s], finite; zero until the position has changed twice.
                pub velocity: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
            }

            /// Checks the settings and initialises the estimator. `about` may be null.
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

            /// Computes the velocity at `position` [channel unit]. `dt` [s] is the time since the
            /// previous call, even if the sample of that call was bad. M is the number of counts in
            /// the time T since the last sample with a count:
            ///
            ///     v+ = v + (1 - exp(-T/time_constant))*(M*count/T - v)   at a sample with counts
            ///     |v| <= count/(time since the last count)               at every other sample
            ///
            /// The result is BOWDEN_RESULT_SETTLING until the position has changed twice, and
            /// BOWDEN_RESULT_STOPPED after `longest_gap` without a count. A bad sample holds the
            /// velocity (BOWDEN_RESULT_HELD).
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
