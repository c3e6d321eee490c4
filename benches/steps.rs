//! Instructions a step on this machine, the crates of the registry beside.
//!
//! `cargo bench --bench steps` prints the table, `-- --write` also writes it into
//! `benches/README.md`. It runs itself under valgrind, each step 1 000 and 11 000 times;
//! the difference over 10 000 is one step, with the loop around it (`nothing`).
//! Unlike times they are the same on a busy machine. `cargo bench --bench control` and
//! `--bench step` have the times.

use bowden::control::{Limits, Pid, PidInput, PidSettings, PidState};
use bowden::effect::{Coulomb, Motion, Viscous};
use bowden::hysteresis::BoucWen;
use bowden::model::{FixedModel, ModelState, Sample, Source, Term};
use bowden::transmission::Transmission;
use bowden::{Error, Real};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::hint::black_box;
use std::process::Command;

const DT: f64 = 1e-3;
const SAMPLES: usize = 1000;
const FEW: u64 = 1_000;
const MANY: u64 = 11_000;

fn samples<T: Real>() -> Vec<PidInput<T>> {
    let sample = |k: usize| {
        let t = DT * k as f64;
        let reference = 25.0 + 10.0 * (1.57 * t).sin();
        let measured = reference + 0.1 * (77.0 * t).sin();
        PidInput {
            velocity: T::from_f64(t.cos()),
            ..PidInput::new(
                T::from_f64(DT),
                T::from_f64(reference),
                T::from_f64(measured),
            )
        }
    };
    (0..SAMPLES).map(sample).collect()
}

/// Steps so many times over the samples.
fn over<T: Real>(count: u64, mut step: impl FnMut(&PidInput<T>) -> T) -> Result<(), Error> {
    let samples = samples::<T>();
    for at in samples.iter().cycle().take(count as usize) {
        black_box(step(black_box(at)));
    }
    Ok(())
}

fn own<T: Real>(count: u64, pid: &Pid<T>) -> Result<(), Error> {
    let mut state = PidState::new();
    over::<T>(count, |at| pid.step(&mut state, at).command)
}

fn limited<T: Real>() -> Result<Pid<T>, Error> {
    Pid::try_new(PidSettings {
        limits: Limits::try_new(T::from_f64(-50.0), T::from_f64(50.0))?
            .with_slew(T::from_f64(1e3))?,
        ..*Pid::paper_pid().settings()
    })
}

fn shape<T: Real>() -> Result<BoucWen<T>, Error> {
    BoucWen::try_new(
        T::from_f64(0.095_82),
        T::from_f64(98.36),
        T::from_f64(3.871),
    )
}

/// Follows 16·sin(pi·t) sample by sample.
fn hysteresis<T: Real>(count: u64, mut step: impl FnMut(T, T) -> T) -> Result<(), Error> {
    let input = |k: usize| T::from_f64(16.0 * (PI * k as f64 * DT).sin());
    let changes: Vec<T> = (1..SAMPLES).map(|k| input(k) - input(k - 1)).collect();
    let mut eta = T::zero();
    for &change in changes.iter().cycle().take(count as usize) {
        eta = step(black_box(eta), black_box(change));
    }
    black_box(eta);
    Ok(())
}

/// One classical Runge-Kutta step of (7), with this power.
#[inline]
fn runge_kutta<T: Real>(shape: &BoucWen<T>, eta: T, change: T, power: impl Fn(T, T) -> T) -> T {
    let (one, direction) = (T::one(), change.signum());
    let right = |eta: T| {
        let power = power(eta.abs(), shape.n() - one);
        let loss =
            shape.sigma() * power * eta - (shape.sigma() - one) * direction * power * eta.abs();
        shape.rho() * (direction - loss)
    };
    let (h, half) = (change.abs(), T::from_f64(0.5));
    let k1 = right(eta);
    let k2 = right(eta + half * h * k1);
    let k3 = right(eta + half * h * k2);
    let k4 = right(eta + h * k3);
    eta + h * (k1 + T::from_f64(2.0) * (k2 + k3) + k4) / T::from_f64(6.0)
}

fn model<T: Real>(count: u64) -> Result<(), Error> {
    let (source, origin) = (Source::Channel(0), T::zero());
    let (viscous, coulomb) = (T::from_f64(-0.4), T::from_f64(-0.8));
    let effect = Coulomb::try_new(T::from_f64(0.05))?;
    let terms = (
        Term {
            effect: Viscous,
            source,
            origin,
            gain: viscous,
        },
        Term {
            effect,
            source,
            origin,
            gain: coulomb,
        },
    );
    let cable = Transmission::torque(
        T::from_f64(0.9978),
        T::from_f64(7.004),
        T::from_f64(0.051_74),
        shape()?,
    )?;
    let (model, mut state) = (FixedModel::try_new(Some(cable), terms)?, ModelState::new());
    over::<T>(count, |at| {
        let motion = |position, velocity| Motion {
            position,
            velocity,
            acceleration: T::zero(),
        };
        let channels = [motion(at.measured, at.velocity)];
        let input = motion(at.reference, T::zero());
        let sample = Sample {
            dt: at.dt,
            input,
            load: at.reference,
            channels: &channels,
        };
        model.step(&mut state, &sample)
    })
}

type Run = fn(u64) -> Result<(), Error>;

