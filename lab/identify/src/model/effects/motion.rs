//! Effects of moving channels and of the input torque.

use super::Scale::{Number, PerReach, Reach, Speed};
use super::{
    on, Bounds, Declared, Entry, FittedZero, On, Place, ToldBy, Trials, Zero, AS_IT_IS,
    BOTH_DIRECTIONS, PLAIN,
};
use std::f64::consts::PI;

// Motions that show several effects.
const SLOW_STROKES: &str = "slow strokes over the whole range of position";
const LOADS: &str = "the same motion under several loads";
const HELD_END: &str = "motion of one end with the other end held fixed, up to the largest load";

/// Above this width the effect is a bent viscous term instead of dry friction.
const SMOOTH_SIGN: Bounds = Bounds::Speed(1e-3, 0.15);
/// Stribeck friction is a matter of low speed.
const LOW_SPEED: Bounds = Bounds::Speed(1e-2, 0.5);
/// Half the width of a play, or the stretch at which a spring slips.
const HALF_WIDTH: Bounds = Bounds::Reach(2e-3, 1.9);

/// The mirror images of 0.8 and 0.92.
const LOWER: &[f64] = &[1.0 - 0.8, 1.0 - 0.92];

/// In the order in which they are tried.
pub(super) const MOTION: &[Entry] = &[
    Entry {
        name: "viscous",
        rank: 2,
        tried: &[
            on(Place::Motion, AS_IT_IS),
            on(Place::TorqueAlone, AS_IT_IS),
        ],
        shown_by: "speeds that vary tenfold",
        takes_energy: true,
        ..PLAIN
    },
    Entry {
        name: "drag-quadratic",
        rank: 13,
        tried: &[on(Place::Motion, AS_IT_IS)],
        shown_by: "speeds up to the rig's maximum",
        ..PLAIN
    },
    Entry {
        name: "drag-cubic",
        rank: 13,
        tried: &[on(Place::Motion, AS_IT_IS)],
        shown_by: "speeds up to the rig's maximum",
        ..PLAIN
    },
    // In no first scan: it lies between viscous and Coulomb friction, and the search asks of it
    // where one of them is named (`search::exchange`).
    Entry {
        name: "power-law",
        rank: 13,
        declared: Declared::OnChannel(&[Number(0.5)]),
        bounds: &[Bounds::Linear(0.1, 0.9)],
        on: &[On::Read, On::Reversal],
        shown_by: "speeds that vary tenfold",
        takes_energy: true,
        ..PLAIN
    },
    Entry {
        name: "coulomb",
        rank: 3,
        tried: &[on(
            Place::Motion,
            Trials::At(&[&[Speed(0.01)], &[Speed(0.08)]]),
        )],
        declared: Declared::OnChannel(&[Speed(0.05)]),
        bounds: &[SMOOTH_SIGN],
        on: &[On::Read, On::Reversal],
        shown_by: "slow and fast zero crossings of the velocity",
        takes_energy: true,
        ..PLAIN
    },
    Entry {
        name: "stribeck",
        rank: 21,
        tried: &[on(
            Place::Motion,
            Trials::At(&[
                &[Speed(0.05), Number(1.0)],
                &[Speed(0.15), Number(1.0)],
                &[Speed(0.4), Number(1.0)],
            ]),
        )],
        declared: Declared::OnChannel(&[Speed(0.3), Number(1.0)]),
        bounds: &[LOW_SPEED, Bounds::Linear(0.5, 3.0)],
        on: &[On::Read, On::Reversal],
        shown_by: "slow motion at constant speeds below and above v_s",
        ..PLAIN
    },
    Entry {
        name: "asymmetry-viscous",
        rank: 12,
        tried: &[on(Place::Motion, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: BOTH_DIRECTIONS,
        ..PLAIN
    },
    Entry {
        name: "asymmetry-drag",
        rank: 12,
        tried: &[on(Place::Motion, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: BOTH_DIRECTIONS,
        ..PLAIN
    },
    Entry {
        name: "inertia",
        rank: 4,
        tried: &[on(Place::Motion, AS_IT_IS)],
        shown_by: "the same speeds at several accelerations",
        ..PLAIN
    },
    Entry {
        name: "stiffness-linear",
        rank: 7,
        tried: &[on(Place::Motion, AS_IT_IS)],
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "stiffness-quadratic",
        rank: 7,
        tried: &[on(Place::Motion, AS_IT_IS), on(Place::Torque, AS_IT_IS)],
        shown_by: SLOW_STROKES,
        fitted_zero: FittedZero::Unless(&["stiffness-linear"]),
        ..PLAIN
    },
    Entry {
        name: "stiffness-cubic",
        rank: 7,
        tried: &[on(Place::Motion, AS_IT_IS), on(Place::Torque, AS_IT_IS)],
        shown_by: SLOW_STROKES,
        fitted_zero: FittedZero::Unless(&["stiffness-linear", "stiffness-quadratic"]),
        ..PLAIN
    },
    Entry {
        name: "stiffness-progressive",
        rank: 7,
        tried: &[on(Place::Motion, AS_IT_IS), on(Place::Torque, AS_IT_IS)],
        shown_by: SLOW_STROKES,
        fitted_zero: FittedZero::Always,
        ..PLAIN
    },
    Entry {
        name: "stretch-linear",
        rank: 7,
        tried: &[on(Place::Stretch, AS_IT_IS)],
        declared: Declared::OnStretch,
        shown_by: HELD_END,
        ..PLAIN
    },
    Entry {
        name: "stretch-cubic",
        rank: 7,
        tried: &[on(Place::Stretch, AS_IT_IS)],
        declared: Declared::OnStretch,
        shown_by: HELD_END,
        fitted_zero: FittedZero::Always,
        ..PLAIN
    },
    Entry {
        name: "hinge",
        rank: 7,
        tried: &[on(Place::Motion, Trials::Quantiles(&[0.25, 0.5, 0.75]))],
        declared: Declared::OnChannel(&[Number(0.0)]),
        bounds: &[Bounds::WithinReach],
        several: true,
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "saturation-upper",
        rank: 17,
        tried: &[
            on(Place::Motion, Trials::Quantiles(&[0.8, 0.92])),
            on(Place::Torque, Trials::Quantiles(&[0.8, 0.92])),
        ],
        declared: Declared::OnChannel(&[Number(0.0)]),
        bounds: &[Bounds::WithinReach],
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "saturation-lower",
        rank: 17,
        tried: &[
            on(Place::Motion, Trials::Quantiles(LOWER)),
            on(Place::Torque, Trials::Quantiles(LOWER)),
        ],
        declared: Declared::OnChannel(&[Number(0.0)]),
        bounds: &[Bounds::WithinReach],
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "gravity",
        rank: 8,
        tried: &[on(
            Place::Joint,
            Trials::At(&[
                &[Number(0.0)],
                &[Number(0.25 * PI)],
                &[Number(0.5 * PI)],
                &[Number(0.75 * PI)],
            ]),
        )],
        declared: Declared::OnChannel(&[Number(0.0)]),
        bounds: &[Bounds::Phase],
        zero: Zero::Sensor,
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "position-friction",
        rank: 16,
        tried: &[on(
            Place::Motion,
            Trials::At(&[&[Speed(0.01)], &[Speed(0.08)]]),
        )],
        declared: Declared::OnChannel(&[Speed(0.05)]),
        bounds: &[SMOOTH_SIGN],
        on: &[On::DirectedPosition],
        shown_by: "short strokes at several positions",
        fitted_zero: FittedZero::Unless(&["coulomb"]),
        ..PLAIN
    },
    Entry {
        name: "position-hysteresis",
        rank: 16,
        // Of the torque itself: the friction of a cable grows with its tension. Of a temperature: a
        // lubricant gets thinner.
        tried: &[
            on(Place::Motion, AS_IT_IS),
            on(Place::Torque, AS_IT_IS),
            on(Place::Temperature, AS_IT_IS),
        ],
        on: &[On::DirectedPosition],
        shown_by: "short strokes at several positions",
        ..PLAIN
    },
    Entry {
        name: "load-friction",
        rank: 14,
        tried: &[on(Place::LoadedMotion, Trials::At(&[&[Speed(0.05)]]))],
        declared: Declared::OnChannel(&[Speed(0.05)]),
        bounds: &[SMOOTH_SIGN],
        on: &[On::DirectedLoad],
        shown_by: LOADS,
        ..PLAIN
    },
    Entry {
        name: "drive-friction",
        rank: 18,
        tried: &[on(Place::LoadedMotion, Trials::At(&[&[Speed(0.05)]]))],
        declared: Declared::OnChannel(&[Speed(0.05)]),
        bounds: &[SMOOTH_SIGN],
        on: &[On::DirectedLoad],
        shown_by: LOADS,
        ..PLAIN
    },
    Entry {
        name: "back-drive-friction",
        rank: 18,
        tried: &[on(Place::LoadedMotion, Trials::At(&[&[Speed(0.05)]]))],
        declared: Declared::OnChannel(&[Speed(0.05)]),
        bounds: &[SMOOTH_SIGN],
        on: &[On::DirectedLoad],
        shown_by: LOADS,
        ..PLAIN
    },
    Entry {
        name: "capstan",
        rank: 19,
        tried: &[on(
            Place::LoadedMotion,
            Trials::At(&[&[Speed(0.05), PerReach(0.2)]]),
        )],
        declared: Declared::OnChannel(&[Speed(0.05), PerReach(0.2)]),
        bounds: &[SMOOTH_SIGN, Bounds::PerReach(1e-3, 3.0)],
        on: &[On::DirectedLoad],
        shown_by: LOADS,
        fitted_zero: FittedZero::Always,
        ..PLAIN
    },
    Entry {
        name: "backlash",
        rank: 22,
        tried: &[
            on(
                Place::Motion,
                Trials::At(&[&[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)]]),
            ),
            on(
                Place::Torque,
                Trials::At(&[&[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)]]),
            ),
        ],
        declared: Declared::OnChannel(&[Reach(0.1)]),
        bounds: &[HALF_WIDTH],
        on: &[On::Reversal, On::Position],
        past: true,
        shown_by: "reversals with strokes shorter and longer than the play",
        ..PLAIN
    },
    Entry {
        name: "play-in-series",
        rank: 22,
        tried: &[on(
            Place::InputMotion,
            Trials::At(&[&[Reach(0.01)], &[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)]]),
        )],
        declared: Declared::OnInput(&[Reach(0.1)]),
        bounds: &[HALF_WIDTH],
        on: &[On::Reversal, On::Position],
        past: true,
        shown_by: "reversals with strokes shorter and longer than the play",
        ..PLAIN
    },
    Entry {
        name: "dead-zone",
        rank: 22,
        tried: &[
            on(
                Place::Motion,
                Trials::At(&[
                    &[Reach(0.08)],
                    &[Reach(0.16)],
                    &[Reach(0.3)],
                    &[Reach(0.55)],
                ]),
            ),
            on(
                Place::Torque,
                Trials::At(&[&[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)]]),
            ),
        ],
        declared: Declared::OnChannel(&[Reach(0.1)]),
        bounds: &[HALF_WIDTH],
        on: &[On::Reversal, On::Position],
        shown_by: "reversals with strokes shorter and longer than the play",
        fitted_zero: FittedZero::Always,
        ..PLAIN
    },
    Entry {
        name: "presliding",
        rank: 23,
        tried: &[
            on(
                Place::Motion,
                Trials::At(&[
                    &[Reach(0.01)],
                    &[Reach(0.03)],
                    &[Reach(0.1)],
                    &[Reach(0.3)],
                    &[Reach(0.8)],
                ]),
            ),
            on(
                Place::Torque,
                Trials::At(&[&[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)], &[Reach(0.8)]]),
            ),
        ],
        declared: Declared::OnChannel(&[Reach(0.1)]),
        bounds: &[HALF_WIDTH],
        on: &[On::Reversal],
        several: true,
        past: true,
        shown_by: "small reversals inside large strokes",
        ..PLAIN
    },
    Entry {
        name: "presliding-dahl",
        rank: 23,
        tried: &[
            on(
                Place::Motion,
                Trials::At(&[
                    &[Reach(0.01)],
                    &[Reach(0.03)],
                    &[Reach(0.1)],
                    &[Reach(0.3)],
                    &[Reach(0.8)],
                ]),
            ),
            on(
                Place::Torque,
                Trials::At(&[&[Reach(0.03)], &[Reach(0.1)], &[Reach(0.3)], &[Reach(0.8)]]),
            ),
        ],
        declared: Declared::Never,
        bounds: &[HALF_WIDTH],
        on: &[On::Reversal],
        several: true,
        past: true,
        shown_by: "small reversals inside large strokes",
        ..PLAIN
    },
    // The two segments of a curve. The search has curves of its own (`model::Table`), which a model
    // file gives as these.
    Entry {
        name: "curve-position",
        rank: 30,
        declared: Declared::Never,
        bounds: &[Bounds::Held, Bounds::Held],
        shown_by: SLOW_STROKES,
        ..PLAIN
    },
    Entry {
        name: "curve-velocity",
        rank: 30,
        declared: Declared::Never,
        bounds: &[Bounds::Held, Bounds::Held],
        shown_by: "speeds that vary tenfold",
        ..PLAIN
    },
    // Only where asked for: on a record that saturates it is a worse Bouc-Wen.
    Entry {
        name: "hardening",
        rank: 29,
        declared: Declared::OnChannel(&[PerReach(0.3), PerReach(1.0)]),
        bounds: &[Bounds::PerReach(1e-3, 10.0), Bounds::PerReach(1e-3, 30.0)],
        on: &[On::Read, On::Reversal],
        past: true,
        shown_by: "strokes of several lengths, the longest over the whole range",
        ..PLAIN
    },
    Entry {
        name: "creep",
        rank: 24,
        tried: &[
            on(Place::Motion, Trials::TimeConstants(&[0.1, 1.0, 10.0])),
            on(Place::Torque, Trials::TimeConstants(&[0.1, 1.0, 10.0])),
        ],
        declared: Declared::OnChannel(&[Number(1.0)]),
        bounds: &[Bounds::SamplesToRecord(0.5, 0.5)],
        on: &[On::Reversal],
        past: true,
        shown_by: "steps with holds of several time constants",
        ..PLAIN
    },
    Entry {
        name: "ripple",
        rank: 27,
        tried: &[on(Place::Motion, Trials::Orders)],
        declared: Declared::Never,
        bounds: &[Bounds::Value(0.8, 1.25), Bounds::Phase],
        several: true,
        shown_by: SLOW_STROKES,
        told_by: ToldBy::Order,
        ..PLAIN
    },
    Entry {
        name: "rate",
        rank: 20,
        tried: &[on(Place::Motion, AS_IT_IS), on(Place::Torque, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: "the same stroke at several speeds",
        ..PLAIN
    },
    Entry {
        name: "rate-symmetric",
        rank: 20,
        tried: &[on(Place::Motion, AS_IT_IS), on(Place::Torque, AS_IT_IS)],
        on: &[On::Read, On::Reversal],
        shown_by: "the same stroke at several speeds",
        ..PLAIN
    },
];
