//! What the law must do: it reaches its limits, it comes back, what waits moves again.

use super::{cast_estimator, lag, literal};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Fault, Form,
    Leakage, Limits, OnMissing, SmoothSign, Status,
};
use bowden::Real;
use proptest::prelude::*;

/// Laws of each form, half of them in each float.
const LAWS: u32 = 2000;

/// Most samples of one way, so that all laws take seconds.
const LONGEST_WAY: f64 = 1500.0;

/// A number between two, spread evenly over its logarithm.
fn over_decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// How far beyond its limit the law must ask before the command counts as being there, as a share
/// of the range: above the rounding of any sum here, and what the lag approaches within.
const MARGIN: f64 = 1e-3;

/// A law, a sample time, and errors of both signs that do not end by themselves.
#[derive(Debug, Clone, Copy)]
struct Journey<T: Real> {
    law: Adaptive<T, 2>,
    dt: T,
    reference: T,
    regressors: [T; 2],
    feed_forward: T,
    /// Magnitude of the error on the way up, and down.
    errors: [f64; 2],
}

fn of<T: Real>(x: T) -> f64 {
    x.to_f64().unwrap()
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

/// A range, which the slew rate takes so many seconds to go through.
fn limited<T: Real>(low: f64, high: f64, seconds: Option<f64>) -> Limits<T> {
    let limits = Limits::try_new(T::from_f64(-low), T::from_f64(high)).unwrap();
    seconds.map_or(limits, |seconds| {
        limits
            .with_slew(T::from_f64((low + high) / seconds))
            .unwrap()
    })
}

/// Admissible laws over several decades of every number.
fn journey<T: Real>(is_lag: bool) -> impl Strategy<Value = Journey<T>> {
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
    (gains, boxes, times, range, sample).prop_map(
        move |((gain, lambda, epsilon, smooth_sign), boxes, times, range, sample)| {
            let (beta, delta, theta_0, theta_1) = boxes;
            let (loop_gain, share, free_dt) = times;
            let (low, high, slew, z_limit) = range;
            // The largest step of the lag form is 1/(lambda·max(1, loop_gain)).
            let dt = if is_lag {
                share * 0.999 / (lambda * loop_gain.max(1.0))
            } else {
                free_dt
            };
            let form = if is_lag {
                Form::FirstOrder {
                    step: T::from_f64(dt),
                    plant_gain: T::from_f64(
                        loop_gain / (beta.high * (gain + delta.high / epsilon)),
                    ),
                }
            } else {
                Form::AsPublished {
                    time_constant: T::from_f64(0.2 * dt * loop_gain),
                }
            };
            let limits = limited(low, high, slew.map(|samples| samples * dt));
            let settings = AdaptiveSettings {
                smooth_sign,
                beta: cast_estimator(&beta),
                delta: cast_estimator(&delta),
                theta: [cast_estimator(&theta_0), cast_estimator(&theta_1)],
                z_limit: z_limit.map_or(T::HIGHEST, T::from_f64),
                ..AdaptiveSettings::new(
                    form,
                    T::from_f64(gain),
                    T::from_f64(lambda),
                    T::from_f64(epsilon),
                    limits,
                    T::from_f64(10.0),
                    Fallback::try_new(20, T::zero()).unwrap(),
                )
            };
            let (reference, [x_0, x_1], feed_forward, errors) = sample;
            let journey = Journey {
                law: Adaptive::try_new(settings).unwrap(),
                dt: T::from_f64(dt),
                reference: T::from_f64(reference),
                regressors: [T::from_f64(x_0), T::from_f64(x_1)],
                feed_forward: T::from_f64(feed_forward),
                errors,
            };
            journey.in_time()
        },
    )
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
        let measured = self.reference - T::from_f64(sign * error);
        AdaptiveInput {
            feed_forward: self.feed_forward,
            ..AdaptiveInput::new(self.dt, self.reference, measured, self.regressors)
        }
    }

    fn width(&self) -> f64 {
        let limits = self.law.settings().limits;
        of(limits.high()) - of(limits.low())
    }

    /// |z| from which on the law asks for more than the limit on this side, wherever the estimates
    /// are in their boxes: (23) with s = -sign·(e + lambda·|z|), where delta_hat·T helps.
    fn z_at_limit(&self, sign: f64, error: f64) -> f64 {
        let s = self.law.settings();
        let limit = of(if sign > 0.0 {
            s.limits.high()
        } else {
            s.limits.low()
        });
        let wanted = sign * (limit - of(self.feed_forward)) + MARGIN * self.width();
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
            prop_assert!(
                close(z.1, z.0, change, change.abs(), -s.z_limit, s.z_limit),
                "{z:?}"
            );
        }
        let waits = asks_more(terms.s);
        let pull = of(s.lambda) * of(terms.s);
        let theta = |i: usize| {
            let drive = -pull * of(at.regressors[i]);
            (
                before.theta_hat()[i],
                state.theta_hat()[i],
                s.theta[i],
                drive,
            )
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
            prop_assert!(
                close(got, from, change, terms, estimator.low, estimator.high),
                "{from} {got} {change}"
            );
        }
        Ok((out.command, waits))
    }

    /// With an error that keeps its sign the command reaches the limit on its side, and stays.
    fn reaches(&self, state: &mut AdaptiveState<T, 2>, sign: f64) -> Result<(), TestCaseError> {
        let s = self.law.settings();
        let error = self.errors[usize::from(sign < 0.0)];
        let (at, most) = (self.at(sign, error), self.most(state, sign, error));
        // Of the error as the float has it.
        let (limit, z_end) = if sign > 0.0 {
            (s.limits.high(), -s.z_limit)
        } else {
            (s.limits.low(), s.z_limit)
        };
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
            prop_assert!(
                on_the_way <= most,
                "{command} of {limit} after {on_the_way} of {most}, z = {}",
                state.accumulated_error()
            );
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
    let laws = ProptestConfig {
        cases: LAWS / 2,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(u64::from(is_lag)),
        ..ProptestConfig::default()
    };
    let mut runner = proptest::test_runner::TestRunner::new(laws);
    let travels = |journey: Journey<f32>| journey.travels();
    runner.run(&journey::<f32>(is_lag), travels).unwrap();
    let travels = |journey: Journey<f64>| journey.travels();
    runner.run(&journey::<f64>(is_lag), travels).unwrap();
}

