//! Play operator, which keeps input noise from driving a hysteresis model.

use crate::object::{kept, start, writable, write, Object};
use crate::result::{bowden_about, bowden_result, code, told, Refused};
use core_bowden::signal::{Play, PlayState};

/// Size of bowden_play_f32 in 64-bit words.
pub const BOWDEN_PLAY_F32_WORDS: usize = 4;
/// Size of bowden_play_f64 in 64-bit words.
pub const BOWDEN_PLAY_F64_WORDS: usize = 6;

macro_rules! play {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Play operator with its state.
            #[repr(C)]
            pub struct [<bowden_play_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_PLAY_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_play_ $f>] {
                type Inner = (Play<$f>, PlayState<$f>);
                const MAGIC: u64 = $magic;
            }

            /// Initialises a play operator; see bowden_play_step. `half_width` [input unit] must be
            /// at least 0; with 0 the output equals the input. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_play_init_ $f>](
                play: *mut [<bowden_play_ $f>],
                half_width: $f,
                about: *mut bowden_about,
            ) -> bowden_result {
                let parts = || -> Result<_, Refused> {
                    Ok((Play::try_new(half_width)?, PlayState::new()))
                };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts().and_then(|inner| Ok(start(play, inner)?)), about) }
            }

            /// Processes one input sample x [input unit]. The output y moves by the smallest amount
            /// that keeps it within the half-width r of the input:
            ///
            ///     y+ = clamp(y, x - r, x + r)
            ///
            /// An oscillation of the input with a peak-to-peak amplitude of up to 2*r does not move
            /// the output. At the input of a hysteresis model, a play operator prevents reversals
            /// due to sensor noise. The first output equals the first good sample. If the input is
            /// not finite, the last output is held (BOWDEN_RESULT_HELD).
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_play_step_ $f>](
                play: *mut [<bowden_play_ $f>],
                input: $f,
                output: *mut $f,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(output)?;
                    let (own, state) = kept(play)?;
                    let value = own.step(state, input);
                    write(output, value)?;
                    Ok(if input.is_finite() { bowden_result::Ok } else { bowden_result::Held })
                })())
            }
        }
    };
}
play!(f32, 0x706c_6179_6633_3220);
play!(f64, 0x706c_6179_6636_3420);
