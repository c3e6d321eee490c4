//! What the law must do: it reaches its limits, it comes back, what waits moves again.

use super::*;

/// Laws of each form, half of them in each float.
const LAWS: u32 = 2000;

/// Most samples of one way, so that all laws take seconds.
const LONGEST_WAY: f64 = 1500.0;

/// How far beyond its limit the law must ask before the command counts as being there, as a share
/// of the range: above the rounding of any sum here, and what the lag approaches within.
const MARGIN: f64 = 1e-3;

/// A law, a sample time, and errors of both signs that do not end by themselves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Journey<T: Real> {
    pub(super) law: Adaptive<T, 2>,
    dt: T,
    reference: T,
    regressors: [T; 2],
    feed_forward: T,
    /// Magnitude of the error on the way up, and down.
    errors: [f64; 2],
}

fn of<T: Real>(x: T) -> f64 {
    x.as_f64()
}

fn to<T: Real>(x: f64) -> T {
    T::from_f64(x)
}

/// An estimator with a box around some value, a gain and any leakage.
fn estimator(low: f64, high: f64) -> impl Strategy<Value = Estimator<f64>> {
    let ends = (0.0..=1.0_f64, 0.0..=1.0_f64);
    let gain = prop_oneof![1 => Just(0.0), 3 => over_decades(1e-5, 1e-2)];
    let leakage = (0_u8..3, over_decades(1e-3, 10.0), over_decades(0.1, 5.0));
    (ends, gain, leakage).prop_map(move |((start, prior), gain, (kind, rate, bound))| {
        let at = |share: f64| low + share * (high - low);
        Estimator {
            gain,
            leakage: match kind {
                0 => Leakage::None,
                1 => Leakage::Constant { rate },
                _ => Leakage::Switching { rate, bound },
            },
            prior: at(prior),
            ..Estimator::fixed(at(start)).within(low, high)
        }
    })
}

/// Admissible laws over several decades of every number.
pub(super) fn journey<T: Real>(is_lag: bool) -> impl Strategy<Value = Journey<T>> {
    let gains = (
        over_decades(0.5, 50.0),
        over_decades(0.5, 20.0),
        over_decades(0.05, 2.0),
        prop_oneof![Just(SmoothSign::Tanh), Just(SmoothSign::Clamp)],
    );
    let boxes = (
        over_decades(0.05, 2.0)
            .prop_flat_map(|low| (1.1..4.0_f64).prop_flat_map(move |by| estimator(low, by * low))),
        (0.5..8.0_f64).prop_flat_map(|high| estimator(0.0, high)),
        estimator(-3.0, 2.0),
        estimator(-1.0, 4.0),
    );
    let free_dt = over_decades(1e-4, 0.01);
    let times = (over_decades(0.5, 50.0), 0.2..1.0_f64, free_dt);
    let range = (
        over_decades(0.5, 80.0),
        over_decades(0.5, 80.0),
        prop::option::of(over_decades(1.0, 1000.0)),
        prop::option::weighted(0.2, over_decades(1e-3, 10.0)),
    );
    let sample = (
        -30.0..30.0_f64,
        [-2.0..2.0_f64, -2.0..2.0],
        -40.0..40.0_f64,
        [over_decades(0.01, 30.0), over_decades(0.01, 30.0)],
    );
    (gains, boxes, times, range, sample).prop_map(move |(gains, boxes, times, range, sample)| {
        let (gain, lambda, epsilon, smooth_sign) = gains;
        let (beta, delta, theta_0, theta_1) = boxes;
        let (loop_gain, share, free_dt) = times;
        let (low, high, slew, z_limit) = range;
        // The largest step of the lag form is 1/(lambda·max(1, loop_gain)).
        let largest = 0.999 / (lambda * loop_gain.max(1.0));
        let dt = if is_lag { share * largest } else { free_dt };
        let plant_gain = loop_gain / (beta.high * (gain + delta.high / epsilon));
        let form = match is_lag {
            true => Form::FirstOrder {
                step: to(dt),
                plant_gain: to(plant_gain),
            },
            false => Form::AsPublished {
                time_constant: to(0.2 * dt * loop_gain),
            },
        };
        let limits = Limits::try_new(to::<T>(-low), to(high)).unwrap();
        // A range that the slew rate takes so many samples to go through.
        let slew = slew.map(|samples| to((low + high) / (samples * dt)));
        let limits = slew.map_or(limits, |slew| limits.with_slew(slew).unwrap());
        let safe = Fallback::try_new(20, T::zero()).unwrap();
        let [gain, lambda, epsilon] = [gain, lambda, epsilon].map(to);
        let settings = AdaptiveSettings {
            smooth_sign,
            beta: cast_estimator(&beta),
            delta: cast_estimator(&delta),
            theta: [cast_estimator(&theta_0), cast_estimator(&theta_1)],
            z_limit: z_limit.map_or(T::HIGHEST, to),
            ..AdaptiveSettings::new(form, gain, lambda, epsilon, limits, to(10.0), safe)
        };
        let (reference, regressors, feed_forward, errors) = sample;
        let journey = Journey {
            law: Adaptive::try_new(settings).unwrap(),
            dt: to(dt),
            reference: to(reference),
            regressors: regressors.map(to),
            feed_forward: to(feed_forward),
            errors,
        };
        journey.in_time()
    })
}

