//! Iterative learning: what a task that repeats has lacked so far, fed forward.

use crate::object::{kept, read, start, writable, write, Lent, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use core_bowden::control::{Learning, LearningInput, LearningState};
use core_bowden::{Error, Real};

/// Most cells of a cycle.
pub const BOWDEN_CELLS: usize = 65535;
const _: () = assert!(BOWDEN_CELLS == Learning::<f32>::MOST_CELLS);
/// Room of a bowden_learning_f32, in words of 64 bits.
pub const BOWDEN_LEARNING_F32_WORDS: usize = 14;
/// Room of a bowden_learning_f64, in words of 64 bits.
pub const BOWDEN_LEARNING_F64_WORDS: usize = 18;

/// Starts over both arrays, of which the second is set to zero, and the first one where nothing is
/// kept: after all that can be refused.
///
/// # Safety
/// The caller's rule of pointers; of the arrays as [`Lent::new`], and where the first one is kept
/// numbers stand in it.
unsafe fn begin<T: Real, O: Object<Inner = (Learning<T>, LearningState<T, Lent<T>>)>>(
    own: Result<Learning<T>, Refused>,
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
        return Err(Error::Inadmissible("learned and unfiltered do not overlap").into());
    }
    if learned.overlaps_object(object) || unfiltered.overlaps_object(object) {
        return Err(Error::Inadmissible("the arrays do not overlap the object").into());
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
            /// A learning with its state but for two arrays of the caller; made by
            /// bowden_learning_init or bowden_learning_resume.
            #[repr(C)]
            pub struct [<bowden_learning_ $f>] {
                /// Not for use.
                pub opaque: [u64; [<BOWDEN_LEARNING_ $f:upper _WORDS>]],
            }

            // SAFETY: `repr(C)` of one array of u64.
            unsafe impl Object for [<bowden_learning_ $f>] {
                type Inner = (Learning<$f>, LearningState<$f, Lent<$f>>);
                const MAGIC: u64 = $magic;
            }

            /// Settings of a learning. A cycle is divided into cells of equal phase; with e the mean
            /// of reference - measured over a cell, and w(k) a triangle of area 1:
            ///
            ///     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
            ///     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_learning_settings_ $f>] {
                /// Of the error, not zero, of the sign of the plant's [command unit/output unit].
                pub gain: $f,
                /// Greatest magnitude of what is learned, above zero [command unit].
                pub limit: $f,
                /// Share of what a cell has learned that is forgotten each time, from 0 to 1.
                pub forgetting: $f,
                /// How many cells a command comes before its effect.
                pub lead: u16,
                /// Half width of the triangle [cells]; 0 filters nothing.
                pub half_width: u16,
            }

            impl [<bowden_learning_settings_ $f>] {
                fn learning(&self) -> Result<Learning<$f>, Refused> {
                    let own =
                        Learning::try_new(self.gain, self.limit, self.lead, self.half_width)?;
                    Ok(own.with_forgetting(self.forgetting)?)
                }
            }

            /// What a step of a learning gives.
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct [<bowden_learning_output_ $f>] {
                /// To be added to the command, as feed_forward of a controller [command unit];
                /// finite and within the limit in any case.
                pub feed_forward: $f,
                /// What the step did: the same as it returns.
                pub result: bowden_result,
                /// What was wrong.
                pub fault: bowden_fault,
            }

            /// Starts a learning that has learned nothing, over two arrays of `cells` numbers, which
            /// it sets to zero: at least lead + 2*half_width + 9, at most BOWDEN_CELLS.
            ///
            /// The arrays stay the caller's. They must be there, and nobody may write to them, for
            /// as long as the object is used: a local array of the function that calls this is
            /// wrong where the object outlives it. Between two calls `learned` may be read, for a
            /// plot or to be stored. They overlap neither each other nor the object
            /// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and serve one object at a time; a copy of the
            /// object goes on with the same arrays, so only one of the two may be used.
            ///
            /// On an error object and arrays are as they were. `about` may be null.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_learning_init_ $f>](
                learning: *mut [<bowden_learning_ $f>],
                settings: *const [<bowden_learning_settings_ $f>],
                learned: *mut $f,
                unfiltered: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let own = read(settings).map_err(Refused::from).and_then(|own| own.learning());
                    told(begin(own, learning, [learned, unfiltered], cells, false), about)
                }
            }

            /// The same where `learned` holds what was learned before, such as a copy from before a
            /// reset, or an array that another object has learned in and is used with no more; it is
            /// confined to the limit, and zero for NaN. `unfiltered` may hold anything.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_learning_resume_ $f>](
                learning: *mut [<bowden_learning_ $f>],
                settings: *const [<bowden_learning_settings_ $f>],
                learned: *mut $f,
                unfiltered: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                unsafe {
                    let own = read(settings).map_err(Refused::from).and_then(|own| own.learning());
                    told(begin(own, learning, [learned, unfiltered], cells, true), about)
                }
            }

            /// One sample, before the controller's own: where in the cycle it is, from 0 to 1, the
            /// reference and the measured output [output unit]. `learns` is 0 where what is out is not
            /// to be learned from: where a limit cut the command, the safe one is out, or the task is
            /// another one. Where that is so of more than half of a cell's samples, the errors of the
            /// next `lead` cells teach nothing either.
            ///
            /// A phase that is not from 0 to 1 moves nothing and holds the feed-forward:
            /// BOWDEN_RESULT_HELD, for as long as there is none; the controller's samples are good
            /// meanwhile. BOWDEN_RESULT_DEGRADED where the feed-forward is of this phase but
            /// reference or measured output are not finite, so that nothing was learned, or where the
            /// phase has jumped, by more than four cells: the cell that was left does not learn then,
            /// and the feed-forward jumps with the phase. Give the controller a slew rate. `out` is
            /// written with every result that is not negative.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_learning_step_ $f>](
                learning: *mut [<bowden_learning_ $f>],
                phase: $f,
                reference: $f,
                measured: $f,
                learns: u32,
                out: *mut [<bowden_learning_output_ $f>],
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                code((|| unsafe {
                    writable(out)?;
                    let (own, state) = kept(learning)?;
                    let learns = learns != 0;
                    let at = LearningInput { phase, reference, measured, learns };
                    let output = own.step(state, &at);
                    let (result, fault, _) = of_status(output.status);
                    let feed_forward = output.feed_forward;
                    write(out, [<bowden_learning_output_ $f>] { feed_forward, result, fault })?;
                    Ok(result)
                })())
            }
        }
    };
}
learning!(f32, 0x6c65_6172_6633_3220);
learning!(f64, 0x6c65_6172_6636_3420);
