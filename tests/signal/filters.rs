//! The low-pass and the second-order section: responses, bounds, liveness, bad samples.

use super::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// A step of a filter in either float: sample in, output out.
type Step<'a> = &'a mut dyn FnMut(f64) -> f64;

/// Complex response at `m/1000` of the sample rate, after `settling` samples.
fn response(step: Step, m: u32, settling: u32) -> (f64, f64) {
    let angle = |k: u32| TAU * f64::from(k * m % 1000) / 1000.0;
    let settling = settling.div_ceil(1000) * 1000;
    for k in 0..settling {
        step(angle(k).sin());
    }
    let (mut re, mut im) = (0.0, 0.0);
    for k in 0..1000 {
        let y = step(angle(k).sin());
        re += y * angle(k).sin() / 500.0;
        im += y * angle(k).cos() / 500.0;
    }
    (re, im)
}

fn divided((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    let square = c * c + d * d;
    ((a * c + b * d) / square, (b * c - a * d) / square)
}

/// `1/(1 − w² + i·w/q)` or `(1 − w²)` times that, at the prewarped `w`.
fn closed_form(is_notch: bool, at: f64, corner: f64, q: f64) -> (f64, f64) {
    let w = (PI * at).tan() / (PI * corner).tan();
    let above = if is_notch { 1.0 - w * w } else { 1.0 };
    divided((above, 0.0), (1.0 - w * w, w / q))
}

fn designed<T: Real>(is_notch: bool, corner: f64, q: f64) -> Biquad<T> {
    let design = [Biquad::low_pass, Biquad::notch][usize::from(is_notch)];
    design(T::from_f64(corner / DT), T::from_f64(q), T::from_f64(DT)).unwrap()
}

fn stepper<T: Real>(filter: Biquad<T>) -> impl FnMut(f64) -> f64 {
    let (mut state, dt) = (BiquadState::new(), T::from_f64(DT));
    move |x| filter.step(&mut state, T::from_f64(x), dt).as_f64()
}

/// Magnitude of the slower pole: the filter forgets by this in a sample.
fn slowest_pole(corner: f64, q: f64) -> f64 {
    let g = (PI * corner).tan();
    let below = 1.0 + g / q + g * g;
    let (sum, product) = (2.0 * (1.0 - g * g) / below, (1.0 - g / q + g * g) / below);
    let inside = sum * sum / 4.0 - product;
    if inside < 0.0 {
        product.sqrt()
    } else {
        sum.abs() / 2.0 + inside.sqrt()
    }
}

/// Samples after which a pole has fallen to `share`.
fn samples_to(share: f64, pole: f64) -> u32 {
    (share.ln() / pole.ln()).ceil() as u32
}

/// What four roundings to `f32` (of the sample time, its product with the slope, 1/q and the
/// output) make of a response that changes by `steepness` over its relative frequency. The
/// tangent magnifies that of its argument by `2x/sin(2x)`.
fn single_precision(corner: f64, steepness: f64) -> f64 {
    let x = TAU * corner;
    4.0 * 0.5 * f64::from(f32::EPSILON) * steepness * (x / x.sin())
}

const CORNERS: [f64; 5] = [0.005, 0.03, 0.1, 0.3, 0.45];
const QUALITIES: [f64; 4] = [0.4, FRAC_1_SQRT_2, 2.0, 10.0];

/// Every notch and low-pass of these corners and qualities.
fn designs(corners: &[f64], qualities: &[f64]) -> Vec<(bool, f64, f64)> {
    let pairs = corners
        .iter()
        .flat_map(|corner| qualities.iter().map(|q| (*corner, *q)));
    pairs
        .flat_map(|(corner, q)| [false, true].map(|is_notch| (is_notch, corner, q)))
        .collect()
}

#[test]
fn the_responses_are_those_of_the_prewarped_designs() {
    for (is_notch, corner, q) in designs(&CORNERS, &QUALITIES) {
        let settling = samples_to(1e-13, slowest_pole(corner, q));
        for m in [1, 3, 10, 50, 100, 200, 300, 400, 480, 490] {
            let expected = closed_form(is_notch, f64::from(m) / 1000.0, corner, q);
            let error = |step: Step| {
                let found = response(step, m, settling);
                (found.0 - expected.0).hypot(found.1 - expected.1)
            };
            let wide = error(&mut stepper(designed::<f64>(is_notch, corner, q)));
            let single = error(&mut stepper(designed::<f32>(is_notch, corner, q)));
            // Rounding of the samples and of the states, which the resonance magnifies.
            let bound = 40.0 * (1.0 + q) * f64::EPSILON / corner;
            assert!(wide < bound, "{corner} {q} {m}: {wide:e}");
            let bound = single_precision(corner, 1.0 + 2.0 * q * q);
            assert!(single < bound, "{corner} {q} {m}: {single:e}");
        }
    }
}

#[test]
fn a_notch_takes_its_own_frequency_out() {
    for (_, corner, q) in designs(&[0.03, 0.1, 0.45], &QUALITIES) {
        let settling = samples_to(1e-13, slowest_pole(corner, q));
        let depth = |step: Step| {
            let (re, im) = response(step, (1000.0 * corner).round() as u32, settling);
            re.hypot(im)
        };
        let wide = depth(&mut stepper(designed::<f64>(true, corner, q)));
        let short = depth(&mut stepper(designed::<f32>(true, corner, q)));
        // A centre that is wrong by e leaves 2·q·e; the samples are rounded besides.
        assert!(wide < 1e-13 * (1.0 + q) / corner, "{corner} {q}: {wide:e}");
        let bound = single_precision(corner, 1.0 + 2.0 * q);
        assert!(short < bound, "{corner} {q}: {short:e}");
    }
}

#[test]
fn the_output_is_bounded_by_the_sum_of_the_impulse_response_that_the_docs_state() {
    let mut closest = [0.0_f64; 2];
    let corners = [0.001, 0.01, 0.1, 0.25, 0.4, 0.49, 0.499];
    let qualities = [0.05, 0.2, 0.5, FRAC_1_SQRT_2, 2.0, 20.0];
    for (is_notch, corner, q) in designs(&corners, &qualities) {
        let mut step = stepper(designed::<f64>(is_notch, corner, q));
        step(0.0); // at rest at zero
        let samples = samples_to(1e-9, slowest_pole(corner, q)).min(100_000);
        let sum: f64 = (0..samples)
            .map(|k| step(f64::from(u8::from(k == 0))).abs())
            .sum();
        let bound = if is_notch { 3.0 } else { 2.0 + 4.0 * q / PI };
        assert!(sum <= bound, "{corner} {q} {is_notch}: {sum}");
        let closest = &mut closest[usize::from(is_notch)];
        *closest = closest.max(sum / bound);
    }
    // The bounds are no more than that.
    assert!(closest[0] > 0.9 && closest[1] > 0.9, "{closest:?}");
}

#[test]
fn a_constant_input_is_reached_to_the_bit_within_the_samples_of_the_slower_pole() {
    let all = designs(&CORNERS, &[FRAC_1_SQRT_2, 2.0, 10.0]);
    let targets = [25.0_f32, -0.3, 1e-3];
    for ((is_notch, corner, q), target) in all.iter().flat_map(|it| targets.map(|to| (*it, to))) {
        let filter = designed::<f32>(is_notch, corner, q);
        let mut state = BiquadState::at(100.0);
        // From 100 to half a unit in the last place of the target; the envelope of the oscillation
        // is at most 2·q + 1 times the step.
        let share = f64::from(target.abs()) * 3e-8 / (100.0 * (2.0 * q + 1.0));
        let samples = samples_to(share, slowest_pole(corner, q)) + 2;
        for k in 0..samples + 100 {
            let value = filter.step(&mut state, target, DT as f32);
            assert!(k < samples || value == target, "{corner} {q} {is_notch}");
        }
    }
}

#[test]
fn a_constant_has_no_transient_from_the_first_sample_on() {
    let low_pass = LowPass::try_new(0.01_f32).unwrap();
    for is_notch in [false, true] {
        let filter = designed::<f32>(is_notch, 0.03, 2.0);
        let (mut state, mut lag) = (BiquadState::new(), LowPassState::new());
        for _ in 0..1000 {
            assert_eq!(filter.step(&mut state, -7.3, 0.001), -7.3);
            assert_eq!(low_pass.step(&mut lag, -7.3, 0.001), -7.3);
        }
    }
}

/// Transposed direct form II with the coefficients of the same design.
fn direct_form<T: Real>(corner: f64, q: f64) -> impl FnMut(f64) -> f64 {
    let g = (PI * corner).tan();
    let a0 = 1.0 + g / q + g * g;
    let coefficients = [g * g, 2.0 * (g * g - 1.0), 1.0 - g / q + g * g];
    let [b, a1, a2] = coefficients.map(|x| T::from_f64(x / a0));
    let (mut s1, mut s2) = (T::ZERO, T::ZERO);
    move |x| {
        let x = T::from_f64(x);
        let y = b * x + s1;
        s1 = T::from_f64(2.0) * b * x - a1 * y + s2;
        s2 = b * x - a2 * y;
        y.as_f64()
    }
}

#[test]
fn a_low_corner_needs_this_form_in_single_precision() {
    for corner in [1e-3, 1e-4, 1e-5] {
        let q = FRAC_1_SQRT_2;
        let mut truth = direct_form::<f64>(corner, q);
        let mut direct = direct_form::<f32>(corner, q);
        let mut own = stepper(designed::<f32>(false, corner, q));
        own(0.0);
        let (mut worst_direct, mut worst_own) = (0.0_f64, 0.0_f64);
        for _ in 0..samples_to(1e-3, slowest_pole(corner, q)) {
            let exact = truth(1.0);
            worst_direct = worst_direct.max((direct(1.0) - exact).abs());
            worst_own = worst_own.max((own(1.0) - exact).abs());
        }
        // The rounding of g, of 1/q, of the output and of the truth.
        assert!(worst_own < 4.0 * f64::from(f32::EPSILON), "{worst_own:e}");
        assert!(
            worst_direct > 1e3 * worst_own,
            "{worst_direct:e} {worst_own:e}"
        );
    }
}

#[test]
fn a_dt_that_varies_moves_the_corner_by_the_share_that_the_docs_state() {
    let (corner, q) = (0.1, FRAC_1_SQRT_2);
    let filter = designed::<f64>(false, corner, q);
    for change in [-0.1, 0.1] {
        let dt = DT * (1.0 + change);
        let mut state = BiquadState::new();
        let settling = samples_to(1e-13, slowest_pole(0.05, q));
        let found = response(&mut |x| filter.step(&mut state, x, dt), 100, settling);
        let w = (PI * 0.1_f64).tan() / ((1.0 + change) * (PI * corner).tan());
        let exact = divided((1.0, 0.0), (1.0 - w * w, w / q));
        assert!((found.0 - exact.0).hypot(found.1 - exact.1) < 1e-12);
        // Where w is 1, in units of the design's corner.
        let x = PI * corner;
        let moved = ((1.0 + change) * x.tan()).atan() / (x * (1.0 + change)) - 1.0;
        assert!(moved.abs() < change.abs() * x * x, "{moved}");
    }
}

#[test]
fn bad_samples_leave_the_filters_and_hold_the_output() {
    let filter = designed::<f64>(true, 0.05, 2.0);
    let low_pass = LowPass::try_new(0.01).unwrap();
    let (mut state, mut undisturbed) = (BiquadState::new(), BiquadState::new());
    let (mut lag, mut lag_undisturbed) = (LowPassState::new(), LowPassState::new());
    assert_eq!(filter.step(&mut state, f64::NAN, DT), 0.0);
    assert_eq!(low_pass.step(&mut lag, f64::NAN, DT), 0.0);
    for k in 0..100 {
        let x = 5.0 + f64::from(k * k % 17);
        let first = (
            filter.step(&mut state, x, DT),
            low_pass.step(&mut lag, x, DT),
        );
        if k == 0 {
            assert_eq!(first, (x, x)); // at rest at the first sample
        }
        filter.step(&mut undisturbed, x, DT);
        low_pass.step(&mut lag_undisturbed, x, DT);
        for (bad, dt) in [
            (f64::NAN, DT),
            (f64::INFINITY, DT),
            (1.0, f64::NAN),
            (1.0, f64::INFINITY),
            (1.0, 0.0),
            (1.0, -DT),
        ] {
            assert_eq!(filter.step(&mut state, bad, dt), first.0);
            assert_eq!(low_pass.step(&mut lag, bad, dt), first.1);
        }
        assert_eq!((state, lag), (undisturbed, lag_undisturbed));
    }
}

#[test]
fn settings_that_make_no_filter_are_refused_by_name() {
    for design in [Biquad::<f64>::low_pass, Biquad::<f64>::notch] {
        for (frequency, q, sample_time, error) in [
            (0.0, 1.0, DT, Error::OutOfRange("frequency")),
            (f64::NAN, 1.0, DT, Error::NonFinite("frequency")),
            (10.0, 0.0, DT, Error::OutOfRange("q")),
            (10.0, f64::INFINITY, DT, Error::NonFinite("q")),
            (10.0, 1e-320, DT, Error::OutOfRange("q")),
            (10.0, 1.0, 0.0, Error::OutOfRange("sample_time")),
        ] {
            assert_eq!(design(frequency, q, sample_time), Err(error));
        }
        let above = Error::Inadmissible("frequency < 1/(2·sample_time)");
        assert_eq!(design(500.0, 1.0, DT), Err(above));
        assert!(design(499.9, 1.0, DT).is_ok());
    }
    let low_pass = |time_constant: f32| LowPass::try_new(time_constant).err();
    assert_eq!(low_pass(-1.0), Some(Error::OutOfRange("time_constant")));
    assert_eq!(low_pass(f32::NAN), Some(Error::NonFinite("time_constant")));
}

#[test]
fn the_low_pass_is_the_implicit_lag_at_every_frequency() {
    for time_constant in [0.0005, 0.01, 0.3_f64] {
        let filter = LowPass::try_new(time_constant).unwrap();
        let share = DT / (time_constant + DT);
        for m in [1, 10, 100, 250, 400, 490] {
            let mut state = LowPassState::new();
            let step: Step = &mut |x| filter.step(&mut state, x, DT);
            let found = response(step, m, samples_to(1e-13, 1.0 - share));
            let w = TAU * f64::from(m) / 1000.0;
            // share/(1 − (1 − share)·e^(−iw))
            let below = (1.0 - (1.0 - share) * w.cos(), (1.0 - share) * w.sin());
            let exact = divided((share, 0.0), below);
            assert!((found.0 - exact.0).hypot(found.1 - exact.1) < 1e-11);
        }
    }
}

#[test]
fn a_single_precision_low_pass_reaches_its_target_in_the_samples_of_its_pole() {
    for (time_constant, dt) in [(0.01_f32, 0.001_f32), (1.0, 1e-4), (10.0, 1e-4)] {
        let filter = LowPass::try_new(time_constant).unwrap();
        let mut state = LowPassState::at(0.0);
        let target = 25.0_f32;
        // Down to half a unit in the last place: 25 and below 32 have 1.9e-6.
        let share = 0.5 * 1.9e-6 / f64::from(target);
        let pole = 1.0 / (1.0 + f64::from(dt) / f64::from(time_constant));
        // The increments are rounded to 6e-8 of themselves.
        let samples = samples_to(share, pole) + samples_to(0.9, pole);
        for _ in 0..samples {
            filter.step(&mut state, target, dt);
        }
        assert_eq!(state.value(), target, "{time_constant}");
        let mut plain = 0.0_f32;
        for _ in 0..samples {
            plain += dt / (time_constant + dt) * (target - plain);
        }
        assert!(plain < target); // what the compensation is for
    }
}

proptest! {
    /// The energy about a constant sample never grows, so that the output stays within the
    /// distance at the start; 1e-5: sums of 200 roundings.
    #[test]
    fn no_sequence_of_times_makes_a_low_pass_leave_its_band(
        dts in prop::collection::vec(1e-6..1.0_f32, 1..200), q in 0.1..20.0_f32,
    ) {
        let filter = Biquad::low_pass(30.0, q, 0.001).unwrap();
        let mut state = BiquadState::at(0.0);
        for dt in dts {
            let y = filter.step(&mut state, 1.0, dt);
            prop_assert!((-1e-5..=2.0 + 1e-5).contains(&y), "{}", y);
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn stored_filters_are_read_through_their_checks() {
    let filter = designed::<f64>(true, 0.05, 2.0);
    let stored = serde_json::to_string(&filter).unwrap();
    assert_eq!(
        stored,
        r#"{"response":"notch","frequency":50.0,"q":2.0,"sample_time":0.001}"#
    );
    reads_back(&filter, &[("50.0", "500.0")]);
    let mut state = BiquadState::new();
    filter.step(&mut state, 1.0, DT);
    filter.step(&mut state, 2.0, DT);
    reads_back(&state, &[("\"low\":", "\"low\":1e999,\"x\":")]);
    reads_back(&LowPass::try_new(0.01).unwrap(), &[]);
}