impl<T: Real> Journey<T> {
    /// The same with errors that are not too small to get there in the longest way.
    fn in_time(mut self) -> Self {
        for (sign, i) in [(1.0, 0), (-1.0, 1)] {
            let error = self.errors[i];
            let way = 2.0 * self.z_at_limit(sign, error) / (of(self.dt) * error);
            self.errors[i] *= (way / LONGEST_WAY).max(1.0);
        }
        self
    }

    /// A sample whose output is behind the reference by `error`, to the side of `sign`.
    fn at(&self, sign: f64, error: f64) -> AdaptiveInput<T, 2> {
        let measured = self.reference - to(sign * error);
        let at = AdaptiveInput::new(self.dt, self.reference, measured, self.regressors);
        with(at, |at| at.feed_forward = self.feed_forward)
    }

    fn width(&self) -> f64 {
        of(self.limit(1.0)) - of(self.limit(-1.0))
    }

    fn limit(&self, sign: f64) -> T {
        let limits = self.law.settings().limits;
        if sign > 0.0 {
            limits.high()
        } else {
            limits.low()
        }
    }

    /// |z| from which on the law asks for more than the limit on this side, wherever the estimates
    /// are in their boxes: (23) with s = -sign·(e + lambda·|z|), where delta_hat·T helps.
    fn z_at_limit(&self, sign: f64, error: f64) -> f64 {
        let s = self.law.settings();
        let limit = of(self.limit(sign)) - of(self.feed_forward);
        let wanted = sign * limit + MARGIN * self.width();
        let virtual_command = (wanted / of(s.beta.low)).max(0.0);
        let theta = s.theta.iter().zip(&self.regressors);
        let against: f64 = theta
            .map(|(theta, x)| of(*x).abs() * of(theta.low).abs().max(of(theta.high).abs()))
            .sum();
        let (gain, lambda) = (of(s.gain), of(s.lambda));
        let lacking = virtual_command - gain * error - sign * of(self.reference) + against;
        (lacking / (gain * lambda + 1.0 / lambda)).max(0.0)
    }

    /// Samples at the most, not counting those at the limit, until the command stays there; or, where
    /// z's own limit is too small for that, until z is there.
    ///
    /// A sample moves z by dt·e, or moves the command by what the slew rate gives towards the limit.
    /// It moves away from it in a sample of the first kind only. Then the lag comes within the margin.
    fn most(&self, state: &AdaptiveState<T, 2>, sign: f64, error: f64) -> f64 {
        let s = self.law.settings();
        let there = self.z_at_limit(sign, error).min(of(s.z_limit));
        let by_z =
            ((there + sign * of(state.accumulated_error())) / (of(self.dt) * error)).max(0.0);
        let by_lag = match s.form {
            Form::FirstOrder { .. } => (1.0 / MARGIN + 1.0).ln() / (of(self.dt) * of(s.lambda)),
            Form::AsPublished { .. } => 0.0,
        };
        let by_slew = s
            .limits
            .slew()
            .map_or(0.0, |slew| by_z + self.width() / (of(slew) * of(self.dt)));
        // Two samples for the ends of each; a thousandth for the rounding of dt·e.
        1.001 * (by_z + by_lag + by_slew) + 6.0
    }

