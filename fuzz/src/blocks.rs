//! Filters, the velocity between counts, and the relay experiment.

use crate::numbers::Numbers;
use crate::properties::control::a_relay_experiment_is_bounded_and_ends;
use bowden::control::{Relay, RelaySettings, RelayState};
use bowden::signal::{Biquad, BiquadState, LowPass, LowPassState};
use bowden::signal::{EdgeVelocity, EdgeVelocityState, RateStatus};
use bowden::Constant;

/// Whether a filter may use a sample.
fn is_usable(sample: f32, dt: f32) -> bool {
    sample.is_finite() && dt.is_finite() && dt > 0.0
}

/// A low-pass that its constructor accepts.
pub fn low_pass(from: &mut Numbers) -> Option<LowPass<f32>> {
    let time_constant: f32 = from.any()?;
    let filter = LowPass::<f32>::try_new(time_constant);
    assert!(filter == Constant::<LowPass<f32>>::try_new(time_constant));
    assert!(filter.is_ok() == (time_constant.is_finite() && time_constant >= 0.0));
    filter.ok()
}

/// The output is finite and within the range of the samples; a bad sample leaves it.
pub fn low_pass_runs(from: &mut Numbers) -> Option<()> {
    let (filter, mut state) = (low_pass(from)?, LowPassState::new());
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    loop {
        let (sample, dt) = (from.any()?, from.dt()?);
        low_pass_steps(&filter, &mut state, sample, dt);
        if !is_usable(sample, dt) {
            continue;
        }
        (low, high) = (low.min(sample), high.max(sample));
        // An increment is at most the range, and has five roundings with that of the sum.
        let slack = 5.0 * f32::EPSILON * (0.5 * high - 0.5 * low) + f32::MIN_POSITIVE;
        let (below, above) = (low - 2.0 * slack, high + 2.0 * slack);
        assert!(below <= state.value() && state.value() <= above);
    }
}

/// One sample to a low-pass in any state.
pub fn low_pass_steps(filter: &LowPass<f32>, state: &mut LowPassState<f32>, sample: f32, dt: f32) {
    let before = *state;
    let out = filter.step(state, sample, dt);
    assert!(out.is_finite() && out == state.value());
    assert!(is_usable(sample, dt) || *state == before);
}

/// A low-pass or a notch that its constructor accepts.
pub fn biquad(from: &mut Numbers) -> Option<Biquad<f32>> {
    let is_notch = from.flag()?;
    let (frequency, q, sample_time) = (from.any()?, from.any()?, from.any()?);
    let (filter, constant) = if is_notch {
        (
            Biquad::<f32>::notch(frequency, q, sample_time),
            Constant::<Biquad<f32>>::notch(frequency, q, sample_time),
        )
    } else {
        (
            Biquad::<f32>::low_pass(frequency, q, sample_time),
            Constant::<Biquad<f32>>::low_pass(frequency, q, sample_time),
        )
    };
    assert!(filter == constant);
    if filter.is_ok() {
        let all = [frequency, q, sample_time];
        assert!(all.iter().all(|x| x.is_finite() && *x > 0.0));
        assert!(frequency * sample_time < 0.5);
    }
    filter.ok()
}

/// The output is finite, a bad sample leaves it, and at rest it stays at its input.
pub fn biquad_runs(from: &mut Numbers) -> Option<()> {
    let (filter, mut state) = (biquad(from)?, BiquadState::new());
    loop {
        let (sample, dt) = (from.any()?, from.dt()?);
        biquad_steps(&filter, &mut state, sample, dt);
        if is_usable(sample, dt) {
            let mut rest = BiquadState::at(sample);
            assert!(filter.step(&mut rest, sample, dt) == sample);
            assert!(rest == BiquadState::at(sample));
        }
    }
}

/// One sample to a second-order section in any state.
pub fn biquad_steps(filter: &Biquad<f32>, state: &mut BiquadState<f32>, sample: f32, dt: f32) {
    let before = *state;
    let out = filter.step(state, sample, dt);
    assert!(out.is_finite() && out == state.value());
    assert!(is_usable(sample, dt) || *state == before);
}