#[test]
fn any_literal_law_reaches_one_limit_and_then_the_other() {
    every_law_travels(false);
}

#[test]
fn any_law_of_the_lag_form_reaches_one_limit_and_then_the_other() {
    every_law_travels(true);
}

/// A NaN encoder for a second: its estimate, and those of the others, wait; then all move again.
#[test]
fn estimates_that_a_dropped_regressor_held_move_again_with_the_first_good_sample() {
    for settings in [literal(), lag()] {
        let law = Adaptive::try_new(AdaptiveSettings {
            missing: [OnMissing::DropRegressor],
            ..settings
        })
        .unwrap();
        let mut state = AdaptiveState::new(&law);
        let at = |x| AdaptiveInput::new(0.001, 3.0, 2.9, [x]);
        law.step(&mut state, &at(0.3));
        let estimates = |state: &AdaptiveState<f64, 1>| {
            [state.beta_hat(), state.delta_hat(), state.theta_hat()[0]]
        };
        let held = estimates(&state);
        for k in 0..1000 {
            let status = law.step(&mut state, &at(f64::NAN)).status;
            assert_eq!(status, Status::Degraded(Fault::Regressor(0)), "{k}");
            assert_eq!(estimates(&state), held);
        }
        // The loop is closed all the time: -0.1 N·m for 1.001 s.
        assert!((state.accumulated_error() + 0.1001).abs() < 1e-12);
        assert_eq!(law.step(&mut state, &at(0.3)).status, Status::Good);
        let moved = estimates(&state);
        assert!(moved.iter().zip(&held).all(|(new, old)| new != old));
    }
}

#[test]
fn estimates_that_were_frozen_move_again_with_the_first_sample_of_a_law_that_is_not() {
    for settings in [literal(), lag()] {
        let free = Adaptive::try_new(settings).unwrap();
        let frozen = Adaptive::try_new(AdaptiveSettings {
            frozen: true,
            ..settings
        })
        .unwrap();
        let at = AdaptiveInput::new(0.001, 3.0, 2.9, [0.3]);
        let mut state = AdaptiveState::new(&frozen);
        for _ in 0..1000 {
            frozen.step(&mut state, &at);
        }
        assert_eq!(state.beta_hat(), settings.beta.initial);
        assert_eq!(state.delta_hat(), settings.delta.initial);
        assert_eq!(state.theta_hat()[0], settings.theta[0].initial);
        free.step(&mut state, &at);
        assert!(state.beta_hat() != settings.beta.initial);
        assert!(state.delta_hat() != settings.delta.initial);
        assert!(state.theta_hat()[0] != settings.theta[0].initial);
    }
}

/// In f32 what a sample adds is below half an ulp of the sum: it is added all the same.
#[test]
fn in_f32_the_accumulated_error_moves_by_changes_below_its_rounding() {
    for is_lag in [false, true] {
        let form = if is_lag {
            Form::FirstOrder {
                step: 1e-4,
                plant_gain: 1.0,
            }
        } else {
            Form::AsPublished {
                time_constant: 0.01,
            }
        };
        let law = Adaptive::try_new(AdaptiveSettings::<f32, 0>::unlimited(form, 24.0, 8.0, 0.2));
        let (law, mut state) = (law.unwrap(), AdaptiveState::new(&law.unwrap()));
        for _ in 0..10_000 {
            law.step(&mut state, &AdaptiveInput::new(1e-4, 0.0, 10.0, []));
        }
        // 1e-7 a sample, an eighth of the distance of two floats at 10.
        let from = state.accumulated_error();
        let error = 1e-3_f32;
        for _ in 0..100_000 {
            law.step(&mut state, &AdaptiveInput::new(1e-4, 0.0, error, []));
        }
        let moved = f64::from(state.accumulated_error()) - f64::from(from);
        // To that distance at both ends, and the rounding of 1e-4·1e-3.
        assert!((moved - 0.01).abs() < 2e-6, "{moved}");
    }
}
