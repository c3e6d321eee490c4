//! Constructors: at run time, as a constant, and what they make.

use crate::adaptive;
use crate::blocks;
use crate::numbers::Numbers;
use crate::pid;
use crate::properties::control::{estimates_keep_their_limit, learning_keeps_its_limit};
use bowden::control::{Adaptive, Fallback, Limits, Pid};
use bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};
use bowden::control::{IterativeLearning, IterativeLearningInput};
use bowden::signal::{Plausible, PlausibleState, Ramp, RampState, Rates, RatesState};
use bowden::Constant;

/// Whatever the arguments: a constant is accepted where the run time accepts it, and refused
/// in the same words; the blocks in front of a controller do what their docs say.
pub fn check(data: &[u8]) {
    let mut from = Numbers::new(data);
    let _ = match from.byte().map(|byte| byte % 12) {
        Some(0) => limits(&mut from),
        Some(1) => laws(&mut from),
        Some(2) => plausible(&mut from),
        Some(3) => ramp(&mut from),
        Some(4) => rates(&mut from),
        Some(6) => observer(&mut from),
        Some(7) => learning(&mut from),
        Some(8) => blocks::low_pass_runs(&mut from),
        Some(9) => blocks::biquad_runs(&mut from),
        Some(10) => blocks::edges_run(&mut from),
        Some(11) => blocks::relay_runs(&mut from),
        _ => fallback(&mut from),
    };
}

fn limits(from: &mut Numbers) -> Option<()> {
    let (low, high, slew) = (from.any()?, from.any()?, from.any()?);
    let range = Limits::<f32>::try_new(low, high);
    assert!(range == Constant::<Limits<f32>>::try_new(low, high));
    assert!(range.is_ok() == (low.is_finite() && high.is_finite() && low < high));
    let range = range.unwrap_or(Limits::unlimited());
    let slewed = range.with_slew(slew);
    assert!(slewed == Constant::<Limits<f32>>::with_slew(range, slew));
    assert!(slewed.is_ok() == (slew.is_finite() && slew > 0.0));
    let limits = slewed.unwrap_or(range);
    loop {
        let (last, wanted) = (from.any()?, from.any()?);
        assert!(limits.contains(limits.clamp(wanted)));
        let out = limits.apply(last, wanted, 0.001);
        assert!(limits.contains(out) || wanted.is_nan() || last.is_nan());
    }
}

fn fallback(from: &mut Numbers) -> Option<()> {
    let (after, weight) = (u32::from(from.byte()?), u32::from(from.byte()?));
    let command: f32 = from.any()?;
    let safe = Fallback::<f32>::try_new(after, command);
    assert!(safe == Constant::<Fallback<f32>>::try_new(after, command));
    assert!(safe.is_ok() == (after > 0 && command.is_finite()));
    let safe = safe.unwrap_or(Fallback::hold_indefinitely());
    let weighed = safe.with_weight(weight);
    assert!(weighed.is_ok() == (weight > 0));
    if let Ok(weighed) = weighed {
        assert!(weighed.weight() == weight && weighed.command() == safe.command());
        assert!(weighed.after() == safe.after());
    }
    Some(())
}

fn laws(from: &mut Numbers) -> Option<()> {
    loop {
        if from.flag()? {
            let settings = pid::settings(from)?;
            assert!(Constant::<Pid<f32>>::try_new(settings) == Pid::try_new(settings));
        } else {
            let settings = adaptive::settings(from)?;
            assert!(Constant::<Adaptive<f32, 2>>::try_new(settings) == Adaptive::try_new(settings));
        }
    }
}

fn plausible(from: &mut Numbers) -> Option<()> {
    let (low, high, rate) = (from.any()?, from.any()?, from.any()?);
    let range = Plausible::<f32>::try_new(low, high);
    assert!(range == Constant::<Plausible<f32>>::try_new(low, high));
    let range = range.ok()?;
    let rated = range.with_rate(rate);
    assert!(rated == Constant::<Plausible<f32>>::with_rate(range, rate));
    let is_rated = rated.is_ok();
    let rated = rated
        .unwrap_or(range)
        .with_stuck_after(u32::from(from.byte()? % 4));
    let (period, longest_dt): (Option<f32>, Option<f32>) =
        (from.any_or_none()?, from.any_or_none()?);
    let sampled = period.map_or(Ok(rated), |period| rated.with_sample_period(period));
    let constant = period.map_or(Ok(rated), |period| {
        Constant::<Plausible<f32>>::with_sample_period(rated, period)
    });
    assert!(sampled == constant);
    let period = period.filter(|_| is_rated && sampled.is_ok());
    let sampled = sampled.unwrap_or(rated);
    let longest = longest_dt.map_or(Ok(sampled), |longest| sampled.with_longest_dt(longest));
    let constant = longest_dt.map_or(Ok(sampled), |it| {
        Constant::<Plausible<f32>>::with_longest_dt(sampled, it)
    });
    assert!(longest == constant);
    let longest_dt = longest_dt.filter(|_| longest.is_ok()).unwrap_or(f32::MAX);
    let plausible = longest.unwrap_or(sampled);
    let (mut state, mut was_good) = (PlausibleState::new(), false);
    loop {
        let (sample, last, dt) = (from.any()?, state.last(), from.dt()?);
        let out = plausible.step(&mut state, sample, dt, from.flag()?);
        assert!(out.value.is_nan() == out.fault.is_some());
        if out.fault.is_none() {
            assert!(out.value == sample && low <= sample && sample <= high);
            assert!(state.last() == Some(sample));
        } else {
            assert!(state.last() == last);
        }
        if let (Some(period), Some(last), true, None) = (period, last, was_good, out.fault) {
            let usable = dt >= 0.0 && dt <= longest_dt;
            let passed = f64::from(period) + f64::from(if usable { dt } else { longest_dt });
            // A time, a product and a difference are rounded; near zero to an absolute bit.
            let most = f64::from(rate) * passed * (1.0 + 4.0 * f64::from(f32::EPSILON));
            let way = (f64::from(sample) - f64::from(last)).abs();
            assert!(way <= most + f64::from(f32::MIN_POSITIVE));
        }
        was_good = out.fault.is_none();
    }
}

