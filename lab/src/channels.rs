//! From a record to the grid on which everything is computed.
//!
//! Time is made uniform, long gaps are masked. One smoother at 2.5 f_c goes over the
//! input, every channel **and the output**; velocity and acceleration are derived
//! from the smoothed signals. Then every column of the regression and the output go
//! through the same zero-phase filter at f_c. So noise cannot make a fake viscous
//! term or a fake delay.
//!
//! Three grids: the record's own rate; the *work* grid, on which hysteresis and
//! effects run (about 24 samples per period of f_c); the *estimation* grid, on which
//! least squares runs (about 4 per period, since nothing above f_c is left). Starts are
//! searched on a coarser work grid that ends with the fit segment.

use crate::filter::{derivative, ZeroPhase};
use crate::record::{Mode, Record};
use crate::spectrum;
use bowden::effect::Motion;
use std::ops::Range;

/// How the record is to be prepared.
#[derive(Debug, Clone, Copy, Default)]
pub struct Preparation {
    /// Cut-off \[Hz\]; from the spectrum of the input where `None`.
    pub cutoff: Option<f64>,
}

/// A measured channel on the work grid.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Name as in the record, or as mapped by the user.
    pub name: String,
    /// Unit of the position, where the record states one.
    pub unit: Option<String>,
    /// Position, velocity and acceleration at each work sample.
    pub motion: Vec<Motion<f64>>,
    /// The origin from which effects measure the position: 0 or the mid-range.
    pub origin: f64,
    /// Middle of the range of the position.
    pub middle: f64,
    /// Half of the range of the position.
    pub reach: f64,
    /// Root mean square of the velocity.
    pub speed: f64,
}

impl Channel {
    fn new(
        name: String,
        unit: Option<String>,
        smoothed: &[f64],
        stride: usize,
        dt: f64,
        used: &Range<usize>,
    ) -> Self {
        let velocity = derivative(smoothed, dt);
        let acceleration = derivative(&velocity, dt);
        let motion: Vec<_> = (0..smoothed.len())
            .step_by(stride)
            .map(|i| Motion {
                position: smoothed[i],
                velocity: velocity[i],
                acceleration: acceleration[i],
            })
            .collect();
        let inside = &motion[used.clone()];
        let low = inside
            .iter()
            .map(|m| m.position)
            .fold(f64::INFINITY, f64::min);
        let high = inside
            .iter()
            .map(|m| m.position)
            .fold(f64::NEG_INFINITY, f64::max);
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
        // An axis that is nearly centred keeps its own zero: that is where its physics is.
        let origin = if middle.abs() < 0.1 * reach {
            0.0
        } else {
            middle
        };
        let speed = (inside.iter().map(|m| m.velocity * m.velocity).sum::<f64>()
            / inside.len().max(1) as f64)
            .sqrt();
        Self {
            name,
            unit,
            motion,
            origin,
            middle,
            reach,
            speed,
        }
    }
}

/// The trailing segments: fit and select, stop-check, held out.
#[derive(Debug, Clone)]
pub struct Split {
    /// The first 60 %: parameters are fitted and effects selected here.
    pub fit: Vec<usize>,
    /// The next 15 %: a round must not make this worse.
    pub stop: Vec<usize>,
    /// The last 25 %: seen by nothing, only reported.
    pub held_out: Vec<usize>,
}

/// A record on its grids, ready to be fitted.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Torque or displacement input.
    pub mode: Mode,
    /// Samples of the record after cutting.
    pub samples: usize,
    /// Rate of the record \[Hz\], after making time uniform.
    pub rate: f64,
    /// Cut-off f_c \[Hz\].
    pub cutoff: f64,
    /// Step of the work grid \[s\].
    pub dt: f64,
    /// Work samples per estimation sample.
    pub stride: usize,
    /// The transmission's input on the work grid.
    pub input: Channel,
    /// The other channels.
    pub channels: Vec<Channel>,
    /// Index into `channels` of a measured load, where there is one.
    pub load: Option<usize>,
    /// The output's name and unit.
    pub output_name: String,
    /// The output's unit.
    pub output_unit: Option<String>,
    /// The output behind the smoother, on the work grid.
    output: Vec<f64>,
    /// The output through the filter, on the estimation grid.
    pub target: Vec<f64>,
    /// The output as recorded (uniform time, not filtered) on the estimation grid.
    pub target_raw: Vec<f64>,
    /// Estimation samples of each segment.
    pub split: Split,
    /// Rms of the output's noise that passes the filter, taken as white.
    pub noise_floor: f64,
    /// The input range's travelled distance up to each estimation sample.
    pub path: Vec<f64>,
    /// Remarks for the user.
    pub notes: Vec<String>,
    smoother: ZeroPhase,
}

