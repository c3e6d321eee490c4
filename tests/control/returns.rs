//! What an observer and a memory of cycles must do: they arrive, they return, they forget.

use super::*;

/// An observer, what it has seen before, and a constant disturbance.
#[derive(Debug, Clone)]
struct Seen {
    plant: (f64, f64, f64),
    tau: f64,
    latency: f64,
    dt: f64,
    limit: f64,
    before: Vec<(f64, f64, u8)>,
    sent: f64,
    disturbance: f64,
}

fn seen() -> impl Strategy<Value = Seen> {
    let plant = (
        over_decades(0.1, 10.0),
        over_decades(3.0, 100.0),
        0.0..2.0_f64,
    );
    // tau of a tenth of 1/wn to thirty; 1 to 300 samples of it.
    let times = (
        over_decades(0.1, 30.0),
        over_decades(1.0, 300.0),
        prop_oneof![Just(0.0), over_decades(0.1, 30.0)],
    );
    let sample = (-100.0..100.0_f64, -100.0..100.0_f64, 0_u8..8);
    let before = prop::collection::vec(sample, 0..40);
    let constant = (over_decades(0.5, 50.0), -20.0..20.0_f64, -40.0..40.0_f64);
    (plant, times, before, constant).prop_map(
        |(plant, (lags, samples, late), before, (limit, sent, disturbance))| {
            let tau = lags / plant.1;
            let dt = tau / samples;
            let latency = late * dt;
            Seen {
                plant,
                tau,
                dt,
                latency,
                limit,
                before,
                sent,
                disturbance,
            }
        },
    )
}

impl Seen {
    fn observer<T: Real>(&self, limit: f64) -> DisturbanceObserver<T> {
        let plant = <[f64; 3]>::from(self.plant).map(T::from_f64);
        let plant = NominalPlant::try_new(plant[0], plant[1], plant[2]).unwrap();
        let [tau, limit, longest] = [self.tau, limit, 20.0 * self.dt].map(T::from_f64);
        let observer = DisturbanceObserver::try_new(plant, tau, limit, longest).unwrap();
        observer.with_latency(T::from_f64(self.latency)).unwrap()
    }

    /// Samples after which the estimate is what the plant lacks, to a thousandth of the limit.
    ///
    /// Three lags in series, none of which moves by less than m of its way, leave of a distance D at
    /// most `D·((1 − m)^n + n·m·(1 − m)^(n−1) + n·(n−1)/2·m²·(1 − m)^(n−2))`: the share of n throws
    /// that have hit less than three times.
    fn samples(&self) -> u32 {
        let (alpha, wn, zeta) = self.plant;
        let product = wn * self.tau;
        // The inverse's weights of the lags: of z2, of z1 - z2, and of y - 2·z1 + z2.
        let weights = 1.0 + (1.0 + 4.0 * zeta / product + 4.0 / (product * product)) / alpha;
        // No sample was beyond ±100, nor is what the plant gives: alpha·60.
        let most = weights * (200.0 + 60.0 * alpha);
        let share = self.dt / (self.tau + self.dt);
        let m = share.min(self.dt / self.latency.max(self.dt));
        let left = |n: f64| {
            let q = 1.0 - m;
            q.powf(n) + n * m * q.powf(n - 1.0) + 0.5 * n * (n - 1.0) * m * m * q.powf(n - 2.0)
        };
        let mut n = 4;
        while left(f64::from(n)) * most > 1e-3 * self.limit {
            n += 1;
        }
        n
    }

    /// The estimate arrives, whatever was before; without the disturbance it returns to zero.
    fn arrives<T: Real>(&self) -> Result<(), TestCaseError> {
        let [observer, free] =
            [self.limit, f64::from(f32::MAX)].map(|most| self.observer::<T>(most));
        let (mut state, mut unlimited) = (ObserverState::new(), ObserverState::new());
        for &(sent, measured, kind) in &self.before {
            let (dt, measured) = match kind {
                0 => (f64::NAN, measured),
                1 => (-self.dt, measured),
                2 => (1e3, measured),
                3 => (self.dt, f64::NAN),
                _ => (self.dt, measured),
            };
            let [dt, sent, measured] = [dt, sent, measured].map(T::from_f64);
            let at = ObserverInput { dt, sent, measured };
            observer.step(&mut state, &at);
            free.step(&mut unlimited, &at);
        }
        let (alpha, wn, zeta) = self.plant;
        let product = wn * self.tau;
        let weights = (1.0 + 4.0 * zeta / product + 4.0 / (product * product)) / alpha;
        for disturbance in [self.disturbance, 0.0, -self.disturbance] {
            let measured = alpha * (self.sent - disturbance);
            let [dt, sent, shown] = [self.dt, self.sent, measured].map(T::from_f64);
            let at = ObserverInput {
                dt,
                sent,
                measured: shown,
            };
            let mut estimate = T::zero();
            for _ in 0..self.samples() {
                let out = observer.step(&mut state, &at);
                prop_assert_eq!(out.status, Status::Good);
                estimate = out.command;
                // The limit cuts the output alone: nothing winds up behind it.
                let whole = free.step(&mut unlimited, &at).command;
                let limit = observer.limit();
                prop_assert_eq!(estimate, bowden::signal::clamp(whole, -limit, limit));
            }
            let expected = disturbance.clamp(-self.limit, self.limit);
            // Two floats next to each other in every lag, by the weights.
            let rounding =
                4.0 * T::epsilon().as_f64() * (self.sent.abs() + weights * measured.abs());
            let error = (estimate.as_f64() - expected).abs();
            prop_assert!(
                error <= 1e-3 * self.limit + rounding,
                "{estimate} {expected}"
            );
        }
        Ok(())
    }
}

