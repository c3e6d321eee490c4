//! Iterative learning: an unrolled oracle, closed forms, a static plant, bad samples, jumps.

use super::*;
use bowden::control::IterativeLearningInput as Input;

fn learning(gain: f64, lead: u16, half_width: u16) -> IterativeLearning<f64> {
    IterativeLearning::try_new(gain, 1e6, lead, half_width).unwrap()
}

type Cells = IterativeLearningState<f64, Vec<f64>>;

fn started(learning: &IterativeLearning<f64>, cells: usize) -> Cells {
    learning.start(vec![0.0; cells], vec![0.0; cells]).unwrap()
}

/// Goes through cells `from..to`, counted on over the cycles, a few samples in each; the error of a
/// cell and its feed-forward are told by the cell's number.
fn pass(
    learning: &IterativeLearning<f64>,
    state: &mut Cells,
    (from, to): (usize, usize),
    mut error: impl FnMut(usize, f64) -> f64,
) {
    let cells = state.learned().len();
    for cell in from..to {
        for part in [0.1, 0.5, 0.9] {
            let phase = ((cell % cells) as f64 + part) / cells as f64;
            // The feed-forward in the middle of a cell is what the cell has learned.
            let own = state.learned()[cell % cells];
            let out = learning.step(state, &Input::new(phase, error(cell, own), 0.0));
            assert_eq!(out.status, Status::Good);
            if part == 0.5 {
                near(out.command, state.learned()[cell % cells], 1e-9);
            }
        }
    }
}

/// What stands in the cells after these errors, the last `lead + half` of which are behind: the
/// recursion over all cells that ever were, without a ring and without a running sum,
/// `v(j) = (1 − f)·u(j) + g·e(j + lead)`, `u(j + n) = Σ w(k)·v(j + k)`.
fn unrolled(
    errors: &[f64],
    cells: usize,
    (gain, lead, half, forgetting): (f64, usize, usize, f64),
) -> Vec<f64> {
    // What comes before the first cell is at rest.
    let offset = lead + 2 * half + 1;
    let total = errors.len() + cells + offset;
    let (mut u, mut v) = (vec![0.0; total + cells], vec![0.0; total + cells]);
    let width = (half + 1) as f64;
    for j in 0..offset + errors.len() {
        let of = |j: usize| j.checked_sub(offset).and_then(|j| errors.get(j));
        let Some(error) = of(j + lead) else { continue };
        // What was out before the first cell is not known: it teaches nothing.
        if j >= offset {
            v[j] = (1.0 - forgetting) * u[j] + gain * error;
        }
        if let Some(s) = j.checked_sub(half) {
            u[s + cells] = (s.saturating_sub(half)..=s + half)
                .map(|k| (width - k.abs_diff(s) as f64) / (width * width) * v[k])
                .sum();
        }
    }
    let mut all = vec![0.0; cells];
    // The newest that is finished is of the next cycle.
    let newest = offset + errors.len() + cells - lead - half;
    for j in newest - cells..newest {
        all[(j + cells * 8 - offset) % cells] = u[j];
    }
    all
}

proptest! {
    #[test]
    fn a_ring_of_cells_learns_what_an_endless_row_of_them_does(
        errors in prop::collection::vec(-3.0..3.0_f64, 41..150),
        shape in (0..6_u16, 0..4_u16, 0.0..0.5_f64, 0.1..2.0_f64),
        cells in 24..40_usize,
    ) {
        let (lead, half, forgetting, gain) = shape;
        let learning = learning(gain, lead, half).with_forgetting(forgetting).unwrap();
        let mut state = started(&learning, cells);
        pass(&learning, &mut state, (0, errors.len()), |cell, _| errors[cell]);
        // The last cell was not left.
        let numbers = (gain, usize::from(lead), usize::from(half), forgetting);
        let expected = unrolled(&errors[..errors.len() - 1], cells, numbers);
        for (own, expected) in state.learned().iter().zip(&expected) {
            // Sums of a hundred terms of at most 100.
            prop_assert!((own - expected).abs() < 1e-10, "{own} {expected}");
        }
    }
}

/// Fejér's kernel.
fn fejer(half_width: u16, turn: f64) -> f64 {
    let (m, x) = (f64::from(half_width) + 1.0, 0.5 * turn);
    ((m * x).sin() / (m * x.sin())).powi(2)
}

