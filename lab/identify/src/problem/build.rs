//! From records to their grids.

use super::against::{self, against};
use super::blind::{blind, bridged};
use super::spectrum;
use super::together;
use super::uniform::{usual_step, Uniform};
use super::{filtered, motion, Channel, HeldOut, Piece, Preparation, Prepared, Split, ZeroPhase};
use super::{floor, rest, still};
use crate::record::{Column, Defect, Mode, Record};
use crate::scale::QUARTER;
use bowden::effect::Motion;
use std::ops::Range;

/// Records whose rates differ by more than this factor are not put on one grid: most of it would be
/// interpolation.
const RATES_APART: f64 = 16.0;

/// Of a record that is held out as a whole, the start counts only once the input has
/// covered its half-range this many times: by then the hysteresis has forgotten its
/// unknown state at the first sample. No more than a quarter of the record is left out for it.
const FORGOTTEN: f64 = 4.0;

/// What all records have in common.
pub(super) struct Grid {
    /// Step of the uniform signals \[s\].
    step: f64,
    cutoff: f64,
    /// Uniform samples per work sample.
    pub(super) thinning: usize,
    /// Step of the work grid \[s\].
    dt: f64,
    stride: usize,
    /// Estimation samples that are dropped at both ends.
    edge: usize,
}

/// One record on the work grid.
struct Placed {
    /// The input first, then the channels.
    motion: Vec<Vec<Motion<f64>>>,
    output: Vec<f64>,
    raw: Vec<f64>,
    /// Estimation samples, by their place in the record.
    fit: Vec<usize>,
    selection: Vec<usize>,
    held_out: Vec<usize>,
    /// What the fit may see, on the work grid.
    seen: Range<usize>,
    noise_floor: f64,
    /// What is said of rest at the ends.
    rest: Option<String>,
    /// Whether the input is nothing but noise.
    rests: bool,
    shuffled: bool,
    /// Of each channel, whether it is nothing but noise.
    still: Vec<bool>,
}

impl Prepared {
    /// Puts a record on its grids.
    ///
    /// # Errors
    /// A message if the record is too short for the cut-off.
    pub fn new(record: &Record, preparation: Preparation) -> Result<Self, String> {
        Self::joined(std::slice::from_ref(record), preparation, HeldOut::Trailing)
    }

    /// Puts several records of one rig one after another on common grids: one step, one cut-off.
    /// The records have the same mode and the same channels in the same order.
    ///
    /// The step is that of the fastest record; slower ones are interpolated by cubics. Nothing is
    /// fitted to a record that is held out as a whole, not even its state at the start. Its samples
    /// count only after the input has covered its half-range four times.
    ///
    /// # Errors
    /// A message if a record is too short for the cut-off or cannot be put on a common grid; it
    /// names the file if there are several.
    pub fn joined(
        records: &[Record],
        preparation: Preparation,
        held_out: HeldOut,
    ) -> Result<Self, String> {
        let first = records.first().ok_or("no record was given")?;
        together(records.len())?;
        let several = records.len() > 1;
        let named = |record: &Record, message: String| match several {
            true => format!("{}: {message}", record.path),
            false => message,
        };
        let steps: Vec<f64> = records.iter().map(|r| usual_step(&r.time)).collect();
        let step = steps.iter().copied().fold(f64::INFINITY, f64::min);
        let slowest = steps.iter().copied().fold(0.0, f64::max);
        if let Some((record, own)) = records
            .iter()
            .zip(&steps)
            .find(|(_, own)| **own > RATES_APART * step)
        {
            return Err(named(record, format!(
                "the file is sampled at {:.6} Hz, but another file is sampled at {:.6} Hz; the rates may differ by at most a factor of {RATES_APART}",
                1.0 / own,
                1.0 / step
            )));
        }
        let uniform = records
            .iter()
            .zip(&steps)
            .map(|(r, own)| Uniform::new(&r.time, *own, step).map_err(|m| named(r, m)))
            .collect::<Result<Vec<_>, _>>()?;
        let inputs = records.iter().zip(&uniform);
        let inputs: Vec<_> = inputs
            .map(|(r, u)| u.signal(&bridged(r, &r.input)))
            .collect();
        let cutoff = cutoff(preparation, &inputs, step, slowest)?;
        let grid = Grid::new(step, cutoff);

        let mut whole = Collected::default();
        for (index, (record, uniform)) in records.iter().zip(&uniform).enumerate() {
            let last = index + 1 == records.len();
            let shares = match held_out {
                HeldOut::Trailing => Some((60, 75)),
                HeldOut::LastRecord if last => None,
                HeldOut::LastRecord => Some((80, 100)),
                HeldOut::Nothing => Some((100, 100)),
            };
            let placed = place(record, uniform, &inputs[index], &grid, last, shares)
                .map_err(|m| named(record, m))?;
            whole.note(record, uniform, placed.rest.as_ref(), several);
            whole.blame(record, several);
            whole.add(record, 1.0 / steps[index], placed, &grid);
        }
        whole.finish(first, &grid, held_out)
    }

