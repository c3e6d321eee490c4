//! The step is its line: what the certificates speak of is what is shipped, bit for bit.
//!
//! The lines below are written from the equations (18), (19), (23)-(26) and from the forward
//! error analysis of `bowden_bound::PeakRounded`, with sums, filters and limits of their own.

use super::*;

type Settings<T> = AdaptiveSettings<T, 2>;

/// A sum and what it owes: Knuth's six operations, in another order of writing.
#[derive(Clone, Copy)]
struct Sum<T>(T, T);

impl<T: Real> Sum<T> {
    fn plus(self, increment: T) -> Self {
        let moved = increment + self.1;
        let sum = self.0 + moved;
        let taken = sum - self.0;
        let of_value = self.0 - (sum - taken);
        let of_moved = moved - taken;
        Self(sum, of_value + of_moved)
    }

    fn within(self, low: T, high: T) -> Self {
        if self.0 < low {
            Self(low, T::ZERO)
        } else if self.0 > high {
            Self(high, T::ZERO)
        } else {
            self
        }
    }
}

/// One estimate: (24)-(26) with its box.
fn adapted<T: Real>(by: &Estimator<T>, p: Sum<T>, dt: T, drive: T) -> Sum<T> {
    let sigma = match by.leakage {
        Leakage::Constant { rate } => rate,
        _ => T::ZERO,
    };
    let rate = by.gain * drive - sigma * (p.0 - by.prior);
    let moved = p.plus(dt * rate / (T::ONE + dt * sigma));
    moved.within(by.low, by.high)
}

struct Line<T> {
    z: Sum<T>,
    lag: Sum<T>,
    beta: Sum<T>,
    delta: Sum<T>,
    theta: [Sum<T>; 2],
    command: T,
    /// The filter of the error's rate: last error, rate.
    filter: (Option<T>, T),
}

impl<T: Real> Line<T> {
    fn new(law: &Settings<T>) -> Self {
        let sum = |x| Sum(x, T::ZERO);
        let start = law.limits.low().max(T::ZERO).min(law.limits.high());
        Self {
            z: sum(T::ZERO),
            lag: sum(start),
            beta: sum(law.beta.initial),
            delta: sum(law.delta.initial),
            theta: law.theta.map(|theta| sum(theta.initial)),
            command: start,
            filter: (None, T::ZERO),
        }
    }

    /// The rate of the reference, or less that of the error.
    fn rate(&mut self, law: &Settings<T>, at: &AdaptiveInput<T, 2>, e: T) -> T {
        let Form::AsPublished { time_constant } = law.form else {
            return (at.next_reference - at.reference) / at.dt;
        };
        if let Some(last) = self.filter.0 {
            let change = time_constant * self.filter.1 + (e - last);
            self.filter.1 = change / (time_constant + at.dt);
        }
        self.filter.0 = Some(e);
        -self.filter.1
    }

    /// The step; gives s and the command before the limits.
    fn step(&mut self, law: &Settings<T>, at: &AdaptiveInput<T, 2>) -> (T, T) {
        let (k, lambda, dt, x) = (law.gain, law.lambda, at.dt, at.regressors);
        let e = at.measured - at.reference;
        let s = e + lambda * self.z.0;
        let t = law.smooth_sign.of(s / law.epsilon);
        let rate = self.rate(law, at, e);
        let compensation = self.theta[0].0 * x[0] + self.theta[1].0 * x[1];
        let ubar =
            -(k * s) + at.reference + (rate - self.z.0) / lambda + compensation - self.delta.0 * t;
        let wanted = self.beta.0 * ubar;
        let lag = match law.form {
            Form::AsPublished { .. } => Sum(wanted, T::ZERO),
            Form::FirstOrder { .. } => self.lag.plus(dt * lambda * (wanted - self.lag.0)),
        };
        let unlimited = lag.0 + at.feed_forward;
        let command = self.limited(law, unlimited, dt);
        self.lag = if command == unlimited {
            lag
        } else {
            Sum(command - at.feed_forward, T::ZERO)
        };
        // Which way the limits cut: an error that asks for more is not summed.
        let cut = |error: T| {
            (command < unlimited && error < T::ZERO) || (command > unlimited && error > T::ZERO)
        };
        if !cut(e) {
            self.z = self.z.plus(dt * e).within(-law.z_limit, law.z_limit);
        }
        if !cut(s) {
            let pull = lambda * s;
            self.beta = adapted(&law.beta, self.beta, dt, -pull * ubar);
            self.delta = adapted(&law.delta, self.delta, dt, pull * t);
            for (i, x) in x.into_iter().enumerate() {
                self.theta[i] = adapted(&law.theta[i], self.theta[i], dt, -pull * x);
            }
        }
        self.command = command;
        (s, unlimited)
    }

    fn limited(&self, law: &Settings<T>, wanted: T, dt: T) -> T {
        let mut command = wanted;
        if let Some(slew) = law.limits.slew() {
            let reach = slew * dt;
            command = command.max(self.command - reach).min(self.command + reach);
        }
        command.max(law.limits.low()).min(law.limits.high())
    }
}