#[test]
fn the_filter_is_fejers_kernel_without_a_phase() {
    let (cells, pairs) = (120, [1, 3, 10, 30, 59]);
    let all = [0, 1, 2, 5, 11]
        .into_iter()
        .flat_map(|half| pairs.map(|cycles| (half, cycles)));
    for (half_width, cycles) in all {
        let turn = std::f64::consts::TAU * f64::from(cycles) / cells as f64;
        let learning = learning(1.0, 0, half_width);
        let mut state = started(&learning, cells);
        // Not the first cells, whose neighbours had learned nothing.
        let tone = |cell, _| (turn * (cell % cells) as f64).cos();
        pass(&learning, &mut state, (0, cells + 13), tone);
        let gain = fejer(half_width, turn);
        assert!((0.0..=1.0).contains(&gain));
        for (cell, learned) in state.learned().iter().enumerate().skip(20).take(60) {
            near(*learned, gain * (turn * cell as f64).cos(), 1e-12);
        }
    }
    // What the docs say of the corner.
    near(fejer(39, std::f64::consts::TAU * 0.32 / 40.0), 0.71, 0.005);
}

/// A plant that answers at once, `y = a·(u + d)` against a reference of one: what is left is
/// `(1 − gain·a)` of the error before.
#[test]
fn a_static_plant_is_learned_by_a_geometric_series() {
    let (a, gain) = (0.6, 0.5);
    let learning = learning(gain, 0, 0);
    let mut state = started(&learning, 40);
    let disturbance = |cell: usize| (cell % 40) as f64 * 0.05;
    for cycle in 0..30 {
        let left = (1.0 - gain * a).powi(cycle as i32);
        pass(
            &learning,
            &mut state,
            (40 * cycle, 40 * (cycle + 1)),
            |cell, own| {
                let error = 1.0 - a * (own + disturbance(cell));
                near(error, left * (1.0 - a * disturbance(cell)), 1e-12);
                error
            },
        );
    }
}

#[test]
fn what_is_learned_stops_at_the_limit_and_comes_back_at_once() {
    let learning = IterativeLearning::try_new(1.0, 2.5, 0, 1).unwrap();
    let mut state = started(&learning, 20);
    pass(&learning, &mut state, (0, 20 * 9), |_, _| 1.0);
    assert!(state.learned().iter().all(|u| *u == 2.5));
    pass(&learning, &mut state, (20 * 9, 20 * 10 + 1), |_, _| -1.0);
    // Around the start: both edges have neighbours of the other cycle.
    let learned = state.learned();
    assert_eq!((learned[0], learned[19]), (1.75, 2.25));
    assert!(learned[1..18].iter().all(|u| (u - 1.5).abs() < 1e-12));
}

#[test]
fn a_sample_that_is_not_to_be_learned_from_changes_nothing() {
    let learning = learning(1.0, 1, 2);
    let start: Vec<f64> = (0..30).map(|k| f64::from(k % 7)).collect();
    let mut state = learning.resume(start.clone(), vec![9.0; 30]).unwrap();
    for k in 0..3000 {
        let at = with(Input::new(f64::from(k % 300) / 300.0, 5.0, 0.0), |at| {
            at.learns = false
        });
        assert_eq!(learning.step(&mut state, &at).status, Status::Good);
    }
    assert_eq!(state.learned(), start);
}

#[test]
fn bad_samples_teach_nothing_and_the_phase_goes_on() {
    let learning = learning(1.0, 1, 1);
    let teach = |spoil: bool| {
        let mut state = started(&learning, 30);
        for k in 0..900_u32 {
            let good = Input::new(f64::from(k % 300) / 300.0, 1.0, 0.5);
            if spoil && k % 7 == 3 {
                let (held, before) = (state.feed_forward(), state.learned().to_vec());
                for phase in [f64::NAN, 1.0001, -0.0001, f64::INFINITY] {
                    let out = learning.step(&mut state, &with(good, |at| at.phase = phase));
                    let told = Status::Held(Fault::Phase);
                    assert_eq!((out.status, out.command), (told, held));
                }
                assert_eq!(state.learned(), before);
                let huge = Input::new(good.phase, f64::MAX, -f64::MAX);
                for (bad, fault) in [
                    (with(good, |at| at.measured = f64::NAN), Fault::Measured),
                    (
                        with(good, |at| at.reference = f64::INFINITY),
                        Fault::Reference,
                    ),
                    (huge, Fault::Overflow),
                ] {
                    let out = learning.step(&mut state, &bad);
                    assert_eq!(out.status, Status::Degraded(fault));
                }
            }
            assert_eq!(learning.step(&mut state, &good).status, Status::Good);
        }
        state.learned().to_vec()
    };
    assert_eq!(teach(true), teach(false));
}

