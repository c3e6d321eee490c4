//! Convergence of learning: what is proved, against the frequency response by other means and
//! against the controllers that ship on simulated plants.

use super::simulated::{at, One, Simulated, BASE, DT};
use super::*;
use core::f64::consts::{PI, TAU};

const CELLS: usize = 250;

fn learning(gain: f64, lead: u16, half_width: u16) -> IterativeLearning<f64> {
    IterativeLearning::try_new(gain, 1e100, lead, half_width).unwrap()
}

fn around(x: f64, share: f64) -> Interval<f64> {
    between(x * (1.0 - share), x * (1.0 + share))
}

fn proved(
    learning: &IterativeLearning<f64>,
    cycle: &Interval<f64>,
    law: &Pid<f64>,
    plants: &PlantRange,
    factor: f64,
) -> bool {
    IterativeLearningConvergence::try_new(learning, CELLS, cycle, law, plants, factor).is_ok()
}

/// A complex number.
#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    fn turned(angle: f64) -> Self {
        Self(angle.cos(), angle.sin())
    }
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
    fn times(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self(a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
    }
    fn over(self, other: Self) -> Self {
        let size = other.0 * other.0 + other.1 * other.1;
        self.times(Self(other.0 / size, -other.1 / size))
    }
    fn size(self) -> f64 {
        self.0.hypot(self.1)
    }
}

/// A loop as its numbers stand in the docs.
#[derive(Clone, Copy)]
struct Numbers {
    plant: One,
    latency: f64,
    k_p: f64,
    k_i: f64,
}

impl Numbers {
    /// `P~/(1 + C·P~)`.
    fn closed(&self, w: f64) -> Complex {
        let (p, one) = (&self.plant, Complex(1.0, 0.0));
        let motor = Complex(-w * w / (p.wn * p.wn), 2.0 * p.zeta * w / p.wn);
        let load = motor.over(Complex(1.0, p.joint * w));
        let load = Complex(p.slope, 0.0).times(load).plus(one);
        let gain = Complex(p.slope * p.gain, 0.0);
        let plant = gain.times(Complex::turned(-self.latency * w)).over(load);
        let law = Complex(self.k_p, -self.k_i / w);
        plant.over(one.plus(law.times(plant)))
    }

    /// The greatest |H| of a fine grid of frequencies, with 40 images, and where it is \[rad/s\].
    fn most(&self, learning: &IterativeLearning<f64>, cycle: f64) -> (f64, f64) {
        let cell = cycle / CELLS as f64;
        let (first, last) = (TAU / cycle, PI / cell);
        let width = f64::from(learning.half_width()) + 1.0;
        let mut most = (0.0_f64, first);
        for k in 0..4000 {
            let w = first * (last / first).powf(f64::from(k) / 3999.0);
            let x = 0.5 * w * cell;
            let mut seen = Complex(0.0, 0.0);
            for image in -20..=20 {
                let y = x + PI * f64::from(image);
                // The docs' S³ at the image; G of a negative frequency is the conjugate.
                let share = (y.sin() / y).powi(3);
                let at = 2.0 * y / cell;
                let there = self.closed(at.abs());
                let there = Complex(there.0, there.1 * at.signum());
                seen = seen.plus(Complex(share, 0.0).times(there));
            }
            let early = Complex::turned(w * cell * f64::from(learning.lead()));
            let taught = Complex(-learning.gain(), 0.0).times(early).times(seen);
            let kept = Complex(1.0 - learning.forgetting(), 0.0);
            let filter = ((width * x).sin() / (width * x.sin())).powi(2);
            let left = filter * kept.plus(taught).size();
            most = if left > most.0 { (left, w) } else { most };
        }
        most
    }
}

fn numbers(plant: One, k_p: f64, k_i: f64) -> Numbers {
    Numbers {
        plant,
        latency: (plant.late as f64 + 0.5) * DT,
        k_p,
        k_i,
    }
}

/// For a single plant the least factor that is proved is the greatest |H|, computed by other means,
/// and what the bound of the images adds; the frequency of that |H|.
fn is_the_frequency_response(
    learning: &IterativeLearning<f64>,
    (plant, k_p, k_i): (One, f64, f64),
    images: f64,
) -> f64 {
    let (expected, w) = numbers(plant, k_p, k_i).most(learning, 1.0);
    let (law, cycle) = (pi(k_p, k_i), Interval::exactly(1.0));
    let shown = |factor: f64| proved(learning, &cycle, &law, &at(plant), factor);
    // Below it is false, so that nothing can be shown.
    assert!(
        !shown((expected - 1e-4).min(0.99)),
        "{learning:?} {expected}"
    );
    let is_clear = expected <= 0.99;
    assert!(
        !is_clear || shown(expected + images),
        "{learning:?} {expected}"
    );
    w
}

