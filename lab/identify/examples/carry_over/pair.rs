//! What two records of one rig say of each other: the names that come again, the rounds that
//! raise the held-out error, and the error of each one's model on the other.

use bowden::model::Source;
use bowden_lab::check::{Check, Given, Verdict};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::mechanisms::mechanisms;
use bowden_lab::conclude::verdict::raises;
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::facts::Asked;
use bowden_lab::ledger::{Grade, Ledger, Round};
use bowden_lab::model::catalogue::Candidate;
use bowden_lab::model::declared::structure;
use bowden_lab::model::mechanism::Mechanism;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::Record;
use bowden_lab::search::close;
use std::path::Path;

/// What tells two names apart: the family and the channel that it reads. A search looks for
/// rivals of a name in other families and on other channels only.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    pub family: &'static str,
    pub channel: Option<String>,
}

impl Identity {
    fn of(data: &Prepared, candidate: &Candidate) -> Self {
        let source = candidate.term.source;
        let channel = match source {
            Source::Input => None,
            Source::Channel(_) => data.channel(source).map(|c| c.name.clone()),
        };
        Self {
            family: candidate.family,
            channel,
        }
    }
}

impl std::fmt::Display for Identity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.channel {
            Some(channel) => write!(f, "{}@{channel}", self.family),
            None => write!(f, "{}", self.family),
        }
    }
}

/// A name of the delivered model.
#[derive(Debug, Clone)]
pub struct Name {
    pub identity: Identity,
    pub grade: Grade,
    pub rivals: Vec<Identity>,
    /// Whether its round raises the held-out error.
    pub raises: bool,
}

/// A record that was closed, and its model as `bowden identify --model-out` writes it.
pub struct Closed {
    pub label: String,
    record: Record,
    /// The delivered names, in the order of their rounds.
    pub names: Vec<Name>,
    /// What was found beyond these and is not delivered.
    pub beyond: usize,
    /// On what the record depends besides, where that has no name.
    pub unknown: Option<String>,
    /// The main missing mechanism with its confidence, where one is missing.
    pub mechanism: Option<(Mechanism, Grade)>,
    given: Given,
    /// Held-out error of the model that is written, over the output's standard deviation.
    pub held_out: f64,
}

impl Closed {
    /// Reads and closes a record.
    ///
    /// # Errors
    /// One line where it cannot be read or fitted, or where no model can be written.
    pub fn new(asked: &Asked, path: &Path) -> Result<Self, String> {
        Self::of(asked, asked.read(path)?, path)
    }

    /// Closes a record that came from that path.
    ///
    /// # Errors
    /// One line where it cannot be fitted, or where no model can be written.
    pub fn of(asked: &Asked, record: Record, path: &Path) -> Result<Self, String> {
        let label = path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let cutoff = asked.cutoff;
        let data = Prepared::new(&record, Preparation { cutoff })?;
        let ledger = close(&data, &structure(&asked.declare, &data)?, |_| ())?;
        let done = FinalFit::new(&data, &ledger);
        let records = [record];
        let hand = HandOver::new(&records, &data, &ledger, &done, false, |_| ())?;
        let [record] = records;
        let file = hand.files.first().ok_or("no model is handed over")?;
        let text = file.toml().map_err(|e| e.to_string())?;
        Ok(Self {
            label,
            record,
            names: names(&data, &ledger),
            beyond: ledger.beyond.len(),
            mechanism: mechanisms(&data, &ledger, &done)
                .first()
                .map(|lack| (lack.mechanism, lack.confidence)),
            unknown: ledger.unknown.map(|u| u.variable.words(&data)),
            given: Given::parse(&text)?,
            held_out: hand.nrmse.held_out,
        })
    }

    /// Delivered rounds that raise the held-out error.
    pub fn raising(&self) -> Share {
        Share {
            count: self.names.iter().filter(|name| name.raises).count(),
            of: self.names.len(),
        }
    }
}

fn names(data: &Prepared, ledger: &Ledger) -> Vec<Name> {
    let name = |round: &Round| Name {
        identity: Identity::of(data, &round.candidate),
        grade: round.grade,
        rivals: (round.possible().skip(1).map(|r| Identity::of(data, &r))).collect(),
        raises: raises(round),
    };
    ledger.rounds.iter().map(name).collect()
}