#[test]
fn the_end_of_a_cycle_is_the_start_of_the_next() {
    let learning = learning(1.0, 0, 0);
    let start: Vec<f64> = (0..20).map(f64::from).collect();
    let mut state = learning.resume(start, vec![0.0; 20]).unwrap();
    let mut at = |phase| {
        learning
            .step(&mut state, &Input::new(phase, 0.0, 0.0))
            .command
    };
    // Halfway between the middles of the last cell and the first.
    assert_eq!((at(0.0), at(1.0), at(0.025)), (9.5, 9.5, 0.0));
    near(at(0.9999), 9.5, 0.1);
}

#[test]
fn a_phase_that_trembles_or_jumps_teaches_no_wrong_cell() {
    let learning = learning(1.0, 0, 0);
    let mut state = started(&learning, 100);
    let jumped = Status::Degraded(Fault::Phase);
    let mut step = |cell: usize, error: f64, expected| {
        let at = Input::new((cell as f64 + 0.5) / 100.0, error, 0.0);
        assert_eq!(learning.step(&mut state, &at).status, expected);
        state.learned().to_vec()
    };
    let good = Status::Good;
    // Forth and back at an edge: the cell behind is not learned twice, nor from later errors.
    for cell in [10, 11, 10, 11, 10, 11, 12] {
        step(cell, if cell == 10 { 1.0 } else { 2.0 }, good);
    }
    assert_eq!(step(12, 0.0, good)[10..13], [1.0, 2.0, 0.0]);
    // Over four cells: they learn what the last one had.
    step(13, 3.0, good);
    step(17, 0.0, good);
    assert_eq!(step(17, 0.0, good)[13..18], [3.0, 3.0, 3.0, 3.0, 0.0]);
    // Over five: a jump, which is told, and the cell that was left has learned nothing.
    step(18, 5.0, good);
    step(23, 1.0, jumped);
    let learned = step(24, 0.0, good);
    assert_eq!((learned[18], learned[22], learned[23]), (0.0, 0.0, 1.0));
    // The heel's contact ends a step early; the next one begins.
    step(93, 1.0, jumped);
    step(0, 4.0, jumped);
    step(1, 0.0, good);
    let learned = step(2, 0.0, good);
    assert_eq!((learned[93], learned[99], learned[0]), (0.0, 0.0, 4.0));
    // Four back is still a phase that trembles; what comes there is not gathered.
    step(40, 1.0, jumped);
    step(36, 9.0, good);
    step(41, 0.0, good);
    assert_eq!(step(42, 0.0, good)[40], 1.0);
    // Five back is a jump, and so is far.
    step(37, 0.0, jumped);
    step(90, 7.0, jumped);
}

/// Steps that end early, with a plant that answers `lead` cells late against a load of one: what comes
/// after the usual end is not wound up by errors that others made.
#[test]
fn after_a_step_that_ended_early_no_cell_learns_that_was_not_passed() {
    let (cells, lead) = (100, 3);
    for (half_width, sure) in [(0, 0..85), (2, 20..65)] {
        let learning = learning(0.5, lead as u16, half_width);
        let mut state = started(&learning, cells);
        let mut late = std::collections::VecDeque::from(vec![0.0; lead]);
        let mut step = |state: &mut Cells, end: usize| {
            (0..end).fold(0.0_f64, |worst, cell| {
                let output = late.pop_front().unwrap();
                let at = Input::new((cell as f64 + 0.5) / cells as f64, 1.0, output);
                late.push_back(learning.step(state, &at).command);
                worst.max((output - 1.0).abs())
            })
        };
        for _ in 0..200 {
            step(&mut state, 90);
        }
        // But for the edges, into which the filter carries the cells that learn nothing.
        let learned = state.learned();
        assert!(learned[sure].iter().all(|u| (u - 1.0).abs() < 1e-3));
        assert!(learned.iter().all(|u| (0.0..=1.0 + 1e-9).contains(u)));
        // A whole one goes on with what it has learned, and learns the rest.
        for _ in 0..201 {
            step(&mut state, cells);
        }
        assert!(step(&mut state, cells) < 1e-3);
    }
}

#[test]
fn what_was_out_while_nothing_was_to_be_learned_teaches_nothing_later_either() {
    let (cells, lead) = (60_u32, 4_u16);
    let learning = learning(1.0, lead, 0);
    let mut state = started(&learning, 60);
    // One sample of four in cell 20, which is learned from as ever, and all of 30 to 32; the last of
    // them at a phase that is none.
    for k in 0..cells * 4 + 2 {
        let (cell, part) = (k / 4, k % 4);
        let phase = (f64::from(k % (4 * cells)) + 0.5) / f64::from(4 * cells);
        let lost = cell == 32 && part == 3;
        let mut at = Input::new(if lost { f64::NAN } else { phase }, 1.0, 0.0);
        at.learns = !(k == 81 || (30..33).contains(&cell));
        learning.step(&mut state, &at);
    }
    for (cell, learned) in state.learned().iter().enumerate() {
        // Neither these cells, nor those whose errors came in them; nor those whose errors come after
        // the end of the cycle.
        let taught = !matches!(cell, 26..=32 | 56..);
        assert_eq!(*learned, f64::from(u8::from(taught)), "{cell}");
    }
}