#[test]
fn of_single_plants_the_proof_is_the_frequency_response() {
    for (k_p, k_i) in [(30.0, 18.0), (12.0, 60.0), (6.0, 0.0)] {
        for (gain, lead, half_width) in [(4.0, 3, 4), (2.0, 2, 2), (1.0, 4, 5)] {
            let learning = learning(gain, lead, half_width).with_forgetting(0.01);
            let learning = learning.unwrap();
            for plant in [BASE, One { slope: 0.4, ..BASE }] {
                is_the_frequency_response(&learning, (plant, k_p, k_i), 5e-3);
            }
        }
    }
}

/// Likewise where the greatest |H| is far above the cycle's own frequency, so that lead, latency and
/// filter decide it.
#[test]
fn of_single_plants_the_proof_is_the_frequency_response_at_high_frequencies_too() {
    let soft = One { slope: 0.4, ..BASE };
    for (gain, lead, half_width, plant) in [
        (12.0, 3, 4, soft),
        (10.0, 4, 4, soft),
        (10.0, 3, 4, BASE),
        (10.0, 4, 4, BASE),
        (8.0, 5, 5, BASE),
        (6.0, 5, 4, BASE),
        (4.0, 5, 3, BASE),
    ] {
        let learning = learning(gain, lead, half_width);
        assert!(numbers(plant, 30.0, 18.0).most(&learning, 1.0).0 < 0.95);
        // The bound of the images has more of a greater gain.
        let w = is_the_frequency_response(&learning, (plant, 30.0, 18.0), 2e-3 * gain);
        assert!(w > 90.0, "{gain} {lead}: at {w}");
    }
}

#[test]
fn a_range_of_cycle_times_is_no_better_than_its_worst_end() {
    let learning = learning(4.0, 5, 3);
    let plant = One { late: 0, ..BASE };
    let latency = 0.0031;
    let own = with(numbers(plant, 30.0, 18.0), |own| own.latency = latency);
    let [(short, _), (long, _)] = [0.8, 1.25].map(|cycle| own.most(&learning, cycle));
    assert!(short < 0.88 && long > 0.94, "{short} {long}");
    let range = with(at(plant), |range| {
        range.latency = Interval::exactly(latency)
    });
    let shown = |low: f64, high: f64, factor: f64| {
        let law = pi(30.0, 18.0);
        proved(&learning, &between(low, high), &law, &range, factor)
    };
    assert!(shown(0.8, 0.8, 0.908));
    assert!(!shown(0.8, 1.25, 0.908));
    assert!(shown(0.8, 1.25, 0.951));
    assert!(!shown(1.25, 1.25, long - 1e-4));
}

#[test]
fn no_plant_of_a_range_is_worse_than_what_is_proved() {
    let share = 0.05;
    let learning = learning(4.0, 3, 4);
    let range = PlantRange {
        gain: around(0.6, share),
        natural_frequency: around(25.5, 0.5 * share),
        damping_ratio: around(0.265, share),
        joint: around(0.0033, share),
        slope: between(0.33, 1.0),
        latency: around(0.003, share),
    };
    let cycle = around(1.0, 0.1);
    assert!(proved(&learning, &cycle, &pi(30.0, 18.0), &range, 0.92));
    let (mut random, mut most) = (Random(5), 0.0_f64);
    for _ in 0..100 {
        let mut of = |interval: &Interval<f64>| match random.within(0.0, 3.0) as u32 {
            0 => interval.low,
            1 => interval.high,
            _ => random.within(interval.low, interval.high),
        };
        let plant = One {
            gain: of(&range.gain),
            wn: of(&range.natural_frequency),
            zeta: of(&range.damping_ratio),
            joint: of(&range.joint),
            slope: of(&range.slope),
            late: 0,
        };
        let latency = of(&range.latency);
        let own = with(numbers(plant, 30.0, 18.0), |own| own.latency = latency);
        most = most.max(own.most(&learning, of(&cycle)).0);
    }
    assert!(most < 0.92 && most > 0.885, "{most}");
}

/// Rms of the measured output over each cycle of one second, from a first feed-forward.
fn cycles(
    learning: &IterativeLearning<f64>,
    law: &Pid<f64>,
    plant: One,
    (cells, count): (usize, usize),
    first: impl FnMut(usize) -> f64,
) -> Vec<f64> {
    let first: Vec<f64> = (0..cells).map(first).collect();
    let mut known = learning.resume(first, vec![0.0; cells]).unwrap();
    let (mut state, mut simulated) = (PidState::new(), Simulated::new(plant));
    let per_cycle = (1.0 / DT).round() as usize;
    let mut all = Vec::new();
    for _ in 0..count {
        let mut squares = 0.0;
        for k in 0..per_cycle {
            let measured = simulated.measured();
            squares += measured * measured;
            let phase = k as f64 / per_cycle as f64;
            let at = IterativeLearningInput::new(phase, 0.0, measured);
            let command = learning.step(&mut known, &at).command;
            let at = with(PidInput::new(DT, 0.0, measured), |at| {
                at.feed_forward = command
            });
            simulated.step(law.step(&mut state, &at).command);
        }
        all.push((squares / per_cycle as f64).sqrt());
    }
    all
}

