//! Four PID crates of the registry beside ours, on the same samples.
//!
//! On good samples they are an oracle: where the laws are the same, so are the commands.
//! On bad samples they are a warning; `cargo test -p bowden --test control peers --
//! --nocapture` prints the table. (idsp is missing: it wants a newer Rust than this crate
//! promises.)

use super::*;

const K_P: f64 = 30.0;
const K_I: f64 = 18.0;
const K_D: f64 = 0.2;
const LIMIT: f64 = 1e3;

/// A controller as all of them can be seen: reference, measured, dt to a command.
///
/// Nothing comes back where the crate refuses the sample.
type Step = Box<dyn FnMut(f64, f64, f64) -> Option<f64>>;

/// Makes one whose derivative is filtered over that time [s].
type Make = fn(f64) -> Step;

/// Derivative on the measurement through a lag of `tau` \[s\]; none at zero.
fn ours(tau: f64) -> Step {
    let pid = pid(K_P, K_I, |s| {
        (s.k_d, s.derivative_time, s.limits) = (K_D, tau, range(-LIMIT, LIMIT));
    });
    let mut state = PidState::new();
    Box::new(move |reference, measured, dt| {
        let out = pid.step(&mut state, &PidInput::new(dt, reference, measured));
        (out.status == Status::Good).then_some(out.command)
    })
}

/// What the other crates call smoothing: the share of a new quotient in the filter.
fn share(tau: f64) -> f64 {
    DT / (tau + DT)
}

/// `pid`: counts in samples, has no filter.
fn pid_rs(_: f64) -> Step {
    let mut pid = ::pid::Pid::<f64>::new(0.0, LIMIT);
    pid.p(K_P, 1e9).i(K_I * DT, 1e9).d(K_D / DT, 1e9);
    Box::new(move |reference, measured, _| {
        pid.setpoint(reference);
        Some(pid.next_control_output(measured).output)
    })
}

fn robust_pid(tau: f64) -> Step {
    let mut pid = robust_pid::RobustPid::<f64>::new(robust_pid::PidConfig {
        kp: K_P,
        ki: K_I,
        kd: K_D,
        output_max: LIMIT,
        output_min: -LIMIT,
        i_limit: 1e9,
        antiwindup_mode: robust_pid::AntiWindupMode::Clamping,
        derivative_filter_coeff: share(tau),
        ..robust_pid::PidConfig::default()
    });
    Box::new(move |reference, measured, dt| {
        pid.set_setpoint(reference);
        Some(pid.update(measured, dt).output)
    })
}

/// `multicalc`: its dt is fixed.
fn multicalc(tau: f64) -> Step {
    let mut pid = multicalc::control::Pid::<f64>::new(K_P, K_I, K_D, DT)
        .and_then(|pid| pid.with_output_limits(-LIMIT, LIMIT))
        .and_then(|pid| pid.with_derivative_filter(share(tau)))
        .unwrap();
    Box::new(move |reference, measured, _| Some(pid.update(reference, measured)))
}

fn pidgeon(tau: f64) -> Step {
    let per_second = share(tau) / (DT * (1.0 - share(tau)));
    let config = pidgeon::ControllerConfig::builder()
        .with_kp(K_P)
        .with_ki(K_I)
        .with_kd(K_D)
        .with_output_limits(-LIMIT, LIMIT)
        .with_derivative_filter_coeff(per_second)
        .build()
        .unwrap();
    let mut pid = pidgeon::PidController::new(config);
    Box::new(move |reference, measured, dt| {
        pid.set_setpoint(reference).ok()?;
        pid.compute(measured, dt).ok()
    })
}

/// Slow reference, measurement with two tones: nothing near a limit.
fn good(k: u32) -> (f64, f64) {
    let t = DT * f64::from(k);
    let reference = 25.0 + 10.0 * (1.57 * t).sin();
    let error = 0.05 * (77.0 * t).sin() - 0.3 * (9.0 * t).cos();
    (reference, reference + error)
}

#[test]
fn on_good_samples_peers_and_ours_give_the_same_command() {
    let all: [(Make, f64); 6] = [
        (pid_rs, 0.0),
        (robust_pid, 0.0),
        (robust_pid, 0.02),
        (multicalc, 0.0),
        (multicalc, 0.02),
        (pidgeon, 0.02),
    ];
    for (make, tau) in all {
        let (mut ours, mut peer) = (ours(tau), make(tau));
        for k in 0..20_000 {
            let (reference, measured) = good(k);
            let [a, b] = [&mut ours, &mut peer].map(|step| step(reference, measured, DT).unwrap());
            // The rounding of 20 000 additions, which they do in another order.
            near(b, a, 1e-9 * (1.0 + a.abs()));
        }
    }
}