    /// The first row that counts: the input has covered its half-range four times, or a quarter of
    /// the record is over.
    #[must_use]
    pub fn settled(&self) -> usize {
        let distance = FORGOTTEN * self.input.reach;
        let own = |piece: &Piece| settled(piece, &self.path, distance);
        self.pieces.first().map_or(0, own)
    }
}

impl Grid {
    pub(super) fn new(step: f64, cutoff: f64) -> Self {
        let rate = 1.0 / step;
        let thinning = ((rate / (24.0 * cutoff) + 1e-6).floor() as usize).max(1);
        let dt = step * thinning as f64;
        let stride = ((1.0 / (4.0 * cutoff * dt) + 1e-6).floor() as usize).max(1);
        Self {
            step,
            cutoff,
            thinning,
            dt,
            stride,
            edge: ((3.0 / (cutoff * dt * stride as f64)).ceil() as usize).max(1),
        }
    }
}

/// The one cut-off: as asked for, or from the spectra of the inputs.
fn cutoff(
    preparation: Preparation,
    inputs: &[Vec<f64>],
    step: f64,
    slowest: f64,
) -> Result<f64, String> {
    let rate = 1.0 / slowest;
    match preparation.cutoff {
        // What the line below prints as the most is allowed, whatever its last digit is.
        Some(cutoff) if cutoff <= 0.4 * rate * (1.0 + 1e-6) => Ok(cutoff),
        Some(cutoff) => Err(format!("--cutoff {cutoff} Hz is too high; a record sampled at {rate:.6} Hz allows at most {:.6} Hz", 0.4 * rate)),
        None => {
            let own = inputs.iter().map(|i| spectrum::default_cutoff(i, 1.0 / step));
            let highest = own.fold(0.0, f64::max);
            // The slowest record has to bear it; one alone bears its own.
            Ok(if inputs.len() > 1 { highest.min(0.2 * rate) } else { highest })
        }
    }
}

/// One record on the grids. `shares` are the percentages at which the fit and the
/// selection segments end; a record without them is held out as a whole.
fn place(
    record: &Record,
    uniform: &Uniform,
    input: &[f64],
    grid: &Grid,
    last: bool,
    shares: Option<(usize, usize)>,
) -> Result<Placed, String> {
    let &Grid {
        cutoff,
        thinning,
        dt,
        stride,
        edge,
        ..
    } = grid;
    let output = uniform.signal(&bridged(record, &record.output));
    let rate = 1.0 / grid.step;
    let n_work = uniform.len.div_ceil(thinning);
    // The next record begins on the estimation grid.
    let n_work = n_work - if last { 0 } else { n_work % stride };
    let n_estimation = n_work.div_ceil(stride);
    if n_estimation < 2 * edge + rest::FEWEST {
        return Err(format!(
            "the record is too short: {:.3} s at a cut-off of {cutoff:.4} Hz; record at least {:.3} s, or set a higher --cutoff",
            uniform.len as f64 * uniform.dt,
            (2 * edge + rest::FEWEST) as f64 * dt * stride as f64
        ));
    }
    let smooth = ZeroPhase::new(2.5 * cutoff, rate);
    let smoothed_output = smooth.apply(&output);
    let moving = |smoothed: &[f64]| {
        let mut all = motion(smoothed, thinning, uniform.dt);
        all.truncate(n_work);
        all
    };
    let (smoothed_input, rested) = still::smoothed(&smooth, input, rate / cutoff);
    let mut motion = vec![moving(&smoothed_input)];
    let channels = record.channels.iter().map(|c| bridged(record, c));
    let channels: Vec<Vec<f64>> = channels.map(|c| uniform.signal(&c)).collect();
    motion.extend(channels.iter().map(|c| moving(&smooth.apply(c))));
    let thinned = |values: &[f64], by: usize, most: usize| -> Vec<f64> {
        values.iter().step_by(by).take(most).copied().collect()
    };
    let on_work = thinned(&smoothed_output, thinning, n_work);
    let raw = thinned(&output, thinning * stride, n_estimation);

    let noise_floor = match record.held.contains(&record.output.name) {
        true => 0.0,
        false if uniform.is_finer() => floor::of_slower(record, uniform, cutoff)?,
        false => floor::of(&output, &smoothed_output, uniform.noise(), (cutoff, rate)),
    };
    let Range { start, end } = without_rest((&motion, &on_work), noise_floor, grid);
    let row = dt * stride as f64;
    let part = |share: usize| start + (end - start) * share / 100;
    let (fit_end, stop_end) = shares.map_or((start, start), |(fit, stop)| (part(fit), part(stop)));

    let mut valid = vec![true; n_estimation];
    let per_estimation = thinning * stride;
    let period = (1.0 / (cutoff * dt * stride as f64)).ceil() as usize;
    let gaps = uniform.gaps(&record.time, cutoff).into_iter();
    let samples = 1.0 / (cutoff * record.step());
    let blind = blind(record, (period, samples), edge)
        .map(|(stretch, guard)| (uniform.stretch(&record.time, &stretch), guard));
    // What stands in for a missing stretch is as wrong as the ends are.
    for (gap, guard) in gaps.map(|gap| (gap, edge)).chain(blind) {
        let from = (gap.start / per_estimation).saturating_sub(guard);
        let to = (gap.end / per_estimation + guard).min(n_estimation - 1);
        if from <= to {
            valid[from..=to].fill(false);
        }
    }
    let keep = |range: Range<usize>| -> Vec<usize> { range.filter(|&i| valid[i]).collect() };
    let rests = still::is_at_rest(input);
    Ok(Placed {
        noise_floor,
        rest: rest::note(
            (start > edge, start as f64 * row),
            (end < n_estimation - edge, (n_estimation - end) as f64 * row),
            rested as f64 * uniform.dt,
        ),
        rests,
        shuffled: rests && still::follows(input, &output),
        still: channels.iter().map(|c| still::is_at_rest(c)).collect(),
        motion,
        output: on_work,
        raw,
        fit: keep(start..fit_end),
        selection: keep(fit_end..stop_end),
        held_out: keep(stop_end..end),
        // Shapes and origins are chosen on what the fit may see.
        seen: start * stride..fit_end * stride,
    })
}