/// Uniform time: the step, and the signals on it.
struct Uniform {
    dt: f64,
    len: usize,
    position: Option<Vec<(usize, f64)>>,
    stretched: usize,
}

impl Uniform {
    fn new(time: &[f64]) -> Result<Self, String> {
        let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        steps.sort_by(f64::total_cmp);
        let median = steps[steps.len() / 2];
        let span = time[time.len() - 1] - time[0];
        // The mean of the steps that are no gaps.
        let usual = steps.partition_point(|s| *s <= 3.0 * median);
        let mean = steps[..usual].iter().sum::<f64>() / usual as f64;
        // Nine digits: what is beyond them is the rounding of the sum.
        let dt: f64 = format!("{mean:.9e}").parse().unwrap_or(mean);
        let uneven = time
            .iter()
            .enumerate()
            .any(|(i, t)| (t - time[0] - i as f64 * dt).abs() > 0.02 * dt);
        if !uneven {
            return Ok(Self {
                dt,
                len: time.len(),
                position: None,
                stretched: 0,
            });
        }
        // Past this there is more gap than record, and the grid would not fit into memory.
        if span / dt > 20.0 * time.len() as f64 {
            return Err(format!(
                "time spans {span:.6} s, but its usual step is {dt:.6} s: most of it is gap; cut it with --skip and --until"
            ));
        }
        let len = (span / dt + 1e-6).floor() as usize + 1;
        let mut position = Vec::with_capacity(len);
        let mut left = 0;
        for k in 0..len {
            let t = time[0] + k as f64 * dt;
            while left + 2 < time.len() && time[left + 1] <= t {
                left += 1;
            }
            let fraction = ((t - time[left]) / (time[left + 1] - time[left])).clamp(0.0, 1.0);
            position.push((left, fraction));
        }
        let stretched = time.windows(2).filter(|w| w[1] - w[0] > 1.5 * dt).count();
        Ok(Self {
            dt,
            len,
            position: Some(position),
            stretched,
        })
    }

    /// Gaps longer than half a period of the cut-off: they hide motion that matters.
    fn gaps(&self, time: &[f64], cutoff: f64) -> Vec<Range<usize>> {
        let longest = (5.0 * self.dt).max(0.5 / cutoff);
        let index = |t: f64| ((t - time[0]) / self.dt).round() as usize;
        time.windows(2)
            .filter(|w| w[1] - w[0] > longest)
            .map(|w| index(w[0])..index(w[1]).min(self.len))
            .collect()
    }

    fn signal(&self, values: &[f64]) -> Vec<f64> {
        match &self.position {
            None => values.to_vec(),
            Some(position) => position
                .iter()
                .map(|&(i, f)| values[i] + f * (values[i + 1] - values[i]))
                .collect(),
        }
    }
}