fn ramp(from: &mut Numbers) -> Option<()> {
    let ramp = Ramp::<f32>::try_new(from.any()?, from.any()?).ok()?;
    let start: f32 = from.any()?;
    let mut state = RampState::at(if start.is_finite() { start } else { 0.0 });
    loop {
        let (wanted, dt) = (from.any()?, from.dt()?);
        let before = state;
        assert!(ramp.step(&mut state, wanted, dt) == state.value());
        assert!(state.value().is_finite());
        if !(wanted.is_finite() && dt.is_finite() && dt > 0.0) {
            assert!(state == before);
        }
    }
}

fn rates(from: &mut Numbers) -> Option<()> {
    let rates = Rates::<f32>::try_new(from.any()?).ok()?;
    let gapped = rates.with_longest_gap(from.any()?).unwrap_or(rates);
    let rates = gapped.with_period(from.any()?).unwrap_or(gapped);
    let mut state = RatesState::new();
    loop {
        let position = from.any()?;
        let motion = rates.step(&mut state, position, from.dt()?).motion;
        assert!(motion.position.is_finite());
        assert!(motion.velocity.is_finite() && motion.acceleration.is_finite());
    }
}

fn observer(from: &mut Numbers) -> Option<()> {
    let (gain, frequency, damping) = (from.any()?, from.any()?, from.any()?);
    let plant = NominalPlant::<f32>::try_new(gain, frequency, damping);
    assert!(plant == Constant::<NominalPlant<f32>>::try_new(gain, frequency, damping));
    let (tau, limit, longest_dt) = (from.any()?, from.any()?, from.any()?);
    let plant = plant.ok()?;
    let observer = DisturbanceObserver::try_new(plant, tau, limit, longest_dt);
    assert!(
        observer == Constant::<DisturbanceObserver<f32>>::try_new(plant, tau, limit, longest_dt)
    );
    let observer = observer.ok()?;
    let latency = from.any()?;
    let late = observer.with_latency(latency);
    assert!(late == Constant::<DisturbanceObserver<f32>>::with_latency(observer, latency));
    assert!(late.is_ok() == (latency.is_finite() && latency >= 0.0));
    let observer = late.unwrap_or(observer);
    let mut state = ObserverState::new();
    loop {
        let (dt, sent, measured) = (from.dt()?, from.any()?, from.any()?);
        let at = ObserverInput { dt, sent, measured };
        assert!(estimates_keep_their_limit(&observer, state, &at));
        observer.step(&mut state, &at);
    }
}

/// Cells of the cycle: fewer than the largest lead and half width need.
const CELLS: usize = 32;

fn learning(from: &mut Numbers) -> Option<()> {
    let (gain, limit) = (from.any()?, from.any()?);
    let (lead, half_width) = (from.byte()? % 16, from.byte()? % 16);
    let (lead, half_width) = (u16::from(lead), u16::from(half_width));
    let learning = IterativeLearning::<f32>::try_new(gain, limit, lead, half_width);
    assert!(learning == Constant::<IterativeLearning<f32>>::try_new(gain, limit, lead, half_width));
    let share: f32 = from.any()?;
    let learning = learning.ok()?;
    let forgetful = learning.with_forgetting(share);
    assert!(forgetful == Constant::<IterativeLearning<f32>>::with_forgetting(learning, share));
    assert!(forgetful.is_ok() == (0.0..=1.0).contains(&share));
    let learning = forgetful.unwrap_or(learning);
    let (stored, unfiltered) = ([from.any()?; CELLS], [from.any()?; CELLS]);
    let state = if from.flag()? {
        learning.resume(stored, unfiltered)
    } else {
        learning.start(stored, unfiltered)
    };
    assert!(state.is_ok() == (learning.fewest_cells() <= CELLS));
    let mut state = state.ok()?;
    assert!(state.learned().iter().all(|x| x.abs() <= learning.limit()));
    let (mut along, mut before) = (0.0, [0.0; CELLS]);
    loop {
        let at = IterativeLearningInput {
            phase: phase(from, &mut along)?,
            reference: from.any()?,
            measured: from.any()?,
            learns: from.flag()?,
        };
        assert!(learning_keeps_its_limit(
            &learning,
            &mut state,
            &at,
            &mut before
        ));
    }
}

/// Mostly a little farther along the cycle, now and then a little back, or anything.
fn phase(from: &mut Numbers, along: &mut f32) -> Option<f32> {
    let byte = from.byte()?;
    let by = match byte {
        0..=207 => f32::from(byte),
        208..=239 => 207.0 - f32::from(byte),
        _ => return from.any(),
    };
    // A cell is 32 of these, and most go over less than five.
    *along = (*along + by / 1024.0).rem_euclid(1.0);
    Some(*along)
}
