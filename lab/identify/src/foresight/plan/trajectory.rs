//! The predefined trajectories, built from the record's own signals.
//!
//! The speed is changed, strokes are scaled, or phases are drawn at random. All signals of the
//! record are transformed together, so their relations on the rig are kept.

use crate::problem::{Preparation, Prepared};
use crate::record::{Column, Record};
use bowden_fourier::{Complex, Transform};
use std::f64::consts::{PI, TAU};

/// The kind of motion of a planned experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The recorded motion at half its speed.
    Slower,
    /// The recorded motion at twice its speed, forward and backward.
    Faster,
    /// One and a half times the distance from the middle.
    LargerStroke,
    /// Two fifths of the distance from the middle.
    SmallerStroke,
    /// The stroke varies between a tenth and the whole.
    SweptStroke,
    /// The same motion about a centre that is shifted by half the half-range.
    OffsetCentre,
    /// The motion stops repeatedly.
    HoldAndWait,
    /// The speed varies slowly between half and double.
    MixedPace,
    /// The recorded spectrum with random phases.
    Multisine,
}

impl Kind {
    /// All kinds; among equals, the earlier one is chosen.
    pub const ALL: [Self; 9] = [
        Self::Slower,
        Self::Faster,
        Self::LargerStroke,
        Self::SmallerStroke,
        Self::SweptStroke,
        Self::OffsetCentre,
        Self::HoldAndWait,
        Self::MixedPace,
        Self::Multisine,
    ];
}

/// A kind of motion, and the record that it is built from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Way {
    /// Index of this record among the records that were identified together.
    pub record: usize,
    /// How it moves.
    pub kind: Kind,
}

impl Way {
    /// Every kind of motion of every record; among equals, the earlier one is chosen.
    #[must_use]
    pub fn all(data: &Prepared) -> Vec<Self> {
        let records = 0..data.pieces.len().max(1);
        let of = |record| Kind::ALL.map(|kind| Self { record, kind });
        records.flat_map(of).collect()
    }
}

/// The longest hold and the shortest \[s\]: creep of seconds shows, a rig is not blocked.
const HOLD: (f64, f64) = (0.5, 5.0);

/// A planned motion: every signal of the record on a uniform time.
#[derive(Debug, Clone)]
pub struct Trajectory {
    /// Its kind, and the record that it is built from.
    pub way: Way,
    /// The motion in words, with its parameters.
    pub words: String,
    /// Step \[s\].
    pub step: f64,
    /// Name, unit and values: the input first, then the channels.
    pub signals: Vec<Column>,
}

/// The recorded signals, and the record's own time scale.
struct Source<'a> {
    data: &'a Prepared,
    signals: Vec<Vec<f64>>,
    /// Time in which the usual speed covers the half-range \[s\].
    stroke_time: f64,
    seconds: f64,
}

/// Value between samples by the cubic through the neighbours (Catmull and Rom).
fn between(signal: &[f64], at: f64) -> f64 {
    let last = signal.len() - 1;
    let at = at.clamp(0.0, last as f64);
    let i = (at as usize).min(last.saturating_sub(1));
    let u = at - i as f64;
    let p = |k: usize| signal[k.min(last)];
    let (a, b, c, d) = (p(i.saturating_sub(1)), p(i), p(i + 1), p(i + 2));
    let (m, n) = (0.5 * (c - a), 0.5 * (d - b));
    let (u2, u3) = (u * u, u * u * u);
    (2.0 * u3 - 3.0 * u2 + 1.0) * b
        + (u3 - 2.0 * u2 + u) * m
        + (3.0 * u2 - 2.0 * u3) * c
        + (u3 - u2) * n
}