    /// One step, in which z and every estimate move by all that (17) and (24)-(26) say, or wait where
    /// the limit has cut what they ask for; whether the estimates did.
    fn step(
        &self,
        state: &mut AdaptiveState<T, 2>,
        at: &AdaptiveInput<T, 2>,
    ) -> Result<(T, bool), TestCaseError> {
        let (s, before) = (self.law.settings(), *state);
        let out = self.law.step_with_terms(state, at);
        prop_assert_eq!(out.status, Status::Good);
        let terms = out.terms;
        let (cut_above, cut_below) = (out.command < terms.unlimited, out.command > terms.unlimited);
        let asks_more = |x: T| (cut_above && x < T::zero()) || (cut_below && x > T::zero());
        // Of sums of two numbers, and of the few products in the terms of the second.
        let close = |got: T, from: T, change: f64, terms: f64, low: T, high: T| {
            let expected = (of(from) + change).clamp(of(low), of(high));
            let rounding = 8.0 * of(T::epsilon()) * (of(from).abs() + terms);
            (of(got) - expected).abs() <= rounding
        };
        let z = (before.accumulated_error(), state.accumulated_error());
        if asks_more(terms.error) {
            prop_assert_eq!(z.0, z.1);
        } else {
            let change = of(at.dt) * of(terms.error);
            let moved = close(z.1, z.0, change, change.abs(), -s.z_limit, s.z_limit);
            prop_assert!(moved, "{z:?}");
        }
        let waits = asks_more(terms.s);
        let pull = of(s.lambda) * of(terms.s);
        let theta = |i: usize| {
            let (from, got) = (before.theta_hat()[i], state.theta_hat()[i]);
            (from, got, s.theta[i], -pull * of(at.regressors[i]))
        };
        let beta = -pull * of(terms.virtual_command);
        let delta = pull * of(terms.smooth_sign);
        for (from, got, estimator, drive) in [
            (before.beta_hat(), state.beta_hat(), s.beta, beta),
            (before.delta_hat(), state.delta_hat(), s.delta, delta),
            theta(0),
            theta(1),
        ] {
            if waits {
                prop_assert_eq!(from, got);
                continue;
            }
            let distance = from - estimator.prior;
            let leakage = of(estimator.leakage.rate_at(distance));
            let (pushed, leaked) = (of(estimator.gain) * drive, leakage * of(distance));
            let h = of(at.dt) / (1.0 + of(at.dt) * leakage);
            let change = h * (pushed - leaked);
            let terms = h * (pushed.abs() + leaked.abs());
            let moved = close(got, from, change, terms, estimator.low, estimator.high);
            prop_assert!(moved, "{from} {got} {change}");
        }
        Ok((out.command, waits))
    }

    /// With an error that keeps its sign the command reaches the limit on its side, and stays.
    fn reaches(&self, state: &mut AdaptiveState<T, 2>, sign: f64) -> Result<(), TestCaseError> {
        let s = self.law.settings();
        let error = self.errors[usize::from(sign < 0.0)];
        let (at, most) = (self.at(sign, error), self.most(state, sign, error));
        // Of the error as the float has it.
        let (limit, z_end) = (self.limit(sign), to::<T>(-sign) * s.z_limit);
        let z_is_enough = of(s.z_limit) >= self.z_at_limit(sign, error);
        let kick = match s.form {
            Form::AsPublished { time_constant } => 20.0 * of(time_constant) / of(self.dt),
            Form::FirstOrder { .. } => 0.0,
        };
        // The kick of the error's rate is over.
        let stays = kick + 20.0;
        let (mut on_the_way, mut there) = (0.0, 0.0);
        while there < stays {
            let (command, _) = self.step(state, &at)?;
            if command == limit {
                there += 1.0;
                continue;
            }
            (there, on_the_way) = (0.0, on_the_way + 1.0);
            if !z_is_enough && state.accumulated_error() == z_end {
                break;
            }
            prop_assert!(on_the_way <= most, "{command} of {limit}, {state:?}");
        }
        Ok(())
    }

    /// There, back, and there again.
    fn travels(&self) -> Result<(), TestCaseError> {
        let mut state = AdaptiveState::new(&self.law);
        for sign in [1.0, -1.0, 1.0] {
            self.reaches(&mut state, sign)?;
        }
        Ok(())
    }
}

fn every_law_travels(is_lag: bool) {
    let laws = seeded(LAWS / 2, u64::from(is_lag));
    let mut runner = proptest::test_runner::TestRunner::new(laws);
    let single = |journey: Journey<f32>| journey.travels();
    runner.run(&journey(is_lag), single).unwrap();
    let double = |journey: Journey<f64>| journey.travels();
    runner.run(&journey(is_lag), double).unwrap();
}

#[test]
fn any_literal_law_reaches_one_limit_and_then_the_other() {
    every_law_travels(false);
}

#[test]
fn any_law_of_the_lag_form_reaches_one_limit_and_then_the_other() {
    every_law_travels(true);
}

