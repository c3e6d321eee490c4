//! Learning through the C interface: the crate's numbers to the bit, in arrays that stay the
//! caller's, and what of these arrays is refused.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
// Its bad times are for the other tests.
#[allow(dead_code)]
mod signal;

use bowden::*;
use core_bowden::control::{Fault, IterativeLearning, IterativeLearningInput, Status};
use core_bowden::Error;
use objects::blank;
use signal::Signal;
use std::ffi::CStr;
use std::ptr::{null_mut, NonNull};

const CELLS: usize = 100;

/// Five samples a cell, but for bad ones and jumps.
fn phase(k: u32) -> f64 {
    match k {
        700 => f64::NAN,
        701 => -0.1,
        702 => 1.5,
        703 => 1.0,
        900..=1000 => f64::from((k + 200) % 500) / 500.0,
        _ => f64::from(k % 500) / 500.0,
    }
}

/// What the crate's status is in C.
fn result_of(status: Status) -> (bowden_result, bowden_fault) {
    let result = match status {
        Status::Good => bowden_result::Ok,
        Status::Degraded(_) => bowden_result::Degraded,
        Status::Held(_) => bowden_result::Held,
        Status::Safe(_) => bowden_result::Safe,
    };
    let fault = match status.fault() {
        None => bowden_fault::None,
        Some(Fault::Measured) => bowden_fault::Measured,
        Some(Fault::Phase) => bowden_fault::Phase,
        Some(_) => bowden_fault::Other,
    };
    (result, fault)
}

macro_rules! learning {
    ($name:ident, $f:ident, $object:ident, $settings:ident, $output:ident,
     $init:ident, $resume:ident, $step:ident) => {
        #[test]
        fn $name() {
            for (forgetting, lead, half_width) in [(0.0, 0, 0), (0.05, 2, 3)] {
                let settings = $settings {
                    gain: 0.5,
                    limit: 12.0,
                    forgetting,
                    lead,
                    half_width,
                    ..$settings::defaults()
                };
                let own = IterativeLearning::<$f>::try_new(0.5, 12.0, lead, half_width)
                    .and_then(|own| own.with_forgetting(forgetting))
                    .unwrap();
                let mut state = own.start([0.0; CELLS], [0.0; CELLS]).unwrap();
                // Whatever stands in the arrays.
                let (mut learned, mut unfiltered) = ([7.0; CELLS], [<$f>::NAN; CELLS]);
                let (first, second) = (learned.as_mut_ptr(), unfiltered.as_mut_ptr());
                let mut learning = blank::<$object>();
                let begun =
                    unsafe { $init(&mut learning, &settings, first, second, CELLS, null_mut()) };
                assert_eq!(begun, bowden_result::Ok);
                let mut signal = Signal::new();
                for k in 0..4000 {
                    let (phase, measured) = (phase(k) as $f, signal.measured(k) as $f);
                    let (reference, learns) = (signal.next(20.0) as $f, k % 11 != 0);
                    let at = IterativeLearningInput {
                        phase,
                        reference,
                        measured,
                        learns,
                    };
                    let (expected, mut out) = (own.step(&mut state, &at), blank::<$output>());
                    let learns = u32::from(learns) * k;
                    let result = unsafe {
                        $step(&mut learning, phase, reference, measured, learns, &mut out)
                    };
                    let (wanted, fault) = result_of(expected.status);
                    assert_eq!(
                        (result, out.result, out.fault),
                        (wanted, wanted, fault),
                        "{k}"
                    );
                    let (one, other) = (out.feed_forward, expected.command);
                    assert_eq!(one.to_bits(), other.to_bits(), "{k}");
                    // After another start, with what was learned before it, in another object.
                    if k == 3000 {
                        learning = blank();
                        let begun = unsafe {
                            $resume(&mut learning, &settings, first, second, CELLS, null_mut())
                        };
                        assert_eq!(begun, bowden_result::Ok);
                        let learned: [$f; CELLS] = state.learned().try_into().unwrap();
                        state = own.resume(learned, [0.0; CELLS]).unwrap();
                    }
                    // Between two calls the array may be read.
                    if k % 100 == 0 {
                        let learned = unsafe { std::slice::from_raw_parts(first, CELLS) };
                        assert_eq!(learned, state.learned(), "{k}");
                        let some = learned.iter().filter(|u| **u != 0.0).count();
                        assert!(k < 600 || some > 90, "{k} {some}");
                    }
                }
            }
        }
    };
}
learning!(
    learning_in_f32,
    f32,
    bowden_iterative_learning_f32,
    bowden_iterative_learning_settings_f32,
    bowden_iterative_learning_output_f32,
    bowden_iterative_learning_init_f32,
    bowden_iterative_learning_resume_f32,
    bowden_iterative_learning_step_f32
);
learning!(
    learning_in_f64,
    f64,
    bowden_iterative_learning_f64,
    bowden_iterative_learning_settings_f64,
    bowden_iterative_learning_output_f64,
    bowden_iterative_learning_init_f64,
    bowden_iterative_learning_resume_f64,
    bowden_iterative_learning_step_f64
);

