//! Iterative learning: what a task that repeats has lacked so far, fed forward.

use crate::object::{kept, read, start, writable, write, Lent, Object};
use crate::result::{bowden_about, bowden_fault, bowden_result, code, of_status, told, Refused};
use core_bowden::control::{Learning, LearningInput, LearningState};
use core_bowden::{Error, Real};

/// Most cells of a cycle.
pub const BOWDEN_CELLS: usize = 65535;
/// Room of a bowden_learning_f32, in words of 64 bits.
pub const BOWDEN_LEARNING_F32_WORDS: usize = 14;
/// Room of a bowden_learning_f64, in words of 64 bits.
pub const BOWDEN_LEARNING_F64_WORDS: usize = 18;

/// Both arrays, of which the second is set to zero, and the first one where nothing is kept: after
/// all that can be refused.
///
/// # Safety
/// As [`Lent::new`] of both arrays; where it is kept, numbers stand in the first one.
unsafe fn lent<T: Real, O: Object>(
    own: &Learning<T>,
    object: *const O,
    [learned, smoothing]: [*mut T; 2],
    cells: usize,
    is_kept: bool,
) -> Result<[Lent<T>; 2], Refused> {
    writable(object)?;
    writable(learned)?;
    writable(smoothing)?;
    if cells > BOWDEN_CELLS {
        return Err(Refused::capacity("cells"));
    }
    // SAFETY: as of this function.
    let (learned, smoothing) = unsafe { (Lent::new(learned, cells), Lent::new(smoothing, cells)) };
    // Both are placed: they would reach beyond the end of all memory.
    let (Ok(mut learned), Ok(mut smoothing)) = (learned, smoothing) else {
        return Err(Refused::capacity("cells"));
    };
    if cells < own.fewest_cells() {
        return Err(Error::Inadmissible("as many cells as lead and filter need").into());
    }
    if learned.overlaps(&smoothing) {
        return Err(Error::Inadmissible("learned and smoothing do not overlap").into());
    }
    if learned.overlaps_object(object) || smoothing.overlaps_object(object) {
        return Err(Error::Inadmissible("the arrays do not overlap the object").into());
    }
    if !is_kept {
        learned.fill(T::ZERO);
    }
    smoothing.fill(T::ZERO);
    Ok([learned, smoothing])
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
                smoothing: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let parts = || -> Result<(), Refused> { unsafe {
                    let own = read(settings)?.learning()?;
                    let arrays = [learned, smoothing];
                    let [learned, smoothing] = lent(&own, learning, arrays, cells, false)?;
                    Ok(start(learning, (own, own.start(learned, smoothing)?))?)
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts(), about) }
            }

            /// The same where `learned` holds what was learned before, such as a copy from before a
            /// reset, or an array that another object has learned in and is used with no more; it is
            /// confined to the limit, and zero for NaN. `smoothing` may hold anything.
            #[no_mangle]
            pub unsafe extern "C" fn [<bowden_learning_resume_ $f>](
                learning: *mut [<bowden_learning_ $f>],
                settings: *const [<bowden_learning_settings_ $f>],
                learned: *mut $f,
                smoothing: *mut $f,
                cells: usize,
                about: *mut bowden_about,
            ) -> bowden_result {
                // SAFETY: the caller's rule of pointers.
                let parts = || -> Result<(), Refused> { unsafe {
                    let own = read(settings)?.learning()?;
                    let arrays = [learned, smoothing];
                    let [learned, smoothing] = lent(&own, learning, arrays, cells, true)?;
                    Ok(start(learning, (own, own.resume(learned, smoothing)?))?)
                } };
                // SAFETY: the caller's rule of pointers.
                unsafe { told(parts(), about) }
            }

            /// One sample, before the controller's own: where in the cycle it is, from 0 to 1, the
            /// reference and the measured output [output unit]. `learns` is 0 where the error is not
            /// to be learned from: where a limit cut the command, or the task is another one.
            ///
            /// A phase that is not from 0 to 1 moves nothing and holds the feed-forward:
            /// BOWDEN_RESULT_HELD. BOWDEN_RESULT_DEGRADED where the feed-forward is of this phase
            /// but reference or measured output are not finite, so that nothing was learned, or where
            /// the phase has jumped, by more than four cells: the cell that was left does not learn
            /// then. `out` is written with every result that is not negative.
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