#[test]
fn estimates_that_a_dropped_regressor_held_move_again_with_the_first_good_sample() {
    for settings in both() {
        let law = law(settings, |s| s.missing = [OnMissing::DropRegressor]);
        let mut state = AdaptiveState::new(&law);
        law.step(&mut state, &at(3.0, 2.9, 0.3));
        let held = estimates(&state);
        for k in 0..1000 {
            // The law without that term.
            let wanted = law.terms(&state, &at(3.0, 2.9, 0.0)).unlimited;
            let out = law.step(&mut state, &at(3.0, 2.9, f64::NAN));
            assert_eq!(out.status, Status::Degraded(Fault::Regressor(0)), "{k}");
            assert_eq!((out.command, estimates(&state)), (wanted, held));
        }
        // The torque sensor is not an encoder.
        let deaf = law.step(&mut state.clone(), &lost(at(3.0, 2.9, f64::NAN)));
        assert_eq!(deaf.status, Status::Held(Fault::Measured));
        // The loop is closed all the time: -0.1 N·m for 1.001 s.
        near(state.accumulated_error(), -0.1001, 1e-12);
        let status = law.step(&mut state, &at(3.0, 2.9, 0.3)).status;
        assert_eq!(status, Status::Good);
        assert!((0..3).all(|i| estimates(&state)[i] != held[i]));
    }
}

#[test]
fn estimates_that_were_frozen_move_again_with_the_first_sample_of_a_law_that_is_not() {
    for settings in both() {
        let (free, frozen) = (law(settings, |_| ()), law(settings, |s| s.frozen = true));
        let (at, mut state) = (at(3.0, 2.9, 0.3), AdaptiveState::new(&frozen));
        let start = estimates(&state);
        for _ in 0..1000 {
            frozen.step(&mut state, &at);
        }
        assert_eq!(estimates(&state), start);
        // z integrates all the same: -0.1 N·m for 1 s.
        near(state.accumulated_error(), -0.1, 1e-12);
        free.step(&mut state, &at);
        assert!((0..3).all(|i| estimates(&state)[i] != start[i]));
    }
}

/// In f32 what a sample adds is below half an ulp of the sum: it is added all the same.
#[test]
fn in_f32_the_accumulated_error_moves_by_changes_below_its_rounding() {
    let (step, plant_gain, time_constant) = (1e-4, 1.0, 0.01);
    for form in [
        Form::AsPublished { time_constant },
        Form::FirstOrder { step, plant_gain },
    ] {
        let settings = AdaptiveSettings::<f32, 0>::unlimited(form, 24.0, 8.0, 0.2);
        let law = Adaptive::try_new(settings).unwrap();
        let mut state = AdaptiveState::new(&law);
        for _ in 0..10_000 {
            law.step(&mut state, &AdaptiveInput::new(1e-4, 0.0, 10.0, []));
        }
        // 1e-7 a sample, an eighth of the distance of two floats at 10.
        let from = state.accumulated_error();
        for _ in 0..100_000 {
            law.step(&mut state, &AdaptiveInput::new(1e-4, 0.0, 1e-3, []));
        }
        let moved = f64::from(state.accumulated_error()) - f64::from(from);
        // To that distance at both ends, and the rounding of 1e-4·1e-3.
        near(moved, 0.01, 2e-6);
    }
}

/// A plant of either sign, driven out of reach for twenty seconds: the output then arrives.
fn returns_on_a_plant_of_gain<T: Real>(alpha: f64) {
    let limits = Limits::try_new(to(-5.0), to(5.0)).unwrap();
    let form = Form::AsPublished {
        time_constant: to(0.005),
    };
    let [gain, lambda, epsilon, longest] = [2.0, 4.0, 0.1, 0.01].map(to);
    let hold = Fallback::hold_indefinitely();
    let settings = AdaptiveSettings::<T, 0> {
        beta: Estimator::fixed(to(1.0 / alpha)),
        z_limit: to(10.0),
        ..AdaptiveSettings::new(form, gain, lambda, epsilon, limits, longest, hold)
    };
    let law = Adaptive::try_new(settings).unwrap();
    let (mut state, mut y) = (AdaptiveState::new(&law), 0.0);
    for k in 0..60_000 {
        let reference = if k < 20_000 { 20.0 } else { 1.0 };
        let input = AdaptiveInput::new(to(0.001), to(reference), to(y), []);
        let command: T = law.step(&mut state, &input).command;
        y += 0.001 * (alpha * of(command) - y) / 0.2;
    }
    // Forty seconds are more than a hundred time constants of the loop.
    assert!((y - 1.0).abs() < 1e-3, "alpha {alpha}: {y}");
}

#[test]
fn a_law_returns_from_its_limit_on_a_plant_of_either_sign() {
    for alpha in [1.0, -1.0] {
        returns_on_a_plant_of_gain::<f32>(alpha);
        returns_on_a_plant_of_gain::<f64>(alpha);
    }
}
