//! The paper's own identification of (5) to (7), to be compared with `bowden identify`.
//!
//! The paper minimises (8), the root mean square error of the output over all samples, over
//! rho, sigma, n, B, kappa_eta and T0: a genetic algorithm roughly, then the Nelder-Mead
//! simplex; the output comes from fourth-order Runge-Kutta. It does not state the settings.
//! Those of the genetic algorithm here are small ones, so that its cost is a lower bound;
//! those of the simplex are the usual ones (Lagarias et al., SIAM J. Optim. 9, 1998, with a
//! first simplex of 5 % of each coordinate and at most 200 evaluations a parameter).

use bowden_lab::record::Record;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// rho·(half-range of the input), sigma, n, B, kappa_eta and T0 over the output's half-range.
const LOWER: Point = [0.1, 0.5, 1.0, 0.0, 0.0, -1.0];
const UPPER: Point = [100.0, 100.0, 10.0, 2.0, 1.0, 1.0];

const POPULATION: usize = 50;
const ELITE: usize = 3;
/// Of the children that are not elite; the others are mutants.
const CROSSED: f64 = 0.8;
const MOST_GENERATIONS: usize = 600;
/// Generations without a gain of this share end the genetic algorithm.
const STALLED: usize = 50;
const GAIN: f64 = 1e-6;

const MOST_SIMPLEX: usize = 1200;
const SIMPLEX_TOLERANCE: f64 = 1e-4;

type Point = [f64; 6];

/// What the method has found, and what it took.
#[derive(Serialize)]
pub struct Found {
    pub evaluations: usize,
    pub samples: usize,
    pub rmse: f64,
    pub rho: f64,
    pub sigma: f64,
    pub n: f64,
}

/// The record as the fitness function sees it.
struct Fitness<'a> {
    input: &'a [f64],
    output: &'a [f64],
    input_reach: f64,
    output_reach: f64,
    evaluations: usize,
    most: usize,
}

fn reach(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * (high - low)
}

impl Fitness<'_> {
    /// (8), by Runge-Kutta with one step a sample; infinite outside the ranges.
    fn of(&mut self, at: &Point) -> f64 {
        let is_inside = |((value, low), high): ((&f64, &f64), &f64)| low <= value && value <= high;
        if !at.iter().zip(&LOWER).zip(&UPPER).all(is_inside) {
            return f64::INFINITY;
        }
        self.evaluations += 1;
        let [rho, sigma, n, b, kappa_eta, t0] = *at;
        let rho = rho / self.input_reach;
        let (kappa_eta, t0) = (kappa_eta * self.output_reach, t0 * self.output_reach);
        // (7) over abs(d tau_i / dt): the step is then the input's.
        let slope = |eta: f64, direction: f64| {
            let power = eta.abs().powf(n - 1.0);
            rho * (direction - sigma * power * eta + (sigma - 1.0) * direction * power * eta.abs())
        };
        let mut eta = 0.0_f64;
        let mut sum = 0.0;
        for (k, (tau_i, tau_o)) in self.input.iter().zip(self.output).enumerate() {
            if let Some(last) = k.checked_sub(1).map(|k| self.input[k]) {
                let (length, direction) = ((tau_i - last).abs(), (tau_i - last).signum());
                let first = slope(eta, direction);
                let second = slope(eta + 0.5 * length * first, direction);
                let third = slope(eta + 0.5 * length * second, direction);
                let fourth = slope(eta + length * third, direction);
                eta += length / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
            }
            let error = b * tau_i - kappa_eta * eta - t0 - tau_o;
            sum += error * error;
        }
        let rms = (sum / self.output.len() as f64).sqrt();
        if rms.is_finite() {
            rms
        } else {
            f64::INFINITY
        }
    }

    fn is_spent(&self) -> bool {
        self.evaluations >= self.most
    }
}

type Scored = (f64, Point);

fn by_fitness(all: &mut [Scored]) {
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
}

/// Of two at random the fitter.
fn parent(all: &[Scored], random: &mut ChaCha8Rng) -> Point {
    // Sorted: the lower index is the fitter.
    let [one, other] = [0, 1].map(|_| random.random_range(0..all.len()));
    all[one.min(other)].1
}

