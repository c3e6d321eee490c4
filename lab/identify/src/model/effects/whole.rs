//! Effects of the model as a whole, of time, of a temperature and of other channels.

use super::Scale::{Middle, Number, Path, Stroke};
use super::{
    on, Bounds, Declared, Entry, On, Place, Stage, ToldBy, Trials, Zero, AS_IT_IS, BOTH_DIRECTIONS,
    PLAIN,
};

// Motions that show several effects.
const FASTER: &str = "faster motion: several sinusoids up to the cut-off frequency";
const LONGER: &str = "a longer record";

/// A lag slower than the motion is creep or drift under another name.
const LAG: Bounds = Bounds::SamplesToStrokes(0.2, 3.0);

/// In the order in which they are tried.
pub(super) const WHOLE: &[Entry] = &[
    Entry {
        name: "offset",
        rank: 0,
        tried: &[on(Place::Whole, AS_IT_IS)],
        declared: Declared::OnInput(&[]),
        ..PLAIN
    },
    Entry {
        name: "gain",
        rank: 1,
        tried: &[on(Place::WholeWithoutTransmission, AS_IT_IS)],
        declared: Declared::OnInput(&[]),
        ..PLAIN
    },
    Entry {
        name: "delay",
        rank: 5,
        tried: &[on(Place::Whole, AS_IT_IS)],
        declared: Declared::OnInput(&[]),
        stage: Some(Stage::Periods(2.0)),
        on: &[On::Read, On::Reversal],
        shown_by: FASTER,
        ..PLAIN
    },
    Entry {
        name: "lag",
        rank: 6,
        tried: &[on(
            Place::Whole,
            Trials::At(&[&[Stroke(0.02)], &[Stroke(0.2)], &[Stroke(1.0)]]),
        )],
        declared: Declared::OnInput(&[Stroke(1.0)]),
        bounds: &[LAG],
        stage: Some(Stage::Number(1.0)),
        on: &[On::Read, On::Reversal],
        shown_by: FASTER,
        ..PLAIN
    },
    Entry {
        name: "asymmetry-eta",
        rank: 12,
        tried: &[on(Place::Whole, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: BOTH_DIRECTIONS,
        ..PLAIN
    },
    Entry {
        name: "asymmetry-eta-squared",
        rank: 12,
        tried: &[on(Place::Whole, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: BOTH_DIRECTIONS,
        ..PLAIN
    },
    Entry {
        name: "degradation",
        rank: 26,
        tried: &[on(Place::Whole, Trials::At(&[&[Path(0.1)], &[Path(1.0)]]))],
        declared: Declared::OnChannel(&[Path(1.0)]),
        bounds: &[Bounds::Path(0.01, 30.0)],
        of_the_record: Some("depends on the travel since the start of this record"),
        shown_by: "a longer record, with many full strokes",
        ..PLAIN
    },
    Entry {
        name: "pinching",
        rank: 25,
        tried: &[on(
            Place::Whole,
            Trials::At(&[&[Number(0.2)], &[Number(0.5)]]),
        )],
        declared: Declared::OnChannel(&[Number(0.3)]),
        bounds: &[Bounds::Number(0.03, 3.0)],
        on: &[On::Read, On::Reversal],
        shown_by: "full strokes, and strokes that reverse near the centre",
        ..PLAIN
    },
    Entry {
        name: "drift",
        rank: 10,
        tried: &[on(Place::Whole, AS_IT_IS)],
        declared: Declared::OnInput(&[]),
        of_the_record: Some("a function of the time since the start of this record"),
        shown_by: LONGER,
        ..PLAIN
    },
    Entry {
        name: "pretension",
        rank: 11,
        tried: &[on(Place::Whole, Trials::Moments)],
        declared: Declared::Never,
        bounds: &[Bounds::FitSegment],
        several: true,
        of_the_record: Some(
            "a step at one time in this record (the model describes the time after the step)",
        ),
        shown_by: "the same amount of motion before and after the step",
        ..PLAIN
    },
    Entry {
        name: "temperature",
        rank: 9,
        tried: &[on(Place::Temperature, Trials::At(&[&[Middle]]))],
        declared: Declared::OnChannel(&[Middle]),
        bounds: &[Bounds::Held],
        zero: Zero::Sensor,
        shown_by: "the same motion over a wider temperature range",
        ..PLAIN
    },
    Entry {
        name: "crosstalk",
        rank: 15,
        tried: &[on(Place::Other, AS_IT_IS)],
        shown_by: "motion of that channel that is independent of the input",
        ..PLAIN
    },
    Entry {
        name: "tone",
        rank: 28,
        declared: Declared::Never,
        bounds: &[Bounds::Value(0.97, 1.03), Bounds::Phase],
        of_the_record: Some("a function of time only, with the phase of this record"),
        shown_by: LONGER,
        told_by: ToldBy::Frequency,
        ..PLAIN
    },
];