const SETTINGS: bowden_iterative_learning_settings_f32 = bowden_iterative_learning_settings_f32 {
    gain: 4.0,
    limit: 30.0,
    forgetting: 0.0,
    lead: 2,
    half_width: 2,
    ..bowden_iterative_learning_settings_f32::defaults()
};

type Begin = unsafe extern "C" fn(
    *mut bowden_iterative_learning_f32,
    *const bowden_iterative_learning_settings_f32,
    *mut f32,
    *mut f32,
    usize,
    *mut bowden_about,
) -> bowden_result;

/// Both ways to begin.
const BEGIN: [Begin; 2] = [
    bowden_iterative_learning_init_f32,
    bowden_iterative_learning_resume_f32,
];

/// What beginning gives, and the text of a refusal.
fn begin(
    begin: Begin,
    object: *mut bowden_iterative_learning_f32,
    settings: &bowden_iterative_learning_settings_f32,
    arrays: [*mut f32; 2],
    cells: usize,
) -> (bowden_result, String) {
    let mut about = blank::<bowden_about>();
    let [learned, unfiltered] = arrays;
    let result = unsafe { begin(object, settings, learned, unfiltered, cells, &mut about) };
    let text = unsafe { CStr::from_ptr(about.text.as_ptr()) };
    (result, text.to_str().unwrap().to_owned())
}

#[test]
fn arrays_that_cannot_be_are_refused_and_nothing_is_written() {
    use bowden_result as R;
    let mut memory = [5.0_f32; 500];
    let first = memory.as_mut_ptr();
    let at = |index: usize| first.wrapping_add(index);
    let odd = first.cast::<u8>().wrapping_add(1).cast::<f32>();
    let (null, far) = (null_mut(), NonNull::<f32>::dangling().as_ptr());
    // The last place that a pointer can lead to.
    let last = far.with_addr(usize::MAX - 3);
    let overlap = "learned and unfiltered must not overlap";
    let few = "the lead and the filter need more cells";
    for (arrays, cells, result, about) in [
        ([null, at(250)], 250, R::ErrorNull, ""),
        ([at(0), null], 250, R::ErrorNull, ""),
        ([at(0), null], usize::MAX, R::ErrorNull, ""),
        ([odd, at(250)], 240, R::ErrorMisaligned, ""),
        ([at(0), odd], 240, R::ErrorMisaligned, ""),
        ([at(0), at(0)], 250, R::ErrorInadmissible, overlap),
        ([at(0), at(249)], 250, R::ErrorInadmissible, overlap),
        ([at(249), at(0)], 250, R::ErrorInadmissible, overlap),
        ([at(0), at(250)], 14, R::ErrorInadmissible, few),
        ([at(0), at(250)], 0, R::ErrorInadmissible, few),
        ([at(0), at(0)], 65_536, R::ErrorCapacity, "cells"),
        ([at(0), far], usize::MAX, R::ErrorCapacity, "cells"),
        ([at(0), far], usize::MAX / 4 + 1, R::ErrorCapacity, "cells"),
        ([last, at(0)], 250, R::ErrorCapacity, "cells"),
    ] {
        for way in BEGIN {
            let mut learning = blank::<bowden_iterative_learning_f32>();
            let tried = begin(way, &mut learning, &SETTINGS, arrays, cells);
            assert_eq!(tried, (result, about.to_owned()), "{cells}");
            assert_eq!(learning.opaque, [0; BOWDEN_ITERATIVE_LEARNING_F32_WORDS]);
        }
    }
    let mut learning = blank::<bowden_iterative_learning_f32>();
    // An object that is none must not let the arrays be written either.
    let object: *mut bowden_iterative_learning_f32 = &mut learning;
    let beside = object.cast::<u8>().wrapping_add(4).cast();
    for (object, result) in [(null_mut(), R::ErrorNull), (beside, R::ErrorMisaligned)] {
        for way in BEGIN {
            let tried = begin(way, object, &SETTINGS, [at(0), at(250)], 250);
            assert_eq!(tried.0, result);
        }
    }
    assert_eq!(memory, [5.0; 500]);
    let core = IterativeLearning::try_new(4.0_f32, 30.0, 2, 2).unwrap();
    let refused = core.start([0.0; 14], [0.0; 14]).err();
    assert_eq!(refused, Some(Error::Inadmissible(few)));
}

