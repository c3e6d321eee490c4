//! Output stages over several columns in parallel.
//!
//! At every sample a column waits for its own last value, but eight columns do not wait for each
//! other. Each result equals
//! [`Effect::contributions`](bowden::effect::Effect::contributions) bit for bit: no sum is
//! reordered, and no product is fused with a sum.

use crate::problem::filter::{ABREAST, BLOCK};
use crate::problem::is_silent;
use bowden::effect::Effect;
use bowden::Real;

/// No sum of a few numbers below this overflows, nor does its product
/// with a gain below this, over any step that is one.
const SMALL: f64 = 1e100;

/// The output of a stage for a sample, from its memory of earlier samples.
#[derive(Clone, Copy)]
enum Stage {
    /// Remembers its level.
    Lag { share: f64, gain: f64 },
    /// Remembers the sample and the output before.
    Late { share: f64 },
    /// Remembers the sample before.
    Early { gain: f64, dt: f64 },
}

impl Stage {
    fn of(effect: &Effect<f64>, gain: f64, dt: f64) -> Option<Self> {
        if !(gain.abs() < SMALL && dt > 0.0) {
            return None;
        }
        match effect.name() {
            "lag" => Some(Self::Lag {
                share: -Real::exp_m1(-dt / effect.shape(0)?),
                gain,
            }),
            "delay" if gain > 0.0 => Some(Self::Late {
                share: (dt - gain) / (dt + gain),
            }),
            "delay" => Some(Self::Early { gain, dt }),
            _ => None,
        }
    }
}

/// Passes columns of one length through a stage. Returns false, with the columns unchanged, if the
/// stage is not one of these, or if something might overflow.
pub(super) fn through(
    effect: &Effect<f64>,
    gain: f64,
    columns: &mut [&mut [f64]],
    dt: f64,
) -> bool {
    let is_small = |column: &&mut [f64]| column.iter().all(|v| v.abs() < SMALL);
    let Some(stage) = Stage::of(effect, gain, dt).filter(|_| columns.iter().all(is_small)) else {
        return false;
    };
    for group in columns.chunks_mut(ABREAST) {
        pulp::Arch::new().dispatch(Group { stage, group });
    }
    true
}

struct Group<'a, 'b> {
    stage: Stage,
    group: &'a mut [&'b mut [f64]],
}

type Row = [f64; ABREAST];

impl pulp::WithSimd for Group<'_, '_> {
    type Output = ();

    // What is not inlined here is compiled for the narrow registers of any processor.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { stage, group } = self;
        let length = group.first().map_or(0, |column| column.len());
        let mut rows = [[0.0; ABREAST]; BLOCK];
        let mut memory = [[0.0; ABREAST]; 2];
        // A stage that has seen no sample takes the first one for what has always been.
        let mut fresh = [true; ABREAST];
        for start in (0..length).step_by(BLOCK) {
            let end = (start + BLOCK).min(length);
            let rows = &mut rows[..end - start];
            let mut had_input = [false; ABREAST];
            for (lane, column) in group.iter().enumerate() {
                let block = &column[start..end];
                had_input[lane] = !block.iter().all(|v| is_silent(*v));
                for (row, v) in rows.iter_mut().zip(block) {
                    row[lane] = *v;
                }
            }
            for lane in 0..ABREAST {
                if fresh[lane] {
                    memory[0][lane] = rows[0][lane];
                    memory[1][lane] = rows[0][lane];
                    fresh[lane] = false;
                }
            }
            stage.along(rows, &mut memory);
            for (lane, column) in group.iter_mut().enumerate() {
                let has_input = column.get(end).is_some_and(|v| !is_silent(*v));
                let block = &mut column[start..end];
                for (row, v) in rows.iter().zip(block.iter_mut()) {
                    *v = row[lane];
                }
                if !had_input[lane] && !has_input && block.iter().all(|v| is_silent(*v)) {
                    block.fill(0.0);
                    fresh[lane] = true;
                }
            }
        }
    }
}

impl Stage {
    #[inline(always)]
    fn along(self, rows: &mut [Row], memory: &mut [Row; 2]) {
        let [mut m0, mut m1] = *memory;
        match self {
            Self::Lag { share, gain } => {
                for row in rows {
                    for lane in 0..ABREAST {
                        let x = row[lane];
                        m0[lane] += share * (x - m0[lane]);
                        row[lane] = x + gain * (m0[lane] - x);
                    }
                }
            }
            Self::Late { share } => {
                for row in rows {
                    for lane in 0..ABREAST {
                        let x = row[lane];
                        let late = m0[lane] + share * (x - m1[lane]);
                        m0[lane] = x;
                        m1[lane] = late;
                        row[lane] = x + (late - x);
                    }
                }
            }
            Self::Early { gain, dt } => {
                for row in rows {
                    for lane in 0..ABREAST {
                        let x = row[lane];
                        row[lane] = x + gain * ((m0[lane] - x) / dt);
                        m0[lane] = x;
                    }
                }
            }
        }
        *memory = [m0, m1];
    }
}
