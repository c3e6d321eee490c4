//! A checker in another language, in exact fractions: `check.py`.

use crate::shell::example;
use bowden_trials::proof::{parse, Proof};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// What the checker says of certificates, a line each; `None` without Python.
fn checked(certificates: &[Proof]) -> Option<Vec<String>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cli/certificates");
    let mut python = Command::new("python3");
    python.arg("check.py").current_dir(folder);
    let child = python.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let Ok(mut child) = child else {
        println!("skipped: python3 is not there");
        return None;
    };
    let mut input = child.stdin.take().unwrap();
    let line = |own: &Proof| serde_json::to_string(own).unwrap() + "\n";
    let lines: String = certificates.iter().map(line).collect();
    // Beside the reading: neither pipe fills up.
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let said: Vec<String> = said.lines().map(str::to_owned).collect();
    assert_eq!(said.len(), certificates.len(), "{said:?}");
    let all_well = said.iter().all(|line| line.ends_with(": ok"));
    assert_eq!(output.status.success(), all_well);
    Some(said)
}

/// xorshift64*: the same in every run.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        #[allow(clippy::cast_precision_loss)]
        let unit = bits as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    fn is_within(&mut self, share: f64) -> bool {
        self.within(0.0, 1.0) < share
    }

    /// Any gains, at rates from 200 Hz to 20 kHz: many are proved, many are not.
    fn gains(&mut self) -> String {
        let float = if self.is_within(0.5) { "f32" } else { "f64" };
        let mut text = format!("float = \"{float}\"\n");
        let step = 1.0 / (200.0 * self.within(1.0, 10.0).powi(2));
        let spread = self.within(0.0, 0.3);
        let (low, high) = (1.0 - spread, 1.0 + spread);
        let _ = writeln!(text, "step = {step:e}\nbeta = [{low:e}, {high:e}]");
        // A slew rate that is met, or one that is not.
        if self.is_within(0.5) {
            let _ = writeln!(text, "slew = {:e}", self.within(5.0, 70.0).powi(2));
        }
        for (name, low, high) in [
            ("k", 0.5, 40.0),
            ("lambda", 1.0, 15.0),
            ("epsilon", 0.02, 1.0),
            ("z_limit", 0.05, 2.0),
            ("command", 20.0, 200.0),
        ] {
            let _ = writeln!(text, "{name} = {:e}", self.within(low, high));
        }
        let delta = self.within(0.0, 8.0);
        let alpha = [self.within(0.8, 1.0), self.within(1.0, 1.2)];
        let _ = writeln!(text, "delta = [0.0, {delta:e}]\n[plant]\nalpha = {alpha:?}");
        for (name, high) in [
            ("disturbance", 10.0),
            ("disturbance_rate", 60.0),
            ("reference", 40.0),
            ("reference_rate", 50.0),
        ] {
            let _ = writeln!(text, "{name} = {:e}", self.within(0.0, high));
        }
        let mut left = self.within(0.0, 4.0);
        while left > 1.0 {
            left -= 1.0;
            let (low, mut high) = (self.within(-2.0, 0.5), self.within(0.5, 3.0));
            // An estimate that does not move.
            if self.is_within(0.2) {
                high = low;
            }
            let theta = [self.within(low, 0.5), self.within(0.5, high.max(0.5))];
            let (magnitude, rate) = (self.within(0.0, 4.0), self.within(0.0, 10.0));
            let boxes = format!("theta_hat = [{low:e}, {high:e}]\ntheta = {theta:?}");
            let sizes = format!("magnitude = {magnitude:e}\nrate = {rate:e}");
            let _ = writeln!(text, "[[regressor]]\n{boxes}\n{sizes}");
        }
        text
    }
}

fn random(number: usize, seed: u64) -> Vec<Proof> {
    let mut random = Random(seed);
    (0..number)
        .map(|_| parse(&random.gains(), "random").unwrap())
        .collect()
}

/// An example with one text of it replaced.
fn changed(name: &str, from: &str, to: &str) -> Proof {
    let own = std::fs::read_to_string(example(name)).unwrap();
    parse(&own.replace(from, to), name).unwrap()
}

fn examples() -> [Proof; 3] {
    ["gains_table2.toml", "gains_own.toml", "gains_refused.toml"].map(|name| changed(name, "", ""))
}