/// The model of one record on another one of the same rig. Errors are shares of the standard
/// deviation of the output that they are of.
#[derive(Debug, Clone)]
pub struct Carried {
    pub from: String,
    pub to: String,
    /// Held-out error on its own record.
    pub own: f64,
    /// Error on the other record, as it is.
    pub as_it_is: f64,
    /// Error on the other record with gain and offset refitted.
    pub refitted: f64,
    /// The refitted gain.
    pub gain: f64,
    /// Largest share of the other record's samples that lie beyond what the model has seen of
    /// one quantity: a position, a velocity or an acceleration.
    pub outside: f64,
    pub verdict: Verdict,
}

impl Carried {
    /// # Errors
    /// One line where the other record lacks what the model reads, or is too short.
    pub fn new(model: &Closed, on: &Closed) -> Result<Self, String> {
        let check = Check::new(on.record.clone(), &model.given, None)?;
        Ok(Self {
            from: model.label.clone(),
            to: on.label.clone(),
            own: model.held_out,
            as_it_is: check.rmse / check.deviation,
            refitted: check.rmse_gain_offset / check.deviation,
            gain: check.line.gain.value,
            outside: check.outside.iter().map(|o| o.share).fold(0.0, f64::max),
            verdict: check.verdict,
        })
    }

    /// Error on the other record with gain and offset refitted, over the own held-out error.
    pub fn ratio(&self) -> f64 {
        self.refitted / self.own
    }
}

/// A count of a total.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Share {
    pub count: usize,
    pub of: usize,
}

impl Share {
    pub fn percent(self) -> f64 {
        100.0 * self.count as f64 / self.of as f64
    }
}

impl std::ops::Add for Share {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            of: self.of + other.of,
        }
    }
}

impl std::iter::Sum for Share {
    fn sum<I: Iterator<Item = Self>>(shares: I) -> Self {
        shares.fold(Self::default(), |sum, share| sum + share)
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {}", self.count, self.of)
    }
}

/// The firm names of one record that another one knows: names itself, or has as a rival of one
/// of its names, firm or weak. Two rounds of one family on one channel are one name. A firm name
/// has no rivals of its own.
pub fn known(of: &[Name], by: &[Name]) -> Share {
    let mut firm: Vec<&Identity> = Vec::new();
    for name in of.iter().filter(|name| name.grade == Grade::High) {
        if !firm.contains(&&name.identity) {
            firm.push(&name.identity);
        }
    }
    let knows = |other: &&&Identity| {
        let mut names = by.iter();
        names.any(|own| own.identity == ***other || own.rivals.contains(other))
    };
    Share {
        count: firm.iter().filter(knows).count(),
        of: firm.len(),
    }
}

/// Pairs of records whose main missing mechanism is the same one, of all in which both lack one;
/// and of those in which both are of high confidence.
fn agreeing<'a>(pairs: impl Iterator<Item = (&'a Closed, &'a Closed)>) -> [Share; 2] {
    let mut shares = [Share::default(); 2];
    for ((one, own), (other, its)) in pairs.filter_map(|(a, b)| Some((a.mechanism?, b.mechanism?)))
    {
        let is_high = own == Grade::High && its == Grade::High;
        for share in shares.iter_mut().take(1 + usize::from(is_high)) {
            share.of += 1;
            share.count += usize::from(one == other);
        }
    }
    shares
}

/// The chance level of [`Rig::mechanisms`]: the same of pairs of records of different rigs.
pub fn by_chance(rigs: &[Rig]) -> [Share; 2] {
    let rigs = rigs.iter().enumerate();
    agreeing(rigs.clone().flat_map(|(i, rig)| {
        let others = rigs.clone().skip(i + 1).flat_map(|(_, rig)| &rig.closed);
        others.flat_map(move |other| rig.closed.iter().map(move |one| (one, other)))
    }))
}

/// Prints how often two records of one rig lack the same mechanism, and the chance level.
pub fn print_agreement(rigs: &[Rig]) {
    let records: Vec<&Closed> = rigs.iter().flat_map(|rig| &rig.closed).collect();
    let with = |is: fn(&Closed) -> bool| records.iter().filter(|one| is(one)).count();
    let [all, high] = rigs.iter().fold([Share::default(); 2], |[all, high], rig| {
        let [own, own_high] = rig.mechanisms();
        [all + own, high + own_high]
    });
    let [chance, chance_high] = by_chance(rigs).map(|share| match share.of {
        0 => String::new(),
        _ => format!("{share} ({:.0} %)", share.percent()),
    });
    println!(
        "\n| the main missing mechanism is the same | of one rig | of different rigs (chance) |"
    );
    println!("|---|---|---|");
    println!("| pairs of records | {all} | {chance} |");
    println!("| of these, both with high confidence | {high} | {chance_high} |");
    println!(
        "\n{} records of {} rigs: {} lack a mechanism, {} of these with high confidence; {} have a high-confidence term",
        records.len(),
        rigs.len(),
        with(|one| one.mechanism.is_some()),
        with(|one| matches!(one.mechanism, Some((_, Grade::High)))),
        with(|one| one.names.iter().any(|name| name.grade == Grade::High)),
    );
}