impl Source<'_> {
    /// All signals along another time; at the ends it turns smoothly and goes back.
    fn warped(&self, seconds: f64, pace: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let dt = self.data.dt;
        let width = 0.25 * self.stroke_time;
        // acos((1 − d) cos) is a triangle with corners rounded over sqrt(2 d)/pi of a period.
        let round = (0.5 * (PI * width / self.seconds).powi(2)).min(0.05);
        let mut own = 0.0;
        let times: Vec<f64> = (0..(seconds / dt) as usize)
            .map(|i| {
                let now = own;
                own += dt * pace(i as f64 * dt);
                let turned = ((1.0 - round) * (PI * now / self.seconds).cos()).acos();
                turned / PI * self.seconds / dt
            })
            .collect();
        self.signals
            .iter()
            .map(|s| times.iter().map(|&t| between(s, t)).collect())
            .collect()
    }

    /// The signals that are commanded or move along, changed; the others as recorded.
    fn moved(&self, change: impl Fn(usize, f64, f64, f64) -> f64) -> Vec<Vec<f64>> {
        let data = self.data;
        let channels = std::iter::once(&data.input).chain(&data.channels);
        self.signals
            .iter()
            .zip(channels)
            .enumerate()
            .map(|(index, (signal, channel))| {
                if !moves(index, &channel.name) {
                    return signal.clone();
                }
                let values = signal.iter().enumerate();
                values
                    .map(|(i, &x)| change(i, x, channel.middle, channel.reach))
                    .collect()
            })
            .collect()
    }

    fn scaled(&self, factor: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let dt = self.data.dt;
        self.moved(|i, x, middle, _| middle + factor(i as f64 * dt) * (x - middle))
    }

    /// Random phases, the same for all signals at each frequency, so that linear relations between
    /// the signals are kept. The signals are scaled so that none leaves its recorded range.
    fn multisine(&self) -> Vec<Vec<f64>> {
        let n = self.signals[0].len();
        let (there, back) = (Transform::forward(n), Transform::inverse(n));
        let fade = |i: usize| {
            let end = (i.min(n - 1 - i) as f64 / (0.1 * n as f64)).min(1.0);
            0.5 - 0.5 * (PI * end).cos()
        };
        let draw = |signal: &[f64], middle: f64| -> Vec<f64> {
            let faded = signal.iter().enumerate();
            let mut spectrum: Vec<_> = faded
                .map(|(i, x)| Complex::new(fade(i) * (x - middle), 0.0))
                .collect();
            there.apply(&mut spectrum);
            for k in 1..n.div_ceil(2) {
                // Squares times the golden ratio: spread evenly over the turn, and the same always.
                let phase = TAU * (k as f64 * k as f64 * 0.618_033_988_749_895).fract();
                let turned = spectrum[k] * Complex::from_polar(1.0, phase);
                spectrum[k] = turned;
                spectrum[n - k] = turned.conj();
            }
            back.apply(&mut spectrum);
            spectrum.iter().map(|c| c.re / n as f64).collect()
        };
        let channels = || std::iter::once(&self.data.input).chain(&self.data.channels);
        let drawn: Vec<Vec<f64>> = self
            .signals
            .iter()
            .zip(channels())
            .map(|(s, c)| draw(s, c.middle))
            .collect();
        let mut factor = f64::INFINITY;
        for (index, (signal, channel)) in drawn.iter().zip(channels()).enumerate() {
            let peak = signal.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if moves(index, &channel.name) && peak > 0.0 {
                factor = factor.min(channel.reach / peak);
            }
        }
        let mut planned = drawn.into_iter().zip(channels()).enumerate();
        planned
            .by_ref()
            .map(|(index, (signal, channel))| {
                if moves(index, &channel.name) && factor.is_finite() {
                    let middle = channel.middle;
                    signal.iter().map(|x| middle + factor * x).collect()
                } else {
                    self.signals[index].clone()
                }
            })
            .collect()
    }

    /// The signals of a kind of motion, and the kind in words with its parameters.
    fn played(&self, kind: Kind) -> (Vec<Vec<f64>>, String) {
        let seconds = self.seconds;
        let unit = self.data.input.unit.as_deref().unwrap_or("");
        let reach = |factor: f64| format!("{:.3} {unit}", factor * self.data.input.reach);
        match kind {
            Kind::Slower => (
                self.warped(2.0 * seconds, |_| 0.5),
                "slower: the recorded motion at half its speed".to_owned(),
            ),
            Kind::Faster => (
                self.warped(seconds, |_| 2.0),
                "faster: the recorded motion at twice its speed, forward and backward".to_owned(),
            ),
            Kind::LargerStroke => (
                self.scaled(|_| 1.5),
                format!("larger stroke: ×1.5, ± {}", reach(1.5)),
            ),
            Kind::SmallerStroke => (
                self.scaled(|_| 0.4),
                format!("smaller stroke: ×0.4, ± {}", reach(0.4)),
            ),
            Kind::SweptStroke => (
                self.scaled(|t| 0.55 - 0.45 * (6.0 * TAU * t / seconds).cos()),
                format!(
                    "swept stroke: ± {} to ± {} and back, six times",
                    reach(0.1),
                    reach(1.0)
                ),
            ),
            Kind::OffsetCentre => (
                self.moved(|_, x, _, reach| x + 0.5 * reach),
                format!(
                    "offset centre: the recorded motion shifted by {}",
                    reach(0.5)
                ),
            ),
            Kind::HoldAndWait => self.with_holds(),
            Kind::MixedPace => (
                self.warped(1.25 * seconds, |t| {
                    2.0_f64.powf((5.0 * TAU * t / (1.25 * seconds)).sin())
                }),
                "mixed speed: varied between 0.5× and 2× the recorded speed, in five cycles"
                    .to_owned(),
            ),
            Kind::Multisine => (
                self.multisine(),
                "multisine: the recorded spectrum with random phases, inside the recorded range"
                    .to_owned(),
            ),
        }
    }

    /// The recorded motion, interrupted by rests.
    fn with_holds(&self) -> (Vec<Vec<f64>>, String) {
        let hold = (4.0 * self.stroke_time).clamp(HOLD.0, HOLD.1);
        let go = 2.0 * hold;
        let brake = 0.25 * hold;
        let pace = move |t: f64| {
            let q = t % (go + hold);
            let edge = (q.min(go - q) / brake).clamp(0.0, 1.0);
            0.5 - 0.5 * (PI * edge).cos()
        };
        (
            self.warped(1.5 * self.seconds, pace),
            format!(
                "hold and wait: {go:.2} s of the recorded motion and {hold:.2} s of rest, repeated"
            ),
        )
    }
}