/// The rows of a record but for its ends and rest there.
fn without_rest(
    (motion, output): (&[Vec<Motion<f64>>], &[f64]),
    noise_floor: f64,
    grid: &Grid,
) -> Range<usize> {
    let by_row = |values: &Vec<Motion<f64>>| {
        let rows = values.iter().step_by(grid.stride);
        (rows.map(|m| m.position).collect(), 0.0)
    };
    let output = output.iter().step_by(grid.stride).copied().collect();
    let signals = motion.iter().map(by_row).chain([(output, noise_floor)]);
    rest::moving(&signals.collect::<Vec<(Vec<f64>, f64)>>(), grid.edge)
}

/// The records so far, one after another.
#[derive(Default)]
struct Collected {
    pieces: Vec<Piece>,
    /// The input first, then the channels.
    motion: Vec<Vec<Motion<f64>>>,
    /// Of each channel, whether it is nothing but noise in all of them.
    still: Vec<bool>,
    output: Vec<f64>,
    raw: Vec<f64>,
    split: Split,
    seen: Vec<Range<usize>>,
    /// Noise floor of each record, and its samples that are fitted and held out.
    noise: Vec<(f64, usize, usize)>,
    notes: Vec<String>,
    defects: Vec<Defect>,
}

impl Collected {
    fn note(&mut self, record: &Record, uniform: &Uniform, rest: Option<&String>, several: bool) {
        let stretched = (uniform.stretched > 0).then(|| {
            format!(
                "resampled at {1:.6} Hz, because {0} time steps are longer than 1.5 samples",
                uniform.stretched,
                1.0 / uniform.dt
            )
        });
        let notes = record.notes.iter().chain(&stretched).chain(rest).cloned();
        self.notes.extend(notes.map(|note| match several {
            true => format!("{}: {note}", record.path),
            false => note,
        }));
    }

    /// The defects of a record; with several records, each defect names its file.
    fn blame(&mut self, record: &Record, several: bool) {
        self.defects.extend(record.defects.iter().map(|defect| {
            let mut own = defect.clone();
            if several {
                own.message = format!("{}: {}", record.path, own.message);
            }
            own
        }));
    }

    fn add(&mut self, record: &Record, rate: f64, placed: Placed, grid: &Grid) {
        let (work, row) = (self.output.len(), self.raw.len());
        let end = work + placed.output.len();
        self.pieces.push(Piece {
            path: record.path.clone(),
            samples: record.time.len(),
            dropped: record.dropped,
            rate: nine_digits(rate),
            work: work..end,
            rows: row..row + placed.raw.len(),
            since: work as f64 * grid.dt,
            fitted: !placed.fit.is_empty(),
            rests: placed.rests,
            shuffled: placed.shuffled,
        });
        self.motion.resize(placed.motion.len(), Vec::new());
        for (all, own) in self.motion.iter_mut().zip(placed.motion) {
            all.extend(own);
        }
        self.still.resize(placed.still.len(), true);
        for (all, own) in self.still.iter_mut().zip(placed.still) {
            *all &= own;
        }
        self.output.extend(placed.output);
        self.raw.extend(placed.raw);
        let moved = |rows: Vec<usize>| rows.into_iter().map(move |i| row + i);
        self.noise
            .push((placed.noise_floor, placed.fit.len(), placed.held_out.len()));
        self.split.fit.extend(moved(placed.fit));
        self.split.selection.extend(moved(placed.selection));
        self.split.held_out.extend(moved(placed.held_out));
        self.seen
            .push(work + placed.seen.start..work + placed.seen.end);
    }

