//! Memory-less effects against closed forms; unit as declared, for all.

use super::*;

/// The catalogue's formulas written out once more, for every effect without memory.
fn closed_form(name: &str, at: &Inputs<f64>) -> f64 {
    let Motion {
        position: x,
        velocity: v,
        acceleration: a,
    } = at.motion;
    let (load, eta, t) = (at.load, at.eta, at.time);
    let w = 0.7; // the one shape of most effects
    match name {
        "offset" => 1.0,
        "gain" => load,
        "viscous" => v,
        "drag-quadratic" => v.signum() * v.powi(2),
        "drag-cubic" => v.powi(3),
        "coulomb" => (v / w).tanh(),
        "power-law" => v.signum() * v.abs().powf(w),
        "stribeck" => (v / 0.06).tanh() / (v.abs() / 0.6).powf(1.7).exp(),
        "asymmetry-viscous" => v.max(-v),
        "asymmetry-drag" => v.powi(2),
        "asymmetry-eta" => eta.max(-eta),
        "asymmetry-eta-squared" => eta.powi(2),
        "load-friction" => load.max(-load) * (v / w).tanh(),
        "capstan" => load * ((0.3 * x).exp() - 1.0) / 0.3 * (v / w).tanh(),
        "drive-friction" => f64::from(load * v > 0.0) * load.abs() * (v / w).tanh(),
        "back-drive-friction" => f64::from(load * v < 0.0) * load.abs() * (v / w).tanh(),
        "inertia" => a,
        "stiffness-linear" | "stretch-linear" | "crosstalk" => x,
        "stiffness-quadratic" => x.powi(2),
        "stiffness-cubic" | "stretch-cubic" => x.powi(3),
        "stiffness-progressive" => x.signum() * x.powi(2),
        "hinge" | "saturation-upper" => (x - w).max(0.0),
        "saturation-lower" => (x - w).min(0.0),
        "gravity" => x.sin() * w.cos() + x.cos() * w.sin(),
        "ripple" => (3.3 * x + 0.4).sin(),
        "position-friction" => x * (v / w).tanh(),
        "position-hysteresis" => eta * x,
        "dead-zone" => x.signum() * (x.abs() - w).max(0.0),
        "rate" => eta * v,
        "rate-symmetric" => eta * v.abs(),
        "pinching" => eta / (eta / w).powi(2).exp(),
        "drift" => t,
        "pretension" => f64::from(t >= w),
        "curve-position" => ((x - w) / 0.4).clamp(0.0, 1.0),
        "curve-velocity" => ((v - w) / 0.4).clamp(0.0, 1.0),
        "temperature" => x - w,
        "tone" => (std::f64::consts::TAU * 1.9 * t + 0.8).sin(),
        _ => panic!("{name} has no closed form here"),
    }
}

proptest! {
    #[test]
    fn every_memoryless_effect_equals_its_closed_form(at in plausible()) {
        for info in CATALOGUE.iter().filter(|info| !info.memory) {
            let [value] = along(&make(info.name), &[at])[..] else { unreachable!() };
            // The forms differ in rounding alone, by a few ulp of terms up to 60.
            assert_relative_eq!(value, closed_form(info.name, &at), max_relative = 1e-12, epsilon = 1e-13);
        }
    }

    #[test]
    fn every_effect_scales_with_the_units_as_declared(
        path in prop::collection::vec(plausible(), 12),
        units in [0.2..5.0_f64, 0.2..5.0, 0.2..5.0, 0.2..5.0, 0.2..5.0],
    ) {
        // Gravity's channel is in radians and no other; a power law's gain is the force at one unit.
        for name in names().filter(|name| !["gravity", "power-law"].contains(name)) {
            let mut effect = make(name);
            for (index, shape) in effect.info().shapes.iter().enumerate() {
                let value = effect.shape(index).unwrap() * factor(shape.dimension, units);
                effect = effect.with_shape(index, value).unwrap();
            }
            let before = along(&make(name), &path);
            let scaled: Vec<_> = path.iter().map(|at| rescale(at, units)).collect();
            for (was, is) in before.iter().zip(along(&effect, &scaled)) {
                let expected = was * factor(effect.info().dimension, units);
                // Sines of angles up to 100 rad lose two digits; the rest is rounding.
                assert_relative_eq!(is, expected, max_relative = 1e-9, epsilon = 1e-9);
            }
        }
    }
}

/// Sliding fast under a load of 2: the capstan's wrap alone, times 2.
fn wrapped<T: Real>(mu: T, position: T) -> T {
    let at = with(at(position, T::zero()), |at| {
        (at.motion.velocity, at.load) = (T::from_f64(1e3), T::from_f64(2.0));
    });
    let effect = Effect::try_from_name("capstan", &[T::one(), mu]).unwrap();
    along(&effect, &[at])[0]
}

#[test]
fn the_capstan_grows_as_the_exponential_of_the_wrap() {
    for mu in [0.02, 0.3, 4.0_f64] {
        for x in [-6.0, -0.5, 0.0, 0.5, 6.0] {
            let expected = 2.0 * ((mu * x).exp() - 1.0) / mu;
            // The 1 that is taken off loses one part in 1e16 over mu·x ≥ 0.01.
            assert_relative_eq!(wrapped(mu, x), expected, max_relative = 1e-13);
        }
        // Two wraps one after the other multiply their tensions: 1 + mu·g(a + b).
        let tension = |x: f64| 1.0 + mu * wrapped(mu, x) / 2.0;
        let product = tension(0.4) * tension(1.1);
        assert_relative_eq!(tension(1.5), product, max_relative = 1e-14);
    }
    // Unwound for ever, nothing of the tension is left.
    assert_eq!(wrapped(0.5, -1e6), -4.0);
}

#[test]
fn the_capstan_is_linear_in_the_wrap_as_mu_goes_to_zero() {
    for x in [-3.0, -1e-9, 1e-200, 0.25, 3.0, 1e6] {
        // The next term of the series is mu·x²/2: 5e-7 of x at most.
        for mu in [1e-12, 1e-16, 1e-100, f64::MIN_POSITIVE, f64::from_bits(1)] {
            let next = mu * f64::abs(x) / 2.0;
            assert_relative_eq!(wrapped(mu, x), 2.0 * x, max_relative = 1.01 * next + 1e-15);
        }
    }
    for x in [-3.0, 1e-3, 0.25, 1e20] {
        for mu in [f32::MIN_POSITIVE, 1e-40, f32::from_bits(1)] {
            assert_eq!(wrapped(mu, x), 2.0 * x, "{mu:e} {x}");
        }
    }
}

/// `units` are those of channel, load, time, output, input.
fn factor(dimension: Dimension, units: [f64; 5]) -> f64 {
    let d = dimension;
    let exponents = [d.channel, d.load, d.time, d.output, d.input];
    let each = units.iter().zip(exponents);
    each.map(|(unit, exponent)| unit.powi(i32::from(exponent)))
        .product()
}

fn rescale(at: &Inputs<f64>, units: [f64; 5]) -> Inputs<f64> {
    let [channel, load, time, output, input] = units;
    let motion = |of: Motion<f64>, unit: f64| {
        let (v, a) = (
            of.velocity * unit / time,
            of.acceleration * unit / time / time,
        );
        moving(of.position * unit, v, a)
    };
    with(*at, |at| {
        (at.dt, at.time) = (at.dt * time, at.time * time);
        (at.motion, at.input) = (motion(at.motion, channel), motion(at.input, input));
        (at.load, at.output) = (at.load * load, at.output * output);
    })
}
