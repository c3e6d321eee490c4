//! Adversaries against the shipped controller, on a plant that is as bad as the certificate
//! allows: the box is filled and never left.

use super::rounded::{own, own_plant, proved, table_2, table_2_plant};
use super::*;

/// A signal that goes from one end to the other as fast as it may, and is there at the end
/// of each half period.
struct Swing {
    most: f64,
    rate: f64,
}

impl Swing {
    /// The value `left` \[s\] before the end of the half of sign `side`. A thousandth of the
    /// rate is left for the rounding of the float that it becomes.
    fn at(&self, side: f64, left: f64) -> f64 {
        side * (self.most - 0.999 * self.rate * left).max(-self.most)
    }
}

/// What the adversary plays: the plant's truth, and which way each regressor pushes.
struct Play<const N: usize> {
    alpha: f64,
    theta: [f64; N],
    /// Length of a half period \[s\].
    half: f64,
    /// Whether the estimates go from one corner of their boxes to the other and back, once a second.
    jumps: bool,
}

/// At rest at one end.
fn resting(jumps: bool) -> Play<0> {
    Play {
        alpha: 1.0,
        theta: [],
        half: f64::INFINITY,
        jumps,
    }
}

/// The reference's way from end to end at its rate, of [`own_plant`]; all else arrives with it.
fn moving(jumps: bool) -> Play<2> {
    Play {
        alpha: 0.92,
        theta: [3.0, 0.3],
        half: 2.0 * 25.0 / (0.999 * 22.3),
        jumps,
    }
}

/// What an adversary reached: the largest `|s|/S` of all samples, and of those whose command
/// the limit cut, with their number.
#[derive(Debug, Default)]
struct Reached {
    all: f64,
    limited: f64,
    cuts: u32,
    /// Fastest move of the command \[command unit/s\].
    fastest: f64,
}

/// The attack over `steps`, from the corner of rest; everything is asserted on the way.
fn attack<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    plant: &Plant<f64, N>,
    play: &Play<N>,
    steps: u32,
) -> Reached {
    attack_in(settings, plant, play, steps, &proved(settings, plant))
}

/// The same against a box that need not be proved.
fn attack_in<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    plant: &Plant<f64, N>,
    play: &Play<N>,
    steps: u32,
    proof: &PeakRounded,
) -> Reached {
    let (s_most, z_most) = (proof.s.high.as_f64(), proof.z.high.as_f64());
    let law = Adaptive::try_new(settings).unwrap();
    let [low, high] = corners(settings).map(|corner| Adaptive::try_new(corner).unwrap());
    let Form::FirstOrder { step: h, .. } = settings.form else {
        unreachable!("the lag form")
    };
    let h = h.min(settings.longest_dt);
    let (dt, lambda) = (h.as_f64(), settings.lambda.as_f64());
    let swing = |most, rate| Swing { most, rate };
    let reference = swing(plant.reference, plant.reference_rate);
    let disturbance = swing(0.999_9 * plant.delta, plant.delta_rate);
    let xs = plant.regressors.map(|x| swing(x.magnitude, x.rate));
    let phase = |n: u32| {
        let time = f64::from(n) * dt;
        let half = (time / play.half).floor();
        let side = if half % 2.0 == 0.0 { 1.0 } else { -1.0 };
        (side, play.half * (half + 1.0) - time)
    };
    let float = |x: f64| T::from_f64(x).as_f64();
    let mut state = AdaptiveState::new(&law);
    let mut last_load: Option<f64> = None;
    let mut reached = Reached::default();
    for n in 0..steps {
        let ((side, left), (next_side, next_left)) = (phase(n), phase(n + 1));
        let r = float(reference.at(side, left));
        let x: [f64; N] = core::array::from_fn(|i| float(xs[i].at(side, left)));
        let known: f64 = x.iter().zip(play.theta).map(|(x, theta)| x * theta).sum();
        let wanted = disturbance.at(side, left);
        let input = |y| AdaptiveInput::new(h, T::from_f64(r), y, x.map(T::from_f64));
        if n == 0 {
            // From rest: the command at which the errors start at zero.
            let at = T::from_f64((r + known + wanted) / play.alpha);
            state = AdaptiveState::resume_from(&law, at, &input(T::from_f64(r)));
        }
        let y = T::from_f64(play.alpha * state.command().as_f64() - known - wanted);
        // The disturbance that this y is of, with what y was rounded by.
        let d = play.alpha * state.command().as_f64() - known - y.as_f64();
        assert!(d.abs() <= plant.delta, "{d}");
        let (load, rate) = (d + known, proof.xi.high.as_f64());
        let moved = last_load.map_or(0.0, |last| (load - last).abs());
        assert!(moved <= dt * rate + 1e-14, "{n}");
        last_load = Some(load);
        let error = y.as_f64() - r;
        let z = state.accumulated_error().as_f64();
        let s = error + lambda * z;
        assert!(s.abs() <= s_most, "step {n}: s = {s}, S = {s_most}");
        assert!(z.abs() <= z_most, "step {n}: z = {z}, Z = {z_most}");
        assert!(error.abs() <= proof.bound(), "step {n}: e = {error}");
        reached.all = reached.all.max(s.abs() / s_most);
        let next = T::from_f64(reference.at(next_side, next_left));
        let input = with(input(y), |at| at.next_reference = next);
        let jumped = (f64::from(n) * dt).fract() >= 0.8;
        let law = match (play.jumps, jumped) {
            (false, _) => &law,
            (true, false) => &low,
            (true, true) => &high,
        };
        let before = state.command().as_f64();
        let output = law.step_with_terms(&mut state, &input);
        let speed = (output.command.as_f64() - before).abs() / dt;
        reached.fastest = reached.fastest.max(speed);
        assert_eq!(output.status, Status::Good);
        if output.terms.limited {
            reached.limited = reached.limited.max(s.abs() / s_most);
            reached.cuts += 1;
        }
    }
    println!("{} bits: {reached:?} in {steps} steps", 8 * size_of::<T>());
    reached
}