    fn finish(
        mut self,
        first: &Record,
        grid: &Grid,
        held_out: HeldOut,
    ) -> Result<Prepared, String> {
        let columns = std::iter::once(&first.input).chain(&first.channels);
        let named = |(motion, column): (Vec<Motion<f64>>, &Column)| {
            Channel::new(column, motion, &self.seen)
        };
        let mut all = self.motion.into_iter().zip(columns).map(named);
        let input = all.next().ok_or("no record was given")?;
        let mut channels: Vec<_> = all.collect();
        for (channel, still) in channels.iter_mut().zip(&self.still) {
            channel.rests = *still;
            self.notes
                .extend(still.then(|| still::note(&channel.name, self.pieces.len())));
        }
        let load = channels.iter().position(|c| c.name == "load");
        let path = path(&input, &self.pieces, grid.stride);
        for piece in self.pieces.iter().filter(|p| !p.fitted) {
            let from = settled(piece, &path, FORGOTTEN * input.reach);
            let too_early = |row: &usize| piece.rows.contains(row) && *row < from;
            self.split.held_out.retain(|row| !too_early(row));
        }
        let split = &self.split;
        let kept_back = split.selection.len().min(split.held_out.len());
        let unseen = held_out == HeldOut::Nothing || kept_back >= 20;
        if split.fit.len() < 96 || !unseen {
            return Err(format!(
                "too few filtered samples remain without gaps and defects: {} for the fit (at least 96 are needed), and {kept_back} in the smaller of the other two segments (at least 20)",
                split.fit.len()
            ));
        }
        let smoother = ZeroPhase::new(grid.cutoff, 1.0 / grid.dt);
        let against = first.mode == Mode::Displacement
            && against(&input, &self.output, &self.seen, grid.stride);
        if against {
            let words = against::words(&first.output.name, &input.name);
            self.notes.push(words);
        }
        Ok(Prepared {
            mode: first.mode,
            against,
            samples: self.pieces.iter().map(|p| p.samples).sum(),
            rate: nine_digits(1.0 / grid.step),
            cutoff: grid.cutoff,
            dt: grid.dt,
            stride: grid.stride,
            input,
            channels,
            load,
            output_name: first.output.name.clone(),
            output_unit: first.output.unit.clone(),
            target: filtered(&smoother, &self.pieces, grid.stride, &self.output),
            output: self.output,
            target_raw: self.raw,
            split: self.split,
            noise_floor: common_floor(self.noise.iter().map(|(floor, fit, _)| (*floor, *fit))),
            held_out_floor: common_floor(self.noise.iter().map(|(floor, _, out)| (*floor, *out))),
            path,
            notes: self.notes,
            defects: self.defects,
            pieces: self.pieces,
            smoother,
        })
    }
}

/// The distance travelled by the input up to each estimation sample; the transition from one record
/// to the next counts as zero.
fn path(input: &Channel, pieces: &[Piece], stride: usize) -> Vec<f64> {
    let mut travelled = 0.0;
    let mut path = Vec::new();
    for piece in pieces {
        let motion = &input.motion[piece.work.clone()];
        for (i, at) in motion.iter().enumerate() {
            if i > 0 {
                travelled += (at.position - motion[i - 1].position).abs();
            }
            if i % stride == 0 {
                path.push(travelled);
            }
        }
    }
    path
}

/// The row of a record after which its initial state has no influence.
fn settled(piece: &Piece, path: &[f64], distance: f64) -> usize {
    let begin = path[piece.rows.start];
    let most = piece.rows.start + (QUARTER * piece.rows.len() as f64) as usize;
    (piece.rows.start..most)
        .find(|&row| path[row] - begin >= distance)
        .unwrap_or(most)
}

/// Rms of the noise of all records over their samples, of those whose noise is known.
fn common_floor(noise: impl Iterator<Item = (f64, usize)>) -> f64 {
    let known: Vec<(f64, usize)> = noise.filter(|(floor, n)| *floor > 0.0 && *n > 0).collect();
    match known[..] {
        [] => 0.0,
        // Its own, to the last digit.
        [(floor, _)] => floor,
        _ => {
            let samples: usize = known.iter().map(|(_, n)| n).sum();
            let squares = known.iter().map(|(floor, n)| floor * floor * *n as f64);
            (squares.sum::<f64>() / samples as f64).sqrt()
        }
    }
}

/// Digits beyond the ninth are rounding.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}
