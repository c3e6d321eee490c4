//! The signals over time, and what each part adds.

use crate::rig::Closed;
use bowden_lab::conclude::trace::trace;
use bowden_synth::{Mode, Planted, Recipe};

/// A trace as its reader sees it.
struct Read {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Read {
    fn new(csv: &str) -> Self {
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let header = reader
            .headers()
            .unwrap()
            .iter()
            .map(str::to_owned)
            .collect();
        let rows = reader
            .records()
            .map(|row| row.unwrap().iter().map(str::to_owned).collect());
        Self {
            header,
            rows: rows.collect(),
        }
    }

    fn text(&self, name: &str) -> Vec<&str> {
        let own = |h: &String| h == name || h.starts_with(&format!("{name} ["));
        let index = self
            .header
            .iter()
            .position(own)
            .unwrap_or_else(|| panic!("{name}: {:?}", self.header));
        self.rows.iter().map(|row| row[index].as_str()).collect()
    }

    fn column(&self, name: &str) -> Vec<f64> {
        self.text(name)
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect()
    }

    /// The sum of all columns behind `residual`.
    fn shares(&self) -> Vec<f64> {
        let first = self
            .header
            .iter()
            .position(|h| h.starts_with("residual"))
            .unwrap()
            + 1;
        let sum = |row: &Vec<String>| row[first..].iter().map(|c| c.parse::<f64>().unwrap()).sum();
        self.rows.iter().map(sum).collect()
    }

    fn assert_shares_sum_to_final(&self) {
        let last = self.column("final");
        let largest = last.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (share, last) in self.shares().iter().zip(&last) {
            // Rounding: the filter over a sum or over its parts.
            assert!((share - last).abs() < 1e-9 * largest, "{share} {last}");
        }
    }

    fn rms(&self, name: &str, segment: &str) -> f64 {
        let segments = self.text("segment");
        let own = self.column(name);
        let own: Vec<f64> = own
            .iter()
            .zip(segments)
            .filter(|(_, s)| *s == segment)
            .map(|(v, _)| v * v)
            .collect();
        (own.iter().sum::<f64>() / own.len() as f64).sqrt()
    }
}

fn traced(closed: &Closed) -> Read {
    Read::new(&trace(&closed.data, &closed.ledger, &closed.done).unwrap())
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_trace_is_what_the_fit_sees_and_its_errors_are_those_of_the_report() {
    let recipe = Recipe {
        effects: vec![
            Planted::with_gain("viscous", 0.02),
            Planted::with_gain("stiffness-cubic", 0.01),
        ],
        ..Recipe::of_one_rig(Mode::Displacement, 74_000)
    };
    let closed = Closed::new(&recipe, &["bouc-wen"], 8);
    let read = traced(&closed);
    assert_eq!(
        read.header[..10],
        [
            "t [s]",
            "segment",
            "input [mm]",
            "measured [N]",
            "baseline [N]",
            "final [N]",
            "residual [N]",
            "transmission.gain [N]",
            "transmission.hysteresis [N]",
            "transmission.offset [N]"
        ]
    );
    assert!(
        read.header.contains(&"viscous [N]".to_owned()),
        "{:?}",
        read.header
    );
    assert_eq!(read.rows.len(), closed.data.target.len());
    let errors = closed.done.rmse;
    for (segment, error) in [
        ("fit", errors.fit),
        ("selection", errors.selection),
        ("held-out", errors.held_out),
    ] {
        // Numbers are printed so that they read back.
        assert!(
            (read.rms("residual", segment) / error - 1.0).abs() < 1e-12,
            "{segment}"
        );
    }
    let segments = read.text("segment");
    assert_eq!(
        (segments[0], segments[segments.len() - 1]),
        ("dropped", "dropped")
    );
    let (measured, last, residual) = (
        read.column("measured"),
        read.column("final"),
        read.column("residual"),
    );
    for i in 0..measured.len() {
        assert!((measured[i] - last[i] - residual[i]).abs() < 1e-9);
    }
    let t = read.column("t");
    let step = closed.data.dt * closed.data.stride as f64;
    assert!(t.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-8));
    read.assert_shares_sum_to_final();
    // What is planted is seen: the share's rms is the gain times the velocity's.
    let speed = closed.data.input.speed;
    // The speed is that of the fit segment before the filter at the cut-off.
    assert!((read.rms("viscous", "fit") / (0.02 * speed) - 1.0).abs() < 0.1);
}

#[test]
fn the_shares_sum_to_the_final_model_with_an_output_stage_too() {
    let recipe = Recipe {
        effects: vec![Planted::new("lag")],
        ..Recipe::of_one_rig(Mode::Displacement, 74_001)
    };
    let closed = Closed::new(&recipe, &["bouc-wen", "lag"], 0);
    let read = traced(&closed);
    read.assert_shares_sum_to_final();
    // The stage is given as what it changes: three times the noise was planted, and what
    // passes the filter of it is nearly all.
    let changed = read.rms("lag", "fit");
    assert!(changed > 0.1 && changed < 0.2, "{changed}");
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_shares_sum_to_the_final_model_with_a_table_and_in_torque_mode() {
    let recipe = Recipe {
        effects: vec![Planted::new("bump-position")],
        ..Recipe::of_one_rig(Mode::Torque, 74_002)
    };
    let closed = Closed::new(&recipe, &["bouc-wen"], 8);
    assert!(closed.ledger.unknown.is_some());
    let read = traced(&closed);
    read.assert_shares_sum_to_final();
    let last = read.header.last().unwrap();
    assert!(last.starts_with("unknown: phi_p"), "{last}");
}

#[test]
fn two_effects_of_one_name_have_two_columns() {
    let recipe = Recipe {
        effects: vec![Planted::new("viscous")],
        ..Recipe::of_one_rig(Mode::Torque, 74_003)
    };
    let closed = Closed::new(&recipe, &["bouc-wen", "viscous@phi_p", "viscous@phi_d"], 0);
    let read = traced(&closed);
    assert!(read.header.contains(&"viscous@phi_p [N·m]".to_owned()));
    assert!(read.header.contains(&"viscous@phi_d [N·m]".to_owned()));
    read.assert_shares_sum_to_final();
}