/// What a controller does with one bad sample, and with good ones after it.
///
/// A sample with a bad measurement or reference takes the place of a good one; one with
/// a bad dt is a call too many.
fn reaction(make: Make, bad: (f64, f64, f64), in_place: bool) -> String {
    let (mut run, mut undisturbed) = (make(0.02), make(0.02));
    let mut last = None;
    for k in 0..500 {
        let (reference, measured) = good(k);
        last = run(reference, measured, DT);
        undisturbed(reference, measured, DT);
    }
    let at = match run(bad.0, bad.1, bad.2) {
        None => "told",
        Some(command) if command.is_nan() => "NaN",
        Some(command) if Some(command) == last => "held",
        Some(command) if command.abs() == LIMIT => "at the limit",
        Some(_) => "goes on",
    };
    let mut most = 0.0_f64;
    for k in 500..1000 {
        let (reference, measured) = good(k);
        let expected = undisturbed(reference, measured, DT).unwrap();
        if k > 500 || !in_place {
            let off = (run(reference, measured, DT).unwrap_or(f64::NAN) - expected).abs();
            most = if off.is_nan() { off } else { most.max(off) };
        }
        if most.is_nan() {
            return format!("{at}, NaN for good");
        }
    }
    format!("{at}, then off by {most:.3}")
}

#[test]
fn one_bad_sample_and_the_half_second_after_it_side_by_side() {
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    let (reference, measured) = good(500);
    let samples = [
        ("measured NaN", reference, nan, DT),
        ("measured inf", reference, infinity, DT),
        ("reference NaN", nan, measured, DT),
        ("dt 0", reference, measured, 0.0),
        ("dt negative", reference, measured, -DT),
        ("dt NaN", reference, measured, nan),
    ];
    let crates: [(&str, Make, bool); 5] = [
        ("bowden", ours, true),
        ("pid 4", pid_rs, false),
        ("robust-pid 0.1", robust_pid, true),
        ("multicalc 0.10", multicalc, false),
        ("pidgeon 0.3", pidgeon, true),
    ];
    let mut table = String::new();
    for (name, reference, measured, dt) in samples {
        // A dt that is fixed cannot be bad.
        for (crate_name, make, _) in crates.iter().filter(|it| it.2 || dt == DT) {
            let what = reaction(*make, (reference, measured, dt), dt == DT);
            table.push_str(&format!("{name:<14}{crate_name:<16}{what}\n"));
        }
    }
    println!("{table}");
    // Every crate, not ours alone: a peer that mends this must not go on being blamed.
    assert_eq!(table, EXPECTED);
}

const EXPECTED: &str = "\
measured NaN  bowden          told, then off by 0.002
measured NaN  pid 4           NaN, NaN for good
measured NaN  robust-pid 0.1  NaN, NaN for good
measured NaN  multicalc 0.10  at the limit, then off by 1009.424
measured NaN  pidgeon 0.3     told, then off by 0.103
measured inf  bowden          told, then off by 0.002
measured inf  pid 4           at the limit, then off by 1009.279
measured inf  robust-pid 0.1  at the limit, NaN for good
measured inf  multicalc 0.10  at the limit, then off by 1009.424
measured inf  pidgeon 0.3     told, then off by 0.103
reference NaN bowden          told, then off by 0.002
reference NaN pid 4           NaN, NaN for good
reference NaN robust-pid 0.1  NaN, NaN for good
reference NaN multicalc 0.10  at the limit, then off by 1009.424
reference NaN pidgeon 0.3     told, then off by 0.103
dt 0          bowden          told, then off by 0.000
dt 0          robust-pid 0.1  goes on, then off by 0.815
dt 0          pidgeon 0.3     told, then off by 0.000
dt negative   bowden          told, then off by 0.002
dt negative   robust-pid 0.1  goes on, then off by 0.815
dt negative   pidgeon 0.3     told, then off by 0.000
dt NaN        bowden          told, then off by 0.002
dt NaN        robust-pid 0.1  NaN, NaN for good
dt NaN        pidgeon 0.3     told, then off by 0.000
";
