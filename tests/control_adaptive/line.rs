//! The step is its line: what the certificates speak of is what is shipped, bit for bit.
//!
//! The lines below are written from the equations (18), (19), (23)-(26) and from the forward
//! error analysis of `bowden_bound::PeakRounded`, with sums, filters and limits of their own.

use super::Random;
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Form, Leakage,
    Limits, SmoothSign, Status,
};

macro_rules! line {
    ($module:ident, $float:ty) => {
        mod $module {
            use super::*;

            /// A sum and what it owes: Knuth's six operations, in another order of writing.
            #[derive(Clone, Copy)]
            struct Sum($float, $float);

            impl Sum {
                fn plus(self, increment: $float) -> Self {
                    let moved = increment + self.1;
                    let sum = self.0 + moved;
                    let taken = sum - self.0;
                    let of_value = self.0 - (sum - taken);
                    let of_moved = moved - taken;
                    Self(sum, of_value + of_moved)
                }

                fn within(self, low: $float, high: $float) -> Self {
                    if self.0 < low {
                        Self(low, 0.0)
                    } else if self.0 > high {
                        Self(high, 0.0)
                    } else {
                        self
                    }
                }
            }

            /// One estimate: (24)-(26) with its box.
            fn adapted(by: &Estimator<$float>, p: Sum, dt: $float, drive: $float) -> Sum {
                let distance = p.0 - by.prior;
                let sigma = match by.leakage {
                    Leakage::Constant { rate } => rate,
                    _ => 0.0,
                };
                let rate = by.gain * drive - sigma * distance;
                p.plus(dt * rate / (1.0 + dt * sigma))
                    .within(by.low, by.high)
            }

            struct Line {
                z: Sum,
                lag: Sum,
                beta: Sum,
                delta: Sum,
                theta: [Sum; 2],
                command: $float,
                /// The filter of the error's rate: last error, rate.
                filter: (Option<$float>, $float),
            }

            impl Line {
                fn new(law: &AdaptiveSettings<$float, 2>) -> Self {
                    let sum = |x: $float| Sum(x, 0.0);
                    let start = law.limits.low().max(0.0).min(law.limits.high());
                    Self {
                        z: sum(0.0),
                        lag: sum(start),
                        beta: sum(law.beta.initial),
                        delta: sum(law.delta.initial),
                        theta: law.theta.map(|theta| sum(theta.initial)),
                        command: start,
                        filter: (None, 0.0),
                    }
                }

                /// The step; gives s and the command before the limits.
                fn step(
                    &mut self,
                    law: &AdaptiveSettings<$float, 2>,
                    at: &AdaptiveInput<$float, 2>,
                ) -> ($float, $float) {
                    let (k, lambda, dt) = (law.gain, law.lambda, at.dt);
                    let e = at.measured - at.reference;
                    let s = e + lambda * self.z.0;
                    let t = law.smooth_sign.of(s / law.epsilon);
                    let rate = match law.form {
                        Form::FirstOrder { .. } => (at.next_reference - at.reference) / dt,
                        Form::AsPublished { time_constant } => {
                            if let Some(last) = self.filter.0 {
                                let change = time_constant * self.filter.1 + (e - last);
                                self.filter.1 = change / (time_constant + dt);
                            }
                            self.filter.0 = Some(e);
                            -self.filter.1
                        }
                    };
                    let compensation =
                        self.theta[0].0 * at.regressors[0] + self.theta[1].0 * at.regressors[1];
                    let ubar = -(k * s) + at.reference + (rate - self.z.0) / lambda + compensation
                        - self.delta.0 * t;
                    let wanted = self.beta.0 * ubar;
                    let lag = match law.form {
                        Form::AsPublished { .. } => Sum(wanted, 0.0),
                        Form::FirstOrder { .. } => {
                            self.lag.plus(dt * lambda * (wanted - self.lag.0))
                        }
                    };
                    let unlimited = lag.0 + at.feed_forward;
                    let command = self.limited(law, unlimited, dt);
                    self.lag = if command == unlimited {
                        lag
                    } else {
                        Sum(command - at.feed_forward, 0.0)
                    };
                    // Which way the limits cut: an error that asks for more is not summed.
                    let cut = |error: $float| {
                        (command < unlimited && error < 0.0) || (command > unlimited && error > 0.0)
                    };
                    if !cut(e) {
                        self.z = self.z.plus(dt * e).within(-law.z_limit, law.z_limit);
                    }
                    if !cut(s) {
                        let pull = lambda * s;
                        self.beta = adapted(&law.beta, self.beta, dt, -pull * ubar);
                        self.delta = adapted(&law.delta, self.delta, dt, pull * t);
                        for i in 0..2 {
                            let drive = -pull * at.regressors[i];
                            self.theta[i] = adapted(&law.theta[i], self.theta[i], dt, drive);
                        }
                    }
                    self.command = command;
                    (s, unlimited)
                }

                fn limited(
                    &self,
                    law: &AdaptiveSettings<$float, 2>,
                    wanted: $float,
                    dt: $float,
                ) -> $float {
                    let mut command = wanted;
                    if let Some(slew) = law.limits.slew() {
                        let reach = slew * dt;
                        command = command.max(self.command - reach).min(self.command + reach);
                    }
                    command.max(law.limits.low()).min(law.limits.high())
                }
            }

            #[allow(clippy::cast_possible_truncation)]
            fn settings(random: &mut Random, number: u32) -> AdaptiveSettings<$float, 2> {
                let mut within = |low: f64, high: f64| random.within(low, high) as $float;
                let form = if number % 2 == 0 {
                    Form::FirstOrder {
                        step: 1e-4,
                        plant_gain: 1.0,
                    }
                } else {
                    Form::AsPublished {
                        time_constant: within(0.0, 0.02),
                    }
                };
                // Free, tight, and tight with a slew rate.
                let limits = match number / 2 % 3 {
                    0 => Limits::unlimited(),
                    1 => Limits::try_new(-within(1.0, 20.0), within(1.0, 20.0)).unwrap(),
                    _ => Limits::try_new(-within(5.0, 40.0), within(5.0, 40.0))
                        .unwrap()
                        .with_slew(within(100.0, 20_000.0))
                        .unwrap(),
                };
                let sign = [SmoothSign::Tanh, SmoothSign::Clamp][(number / 6 % 2) as usize];
                AdaptiveSettings {
                    smooth_sign: sign,
                    beta: Estimator::fixed(1.0)
                        .within(0.8, 1.2)
                        .adapting(within(0.0, 0.01), within(0.0, 0.1)),
                    delta: Estimator::fixed(1.0)
                        .within(0.0, 4.0)
                        .adapting(within(0.0, 0.5), within(0.0, 0.1)),
                    theta: [Estimator::fixed(0.1)
                        .within(-5.0, 5.0)
                        .adapting(within(0.0, 0.1), within(0.0, 0.1)); 2],
                    z_limit: within(0.01, 1.0),
                    ..AdaptiveSettings::new(
                        form,
                        within(1.0, 30.0),
                        within(2.0, 10.0),
                        within(0.2, 1.0),
                        limits,
                        1.0,
                        Fallback::hold_indefinitely(),
                    )
                }
            }

            /// Steps compared, and on how many of them a limit was met.
            #[allow(clippy::cast_possible_truncation)]
            pub(super) fn compared(systems: u32) -> (u32, u32) {
                let mut random = Random(7);
                let (mut compared, mut limited) = (0, 0);
                for number in 0..systems {
                    let settings = settings(&mut random, number);
                    let law = Adaptive::try_new(settings).unwrap();
                    let (mut state, mut line) = (AdaptiveState::new(&law), Line::new(&settings));
                    for _ in 0..150 {
                        let mut within = |low: f64, high: f64| random.within(low, high) as $float;
                        // Sizes of every kind, down to what underflows.
                        let size = within(-300.0, 1.6);
                        let scale =
                            (10.0 as $float).powf(if within(0.0, 1.0) < 0.1 { size } else { 1.6 });
                        let r = within(-1.0, 1.0) * scale;
                        let measured = if within(0.0, 1.0) < 0.05 {
                            r
                        } else {
                            within(-40.0, 40.0)
                        };
                        let at = AdaptiveInput {
                            next_reference: within(-40.0, 40.0),
                            feed_forward: if number % 4 < 2 {
                                0.0
                            } else {
                                within(-5.0, 5.0)
                            },
                            ..AdaptiveInput::new(
                                within(1e-5, 1e-4),
                                r,
                                measured,
                                [within(-2.0, 2.0) * scale, within(-2.0, 2.0)],
                            )
                        };
                        let out = law.step_with_terms(&mut state, &at);
                        assert_eq!(out.status, Status::Good);
                        let (s, unlimited) = line.step(&settings, &at);
                        let shipped = [
                            out.terms.s,
                            out.terms.unlimited,
                            out.command,
                            state.accumulated_error(),
                            state.beta_hat(),
                            state.delta_hat(),
                            state.theta_hat()[0],
                            state.theta_hat()[1],
                        ];
                        let written = [
                            s,
                            unlimited,
                            line.command,
                            line.z.0,
                            line.beta.0,
                            line.delta.0,
                            line.theta[0].0,
                            line.theta[1].0,
                        ];
                        // A zero of either sign is a zero: what it adds to is the same.
                        let bits = |x: $float| (x + 0.0).to_bits();
                        assert_eq!(shipped.map(bits), written.map(bits), "{settings:?} {at:?}");
                        compared += 1;
                        limited += u32::from(out.terms.limited);
                    }
                }
                (compared, limited)
            }
        }
    };
}
line!(single, f32);
line!(double, f64);

#[test]
fn the_shipped_step_is_its_line_to_the_bit() {
    for (compared, limited) in [single::compared(2400), double::compared(2400)] {
        println!("{compared} steps to the bit, {limited} of them at a limit");
        assert!(compared == 360_000 && limited > compared / 10 && limited < compared);
    }
}
