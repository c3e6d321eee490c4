//! The part of the grids on which starts are searched.

use super::{filtered, Channel, Piece, Prepared, Split, ZeroPhase};
use std::ops::Range;

impl Prepared {
    /// The same records up to the end of the fit segments, on a work grid that is coarser if the
    /// estimation grid allows it; for the search of shapes.
    ///
    /// `coarse` = false keeps the work grid. The estimation grid is unchanged, except for the part
    /// that is cut off at each record's end; `path` is not cut.
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
        // The filter needs what follows: three periods of the cut-off.
        let margin = (3.0 * per_period / self.stride as f64).ceil() as usize;
        let kept: Vec<Range<usize>> = self.pieces.iter().map(|p| self.seen(p, margin)).collect();
        let thinned = |i: &Range<usize>| i.clone().step_by(factor);
        let thin = |channel: &Channel| Channel {
            motion: kept
                .iter()
                .flat_map(thinned)
                .map(|i| channel.motion[i])
                .collect(),
            ..channel.clone()
        };
        let dt = self.dt * factor as f64;
        let stride = self.stride / factor;
        let smoother = ZeroPhase::new(self.cutoff, 1.0 / dt);
        let output: Vec<f64> = kept
            .iter()
            .flat_map(thinned)
            .map(|i| self.output[i])
            .collect();
        let pieces = shortened(&self.pieces, &kept, factor, stride);
        let target = filtered(&smoother, &pieces, stride, &output);
        let fit = self.split.fit.iter().map(|&row| {
            let own = |(p, _): &(&Piece, &Piece)| p.rows.contains(&row);
            let place = self.pieces.iter().zip(&pieces).find(own);
            place.map_or(row, |(old, new)| row - old.rows.start + new.rows.start)
        });
        Self {
            dt,
            stride,
            input: thin(&self.input),
            channels: self.channels.iter().map(thin).collect(),
            output,
            target,
            split: Split {
                fit: fit.collect(),
                selection: Vec::new(),
                held_out: Vec::new(),
            },
            pieces,
            smoother,
            notes: Vec::new(),
            ..self.clone()
        }
    }

    /// The samples of a record that the search needs, on the work grid: none if none is fitted.
    fn seen(&self, piece: &Piece, margin: usize) -> Range<usize> {
        let start = piece.work.start;
        let last = self.split.fit.partition_point(|&row| row < piece.rows.end);
        let last = last.checked_sub(1).map(|k| self.split.fit[k]);
        let Some(last) = last.filter(|row| piece.rows.contains(row)) else {
            return start..start;
        };
        let rows = (last + 1 - piece.rows.start + margin).min(piece.rows.len());
        // Only after the last record need a row not be whole.
        let most = match self.pieces.len() {
            1 => (rows - 1) * self.stride + 1,
            _ => rows * self.stride,
        };
        start..start + most.min(piece.work.len())
    }
}

fn shortened(pieces: &[Piece], kept: &[Range<usize>], factor: usize, stride: usize) -> Vec<Piece> {
    let (mut work, mut rows) = (0, 0);
    let place = |(piece, kept): (&Piece, &Range<usize>)| {
        let samples = kept.len().div_ceil(factor);
        let own = Piece {
            work: work..work + samples,
            rows: rows..rows + samples.div_ceil(stride),
            ..piece.clone()
        };
        (work, rows) = (own.work.end, own.rows.end);
        own
    };
    pieces.iter().zip(kept).map(place).collect()
}