/// What is proved to shrink shrinks as fast, and the edge of the proof is the edge at which the
/// shipped controllers' errors grow.
#[test]
fn the_edge_of_the_proof_is_the_edge_of_what_grows() {
    let law = pi(30.0, 18.0);
    for (lead, half_width) in [(2, 2), (3, 4), (1, 3)] {
        let (one, plants) = (Interval::exactly(1.0), at(BASE));
        let own = |gain| learning(gain, lead, half_width);
        let shrinks = |gain: f64| proved(&own(gain), &one, &law, &plants, 1.0);
        let falls = |gain: f64| {
            let mut random = Random(11);
            let first = |_| random.within(-1.0, 1.0);
            let all = cycles(&own(gain), &law, BASE, (CELLS, 60), first);
            // Not where it is no number any more.
            all[59] < all[29]
        };
        let edge = |good: &dyn Fn(f64) -> bool| {
            let (mut low, mut high) = (0.5, 20.0);
            assert!(good(low) && !good(high));
            for _ in 0..6 {
                let middle = f64::sqrt(low * high);
                *(if good(middle) { &mut low } else { &mut high }) = middle;
            }
            f64::sqrt(low * high)
        };
        // A sixth halving of a factor 40 leaves 6 %; the mean of a cell over 20 samples is not the
        // whole integral.
        near(edge(&shrinks) / edge(&falls), 1.0, 0.1);
    }
    // A tone that is alone shrinks by its own |H|, and the first one learns least.
    let learning = learning(4.0, 3, 4);
    let tone = |cell: usize| (TAU * cell as f64 / CELLS as f64).cos();
    let all = cycles(&learning, &law, BASE, (CELLS, 20), tone);
    let slowest = numbers(BASE, 30.0, 18.0).most(&learning, 1.0).0;
    near(all[19] / all[18], slowest, 1e-3);
}

/// Below the cycle's own frequency, where a filter wide as half a cycle leaves nothing to see above it:
/// beside a P the mean itself is learned too fast, beside a PI with a slow integral what is almost the
/// mean. Errors of both grow, although every harmonic shrinks.
#[test]
fn learning_that_grows_below_the_cycles_frequency_is_not_shown() {
    let one = Interval::exactly(1.0);
    let shown = |own: &IterativeLearning<f64>, law: &Pid<f64>, factor: f64| {
        IterativeLearningConvergence::try_new(own, 400, &one, law, &at(BASE), factor).is_ok()
    };
    let grows = |own: &IterativeLearning<f64>, law: &Pid<f64>| {
        let mut random = Random(3);
        let all = cycles(own, law, BASE, (400, 30), |_| random.within(-1.0, 1.0));
        all[29] > 3.0 * all[9]
    };
    for (gain, half_width, law, is_good) in [
        (17.0, 120, pi(6.0, 0.0), false),
        (12.0, 120, pi(6.0, 0.0), true),
        (79.0, 139, pi(30.0, 18.0), false),
        (50.0, 139, pi(30.0, 18.0), true),
    ] {
        let own = learning(gain, 0, half_width);
        assert_eq!(shown(&own, &law, 1.0), is_good, "{gain}");
        assert_eq!(grows(&own, &law), !is_good, "{gain}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused_by_name() {
    let (good, law, plants) = (learning(4.0, 3, 4), pi(30.0, 18.0), at(BASE));
    let one = Interval::exactly(1.0);
    let refused = |cells: usize, cycle: f64, factor: f64| {
        let cycle = Interval::exactly(cycle);
        IterativeLearningConvergence::try_new(&good, cells, &cycle, &law, &plants, factor).err()
    };
    use Error::{Inadmissible, OutOfRange};
    #[rustfmt::skip]
    let cases = [
        (CELLS, 1.0, 1.0, None),
        (CELLS, 1.0, 0.0, Some(OutOfRange("factor"))),
        (CELLS, 1.0, 1.1, Some(OutOfRange("factor"))),
        (CELLS, 0.0, 1.0, Some(OutOfRange("cycle"))),
        (19, 1.0, 1.0, Some(Inadmissible("the lead and the filter need more cells"))),
        (21, 1.0, 1.0, Some(Inadmissible("the loop must hardly respond above the cells' Nyquist frequency"))),
    ];
    for (cells, cycle, factor, error) in cases {
        assert_eq!(refused(cells, cycle, factor), error);
    }
    let unstable = "the loop without learning must be stable with every plant of the range";
    let grows = "every tone must shrink by the factor on every plant of the range";
    let reversed = with(plants, |range| range.gain = Interval::exactly(-0.6));
    for (law, plants, condition) in [
        (Pid::paper_pid(), plants, "the law must be a P or a PI"),
        // Beyond the gain margin, and by Routh already.
        (pi(120.0, 18.0), plants, unstable),
        (pi(1.0, 1e5), plants, unstable),
        (pi(12.0, 60.0), plants, grows),
        (law, reversed, unstable),
    ] {
        let shown = IterativeLearningConvergence::try_new(&good, CELLS, &one, &law, &plants, 1.0);
        assert_eq!(shown.err(), Some(Inadmissible(condition)));
    }
}