/// Records of one rig, each closed once, with the model of each on each other.
pub struct Rig {
    pub name: String,
    pub closed: Vec<Closed>,
    pub carried: Vec<Carried>,
}

impl Rig {
    /// # Errors
    /// One line of the first record or pair that cannot be measured.
    pub fn new(name: &str, closed: Vec<Closed>) -> Result<Self, String> {
        let mut carried = Vec::new();
        for (i, model) in closed.iter().enumerate() {
            for (_, on) in closed.iter().enumerate().filter(|(j, _)| *j != i) {
                carried.push(Carried::new(model, on)?);
            }
        }
        Ok(Self {
            name: name.to_owned(),
            closed,
            carried,
        })
    }

    /// Firm names that the other record of a pair knows, over all directed pairs: so that of
    /// each pair it is (known of A + known of B) over (firm of A + firm of B).
    pub fn agreement(&self) -> Share {
        let pairs = self.closed.iter().enumerate().flat_map(|(i, of)| {
            let others = self.closed.iter().enumerate();
            let others = others.filter(move |(j, _)| *j != i);
            others.map(move |(_, by)| known(&of.names, &by.names))
        });
        pairs.sum()
    }

    /// Pairs of records whose main missing mechanism is the same one, of all in which both lack
    /// one; and of those in which both are of high confidence.
    pub fn mechanisms(&self) -> [Share; 2] {
        let records = self.closed.iter().enumerate();
        agreeing(records.flat_map(|(i, one)| {
            let others = self.closed[i + 1..].iter();
            others.map(move |other| (one, other))
        }))
    }

    /// Delivered rounds that raise the held-out error of their own record.
    pub fn raising(&self) -> Share {
        self.closed.iter().map(Closed::raising).sum()
    }

    /// Both tables in Markdown: what each record names, and how each model does on the others.
    pub fn print(&self) {
        println!("\n{}", self.name);
        println!("\n| record | main missing mechanism | terms: **high**, low confidence | undelivered | held-out error |");
        println!("|---|---|---|---|---|");
        for closed in &self.closed {
            let names: Vec<String> = closed.names.iter().map(words).collect();
            let curve = closed
                .unknown
                .iter()
                .map(|u| format!("unmodelled dependence on {u}"));
            let all: Vec<String> = names.into_iter().chain(curve).collect();
            let mechanism = closed.mechanism.map(|(mechanism, grade)| match grade {
                Grade::High => format!("**{}**", mechanism.name()),
                Grade::Low => mechanism.name().to_owned(),
            });
            println!(
                "| {} | {} | {} | {} | {:.2} % |",
                closed.label,
                mechanism.unwrap_or_default(),
                all.join(", "),
                closed.beyond,
                100.0 * closed.held_out
            );
        }
        println!("\n| model of | on | high-confidence terms found there | outside | own held-out error | without a refit | gain and offset refitted | error ratio |");
        println!("|---|---|---|---|---|---|---|---|");
        for one in &self.carried {
            let find = |label: &str| self.closed.iter().find(|c| c.label == label);
            let known = match (find(&one.from), find(&one.to)) {
                (Some(of), Some(by)) => known(&of.names, &by.names),
                _ => Share::default(),
            };
            println!(
                "| {} | {} | {known} | {:.0} % | {:.2} % | {:.2} % | {:.2} % (gain {:.3}) | {:.2} |",
                one.from,
                one.to,
                100.0 * one.outside,
                100.0 * one.own,
                100.0 * one.as_it_is,
                100.0 * one.refitted,
                one.gain,
                one.ratio()
            );
        }
        println!(
            "\nHigh-confidence terms found again: {}. Terms that raise the held-out error: {}.",
            self.agreement(),
            self.raising(),
        );
    }
}

fn words(name: &Name) -> String {
    let title = match name.grade {
        Grade::High => format!("**{}**", name.identity),
        Grade::Low => name.identity.to_string(),
    };
    let rivals: Vec<String> = name.rivals.iter().map(ToString::to_string).collect();
    let rivals = match rivals.is_empty() {
        true => String::new(),
        false => format!(" (or {})", rivals.join(", ")),
    };
    let raises = if name.raises { ", raises held out" } else { "" };
    format!("{title}{raises}{rivals}")
}