/// The law with its estimates held near either corner of their boxes: a step of it takes them there.
fn corners<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
) -> [AdaptiveSettings<T, N>; 2] {
    let held = |own: Estimator<T>, low: T, high: T| Estimator {
        initial: low,
        prior: low,
        low,
        high,
        ..own
    };
    let near = |own: Estimator<T>| (own.high - own.low) * T::from_f64(1e-3);
    let low = |own: Estimator<T>| held(own, own.low, own.low + near(own));
    let high = |own: Estimator<T>| held(own, own.high - near(own), own.high);
    [each(settings, low), each(settings, high)]
}

/// The law with a change of every estimator.
fn each<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    change: impl Fn(Estimator<T>) -> Estimator<T>,
) -> AdaptiveSettings<T, N> {
    with(settings, |s| {
        (s.beta, s.delta) = (change(s.beta), change(s.delta));
        s.theta = s.theta.map(change);
    })
}

/// Estimates where they do most harm; their gains are too small to move them.
fn worst<T: Real, const N: usize>(settings: AdaptiveSettings<T, N>) -> AdaptiveSettings<T, N> {
    each(settings, |own| with(own, |own| own.initial = own.low))
}

fn both(steps: u32) {
    // r = 10 and g = 0.8 push as 2 N·m, D = 6 N·m with them: W is filled, at rest.
    let (plant, own_plant) = (table_2_plant(), own_plant());
    let (resting, moving) = (resting(false), moving(false));
    for reached in [
        attack(worst(table_2::<f32, 0>(0.0)), &plant, &resting, steps),
        attack(worst(table_2::<f64, 0>(0.0)), &plant, &resting, steps),
        attack(worst(own::<f32>()), &own_plant, &moving, steps),
        attack(worst(own::<f64>()), &own_plant, &moving, steps),
    ] {
        assert!(reached.all >= 0.9, "{reached:?}");
    }
}

#[test]
fn an_adversary_fills_nine_tenths_of_the_box_and_never_leaves_it() {
    both(100_000);
}

#[test]
#[ignore = "slow: bash .ci/run bound"]
fn an_adversary_fills_the_box_for_a_million_steps_and_never_leaves_it() {
    both(1_000_000);
}

/// The same law with a limit of the command.
fn limited<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    command: f64,
) -> AdaptiveSettings<T, N> {
    let command = T::from_f64(command);
    with(settings, |s| {
        s.limits = Limits::try_new(-command, command).unwrap()
    })
}