fn genetic(fitness: &mut Fitness, random: &mut ChaCha8Rng) -> Scored {
    let uniform = |random: &mut ChaCha8Rng| -> Point {
        std::array::from_fn(|i| random.random_range(LOWER[i]..=UPPER[i]))
    };
    let mut all: Vec<Scored> = (0..POPULATION)
        .map(|_| uniform(random))
        .map(|at| (fitness.of(&at), at))
        .collect();
    by_fitness(&mut all);
    let (mut best, mut stalled) = (all[0].0, 0);
    for generation in 0..MOST_GENERATIONS {
        if stalled >= STALLED || fitness.is_spent() {
            break;
        }
        // Mutants reach less far from generation to generation.
        let scale = 1.0 - generation as f64 / MOST_GENERATIONS as f64;
        let mut next = all[..ELITE].to_vec();
        while next.len() < POPULATION {
            let (mother, father) = (parent(&all, random), parent(&all, random));
            let child: Point = if random.random::<f64>() < CROSSED {
                std::array::from_fn(|i| {
                    if random.random() {
                        mother[i]
                    } else {
                        father[i]
                    }
                })
            } else {
                std::array::from_fn(|i| {
                    let normal: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
                    let far = 0.5 * scale * normal * (UPPER[i] - LOWER[i]);
                    (mother[i] + far).clamp(LOWER[i], UPPER[i])
                })
            };
            next.push((fitness.of(&child), child));
        }
        all = next;
        by_fitness(&mut all);
        stalled = if all[0].0 < best * (1.0 - GAIN) {
            0
        } else {
            stalled + 1
        };
        best = all[0].0;
    }
    all[0]
}

fn simplex(fitness: &mut Fitness, from: Scored) -> Scored {
    let begun = fitness.evaluations;
    let mut all = vec![from];
    for i in 0..from.1.len() {
        let mut at = from.1;
        at[i] = if at[i] == 0.0 { 0.00025 } else { 1.05 * at[i] };
        all.push((fitness.of(&at), at));
    }
    by_fitness(&mut all);
    while fitness.evaluations - begun < MOST_SIMPLEX && !fitness.is_spent() {
        let worst = all.len() - 1;
        let spread = all
            .iter()
            .flat_map(|(_, at)| at.iter().zip(&all[0].1).map(|(a, b)| (a - b).abs()));
        let is_flat = all[worst].0 - all[0].0 <= SIMPLEX_TOLERANCE;
        if is_flat && spread.fold(0.0, f64::max) <= SIMPLEX_TOLERANCE {
            break;
        }
        let middle: Point = std::array::from_fn(|i| {
            all[..worst].iter().map(|(_, at)| at[i]).sum::<f64>() / worst as f64
        });
        let mut beyond = |by: f64| {
            let at: Point = std::array::from_fn(|i| middle[i] + by * (middle[i] - all[worst].1[i]));
            (fitness.of(&at), at)
        };
        let reflected = beyond(1.0);
        let taken = if reflected.0 < all[0].0 {
            let expanded = beyond(2.0);
            Some(if expanded.0 < reflected.0 {
                expanded
            } else {
                reflected
            })
        } else if reflected.0 < all[worst - 1].0 {
            Some(reflected)
        } else {
            let by = if reflected.0 < all[worst].0 {
                0.5
            } else {
                -0.5
            };
            Some(beyond(by)).filter(|c| c.0 <= reflected.0.min(all[worst].0))
        };
        match taken {
            Some(taken) => all[worst] = taken,
            None => {
                let best = all[0].1;
                for one in &mut all[1..] {
                    let at: Point = std::array::from_fn(|i| 0.5 * (best[i] + one.1[i]));
                    *one = (fitness.of(&at), at);
                }
            }
        }
        by_fitness(&mut all);
    }
    all[0]
}

/// Identifies a record; `most` ends it early, so that one evaluation can be priced.
pub fn identify(record: &Record, most: usize) -> Found {
    let (input, output) = (&record.input.values, &record.output.values);
    let (input_reach, output_reach) = (reach(input), reach(output));
    let mut fitness = Fitness {
        input,
        output,
        input_reach,
        output_reach,
        evaluations: 0,
        most,
    };
    let rough = genetic(&mut fitness, &mut ChaCha8Rng::seed_from_u64(1));
    let (rmse, at) = simplex(&mut fitness, rough);
    Found {
        evaluations: fitness.evaluations,
        samples: input.len(),
        rmse,
        rho: at[0] / input_reach,
        sigma: at[1],
        n: at[2],
    }
}
