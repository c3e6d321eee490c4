//! Many files in one fit: each has states of its own at its start, which cost it alone.

use crate::rig::{added, closed, on, Files};
use bowden_lab::conclude::intervals::parameters;
use bowden_lab::fit::fit;
use bowden_lab::model::columns::raw_columns;
use bowden_lab::model::declared::structure;
use bowden_lab::model::structure::{Free, Role, Structure};
use bowden_lab::problem::{HeldOut, Prepared, MOST_RECORDS};
use bowden_synth::{Base, Mode, Planted, Recipe};

const VISCOUS: f64 = -0.8;

/// Files of ten seconds of one rig, which lacks viscous friction.
fn files(count: usize) -> Files {
    let recipe = |seed: usize| Recipe {
        seconds: 10.0,
        rate: 500.0,
        effects: vec![Planted::with_gain("viscous", VISCOUS)],
        ..on(Base::CABLE, Mode::Torque, seed as u64)
    };
    Files::new(&(1..=count).map(recipe).collect::<Vec<_>>())
}

/// Runs on a number of threads.
fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(run)
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn of_as_many_files_as_are_allowed_one_model_finds_what_was_planted() {
    let data = files(MOST_RECORDS).joined(HeldOut::LastRecord);
    assert_eq!(data.pieces.len(), 64);
    let ledger = on_threads(1, || closed(&data));
    assert_eq!(added(&ledger), ["viscous"]);
    let last = ledger.last();
    // Noise of one sensor in all files; an rms over a few hundred independent values scatters.
    assert!(last.rmse.held_out < 1.3 * last.rmse.fit, "{:?}", last.rmse);
    assert!(ledger.declared.rmse.held_out > 3.0 * last.rmse.held_out);
    let all = parameters(&data, last);
    let found = all.iter().find(|p| p.name == "viscous@phi_p").unwrap();
    let [low, high] = found.ci95.unwrap();
    // Twice the 95 % interval: four standard deviations to either side.
    let slack = 0.5 * (high - low);
    let covered = (low - slack..=high + slack).contains(&VISCOUS);
    assert!(covered && high - low < 0.05, "{found:?}");
    // Each file that was fitted has its state at the start.
    let states = last
        .free
        .iter()
        .filter(|f| matches!(f.role, Role::Eta0 { .. }));
    assert_eq!(states.count(), 63);

    let again = on_threads(3, || closed(&data));
    let (one, other) = (ledger.last(), again.last());
    assert_eq!(one.values, other.values, "the number of threads tells");
    assert_eq!(one.gains, other.gains);
    assert_eq!(one.prediction, other.prediction);
}

/// The transmission, two effects that remember what was before the record, one that follows the
/// hysteresis, and a stage behind them all.
fn with_memory(data: &Prepared) -> (Structure, Vec<Free>, Vec<f64>) {
    let names = [
        "bouc-wen",
        "backlash",
        "play-in-series",
        "asymmetry-eta",
        "lag",
    ];
    let names = names.map(str::to_owned);
    let structure = structure(&names, data).unwrap();
    let free = structure.free(data);
    let value = |f: &Free| match f.role {
        Role::Rho => 3.0 / data.input.reach,
        Role::Sigma => 0.8,
        Role::N => 1.5,
        Role::Eta0 { record } => 0.1 * (record + 1) as f64,
        Role::Shape { term, index } => {
            let term = structure.terms.find(term).unwrap();
            term.effect.shape(index).unwrap()
        }
        Role::Origin { term } => structure.terms.find(term).unwrap().origin,
        // Half a gap away from the side that the play rests against: it is still there when the
        // record begins, and lies where the start has put it.
        Role::Start { term, record } => {
            let term = structure.terms.find(term).unwrap();
            let channel = data.channel(term.source).unwrap();
            let first = channel.motion[data.pieces[record].work.start].position - term.origin;
            -term.effect.shape(0).unwrap() * first.signum()
        }
        Role::Stage { .. } => 0.7,
    };
    let values = free.iter().map(value).collect();
    (structure, free, values)
}

/// The record whose state at the start a parameter is.
fn own_record(role: Role) -> Option<usize> {
    match role {
        Role::Eta0 { record } | Role::Start { record, .. } => Some(record),
        _ => None,
    }
}

/// The records that a parameter moves, where it is a state at the start or the gap of the play in
/// series: their slopes are differences of trajectories.
fn moved(data: &Prepared, structure: &Structure, role: Role) -> Option<std::ops::Range<usize>> {
    match (role, own_record(role)) {
        (_, Some(record)) => Some(data.pieces[record].work.clone()),
        (Role::Shape { term, .. }, _) => {
            let own = structure.terms.find(term).unwrap();
            own.effect.is_input_stage().then(|| 0..data.work_len())
        }
        _ => None,
    }
}

#[test]
fn the_slope_in_the_state_of_one_file_is_that_of_the_output_and_touches_no_other() {
    let data = files(3).joined(HeldOut::Trailing);
    let (structure, free, values) = with_memory(&data);
    let raw = raw_columns(&data, &structure, &free, &values).unwrap();
    let moves = raw.moves(&data, &structure, &free, &values).unwrap();
    let gains: Vec<f64> = (0..structure.linear())
        .map(|k| 1.0 + 0.3 * k as f64)
        .collect();
    let slopes = raw.tangents(&moves, &gains);
    let (mut tried, mut moving) = (0, 0);
    for ((j, f), slope) in free.iter().enumerate().zip(&slopes) {
        let Some(work) = moved(&data, &structure, f.role) else {
            continue;
        };
        let is_still = slope.values().is_empty();
        assert!(is_still || slope.range() == work, "{:?}", f.role);
        let step = match f.role {
            Role::Eta0 { .. } => 1e-6,
            Role::Shape { .. } => 1e-5 * values[j],
            // As the slopes themselves: they are differences, and a play has corners.
            _ => 1e-5 * data.input.reach,
        };
        let at = |sign: f64| {
            let mut moved = values.clone();
            moved[j] += sign * step;
            let raw = raw_columns(&data, &structure, &free, &moved).unwrap();
            raw.output(&gains)
        };
        let (up, down) = (at(1.0), at(-1.0));
        let size = slope.values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        moving += usize::from(size > 0.0);
        for i in 0..data.work_len() {
            let expected = (up[i] - down[i]) / (2.0 * step);
            if !work.contains(&i) {
                assert_eq!(expected, 0.0, "{:?} moves another file", f.role);
            }
            // Rounding of an output of order ten over a step of 1e-6, and the step's square.
            let off = (slope[i] - expected).abs();
            assert!(off < 1e-5 * size.max(1.0), "{:?} {i}: {off}", f.role);
        }
        tried += 1;
    }
    assert_eq!(tried, 10, "eta0 and two starts of each file, and a gap");
    assert_eq!(moving, tried, "each moves something");
}

#[test]
fn a_solution_keeps_what_belongs_to_one_file_on_the_rows_of_that_file() {
    let data = files(3).joined(HeldOut::Trailing);
    let mut declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
    declared.own_gains = 3;
    let solution = fit(&data, &declared, None, 0.0).unwrap();
    for (f, tangent) in solution.free.iter().zip(&solution.tangents) {
        let own = own_record(f.role).map(|record| data.pieces[record].rows.clone());
        let expected = own.unwrap_or(0..data.target.len());
        assert_eq!(tangent.range(), expected, "{:?}", f.role);
    }
    for (k, column) in solution.columns.iter().enumerate() {
        assert_eq!(column.range(), data.pieces[k / 3].rows, "gain {k}");
    }
}
