//! One step of each controller, beside the crates of the registry.
//!
//! `cargo bench --bench control`. Everything runs on the same slow reference and noisy
//! measurement; one iteration is one sample. What the peers leave out (checks of every
//! number, a slew rate, an exact filter) is part of the difference: see the table that
//! `tests/control/peers.rs` prints.

use bowden::control::{
    AntiWindup, Compensator, CompensatorInput, CompensatorState, Limits, Pid, PidInput,
    PidSettings, PidState,
};
use bowden::hysteresis::BoucWen;
use bowden::model::Model;
use bowden::transmission::Transmission;
use bowden::{Error, Real};
use criterion::{criterion_group, criterion_main, Criterion};
use std::hint::black_box;

const DT: f64 = 1e-3;
const SAMPLES: usize = 4000;

fn samples<T: Real>() -> Vec<PidInput<T>> {
    (0..SAMPLES)
        .map(|k| {
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
        })
        .collect()
}

fn time<T: Real>(c: &mut Criterion, name: &str, mut step: impl FnMut(&PidInput<T>) -> T) {
    let (samples, mut k) = (samples::<T>(), 0);
    c.bench_function(name, |b| {
        b.iter(|| {
            k = if k + 1 < SAMPLES { k + 1 } else { 0 };
            step(black_box(&samples[k]))
        });
    });
}

fn own<T: Real>(c: &mut Criterion, name: &str, pid: Pid<T>) {
    let mut state = PidState::new();
    time::<T>(c, name, |at| pid.step(&mut state, at).command);
}

fn limited<T: Real>() -> Result<Pid<T>, Error> {
    Pid::try_new(PidSettings {
        limits: Limits::try_new(T::from_f64(-50.0), T::from_f64(50.0))?
            .with_slew(T::from_f64(1e3))?,
        anti_windup: AntiWindup::BackCalculation {
            tracking_time: T::from_f64(0.1),
        },
        ..*Pid::paper_pid().settings()
    })
}

fn controllers(c: &mut Criterion) {
    own::<f32>(c, "PI, f32", Pid::paper_pi());
    own::<f64>(c, "PI, f64", Pid::paper_pi());
    own::<f32>(c, "PID, filtered, f32", Pid::paper_pid());
    own::<f64>(c, "PID, filtered, f64", Pid::paper_pid());
    own::<f32>(c, "PIV, f32", Pid::paper_piv());
    if let Ok(pid) = limited::<f32>() {
        own::<f32>(c, "PID, always slew limited, back-calculation, f32", pid);
    }
    if let Ok(compensator) = compensator() {
        let mut state = CompensatorState::new();
        time::<f64>(c, "compensator, inverse transmission, f64", |at| {
            let wish = CompensatorInput::new(at.dt, at.reference);
            compensator.step(&mut state, &wish).command
        });
    }
}

fn compensator() -> Result<Compensator<f64, 0>, Error> {
    let shape = BoucWen::try_new(0.095_82, 0.6, 3.871)?;
    let cable = Transmission::torque(0.9978, 7.004, 0.051_74, shape)?;
    Compensator::try_new(&Model::try_new(Some(cable), &[])?)
}

fn peers(c: &mut Criterion) {
    let mut pid = pid::Pid::<f64>::new(0.0, 1e3);
    pid.p(30.0, 1e9).i(18.0 * DT, 1e9).d(2.0 / DT, 1e9);
    time::<f64>(c, "pid 4, PID unfiltered, f64", |at| {
        pid.setpoint(at.reference);
        pid.next_control_output(at.measured).output
    });
    let mut robust = robust_pid::RobustPid::<f64>::with_gains(30.0, 18.0, 2.0);
    time::<f64>(c, "robust-pid 0.1, PID filtered, f64", |at| {
        robust.set_setpoint(at.reference);
        robust.update(at.measured, at.dt).output
    });
    if let Ok(mut pid) = multicalc::control::Pid::<f64>::new(30.0, 18.0, 2.0, DT) {
        time::<f64>(c, "multicalc 0.10, PID filtered, f64", |at| {
            pid.update(at.reference, at.measured)
        });
    }
    let config = pidgeon::ControllerConfig::builder()
        .with_kp(30.0)
        .with_ki(18.0)
        .with_kd(2.0)
        .with_output_limits(-1e3, 1e3)
        .build();
    if let Ok(mut pid) = config.map(pidgeon::PidController::new) {
        time::<f64>(c, "pidgeon 0.3, PID filtered, f64", |at| {
            let _ = pid.set_setpoint(at.reference);
            pid.compute(at.measured, at.dt).unwrap_or(f64::NAN)
        });
    }
}

criterion_group! {
    name = control;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(600));
    targets = controllers, peers
}
criterion_main!(control);
