//! What two or more records of one rig say of each other. Records in one folder are of one rig.
//!
//! ```sh
//! cargo run --release -p bowden-lab --example carry_over -- A.csv B.csv … \
//!     [--mode torque|displacement] [--time COL] [--input COL] [--output COL] \
//!     [--channel NAME=COL]… [--baseline EFFECT,…] [--start S] [--end S] [--rate HZ] [--cutoff HZ]
//! ```
//! The options are those of `bowden identify`. Each record is closed by itself; then the model of
//! each, as `--model-out` writes it, runs on each other record as in `bowden validate`. Printed
//! are the names of each record, the share of its firm names that the other one knows, the
//! rounds that raise the held-out error, and the error on the other record: as it is, with gain
//! and offset refitted, and over the own held-out error. The last table is about the mechanisms:
//! how often two records of one rig lack the same main mechanism, and how often two records of
//! different rigs do. A record that cannot be read or fitted ends the run.

#[allow(dead_code)]
mod pair;

use bowden_lab::facts::Asked;
use bowden_lab::record::Mode;
use pair::{print_agreement, Closed, Rig};
use std::path::{Path, PathBuf};

/// The records, and how they are read.
struct Arguments {
    paths: Vec<PathBuf>,
    asked: Asked,
}

impl Arguments {
    fn read(words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut words = words;
        let mut all = Self {
            paths: Vec::new(),
            asked: Asked {
                declare: vec!["bouc-wen".to_owned()],
                ..Asked::default()
            },
        };
        while let Some(word) = words.next() {
            if !word.starts_with("--") {
                all.paths.push(PathBuf::from(word));
                continue;
            }
            let value = words.next().ok_or(format!("{word}: a value is missing"))?;
            all.take(&word, value)?;
        }
        match all.paths.len() {
            0 | 1 => Err("give two or more records of one rig".to_owned()),
            _ => Ok(all),
        }
    }

    fn take(&mut self, option: &str, value: String) -> Result<(), String> {
        let number = || {
            let parsed = value.parse::<f64>();
            parsed.map_err(|_| format!("{option}: {value:?} is no number"))
        };
        let options = &mut self.asked.options;
        match option {
            "--mode" => {
                options.mode = Some(match value.as_str() {
                    "torque" => Mode::Torque,
                    "displacement" => Mode::Displacement,
                    _ => return Err("--mode: torque or displacement is needed".to_owned()),
                });
            }
            "--start" => options.skip = number()?,
            "--end" => options.until = Some(number()?),
            "--rate" => options.rate = Some(number()?),
            "--cutoff" => self.asked.cutoff = Some(number()?),
            "--channel" => {
                let (name, column) = value
                    .split_once('=')
                    .ok_or("--channel: NAME=COL is needed")?;
                options.channels.push((name.to_owned(), column.to_owned()));
            }
            "--baseline" => self.asked.declare = value.split(',').map(str::to_owned).collect(),
            "--time" => options.time = Some(value),
            "--input" => options.input = Some(value),
            "--output" => options.output = Some(value),
            _ => return Err(format!("{option} is no option")),
        }
        Ok(())
    }
}

fn main() -> Result<(), String> {
    let Arguments { paths, asked } = Arguments::read(std::env::args().skip(1))?;
    let mut rigs: Vec<(&Path, Vec<Closed>)> = Vec::new();
    for path in &paths {
        eprintln!("closing {}", path.display());
        let closed = Closed::new(&asked, path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        match rigs.iter_mut().find(|(of, _)| *of == folder) {
            Some((_, records)) => records.push(closed),
            None => rigs.push((folder, vec![closed])),
        }
    }
    let rigs = rigs.into_iter().map(|(folder, closed)| {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        Rig::new(&name, closed)
    });
    let rigs = rigs.collect::<Result<Vec<Rig>, String>>()?;
    rigs.iter().for_each(Rig::print);
    print_agreement(&rigs);
    Ok(())
}