/// Name, whose it is, and the run of so many steps.
const STEPS: &[(&str, &str, Run)] = &[
    ("nothing", "", |n| over::<f64>(n, |at| at.dt)),
    ("PI, f32", "bowden", |n| own::<f32>(n, &Pid::paper_pi())),
    ("PI, f64", "bowden", |n| own::<f64>(n, &Pid::paper_pi())),
    ("PID, filtered, f32", "bowden", |n| {
        own::<f32>(n, &Pid::paper_pid())
    }),
    ("PID, filtered, f64", "bowden", |n| {
        own::<f64>(n, &Pid::paper_pid())
    }),
    ("PID, filtered, range and slew rate, f64", "bowden", |n| {
        own::<f64>(n, &limited()?)
    }),
    ("PID, unfiltered, f64", "pid 4", |n| {
        let mut pid = pid::Pid::<f64>::new(0.0, 1e3);
        pid.p(30.0, 1e9).i(18.0 * DT, 1e9).d(2.0 / DT, 1e9);
        over::<f64>(n, |at| {
            pid.setpoint(at.reference);
            pid.next_control_output(at.measured).output
        })
    }),
    ("PID, filtered, f64", "robust-pid 0.1", |n| {
        let mut pid = robust_pid::RobustPid::<f64>::with_gains(30.0, 18.0, 2.0);
        over::<f64>(n, |at| {
            pid.set_setpoint(at.reference);
            pid.update(at.measured, at.dt).output
        })
    }),
    ("PID, filtered, f64", "multicalc 0.10", |n| {
        if let Ok(mut pid) = multicalc::control::Pid::<f64>::new(30.0, 18.0, 2.0, DT) {
            over::<f64>(n, |at| pid.update(at.reference, at.measured))?;
        }
        Ok(())
    }),
    ("PID, filtered, f64", "pidgeon 0.3", |n| {
        let config = pidgeon::ControllerConfig::builder()
            .with_kp(30.0)
            .with_ki(18.0)
            .with_kd(2.0)
            .with_output_limits(-1e3, 1e3)
            .build();
        if let Ok(mut pid) = config.map(pidgeon::PidController::new) {
            over::<f64>(n, |at| {
                let _ = pid.set_setpoint(at.reference);
                pid.compute(at.measured, at.dt).unwrap_or(f64::NAN)
            })?;
        }
        Ok(())
    }),
    ("Bouc-Wen, bounded time, f32", "bowden", |n| {
        let shape = shape::<f32>()?;
        hysteresis(n, |eta, change| shape.advance(eta, change))
    }),
    ("Bouc-Wen, third order, f64", "bowden", |n| {
        let shape = shape::<f64>()?;
        hysteresis(n, |eta, change| shape.advance(eta, change))
    }),
    (
        "Bouc-Wen, Runge-Kutta of fourth order, f64",
        "libm's power",
        |n| {
            let shape = shape::<f64>()?;
            hysteresis(n, |eta, change| runge_kutta(&shape, eta, change, libm::pow))
        },
    ),
    (
        "Bouc-Wen, Runge-Kutta of fourth order, f64",
        "the platform's power",
        |n| {
            let shape = shape::<f64>()?;
            hysteresis(n, |eta, change| runge_kutta(&shape, eta, change, f64::powf))
        },
    ),
    (
        "model with Viscous and Coulomb, f32",
        "bowden",
        model::<f32>,
    ),
    (
        "model with Viscous and Coulomb, f64",
        "bowden",
        model::<f64>,
    ),
];

/// Instructions of a run in a process of its own.
fn instructions(index: usize, count: u64) -> Result<u64, String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args([
            "--tool=cachegrind",
            "--cache-sim=no",
            "--cachegrind-out-file=/dev/null",
        ])
        .arg(own)
        .args(["--run", &index.to_string(), &count.to_string()])
        .output()
        .map_err(|e| format!("valgrind: {e}"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    let line = text.lines().find_map(|line| line.split("refs:").nth(1));
    let number: String = line
        .unwrap_or("")
        .chars()
        .filter(char::is_ascii_digit)
        .collect();
    number
        .parse()
        .map_err(|_| format!("valgrind counted nothing:\n{text}"))
}

fn table() -> Result<String, String> {
    let mut text = String::from("| step | of | instructions |\n|---|---|---|\n");
    for (index, (name, whose, _)) in STEPS.iter().enumerate() {
        let counted = instructions(index, MANY)? - instructions(index, FEW)?;
        let one = counted as f64 / (MANY - FEW) as f64;
        let _ = writeln!(text, "| {name} | {whose} | {one:.0} |");
    }
    Ok(text)
}

const OPEN: &str = "<!-- steps -->\n";
const CLOSE: &str = "<!-- end of steps -->";
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/README.md");

/// The page with a table between its marks.
fn with_table(page: &str, table: &str) -> Option<String> {
    let (before, rest) = page.split_once(OPEN)?;
    let (_, after) = rest.split_once(CLOSE)?;
    Some(format!("{before}{OPEN}{table}{CLOSE}{after}"))
}

fn report(write: bool) -> Result<(), String> {
    let table = table()?;
    print!("{table}");
    if write {
        let page = std::fs::read_to_string(PAGE).map_err(|e| format!("{PAGE}: {e}"))?;
        let page = with_table(&page, &table).ok_or(format!("{PAGE} has no marks for the table"))?;
        std::fs::write(PAGE, page).map_err(|e| format!("{PAGE}: {e}"))?;
    }
    Ok(())
}

fn main() -> std::process::ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<u64> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let done = match (words.first().map(String::as_str), &numbers[..]) {
        (Some("--run"), &[index, count]) => STEPS
            .get(index as usize)
            .map_or(Ok(()), |(_, _, run)| run(count).map_err(|e| e.to_string())),
        _ => report(words.iter().any(|word| word == "--write")),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("steps: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}
