//! Iterative learning control: a feed-forward from the error in earlier cycles of a repeating task.

use crate::object::{kept, read_settings, start, writable, write, Lent, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use crate::settings::{marked, Marked};
use core_bowden::control::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
use core_bowden::{Error, Real};

/// Maximum number of cells in a cycle.
pub const BOWDEN_CELLS: usize = 65535;
const _: () = assert!(BOWDEN_CELLS == IterativeLearning::<f32>::MOST_CELLS);
/// Size of bowden_iterative_learning_f32 in 64-bit words.
pub const BOWDEN_ITERATIVE_LEARNING_F32_WORDS: usize = 14;
/// Size of bowden_iterative_learning_f64 in 64-bit words.
pub const BOWDEN_ITERATIVE_LEARNING_F64_WORDS: usize = 18;

/// Initialises the object with both arrays after all checks. The function sets `unfiltered` to
/// zero, and also `learned` if its values are not kept.
///
/// # Safety
/// The caller's rule of pointers. The arrays satisfy the conditions of [`Lent::new`]. If the values
/// of `learned` are kept, the array contains numbers.
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
            /// Iterative learning controller with its state, except for two arrays that the caller
            /// owns. Initialise it with bowden_iterative_learning_init or
            /// bowden_iterative_learning_resume.
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

            /// Settings of iterative learning control. A cycle is divided into cells of equal width
            /// in phase. e is the mean of reference - measured over a cell, and w(k) are triangular
            /// weights with a sum of 1. In each cycle, the learned values become
            ///
            ///     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
            ///     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
            ///
            /// By default `forgetting` is 0. You must set all other fields.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_iterative_learning_settings_ $f>] {
                /// Initialisation mark, set by NAME_INIT.
                pub init_mark: u32,
                /// Learning gain [command unit/output unit], nonzero, with the sign of the plant
                /// gain.
                pub gain: $f,
                /// Largest magnitude of the learned values [command unit], positive.
                pub limit: $f,
                /// Fraction of a learned value that is forgotten per cycle, 0 to 1.
                pub forgetting: $f,
                /// Number of cells between a command and its effect.
                pub lead: u16,
                /// Half-width of the triangular filter [cells]; 0 disables the filter.
                pub half_width: u16,
            }

            marked!([<bowden_iterative_learning_settings_ $f>]);

            impl [<bowden_iterative_learning_settings_ $f>] {
                /// Returns the defaults.
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

            /// Output of bowden_iterative_learning_step.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_iterative_learning_output_ $f>] {
                /// Feed-forward for a controller [command unit], finite and within the limit.
                pub feed_forward: $f,
                /// Return value of the step.
                pub result: bowden_result,
                /// Bad input, or BOWDEN_FAULT_NONE.
                pub fault: bowden_fault,
            }

            /// Checks the settings, initialises the controller, and sets its two arrays of `cells`
            /// numbers to zero. `cells` must be at least lead + 2*half_width + 9 and at most
            /// BOWDEN_CELLS. If there is an error, the arrays do not change. `about` may be null.
            ///
            /// The caller owns the arrays, which must exist for as long as the object is used. The
            /// caller may read `learned` between two calls. Do not write to the arrays or use them
            /// for another object. The arrays must not overlap each other or the object
            /// (BOWDEN_RESULT_ERROR_INADMISSIBLE). A copy of the object uses the same arrays, so
            /// use only one of the two objects.
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

            /// Initialises the object like bowden_iterative_learning_init, but continues with the
            /// values in `learned`, such as values saved before a reset. The function clamps the
            /// values to the limit and replaces NaN by zero. `unfiltered` may contain any values.
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

            /// Processes one sample. Call this function before the step of the controller. `phase`
            /// is the phase of the cycle, 0 to 1. `reference` and `measured` are in [output unit].
            ///
            /// Set `learns` to 0 while the command is limited, while the safe command is applied,
            /// or during a different task. If more than half of the samples in a cell have `learns`
            /// = 0, the errors of the next `lead` cells are ignored too.
            ///
            /// A phase outside 0 to 1 changes nothing and holds the feed-forward
            /// (BOWDEN_RESULT_HELD). The feedback controller does not detect this fault.
            /// BOWDEN_RESULT_DEGRADED has two causes:
            ///
            /// - The reference or the measured output is not finite. The feed-forward follows the
            ///   phase, but nothing is learned.
            /// - The phase has jumped by more than four cells. The cell before the jump does not
            ///   learn. The feed-forward jumps with the phase, so set a slew-rate limit in the
            ///   feedback controller.
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
