//! Several records: errors by file, and the gains of each file.

use super::layout::{block, Width, LISTED};
use super::words::{estimate, table};
use bowden_lab::facts::{
    across, number, Across, Facts, FinalFacts, Grade, HeldOutOf, RecordFacts, RoundFacts,
};

/// The lengths of the records, in words.
pub(super) fn size(record: &RecordFacts) -> String {
    let rate = number(record.rate, Some(1e-3 * record.rate));
    match record.files.len() {
        0 | 1 => format!(
            "{} samples, {rate} Hz, {:.1} s",
            record.samples, record.seconds
        ),
        several => format!(
            "{} samples in {several} files, {:.1} s in total, resampled to {rate} Hz",
            record.samples, record.seconds
        ),
    }
}

/// The split of the records, in words.
pub(super) fn split(record: &RecordFacts) -> String {
    let trailing = "60 % fit · 15 % selection · 25 % held-out";
    let mut files = record.files.iter();
    let whole = files.find(|file| file.held_out == HeldOutOf::Whole);
    match (record.files.len(), whole) {
        (1, _) => trailing.to_owned(),
        (_, None) => format!("{trailing} of each file"),
        (_, Some(file)) => {
            format!("80 % fit · 20 % selection · held-out: {}", file.path)
        }
    }
}

/// Errors by file before and after, as a table; empty for a single record.
pub(super) fn errors(facts: &Facts) -> String {
    let (Some(before), Some(after)) = (&facts.declared.nrmse_by_file, &facts.shown().nrmse_by_file)
    else {
        return String::new();
    };
    let mut files = table(
        &[
            "error by file [%]",
            "fit",
            "selection",
            "held-out",
            "samples",
            "Hz",
        ],
        1..6,
    );
    let cell = |before: Option<f64>, after: Option<f64>| match (before, after) {
        (Some(before), Some(after)) => {
            let percent = |v: f64| number(100.0 * v, Some(5.0 * v));
            format!("{} → {}", percent(before), percent(after))
        }
        _ => "–".to_owned(),
    };
    for ((before, after), piece) in before.iter().zip(after).zip(&facts.record.files) {
        let pairs = before.segments().into_iter().zip(after.segments());
        let mut row = vec![piece.path.clone()];
        row.extend(pairs.map(|(b, a)| cell(b, a)));
        row.push(piece.samples.to_string());
        row.push(number(piece.rate, Some(1e-3 * piece.rate)));
        files.add_row(row);
    }
    let mut out = format!("{files}\n");
    for file in &facts.worse {
        out += &format!(
            "worse for {}: held-out {} % → {} %\n",
            file.path,
            number(100.0 * file.before, Some(5.0 * file.before)),
            number(100.0 * file.after, Some(5.0 * file.after))
        );
    }
    out + "\n"
}

/// The mechanisms that each file supports alone, and the files in which a term does not lower the
/// error; empty for a single record.
pub(super) fn alone(facts: &Facts, width: Width) -> String {
    let mut out = String::new();
    let lines = across(&facts.lacks, &facts.files_alone)
        .into_iter()
        .filter(|one| !one.files.is_empty());
    let terms = facts.rounds.iter().filter_map(not_everywhere);
    block(
        &mut out,
        width,
        "Files",
        lines.map(|one| words(&one)).chain(terms),
    );
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

/// "creep(x): does not lower the error in b.csv".
fn not_everywhere(round: &RoundFacts) -> Option<String> {
    let files = round.by_file.iter().filter(|file| file.share <= 0.0);
    let files: Vec<&str> = files.map(|file| file.path.as_str()).collect();
    let title = &round.title;
    match files.len() {
        0 => None,
        n if n > LISTED => Some(format!("{title}: does not lower the error in {n} files")),
        _ => Some(format!(
            "{title}: does not lower the error in {}",
            files.join(", ")
        )),
    }
}

/// "friction over the velocity of x: 2 of 3 files support it alone, 1 with high confidence; not
/// c.csv".
fn words(one: &Across) -> String {
    let count = |holds: &dyn Fn(Option<Grade>) -> bool| {
        one.files.iter().filter(|(_, grade)| holds(*grade)).count()
    };
    let (all, some) = (one.files.len(), count(&|grade| grade.is_some()));
    let high = match count(&|grade| grade == Some(Grade::High)) {
        0 => "none with high confidence".to_owned(),
        n if n == some => "with high confidence".to_owned(),
        n => format!("{n} with high confidence"),
    };
    let named = |holds: &dyn Fn(Option<Grade>) -> bool| {
        let names = one.files.iter().filter(|(_, grade)| holds(*grade));
        let names: Vec<&str> = names.map(|(path, _)| *path).collect();
        match names.len() > LISTED {
            true => format!("{} files", names.len()),
            false => names.join(", "),
        }
    };
    let others = || named(&|grade| grade.is_none());
    match (one.is_joint, some) {
        (true, 0) => format!(
            "{}: found only in the joint fit, not in any individual file",
            one.title
        ),
        (true, n) if n == all => format!("{}: found in each individual file, {high}", one.title),
        (true, n) => format!(
            "{}: found in {n} of {all} individual files, {high}; not in {}",
            one.title,
            others()
        ),
        (false, _) => {
            let own = named(&|grade| grade == Some(Grade::High));
            format!("{}: found in {own}, but not in the joint fit", one.title)
        }
    }
}

/// The gains of each file, as a table; empty if the files share them.
pub(super) fn gains(last: &FinalFacts) -> String {
    if last.gains_by_file.is_empty() {
        return String::new();
    }
    let names = last.gain_names;
    let mut files = table(
        &["gains by file (95 %)", names[0], names[1], names[2]],
        0..0,
    );
    for file in &last.gains_by_file {
        let own = file.gains.iter();
        let own = own.map(|found| found.as_ref().map_or_else(String::new, estimate));
        files.add_row(std::iter::once(file.path.clone()).chain(own));
    }
    format!("{files}\n\n")
}
