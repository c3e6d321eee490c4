//! Writes the small records of `examples/data`, on which the README's commands run:
//! `cargo run -p bowden-lab --example example_data -- examples/data`
//!
//! They are made by the generator of test records, so their truth is known: one rig with the
//! cable straight, bent, and straight again some weeks later; the same rig with a user's own
//! column names; a damper.

use bowden_synth::{generate, Base, Mode, Planted, Recipe};
use std::error::Error;
use std::path::Path;

/// The cable, straight.
const STRAIGHT: Base = Base {
    gain: 0.952,
    kappa_eta: 2.29,
    offset: 0.05,
    rho: 0.382,
    sigma: 2.97,
    n: 1.02,
};

/// Bent, it keeps more of the torque to itself.
const BENT: Base = Base {
    gain: 0.905,
    kappa_eta: 3.1,
    ..STRAIGHT
};

fn cable(base: Base, seed: u64) -> Recipe {
    Recipe {
        base: Some(base),
        seed,
        rate: 100.0,
        seconds: 24.0,
        effects: vec![Planted {
            gain: Some(-0.264),
            channel: Some("phi_p".to_owned()),
            ..Planted::new("viscous")
        }],
        ..Recipe::new(Mode::Torque)
    }
}

/// Writes a record with a header of its own and four decimals: below the sensors' steps.
fn write(folder: &Path, name: &str, header: &str, recipe: &Recipe) -> Result<(), Box<dyn Error>> {
    let csv = generate(recipe)?.to_csv();
    let mut text = header.to_owned() + "\n";
    for line in csv.lines().skip(1) {
        let cells: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let cells: Vec<String> = cells?.iter().map(|v| format!("{v:.4}")).collect();
        text += &(cells.join(",") + "\n");
    }
    std::fs::write(folder.join(name), text)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("give the folder to write to")?;
    let folder = Path::new(&folder);
    let own = "t [s],tau_i [N·m],tau_o [N·m],phi_p [rad],phi_d [rad]";
    write(folder, "straight.csv", own, &cable(STRAIGHT, 7))?;
    write(folder, "bent.csv", own, &cable(BENT, 8))?;
    write(folder, "straight_later.csv", own, &cable(STRAIGHT, 9))?;
    let users = "t,motor_Nm,joint_Nm,motor_rad,joint_rad";
    write(folder, "rig.csv", users, &cable(STRAIGHT, 10))?;
    let damper = Recipe {
        rate: 100.0,
        seed: 11,
        effects: vec![Planted::new("viscous")],
        ..Recipe::new(Mode::Displacement)
    };
    write(folder, "damper.csv", "t,x_mm,f_N", &damper)
}