proptest! {
    #[test]
    fn an_estimate_arrives_at_a_constant_disturbance_and_returns_in_a_computed_time(seen in seen()) {
        seen.arrives::<f32>()?;
        seen.arrives::<f64>()?;
    }
}

/// Cycles of ten samples a cell, with one error everywhere; what the cells have learned after each.
fn cycles(
    learning: &IterativeLearning<f32>,
    start: f32,
    errors: &[f32],
    learns: impl Fn(usize, usize) -> bool,
    mut see: impl FnMut(usize, &[f32]),
) {
    let mut state = learning.resume([start; 40], [0.0; 40]).unwrap();
    for (cycle, &error) in errors.iter().enumerate() {
        for k in 0..400_u16 {
            let at = IterativeLearningInput {
                learns: learns(cycle, usize::from(k) / 10),
                ..IterativeLearningInput::new((f32::from(k) + 0.5) / 400.0, error, 0.0)
            };
            assert_eq!(learning.step(&mut state, &at).status, Status::Good);
        }
        see(cycle, state.learned());
    }
}

#[test]
fn what_never_comes_again_fades_by_its_share_of_each_cycle() {
    for half_width in [0, 3] {
        let learning = IterativeLearning::try_new(1.0, 50.0, 2, half_width).unwrap();
        let learning = learning.with_forgetting(0.05).unwrap();
        let mut least = 0.0_f32;
        let all = |_, _| true;
        cycles(&learning, 20.0, &[0.0; 200], all, |cycle, learned| {
            // The last cells of the first cycle are still to come.
            let most = 20.0 * 0.95_f32.powi(cycle as i32);
            least = learned.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
            // 200 cycles of rounding.
            assert!(least <= most * 1.0001, "{cycle} {least} {most}");
        });
        assert!(least < 20.0 * 1e-4, "{least}");
    }
}

#[test]
fn cells_at_the_limit_unlearn_by_the_whole_error_from_the_first_cycle_on() {
    let learning = IterativeLearning::try_new(2.0_f32, 3.0, 1, 0).unwrap();
    // Ten cycles against the limit, then back.
    let mut errors = vec![1.0; 10];
    errors.extend([-0.25; 5]);
    let all = |_, _| true;
    cycles(&learning, 0.0, &errors, all, |cycle, learned| {
        // In the middle of the cycle: the cell has learned this cycle's error.
        let expected = match cycle {
            0 => 2.0,
            1..10 => 3.0,
            _ => 3.0 - 0.5 * (cycle as f32 - 9.0),
        };
        assert_eq!(learned[20], expected, "{cycle}");
    });
}

#[test]
fn after_cycles_that_were_not_to_be_learned_from_every_cell_learns_again() {
    let learning = IterativeLearning::try_new(1.0_f32, 50.0, 3, 0).unwrap();
    // A limit cut the command in half of the cells of two cycles.
    let cut = |cycle, cell| !((1..3).contains(&cycle) && (10..30).contains(&cell));
    let mut all = Vec::new();
    cycles(&learning, 0.0, &[1.0; 6], cut, |_, own| {
        all.push(own.to_vec())
    });
    for (before, pair) in all.windows(2).enumerate() {
        for (cell, (new, old)) in pair[1].iter().zip(&pair[0]).enumerate() {
            let gained = new - old;
            // The cells three before those that were cut, and before the three in which their
            // commands show.
            let is_cut = before < 2 && (7..30).contains(&cell);
            assert_eq!(gained, if is_cut { 0.0 } else { 1.0 }, "{before} {cell}");
        }
    }
}
