//! Iterative learning: a feed-forward from the error of earlier cycles of a repeating task.

use crate::object::{kept, read_settings, start, writable, write, Lent, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::control::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
use core_bowden::{Error, Real};

/// Maximum number of cells of a cycle.
pub const BOWDEN_CELLS: usize = 65535;
const _: () = assert!(BOWDEN_CELLS == IterativeLearning::<f32>::MOST_CELLS);
/// Size of a bowden_iterative_learning_f32 in 64-bit words.
pub const BOWDEN_ITERATIVE_LEARNING_F32_WORDS: usize = 14;
/// Size of a bowden_iterative_learning_f64 in 64-bit words.
pub const BOWDEN_ITERATIVE_LEARNING_F64_WORDS: usize = 18;

/// Starts with both arrays, after all checks. It sets the second array to zero, and the first one
/// if its values are not kept.
///
/// # Safety
/// The caller's rule of pointers. The arrays satisfy the conditions of [`Lent::new`]; if the values
/// of the first one are kept, it contains numbers.
unsafe fn begin<
    T: Real,
    O: Object<Inner = (IterativeLearning<T>, IterativeLearningState<T, Lent<T>>)>,
>(
    own: Result<IterativeLearning<T>, Refused>,
    object: *mut O,
    [learned, unfiltered]: [*mut T; 2],
    cells: usize,
    is_kept: bool,
) -> Result<(), Refused> {
    let own = own?;
    writable(object)?;
    writable(learned)?;
    writable(unfiltered)?;
    // SAFETY: as of this function.
    let arrays = unsafe { (Lent::new(learned, cells), Lent::new(unfiltered, cells)) };
    // Both are placed: they would reach beyond the end of all memory.
    let (Ok(mut learned), Ok(mut unfiltered)) = arrays else {
        return Err(Refused::capacity("cells"));
    };
    own.check_cells(cells)?;
    if learned.overlaps(&unfiltered) {
        return Err(Error::Inadmissible("learned and unfiltered must not overlap").into());
    }
    if learned.overlaps_object(object) || unfiltered.overlaps_object(object) {
        return Err(Error::Inadmissible("the arrays must not overlap the object").into());
    }
    if !is_kept {
        learned.fill(T::ZERO);
    }
    unfiltered.fill(T::ZERO);
    // SAFETY: as of this function.
    Ok(unsafe { start(object, (own, own.resume(learned, unfiltered)?)) }?)
}

macro_rules! learning {
    ($f:ident, $magic:literal) => {
        pastey::paste! {
            /// Iterative learning with its state, except for two arrays that the caller owns;
            /// initialised by bowden_iterative_learning_init or bowden_iterative_learning_resume.
            #[repr(C)]
            pub struct [<bowden_iterative_learning_ $f>] {
                /// Private; do not use.
                pub opaque: [u64; [<BOWDEN_ITERATIVE_LEARNING_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_iterative_learning_ $f>] {
                type Inner = (IterativeLearning<$f>, IterativeLearningState<$f, Lent<$f>>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of iterative learning. A cycle is divided into cells of equal phase; with e
            /// the mean of reference - measured over a cell, and w(k) a triangle of area 1:
            ///
            ///     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
            ///     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
            ///
            /// Start from NAME_INIT. By default nothing is forgotten; all other fields must be set.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_iterative_learning_settings_ $f>] {
                /// The mark that the macro NAME_INIT sets; settings without it are refused.
                pub init_mark: u32,
                /// Gain of the error, not zero, with the sign of the plant's gain [command
                /// unit/output unit].
                pub gain: $f,
                /// Largest magnitude of the learned values, above zero [command unit].
                pub limit: $f,
                /// Share of a learned value that is forgotten per cycle, from 0 to 1.
                pub forgetting: $f,
                /// Number of cells from a command to its effect.
                pub lead: u16,
                /// Half-width of the triangle [cells]; 0 means no filter.
                pub half_width: u16,
            }

            marked!([<bowden_iterative_learning_settings_ $f>]);

            impl [<bowden_iterative_learning_settings_ $f>] {
                /// The defaults; a field without a default has an invalid value.
                pub const fn defaults() -> Self {
                    Self {
                        init_mark: Self::MARK,
                        gain: 0.0,
                        limit: 0.0,
                        forgetting: 0.0,
                        lead: u16::MAX,
                        half_width: u16::MAX,
                    }
                }
            }

            impl [<bowden_iterative_learning_settings_ $f>] {
                fn learning(&self) -> Result<IterativeLearning<$f>, Refused> {
                    for (cells, name) in [(self.lead, "lead"), (self.half_width, "half_width")] {
                        // No array has so many cells: the field was not set.
                        if cells == u16::MAX {
                            return Err(Refused::unset(name));
                        }
                    }
                    let own =
                        IterativeLearning::try_new(self.gain, self.limit, self.lead, self.half_width)?;
                    Ok(own.with_forgetting(self.forgetting)?)
                }
            }

            /// Output of a step of iterative learning.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_iterative_learning_output_ $f>] {
                /// Value to add to the command through the feed_forward of a controller [command
                /// unit]: always finite and within the limit.
                pub feed_forward: $f,
                /// Status of the step, equal to its return value.
                pub result: bowden_result,
                /// The bad input, if there is one.
                pub fault: bowden_fault,
            }

            /// Starts iterative learning over two arrays of `cells` numbers, which it sets to zero.
            /// `cells` is at least lead + 2*half_width + 9 and at most BOWDEN_CELLS.
            ///
            /// The caller owns the arrays. They must exist, and nothing else may write to them, for
            /// as long as the object is used. Do not use a local array if the object outlives the
            /// function. Between two calls the caller may read `learned`, to plot or to store it.
            /// The arrays must not overlap each other or the object
            /// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and they serve one object at a time. A copy of
            /// the object uses the same arrays, so use only one of the two.
            ///
            /// On an error the object and the arrays do not change. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_iterative_learning_init_ $f>](
                learning: *mut [<bowden_iterative_learning_ $f>],
                settings: *const [<bowden_iterative_learning_settings_ $f>],
                learned: *mut $f,
                unfiltered: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let own = read_settings(settings).and_then(|own| own.learning());
                    told(begin(own, learning, [learned, unfiltered], cells, false), about)
                }
            }

            /// The same as bowden_iterative_learning_init, but with earlier values in `learned`: a
            /// copy from before a reset, or the array of an object that is no longer used. Values
            /// are clamped to the limit, and NaN becomes zero. `unfiltered` may have any contents.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_iterative_learning_resume_ $f>](
                learning: *mut [<bowden_iterative_learning_ $f>],
                settings: *const [<bowden_iterative_learning_settings_ $f>],
                learned: *mut $f,
                unfiltered: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let own = read_settings(settings).and_then(|own| own.learning());
                    told(begin(own, learning, [learned, unfiltered], cells, true), about)
                }
            }

            /// Processes one sample; call it before the controller's step, with the phase of the
            /// cycle, from 0 to 1, the reference, and the measured output [output unit]. Set
            /// `learns` to 0 if a limit has cut the command, the safe command is applied, or the
            /// task is different. If more than half of a cell's samples have `learns` = 0, the
            /// errors of the next `lead` cells are ignored too.
            ///
            /// A phase outside 0 to 1 changes nothing and holds the feed-forward:
            /// BOWDEN_RESULT_HELD. The controller counts such samples as good.
            /// BOWDEN_RESULT_DEGRADED has two causes. If the reference or the measured output is
            /// not finite, the feed-forward follows the phase, and nothing is learned. If the phase
            /// has jumped by more than four cells, the cell before the jump does not learn, and the
            /// feed-forward jumps with the phase, so give the controller a slew-rate limit. `out`
            /// is written if the result is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_iterative_learning_step_ $f>](
                learning: *mut [<bowden_iterative_learning_ $f>],
                phase: $f,
                reference: $f,
                measured: $f,
                learns: u32,
                out: *mut [<bowden_iterative_learning_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(learning)?;
                    let learns = learns != 0;
                    let at = IterativeLearningInput { phase, reference, measured, learns };
                    let output = own.step(state, &at);
                    let (result, fault, _) = of_status(output.status);
                    let feed_forward = output.command;
                    write(out, [<bowden_iterative_learning_output_ $f>] { feed_forward, result, fault })?;
                    Ok(result)
                })())
            }
        }
    };
}
learning!(f32, 0x6c65_6172_6633_3220);
learning!(f64, 0x6c65_6172_6636_3420);