#[test]
fn a_cell_that_somebody_stands_in_for_hours_learns_the_mean_of_its_first_samples() {
    let learning = IterativeLearning::try_new(1.0_f32, 30.0, 0, 0).unwrap();
    let mut state = learning.start([0.0; 9], [0.0; 9]).unwrap();
    for _ in 0..36_000_000 {
        learning.step(&mut state, &Input::new(0.5, 0.01, 0.0));
    }
    learning.step(&mut state, &Input::new(0.6, 0.0, 0.0));
    // 65 536 additions of a float of 24 digits: a few thousandths in the worst case.
    near(f64::from(state.learned()[4]) / 0.01, 1.0, 4e-3);
}

#[test]
fn what_was_resumed_stays_where_there_is_no_error() {
    let learning = learning(1.0, 2, 2);
    let mut state = learning.resume(vec![3.0; 30], vec![0.0; 30]).unwrap();
    pass(&learning, &mut state, (0, 90), |_, _| 0.0);
    assert!(state.learned().iter().all(|u| (u - 3.0).abs() < 1e-12));
}

#[test]
fn more_cells_than_samples_can_follow_are_told_at_once() {
    let learning = learning(1.0, 0, 0);
    let mut state = started(&learning, 1000);
    // A hundred samples a cycle pass over ten cells each.
    for k in 0..100 {
        let at = Input::new(f64::from(k) / 100.0, 1.0, 0.0);
        let status = learning.step(&mut state, &at).status;
        assert_eq!(status == Status::Degraded(Fault::Phase), k > 0);
    }
    assert!(state.learned().iter().all(|u| *u == 0.0));
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    use Error::{Inadmissible, NonFinite, OutOfRange};
    for (gain, limit, error) in [
        (0.0, 1.0, Some(OutOfRange("gain"))),
        (f64::NAN, 1.0, Some(NonFinite("gain"))),
        (1.0, 0.0, Some(OutOfRange("limit"))),
        (1.0, f64::INFINITY, Some(NonFinite("limit"))),
        (-1.0, 1.0, None), // a drive that turns the other way
    ] {
        assert_eq!(IterativeLearning::try_new(gain, limit, 1, 1).err(), error);
    }
    let learning = learning(1.0, 3, 2);
    for (share, expected) in [
        (f64::NAN, NonFinite("forgetting")),
        (-0.1, OutOfRange("forgetting")),
        (1.1, OutOfRange("forgetting")),
    ] {
        assert_eq!(learning.with_forgetting(share), Err(expected));
    }
    assert_eq!(learning.fewest_cells(), 16);
    let few = "the lead and the filter need more cells";
    for (first, second, error) in [
        (16, 16, None),
        (
            16,
            17,
            Some(Inadmissible("both buffers must have the same length")),
        ),
        (15, 15, Some(Inadmissible(few))),
        (65_536, 65_536, Some(Error::Capacity("cells"))),
    ] {
        let started = learning.start(vec![0.0; first], vec![0.0; second]);
        assert_eq!(started.err(), error);
    }
}

#[test]
fn what_was_stored_is_confined_and_goes_on() {
    let learning = IterativeLearning::try_new(1.0_f32, 3.0, 1, 1).unwrap();
    let mut own = [0.0; 12];
    own[..5].copy_from_slice(&[1.0, -7.0, f32::NAN, f32::INFINITY, 2.0]);
    let mut state = learning.resume(own, [f32::NAN; 12]).unwrap();
    assert_eq!(state.learned()[..5], [1.0, -3.0, 0.0, 3.0, 2.0]);
    let out = learning.step(&mut state, &Input::new(0.5 / 12.0, 0.0, 0.0));
    assert_eq!(out.command, 1.0);
}

#[test]
fn it_can_live_in_flash() {
    in_flash!(f32: IterativeLearning::try_new(4.0, 30.0, 2, 2).with_forgetting(0.01););
}

#[cfg(feature = "serde")]
#[test]
fn what_is_stored_is_checked_when_it_is_read() {
    let own = learning(4.0, 2, 2).with_forgetting(0.25).unwrap();
    reads_back(&own, &[("4.0", "0.0"), ("0.25", "1.25"), ("lead", "leads")]);
}
