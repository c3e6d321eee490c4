//! Anti-windup of a PI on the rig.

use bowden::control::{AntiWindup, Limits, Pid, PidInput, PidSettings, PidState};
use bowden_rig::{Reference, Rig, RigConfig};

const DT: f64 = 1e-3;

/// RMS error of the true torque \[N·m\] on the reference rig after its start.
fn on_the_rig(anti_windup: AntiWindup<f64>, slew: f64) -> f64 {
    let rig = Rig::<f64, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let pid = Pid::try_new(PidSettings {
        anti_windup,
        limits: Limits::try_new(-200.0, 200.0)
            .unwrap()
            .with_slew(slew)
            .unwrap(),
        ..PidSettings::unlimited(6.0, 60.0)
    })
    .unwrap();
    let (mut plant, mut state, reference) = (rig.start(7), PidState::new(), Reference::paper());
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..20_000 {
        let now = plant.sample();
        let wanted = reference.at(now.time);
        let out = pid.step(&mut state, &PidInput::new(DT, wanted, now.measured));
        rig.step(&mut plant, out.command, DT);
        if now.time > 5.0 {
            sum += (now.tau_o - wanted).powi(2);
            count += 1.0;
        }
    }
    f64::sqrt(sum / count)
}

#[test]
fn conditional_anti_windup_minds_the_range_and_gives_back_what_the_slew_rate_takes() {
    // Gains that are quiet enough for 500/s: 2·k_p·noise·rate = 240. What the slew rate takes
    // is then given back as back-calculation does it, with T_t = k_p/k_i.
    let returned = on_the_rig(AntiWindup::BackCalculation { tracking_time: 0.1 }, 500.0);
    let conditional = on_the_rig(AntiWindup::Conditional, 500.0);
    let wound = on_the_rig(AntiWindup::None, 500.0);
    // The range is never met here, so that they are one law: equal to rounding.
    assert!(
        (conditional - returned).abs() < 1e-9 * returned,
        "{conditional} {returned}"
    );
    assert!(returned < 0.2 * wound, "{returned} {wound}");
}