fn settings<T: Real>(random: &mut Random, number: u32) -> Settings<T> {
    let mut within = |low: f64, high: f64| T::from_f64(random.within(low, high));
    let form = match number % 2 {
        0 => Form::FirstOrder {
            step: T::from_f64(1e-4),
            plant_gain: T::ONE,
        },
        _ => Form::AsPublished {
            time_constant: within(0.0, 0.02),
        },
    };
    // Free, tight, and tight with a slew rate.
    let limits = match number / 2 % 3 {
        0 => Limits::unlimited(),
        1 => Limits::try_new(-within(1.0, 20.0), within(1.0, 20.0)).unwrap(),
        _ => {
            let limits = Limits::try_new(-within(5.0, 40.0), within(5.0, 40.0)).unwrap();
            limits.with_slew(within(100.0, 20_000.0)).unwrap()
        }
    };
    let of = T::from_f64;
    let mut own = |initial, low, high, gain| {
        Estimator::fixed(of(initial))
            .within(of(low), of(high))
            .adapting(within(0.0, gain), within(0.0, 0.1))
    };
    let (beta, delta) = (own(1.0, 0.8, 1.2, 0.01), own(1.0, 0.0, 4.0, 0.5));
    let theta = [own(0.1, -5.0, 5.0, 0.1); 2];
    let gains = (within(1.0, 30.0), within(2.0, 10.0), within(0.2, 1.0));
    let fallback = Fallback::hold_indefinitely();
    AdaptiveSettings {
        smooth_sign: [SmoothSign::Tanh, SmoothSign::Clamp][(number / 6 % 2) as usize],
        beta,
        delta,
        theta,
        z_limit: within(0.01, 1.0),
        ..AdaptiveSettings::new(form, gains.0, gains.1, gains.2, limits, T::ONE, fallback)
    }
}

/// A sample with sizes of every kind, down to what underflows.
fn sample<T: Real>(random: &mut Random, number: u32) -> AdaptiveInput<T, 2> {
    let mut within = |low: f64, high: f64| random.within(low, high);
    let size = if within(0.0, 1.0) < 0.1 {
        within(-300.0, 1.6)
    } else {
        1.6
    };
    let scale = 10.0_f64.powf(size);
    let r = within(-1.0, 1.0) * scale;
    let measured = if within(0.0, 1.0) < 0.05 {
        r
    } else {
        within(-40.0, 40.0)
    };
    let feed_forward = if number % 4 < 2 {
        0.0
    } else {
        within(-5.0, 5.0)
    };
    let x = [within(-2.0, 2.0) * scale, within(-2.0, 2.0)].map(T::from_f64);
    let [dt, r, measured, next_reference, feed_forward] = [
        within(1e-5, 1e-4),
        r,
        measured,
        within(-40.0, 40.0),
        feed_forward,
    ]
    .map(T::from_f64);
    AdaptiveInput {
        next_reference,
        feed_forward,
        ..AdaptiveInput::new(dt, r, measured, x)
    }
}

/// Steps compared, and on how many of them a limit was met.
fn compared<T: Real>(systems: u32) -> (u32, u32) {
    let mut random = Random(7);
    let (mut compared, mut limited) = (0, 0);
    for number in 0..systems {
        let settings = settings::<T>(&mut random, number);
        let law = Adaptive::try_new(settings).unwrap();
        let (mut state, mut line) = (AdaptiveState::new(&law), Line::new(&settings));
        for _ in 0..150 {
            let at = sample(&mut random, number);
            let out = law.step_with_terms(&mut state, &at);
            assert_eq!(out.status, Status::Good);
            let (s, unlimited) = line.step(&settings, &at);
            let [x, y] = state.theta_hat();
            let z = state.accumulated_error();
            let shipped = [out.terms.s, out.terms.unlimited, out.command, z, x, y];
            let [x, y] = line.theta.map(|theta| theta.0);
            let written = [s, unlimited, line.command, line.z.0, x, y];
            // A zero of either sign is a zero: what it adds to is the same.
            let bits = |x: T| (x.as_f64() + 0.0).to_bits();
            assert_eq!(shipped.map(bits), written.map(bits), "{settings:?} {at:?}");
            let (shipped, written) = (
                [state.beta_hat(), state.delta_hat()],
                [line.beta.0, line.delta.0],
            );
            assert_eq!(shipped.map(bits), written.map(bits), "{settings:?} {at:?}");
            compared += 1;
            limited += u32::from(out.terms.limited);
        }
    }
    (compared, limited)
}

#[test]
fn the_shipped_step_is_its_line_to_the_bit() {
    for (compared, limited) in [compared::<f32>(2400), compared::<f64>(2400)] {
        println!("{compared} steps to the bit, {limited} of them at a limit");
        assert!(compared == 360_000 && limited > compared / 10 && limited < compared);
    }
}