impl Prepared {
    /// Puts a record on its grids.
    ///
    /// # Errors
    /// One sentence where the record is too short for the cut-off.
    pub fn new(record: &Record, preparation: Preparation) -> Result<Self, String> {
        let uniform = Uniform::new(&record.time)?;
        let rate = 1.0 / uniform.dt;
        let mut notes = record.notes.clone();
        if uniform.stretched > 0 {
            notes.push(format!(
                "time is not uniform: {} steps are longer than 1.5 samples; resampled at {rate:.6} Hz",
                uniform.stretched
            ));
        }
        let input = uniform.signal(&record.input.values);
        let output = uniform.signal(&record.output.values);
        let n = uniform.len;
        let cutoff = match preparation.cutoff {
            Some(cutoff) if cutoff < 0.4 * rate => cutoff,
            Some(cutoff) => return Err(format!("--cutoff {cutoff} Hz is too high: the record has {rate:.6} samples a second and allows at most {:.6} Hz", 0.4 * rate)),
            None => spectrum::default_cutoff(&input, rate),
        };
        let work_stride = ((rate / (24.0 * cutoff) + 1e-6).floor() as usize).max(1);
        let dt = uniform.dt * work_stride as f64;
        let stride = ((1.0 / (4.0 * cutoff * dt) + 1e-6).floor() as usize).max(1);
        let n_work = n.div_ceil(work_stride);
        let n_estimation = n_work.div_ceil(stride);

        let edge = ((3.0 / (cutoff * dt * stride as f64)).ceil() as usize).max(1);
        if n_estimation < 2 * edge + 160 {
            return Err(format!(
                "the record is too short: {:.3} s at a cut-off of {cutoff:.4} Hz; at least {:.3} s are needed, or a higher --cutoff",
                n as f64 * uniform.dt,
                (2 * edge + 160) as f64 * dt * stride as f64
            ));
        }
        let usable = n_estimation - 2 * edge;
        let fit_end = edge + usable * 60 / 100;
        let stop_end = edge + usable * 75 / 100;
        // Shapes and origins are chosen on what the fit may see.
        let seen = edge * stride..fit_end * stride;

        let smooth = ZeroPhase::new(2.5 * cutoff, rate);
        let smoothed_output = smooth.apply(&output);
        let channel = |column: &crate::record::Column, values: &[f64]| {
            Channel::new(
                column.name.clone(),
                column.unit.clone(),
                &smooth.apply(values),
                work_stride,
                uniform.dt,
                &seen,
            )
        };
        let input_channel = channel(&record.input, &input);
        let channels: Vec<_> = record
            .channels
            .iter()
            .map(|c| channel(c, &uniform.signal(&c.values)))
            .collect();
        let load = channels.iter().position(|c| c.name == "load");

        let smoother = ZeroPhase::new(cutoff, 1.0 / dt);
        let on_work: Vec<f64> = smoothed_output
            .iter()
            .step_by(work_stride)
            .copied()
            .collect();
        let target: Vec<f64> = smoother
            .apply(&on_work)
            .into_iter()
            .step_by(stride)
            .collect();
        let target_raw: Vec<f64> = output
            .iter()
            .step_by(work_stride * stride)
            .copied()
            .collect();

        let mut valid = vec![true; n_estimation];
        let per_estimation = work_stride * stride;
        let guard = (1.0 / (cutoff * dt * stride as f64)).ceil() as usize;
        for gap in &uniform.gaps(&record.time, cutoff) {
            let from = (gap.start / per_estimation).saturating_sub(guard);
            let to = (gap.end / per_estimation + guard).min(n_estimation - 1);
            valid[from..=to].fill(false);
        }
        let keep = |range: Range<usize>| -> Vec<usize> { range.filter(|&i| valid[i]).collect() };
        let split = Split {
            fit: keep(edge..fit_end),
            stop: keep(fit_end..stop_end),
            held_out: keep(stop_end..n_estimation - edge),
        };
        if split.fit.len() < 96 || split.stop.len() < 20 || split.held_out.len() < 20 {
            return Err("the gaps in time leave too few samples to fit".to_owned());
        }

        let mut travelled = 0.0;
        let mut path = Vec::with_capacity(n_estimation);
        for (i, pair) in input_channel.motion.iter().enumerate() {
            if i > 0 {
                travelled += (pair.position - input_channel.motion[i - 1].position).abs();
            }
            if i % stride == 0 {
                path.push(travelled);
            }
        }
        let noise_floor = noise_floor(&output, &smoothed_output, cutoff, rate);
        Ok(Self {
            mode: record.mode,
            samples: record.time.len(),
            rate: format!("{rate:.9e}").parse().unwrap_or(rate),
            cutoff,
            dt,
            stride,
            input: input_channel,
            channels,
            load,
            output_name: record.output.name.clone(),
            output_unit: record.output.unit.clone(),
            output: on_work,
            target,
            target_raw,
            split,
            noise_floor,
            path,
            notes,
            smoother,
        })
    }