/// A velocity between counts that its constructors accept, and its count.
pub fn edges(from: &mut Numbers) -> Option<(EdgeVelocity<f32>, f32)> {
    let (count, time_constant, longest_gap) = (from.any()?, from.any()?, from.any()?);
    let edges = EdgeVelocity::<f32>::try_new(count, time_constant, longest_gap);
    assert!(edges == Constant::<EdgeVelocity<f32>>::try_new(count, time_constant, longest_gap));
    let all = [count, time_constant, longest_gap];
    assert!(edges.is_ok() == all.iter().all(|x| x.is_finite() && *x > 0.0));
    let edges = edges.ok()?;
    let Some(period) = from.any_or_none()? else {
        return Some((edges, count));
    };
    let wrapping = edges.with_period(period);
    assert!(wrapping == Constant::<EdgeVelocity<f32>>::with_period(edges, period));
    assert!(wrapping.is_ok() == (period.is_finite() && period > 0.0));
    Some((wrapping.unwrap_or(edges), count))
}

/// The velocity is finite, zero at a stop, held at a bad sample, and at most a count in the time
/// without one.
pub fn edges_run(from: &mut Numbers) -> Option<()> {
    let ((edges, count), mut state) = (edges(from)?, EdgeVelocityState::new());
    let (mut last, mut gap) = (None, 0.0_f64);
    loop {
        // Every other sample repeats its position, so that there are times without a count.
        let position = match last {
            Some(last) if from.flag()? => last,
            _ => from.any()?,
        };
        let dt = from.dt()?;
        let status = edges_step(&edges, &mut state, position, dt);
        if dt.is_finite() && dt > 0.0 {
            gap = (gap + f64::from(dt)).min(f64::from(f32::MAX));
        }
        if matches!(status, RateStatus::Held(_)) {
            continue;
        }
        if last == Some(position) {
            // The state adds its times in f32: one rounding a sample, of 5000 at most. Near zero the
            // quotient is rounded to an absolute bit.
            let most = f64::from(count) / gap * (1.0 + 5000.0 * f64::from(f32::EPSILON));
            assert!(f64::from(state.velocity()).abs() <= most + f64::from(f32::MIN_POSITIVE));
        } else {
            gap = 0.0;
        }
        last = Some(position);
    }
}

/// One sample to a velocity between counts in any state.
pub fn edges_step(
    edges: &EdgeVelocity<f32>,
    state: &mut EdgeVelocityState<f32>,
    position: f32,
    dt: f32,
) -> RateStatus {
    let before = state.velocity();
    let out = edges.step(state, position, dt);
    assert!(out.velocity.is_finite() && out.velocity == state.velocity());
    let bad = !is_usable(position, dt);
    assert!(bad == matches!(out.status, RateStatus::Held(_)));
    assert!(!bad || out.velocity == before);
    assert!(out.status != RateStatus::Stopped || out.velocity == 0.0);
    out.status
}

/// A relay experiment that its constructor accepts.
pub fn relay(from: &mut Numbers) -> Option<Relay<f32>> {
    let settings = RelaySettings {
        reference: from.any()?,
        centre: from.any()?,
        amplitude: from.any()?,
        hysteresis: from.any()?,
        most_deviation: from.any()?,
        cycles: u32::from(from.byte()? % 8),
        agreement: from.any()?,
        longest_time: from.any()?,
        longest_dt: from.any()?,
        limits: from.limits()?,
        fallback: from.fallback()?,
    };
    let relay = Relay::<f32>::try_new(settings);
    assert!(relay == Constant::<Relay<f32>>::try_new(settings));
    relay.ok()
}

/// The command is finite and within the limits, and the experiment ends: a failure stays until it is
/// acknowledged, a result stays.
pub fn relay_runs(from: &mut Numbers) -> Option<()> {
    let (relay, mut state) = (relay(from)?, RelayState::new());
    loop {
        if from.byte()? < 8 {
            let latched = state.is_latched();
            let before = state;
            state.acknowledge();
            assert!(!state.is_latched() && state.command() == before.command());
            assert!(latched || state == before);
        }
        relay_steps(&relay, &mut state, from)?;
    }
}

/// One sample to a relay experiment in any state.
pub fn relay_steps(
    relay: &Relay<f32>,
    state: &mut RelayState<f32>,
    from: &mut Numbers,
) -> Option<()> {
    let (dt, measured) = (from.dt()?, from.any()?);
    assert!(a_relay_experiment_is_bounded_and_ends(
        relay, state, dt, measured
    ));
    Some(())
}