#[test]
fn another_program_agrees_on_a_limit_that_may_be_met() {
    let [met, weak] = ["command = 41.0", "command = 40.0"]
        .map(|limit| changed("gains_own.toml", "command = 60.0", limit));
    assert!(met.proved && met.may_meet_the_limit);
    assert!(!weak.proved && weak.may_meet_the_limit);
    let mut denied = met.clone();
    denied.may_meet_the_limit = false;
    let mut claimed = weak.clone();
    claimed.proved = true;
    let mut disproved = met.clone();
    disproved.proved = false;
    let Some(said) = checked(&[met, weak, denied, claimed, disproved]) else {
        return;
    };
    let wells: Vec<bool> = said.iter().map(|line| line.ends_with(": ok")).collect();
    assert_eq!(wells, [true, true, false, false, false], "{said:?}");
}

#[track_caller]
fn agree(certificates: &[Proof]) {
    let Some(said) = checked(certificates) else {
        return;
    };
    for line in &said {
        assert!(line.ends_with(": ok"), "{line}");
    }
    let proved = certificates.iter().filter(|c| c.proved).count();
    println!("{proved} of {} proved", certificates.len());
    assert!(proved * 10 > certificates.len() && proved * 10 < 9 * certificates.len());
}

#[test]
fn another_program_agrees_on_random_gains_in_exact_fractions() {
    let mut all = random(300, 5);
    all.extend(examples());
    agree(&all);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn another_program_agrees_on_ten_thousand_random_gains() {
    agree(&random(10_000, 77));
}

/// Half, and twice, what a number is.
fn scale(exact: &mut String, by: i32) {
    let (mantissa, exponent) = exact.split_once("*2^").unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    *exact = format!("{mantissa}*2^{}", exponent + by);
}

/// A little off: the mantissa's last of 40 bits.
fn nudge(exact: &mut String, by: i128) {
    let (mantissa, exponent) = exact.split_once("*2^").unwrap();
    let (mantissa, exponent): (i128, i32) = (mantissa.parse().unwrap(), exponent.parse().unwrap());
    let up = mantissa.leading_zeros() - (128 - 40).min(mantissa.leading_zeros());
    let mantissa = (mantissa << up) + by;
    #[allow(clippy::cast_possible_wrap)]
    let exponent = exponent - up as i32;
    *exact = format!("{mantissa}*2^{exponent}");
}

#[test]
fn each_inequality_with_a_number_changed_is_caught() {
    let [_, good, refused] = examples();
    let slewed = changed(
        "gains_own.toml",
        "command = 60.0",
        "slew = 500.0\ncommand = 60.0",
    );
    assert!(slewed.proved);
    let mut mutated = Vec::new();
    let mut mutate = |own: &Proof, change: &dyn Fn(&mut Proof)| {
        let mut other = own.clone();
        change(&mut other);
        mutated.push(other);
    };
    for i in 0..good.inequalities.len() {
        for by in [-1, 1] {
            mutate(&good, &|own| scale(&mut own.inequalities[i].left.exact, by));
            mutate(&good, &|own| {
                scale(&mut own.inequalities[i].right.exact, by)
            });
        }
        // Too favourable by a millionth of a millionth.
        mutate(&good, &|own| {
            nudge(&mut own.inequalities[i].left.exact, -(1 << 20))
        });
        mutate(&good, &|own| {
            nudge(&mut own.inequalities[i].right.exact, 1 << 20)
        });
    }
    for by in [-1, 1] {
        for i in 0..good.at_the_limit.len() {
            mutate(&good, &|own| scale(&mut own.at_the_limit[i].left.exact, by));
        }
        mutate(&slewed, &|own| {
            scale(&mut own.slew.as_mut().unwrap().left.exact, by)
        });
        mutate(&slewed, &|own| {
            scale(&mut own.slew.as_mut().unwrap().right.exact, by)
        });
    }
    // A smaller box than was proved, and a refusal that is called a proof.
    mutate(&good, &|own| scale(&mut own.s.exact, -1));
    mutate(&refused, &|own| own.proved = true);
    mutate(&refused, &|own| {
        own.proved = true;
        own.inequalities[1].holds = true;
    });
    let Some(said) = checked(&mutated) else {
        return;
    };
    for (i, line) in said.iter().enumerate() {
        assert!(!line.ends_with(": ok"), "mutation {i}: {line}");
    }
}