/// s and z are driven into the corner while the command just holds the load; then the estimates
/// jump, and ask for more than the limit, which only just holds the reference against the load.
fn at_the_limit<T: Real>(steps: u32) {
    // (10 + 6)/1 = 16, and what z's rounding needs.
    let law = limited(worst(table_2::<T, 0>(T::ZERO)), 16.001);
    let plant = table_2_plant();
    assert!(proved(law, &plant).may_meet_the_limit());
    let reached = attack(law, &plant, &resting(true), steps);
    assert!(reached.all >= 0.9 && reached.limited >= 0.9, "{reached:?}");
    assert!(reached.cuts > steps / 100, "{reached:?}");
}

#[test]
fn an_adversary_that_meets_the_limit_fills_the_box_and_never_leaves_it() {
    at_the_limit::<f32>(100_000);
    at_the_limit::<f64>(100_000);
}

#[test]
#[ignore = "slow: bash .ci/run bound"]
fn an_adversary_that_meets_the_limit_for_a_million_steps_never_leaves_the_box() {
    at_the_limit::<f32>(1_000_000);
    at_the_limit::<f64>(1_000_000);
}

fn with_slew<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    slew: f64,
) -> AdaptiveSettings<T, N> {
    with(settings, |s| {
        s.limits = s.limits.with_slew(T::from_f64(slew)).unwrap()
    })
}

/// The same law with the least slew rate that is proved not to be met; the rate \[command unit/s\].
fn slewed<T: Real, const N: usize>(
    settings: AdaptiveSettings<T, N>,
    plant: &Plant<f64, N>,
) -> (AdaptiveSettings<T, N>, f64) {
    let at = |slew: f64| with_slew(settings, slew);
    let examined = PeakRounded::examine(&at(1e6), plant).unwrap();
    let moved = examined.slew.unwrap().left.as_f64();
    let Form::FirstOrder { step, .. } = settings.form else {
        unreachable!("the lag form")
    };
    // The rounding of slew·dt and of its sum with the command is a millionth of the command in f32.
    let least = moved / step.as_f64();
    let slew = least + 60.0 * 4.0 * T::epsilon().as_f64() / step.as_f64();
    let refused = PeakRounded::examine(&at(0.999 * least), plant).unwrap();
    assert_eq!(refused.refused().map(|it| it.name), Some(Named::Slew));
    (at(slew), slew)
}

#[test]
fn a_slew_rate_that_is_proved_not_to_be_met_is_not() {
    let (own_plant, plant) = (own_plant(), table_2_plant());
    let (moving, resting) = (moving(true), resting(true));
    let (single, of_single) = slewed(worst(own::<f32>()), &own_plant);
    let (double, of_double) = slewed(worst(own::<f64>()), &own_plant);
    // With a limit that is met, too.
    let (cut, of_cut) = slewed(limited(worst(table_2::<f32, 0>(0.0)), 16.001), &plant);
    let cut = attack(cut, &plant, &resting, 100_000);
    assert!(cut.cuts > 1000, "{cut:?}");
    for (reached, slew) in [
        (attack(single, &own_plant, &moving, 100_000), of_single),
        (attack(double, &own_plant, &moving, 100_000), of_double),
        (cut, of_cut),
    ] {
        let share = reached.fastest / slew;
        println!("{share} of a slew rate of {slew}");
        // Each term at its worst at once is more than any play reaches, but not by orders.
        assert!(share < 1.0 && share > 0.25, "{share}");
        assert!(reached.all > 0.9, "{reached:?}");
    }
}

#[test]
#[should_panic(expected = "s = ")]
fn below_that_slew_rate_an_adversary_leaves_the_box() {
    let plant = own_plant();
    let settings = worst(own::<f64>());
    let play = moving(true);
    assert!(proved(settings, &plant).slew.is_none());
    let slow = with_slew(settings, 40.0);
    let refused = PeakRounded::examine(&slow, &plant).unwrap();
    assert_eq!(refused.refused().map(|it| it.name), Some(Named::Slew));
    attack_in(slow, &plant, &play, 100_000, &refused);
}
