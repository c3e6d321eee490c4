//! What is usually done instead: forward selection by BIC, and by the error reduction
//! ratio.
//!
//! Both get what the loop's first scan gets: the same columns at the same trial shapes,
//! behind the same filter, beside the columns and the tangents of the baseline model
//! (so that its gains and shapes move along), on the same fit segment. Forward by
//! orthogonal least squares (Chen, Billings and Luo, 1989). BIC (Schwarz, 1978) goes on
//! while n ln(SSE/n) + k ln n falls; the ERR rule while the next column takes at least
//! 0.1 % of the sum of squares that the baseline model leaves.

use bowden_lab::fit::Solution;
use bowden_lab::model::catalogue::Candidate;
use bowden_lab::problem::{Prepared, Stretch};
use nalgebra::{DMatrix, DVector};

/// Share of the residual's squares that the ERR rule asks of the next column.
const ERR: f64 = 1e-3;

/// What a criterion chose.
pub struct Chosen {
    pub families: Vec<&'static str>,
    /// Held-out error over what the noise leaves.
    pub reached: f64,
}

impl Chosen {
    pub fn found(&self, planted: &[&'static str]) -> usize {
        planted.iter().filter(|f| self.families.contains(f)).count()
    }

    /// Families that were not planted.
    pub fn wrong(&self, planted: &[&'static str]) -> usize {
        self.families
            .iter()
            .filter(|f| !planted.contains(f))
            .count()
    }
}

/// The columns in the order in which orthogonal forward selection takes them.
pub struct Library<'a> {
    data: &'a Prepared,
    declared: &'a Solution,
    families: Vec<&'static str>,
    columns: Vec<Stretch>,
    order: Vec<usize>,
    /// Sum of squares before the first and after each of `order`.
    squares: Vec<f64>,
    base: usize,
}

fn on(rows: &[usize], column: &Stretch) -> DVector<f64> {
    DVector::from_iterator(rows.len(), rows.iter().map(|&i| column[i]))
}

fn off(v: &mut DVector<f64>, q: &DVector<f64>) {
    let dot = q.dot(v);
    v.axpy(-dot, q, 1.0);
}

impl<'a> Library<'a> {
    pub fn new(data: &'a Prepared, declared: &'a Solution, tried: &[Candidate]) -> Self {
        let rows = &data.split.fit;
        let mut base: Vec<DVector<f64>> = Vec::new();
        for column in declared.columns.iter().chain(&declared.tangents) {
            let mut v = on(rows, column);
            let norm = v.norm();
            for _ in 0..2 {
                base.iter().for_each(|q| off(&mut v, q));
            }
            if v.norm() > 1e-6 * norm && norm > 0.0 {
                base.push(v.normalize());
            }
        }
        let (mut families, mut columns) = (Vec::new(), Vec::new());
        for candidate in tried {
            if let Some(raw) = declared.adds(data, &candidate.term) {
                columns.push(Stretch::from(data.filtered(&raw)));
                families.push(candidate.family);
            }
        }
        let mut left: Vec<DVector<f64>> = columns.iter().map(|c| on(rows, c)).collect();
        let whole: Vec<f64> = left.iter().map(|v| v.norm_squared()).collect();
        let mut residual = on(rows, &declared.residual.clone().into());
        for q in &base {
            off(&mut residual, q);
            left.iter_mut().for_each(|v| off(v, q));
        }
        let (mut order, mut squares) = (Vec::new(), vec![residual.norm_squared()]);
        // As many as the fit segment could bear; no criterion comes near that.
        while order.len() < 60 {
            let best = (0..left.len())
                .filter(|j| !order.contains(j) && left[*j].norm_squared() > 1e-6 * whole[*j])
                .map(|j| (j, left[j].dot(&residual).powi(2) / left[j].norm_squared()))
                .max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((j, _)) = best else { break };
            let q = left[j].normalize();
            off(&mut residual, &q);
            left.iter_mut().for_each(|v| off(v, &q));
            order.push(j);
            squares.push(residual.norm_squared());
        }
        Self {
            data,
            declared,
            families,
            columns,
            order,
            squares,
            base: base.len(),
        }
    }

    pub fn bic(&self, floor: f64) -> Chosen {
        let n = self.data.split.fit.len() as f64;
        let of = |k: usize| n * (self.squares[k] / n).ln() + (self.base + k) as f64 * n.ln();
        let mut taken = 0;
        while taken < self.order.len() && of(taken + 1) < of(taken) {
            taken += 1;
        }
        self.chosen(taken, floor)
    }

    pub fn err(&self, floor: f64) -> Chosen {
        let mut taken = 0;
        while taken < self.order.len()
            && self.squares[taken] - self.squares[taken + 1] >= ERR * self.squares[0]
        {
            taken += 1;
        }
        self.chosen(taken, floor)
    }

    /// All gains anew with the first `taken` columns; the error on held-out rows.
    fn chosen(&self, taken: usize, floor: f64) -> Chosen {
        let picked = &self.order[..taken];
        let all: Vec<&Stretch> = self
            .declared
            .columns
            .iter()
            .chain(&self.declared.tangents)
            .chain(picked.iter().map(|&j| &self.columns[j]))
            .collect();
        let fit = &self.data.split.fit;
        let scale: Vec<f64> = all
            .iter()
            .map(|c| on(fit, c).norm().max(f64::MIN_POSITIVE))
            .collect();
        let matrix = |rows: &[usize]| {
            DMatrix::from_fn(rows.len(), all.len(), |k, j| all[j][rows[k]] / scale[j])
        };
        let gains = matrix(fit)
            .svd(true, true)
            .solve(&on(fit, &self.declared.residual.clone().into()), 1e-9)
            .unwrap();
        let held_out = &self.data.split.held_out;
        let rest = on(held_out, &self.declared.residual.clone().into()) - matrix(held_out) * gains;
        let mut families: Vec<&'static str> = picked.iter().map(|&j| self.families[j]).collect();
        families.sort_unstable();
        families.dedup();
        Chosen {
            families,
            reached: (rest.norm_squared() / held_out.len() as f64).sqrt() / floor,
        }
    }
}