/// Whether a signal changes with the stroke: the input itself and angles.
fn moves(index: usize, name: &str) -> bool {
    index == 0 || name.starts_with("phi") || name.starts_with("angle")
}

/// The trajectory of a kind of motion, built from one of the records.
#[must_use]
pub fn trajectory(data: &Prepared, way: Way) -> Trajectory {
    let piece = data.pieces.get(way.record);
    let samples = piece.map_or(0..data.work_len(), |p| p.work.clone());
    let position = |c: &crate::problem::Channel| {
        let motion = c.motion[samples.clone()].iter();
        motion.map(|m| m.position).collect()
    };
    let source = Source {
        data,
        signals: std::iter::once(&data.input)
            .chain(&data.channels)
            .map(position)
            .collect(),
        stroke_time: data.input.reach / data.input.speed.max(1e-300),
        seconds: (samples.len() - 1) as f64 * data.dt,
    };
    let (signals, mut words) = source.played(way.kind);
    if let Some(piece) = piece.filter(|_| data.pieces.len() > 1) {
        words += &format!(" ({})", piece.path);
    }
    let channels = std::iter::once(&data.input).chain(&data.channels);
    Trajectory {
        way,
        words,
        step: data.dt,
        signals: signals
            .into_iter()
            .zip(channels)
            .map(|(values, channel)| Column {
                name: channel.name.clone(),
                unit: channel.unit.clone(),
                values,
                definition: channel.definition.clone(),
            })
            .collect(),
    }
}

impl Trajectory {
    /// The planned motion on the grids of a record; `None` if it is too short for them.
    #[must_use]
    pub fn prepared(&self, data: &Prepared) -> Option<Prepared> {
        let mut signals = self.signals.iter().cloned();
        let input = signals.next()?;
        let samples = input.values.len();
        let record = Record {
            path: String::new(),
            mode: data.mode,
            time: (0..samples).map(|i| i as f64 * self.step).collect(),
            output: Column {
                name: data.output_name.clone(),
                unit: data.output_unit.clone(),
                values: vec![0.0; samples],
                definition: None,
            },
            input,
            channels: signals.collect(),
            notes: Vec::new(),
            defects: Vec::new(),
            dropped: 0,
            held: Vec::new(),
        };
        let cutoff = Some(data.cutoff);
        Prepared::new(&record, Preparation { cutoff }).ok()
    }

    /// As CSV: `t [s]`, the reference of the input, then the assumed motion of the channels.
    #[must_use]
    pub fn csv(&self) -> String {
        use std::fmt::Write as _;
        let mut text = "t [s]".to_owned();
        for Column { name, unit, .. } in &self.signals {
            // Writing to a String cannot fail.
            let _ = match unit {
                Some(unit) => write!(text, ",{name} [{unit}]"),
                None => write!(text, ",{name}"),
            };
        }
        text.push('\n');
        let samples = self.signals.first().map_or(0, |s| s.values.len());
        for i in 0..samples {
            let _ = write!(text, "{}", digits(i as f64 * self.step));
            for signal in &self.signals {
                let _ = write!(text, ",{}", digits(signal.values[i]));
            }
            text.push('\n');
        }
        text
    }
}

/// Nine significant digits: more than any drive follows.
fn digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}
