//! The records whose cost is measured: generated ones of any length, and measured ones.

use crate::program::Program;
use crate::shared::Row;
use std::path::{Path, PathBuf};

/// A generated record, and how `identify` is told to read it.
pub struct Case {
    pub label: String,
    pub arguments: Vec<String>,
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// Has the generator write a record into a folder.
pub fn generated(
    program: &Program,
    folder: &Path,
    name: &str,
    arguments: &str,
) -> Result<PathBuf, String> {
    let path = folder.join(name);
    let mut all = words("generate");
    all.extend(words(arguments));
    all.extend(["--out".to_owned(), path.display().to_string()]);
    program.run(&all)?;
    Ok(path)
}

/// The record of the bare command at 1 kHz, longer and shorter.
pub fn of_length(program: &Program, folder: &Path, samples: u64) -> Result<Case, String> {
    let seconds = samples as f64 / 1000.0;
    let recipe = format!("--mode torque --effect viscous --seed 7 --seconds {seconds}");
    let path = generated(program, folder, "length.csv", &recipe)?;
    Ok(Case {
        label: samples.to_string(),
        arguments: vec![path.display().to_string()],
    })
}

/// Angles that a record of the catalogue series has.
pub const ANGLES: [usize; 5] = [0, 1, 2, 4, 8];

/// A record with so many angles, of which only the transmission's own two mean something.
pub fn with_angles(program: &Program, folder: &Path, angles: usize) -> Result<Case, String> {
    let recipe = "--mode torque --effect asymmetry-eta --seed 7";
    let path = generated(program, folder, "angles.csv", recipe)?;
    let named = |e: std::io::Error| format!("{}: {e}", path.display());
    let text = std::fs::read_to_string(&path).map_err(named)?;
    let mut lines = text.lines();
    let mut header = lines.next().unwrap_or_default().to_owned();
    // A column whose name the reader does not know is not read.
    for hidden in ["phi_p", "phi_d"].iter().skip(angles) {
        header = header.replace(hidden, &format!("not_read_{hidden}"));
    }
    let further: Vec<usize> = (2..angles).collect();
    header.extend(further.iter().map(|k| format!(",phi_{k} [rad]")));
    let mut whole = header + "\n";
    for (i, line) in lines.enumerate() {
        whole += line;
        for &k in &further {
            // Two tones below the record's own, of another pace for each angle.
            let at = 1e-3 * i as f64 * (1.0 + 0.37 * k as f64);
            whole += &format!(",{:.6}", 0.5 * at.sin() + 0.3 * (1.7 * at).sin());
        }
        whole += "\n";
    }
    std::fs::write(&path, whole).map_err(named)?;
    let mut arguments = vec![path.display().to_string()];
    for k in further {
        arguments.extend(["--channel".to_owned(), format!("phi_{k}=phi_{k}")]);
    }
    Ok(Case {
        label: angles.to_string(),
        arguments,
    })
}

/// What the records of the names series lack, one more from record to record.
pub const PLANTED: [&str; 4] = ["viscous", "stiffness-quadratic", "ripple", "load-friction"];

/// A record of 60 s that lacks the first `names` of [`PLANTED`].
pub fn with_names(program: &Program, folder: &Path, names: usize) -> Result<Case, String> {
    let effects: Vec<String> = PLANTED[..names]
        .iter()
        .map(|e| format!("--effect {e}:2"))
        .collect();
    let recipe = format!("--mode torque --seed 7 --seconds 60 {}", effects.join(" "));
    let path = generated(program, folder, "names.csv", &recipe)?;
    Ok(Case {
        label: names.to_string(),
        arguments: vec![path.display().to_string()],
    })
}

/// The folder that holds `.ci/run`, from which everything else is found.
pub fn repository() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut above = own.ancestors();
    let found = above.find(|folder| folder.join(".ci/run").exists());
    found.unwrap_or(own).to_owned()
}

/// The row as it is closed, where its file is there.
pub fn measured(row: &Row) -> Option<Case> {
    let mut arguments = vec![row.path()?.display().to_string()];
    arguments.extend(row.options());
    Some(Case {
        label: row.name.to_owned(),
        arguments,
    })
}