    /// The same record as far as the fit segment goes, on a work grid that is coarser
    /// where the estimation grid allows; for the search of shapes.
    ///
    /// `coarse` = false keeps the work grid. The estimation grid stays as it is.
    #[must_use]
    pub fn for_search(&self, coarse: bool) -> Self {
        let per_period = 1.0 / (self.cutoff * self.dt);
        let factor = match coarse {
            true => (1..=self.stride)
                .rev()
                .find(|c| self.stride.is_multiple_of(*c) && per_period / *c as f64 >= 8.0)
                .unwrap_or(1),
            false => 1,
        };
        let last = self.split.fit.last().map_or(0, |l| l + 1);
        // The filter needs what follows: three periods of the cut-off.
        let margin = (3.0 * per_period / self.stride as f64).ceil() as usize;
        let rows = (last + margin).min(self.target.len());
        let work = ((rows - 1) * self.stride + 1).min(self.work_len());
        let thin = |channel: &Channel| Channel {
            motion: channel.motion[..work]
                .iter()
                .step_by(factor)
                .copied()
                .collect(),
            ..channel.clone()
        };
        let dt = self.dt * factor as f64;
        let stride = self.stride / factor;
        let smoother = ZeroPhase::new(self.cutoff, 1.0 / dt);
        let output: Vec<f64> = self.output[..work]
            .iter()
            .step_by(factor)
            .copied()
            .collect();
        let target = smoother
            .apply(&output)
            .into_iter()
            .step_by(stride)
            .collect();
        Self {
            dt,
            stride,
            input: thin(&self.input),
            channels: self.channels.iter().map(thin).collect(),
            output,
            target,
            split: Split {
                fit: self.split.fit.clone(),
                stop: Vec::new(),
                held_out: Vec::new(),
            },
            smoother,
            notes: Vec::new(),
            ..self.clone()
        }
    }

    /// The output behind the smoother, on the work grid.
    #[must_use]
    pub fn output(&self) -> &[f64] {
        &self.output
    }

    /// The same record with another output, given on the work grid.
    #[must_use]
    pub fn with_output(&self, output: Vec<f64>) -> Self {
        Self {
            target: self.filtered(&output),
            target_raw: output.iter().step_by(self.stride).copied().collect(),
            output,
            ..self.clone()
        }
    }

    /// Samples on the work grid.
    #[must_use]
    pub fn work_len(&self) -> usize {
        self.input.motion.len()
    }

    /// A column of the work grid through the filter, on the estimation grid.
    #[must_use]
    pub fn filtered(&self, column: &[f64]) -> Vec<f64> {
        self.smoother
            .apply(column)
            .into_iter()
            .step_by(self.stride)
            .collect()
    }

    /// The channel that an effect reads.
    #[must_use]
    pub fn channel(&self, source: bowden::model::Source) -> Option<&Channel> {
        match source {
            bowden::model::Source::Input => Some(&self.input),
            bowden::model::Source::Channel(i) => self.channels.get(usize::from(i)),
        }
    }
}

/// Rms of white noise behind the filter at `cutoff`, estimated from what the
/// smoother at 2.5 times that took away.
fn noise_floor(output: &[f64], smoothed: &[f64], cutoff: f64, rate: f64) -> f64 {
    // Differences of neighbours see the noise at the top of the band and not the signal.
    let n = output.len();
    let removed: Vec<f64> = output.iter().zip(smoothed).map(|(a, b)| a - b).collect();
    let passed = ZeroPhase::new(2.5 * cutoff, rate).noise_gain();
    // What is left of white noise after taking away its smoothed part: 1 − 2 h0 + sum h².
    let mut impulse = vec![0.0; 4001];
    impulse[2000] = 1.0;
    let centre = ZeroPhase::new(2.5 * cutoff, rate).apply(&impulse)[2000];
    let share = 1.0 - 2.0 * centre + passed * passed;
    if share <= 0.02 {
        return 0.0;
    }
    let variance = removed.iter().map(|v| v * v).sum::<f64>() / n as f64 / share;
    variance.sqrt() * ZeroPhase::new(cutoff, rate).noise_gain()
}

#[cfg(test)]
mod tests;