#[test]
fn arrays_side_by_side_are_good_and_as_few_cells_as_there_may_be() {
    let mut memory = [5.0_f32; 30];
    let first = memory.as_mut_ptr();
    let second = first.wrapping_add(15);
    for way in BEGIN {
        for arrays in [[first, second], [second, first]] {
            let mut learning = blank();
            let tried = begin(way, &mut learning, &SETTINGS, arrays, 15);
            assert_eq!(tried, (bowden_result::Ok, String::new()));
            let mut out = blank();
            let result = unsafe {
                bowden_iterative_learning_step_f32(&mut learning, 0.5, 1.0, 0.0, 1, &mut out)
            };
            assert_eq!(result, bowden_result::Ok);
        }
    }
}

#[test]
fn an_array_within_the_object_is_refused() {
    #[repr(C)]
    struct Nested {
        before: [f32; 14],
        object: [u64; BOWDEN_ITERATIVE_LEARNING_F32_WORDS],
        behind: [f32; 20],
        other: [f32; 20],
    }
    let mut nested = blank::<Nested>();
    let own: *mut Nested = &mut nested;
    let (object, other, behind) = unsafe {
        (
            (&raw mut (*own).object).cast::<bowden_iterative_learning_f32>(),
            (&raw mut (*own).other).cast::<f32>(),
            (&raw mut (*own).behind).cast::<f32>(),
        )
    };
    let text = "the arrays must not overlap the object";
    // One that ends in the object, one within it, one that begins in its last word.
    for array in [own.cast(), object.cast(), behind.wrapping_sub(1)] {
        for arrays in [[array, other], [other, array]] {
            for way in BEGIN {
                let tried = begin(way, object, &SETTINGS, arrays, 15);
                assert_eq!(tried, (bowden_result::ErrorInadmissible, text.to_owned()));
            }
        }
    }
    let tried = begin(BEGIN[0], object, &SETTINGS, [behind, other], 15);
    assert_eq!(tried, (bowden_result::Ok, String::new()));
    assert_eq!(nested.before, [0.0; 14]);
}

#[test]
fn a_setting_that_is_refused_is_named_and_object_and_arrays_are_as_they_were() {
    use bowden_result as R;
    type Change = fn(&mut bowden_iterative_learning_settings_f32);
    let few = "the lead and the filter need more cells";
    let cases: [(Change, R, &str); 8] = [
        (|s| s.gain = f32::NAN, R::ErrorNonFinite, "gain"),
        (|s| s.gain = 0.0, R::ErrorOutOfRange, "gain"),
        (|s| s.limit = 0.0, R::ErrorOutOfRange, "limit"),
        (|s| s.forgetting = 1.5, R::ErrorOutOfRange, "forgetting"),
        (|s| s.lead = u16::MAX - 1, R::ErrorInadmissible, few),
        (|s| s.half_width = u16::MAX - 1, R::ErrorInadmissible, few),
        (|s| s.lead = u16::MAX, R::ErrorOutOfRange, "lead"),
        (
            |s| s.half_width = u16::MAX,
            R::ErrorOutOfRange,
            "half_width",
        ),
    ];
    let mut memory = [5.0_f32; 500];
    let arrays = [memory.as_mut_ptr(), memory.as_mut_ptr().wrapping_add(250)];
    for (change, code, name) in cases {
        let (mut bad, mut learning) = (SETTINGS, blank::<bowden_iterative_learning_f32>());
        change(&mut bad);
        for way in BEGIN {
            let tried = begin(way, &mut learning, &bad, arrays, 250);
            assert_eq!(tried, (code, name.to_owned()));
            assert_eq!(learning.opaque, [0; BOWDEN_ITERATIVE_LEARNING_F32_WORDS]);
        }
    }
    assert_eq!(memory, [5.0; 500]);
}

#[test]
fn what_was_stored_is_confined() {
    let mut memory = [0.0_f32; 40];
    (memory[0], memory[1], memory[2]) = (-99.0, f32::NAN, 12.5);
    let arrays = [memory.as_mut_ptr(), memory.as_mut_ptr().wrapping_add(20)];
    let mut learning = blank();
    let tried = begin(BEGIN[1], &mut learning, &SETTINGS, arrays, 20);
    assert_eq!(tried, (bowden_result::Ok, String::new()));
    assert_eq!(memory[..4], [-30.0, 0.0, 12.5, 0.0]);
}
