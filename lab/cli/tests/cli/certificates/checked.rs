//! A checker in another language, in exact fractions: `check.py`.

use crate::shell::example;
use bowden_trials::proof::{parse, Proof};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// What the checker says of certificates, a line each; `None` without Python.
fn checked(certificates: &[Proof]) -> Option<Vec<String>> {
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/cli/certificates/check.py"
    );
    let child = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn();
    let Ok(mut child) = child else {
        println!("skipped: python3 is not there");
        return None;
    };
    let mut input = child.stdin.take().unwrap();
    let lines = certificates
        .iter()
        .map(|c| serde_json::to_string(c).unwrap() + "\n");
    let lines: String = lines.collect();
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

    /// Any gains, at rates from 200 Hz to 20 kHz: many are proved, many are not.
    fn gains(&mut self) -> String {
        let float = if self.within(0.0, 1.0) < 0.5 {
            "f32"
        } else {
            "f64"
        };
        let (k, lambda) = (self.within(0.5, 40.0), self.within(1.0, 15.0));
        let (step, epsilon) = (
            1.0 / (200.0 * self.within(1.0, 10.0).powi(2)),
            self.within(0.02, 1.0),
        );
        let spread = self.within(0.0, 0.3);
        let mut text = format!(
            "float = \"{float}\"\nk = {k:e}\nlambda = {lambda:e}\nstep = {step:e}\nepsilon = {epsilon:e}\n\
             z_limit = {:e}\ncommand = {:e}\nbeta = [{:e}, {:e}]\ndelta = [0.0, {:e}]\n[plant]\n\
             alpha = [{:e}, {:e}]\ndisturbance = {:e}\ndisturbance_rate = {:e}\nreference = {:e}\nreference_rate = {:e}\n",
            self.within(0.05, 2.0),
            self.within(20.0, 200.0),
            1.0 - spread,
            1.0 + spread,
            self.within(0.0, 8.0),
            self.within(0.8, 1.0),
            self.within(1.0, 1.2),
            self.within(0.0, 10.0),
            self.within(0.0, 60.0),
            self.within(0.0, 40.0),
            self.within(0.0, 50.0),
        );
        let mut left = self.within(0.0, 4.0);
        while left > 1.0 {
            left -= 1.0;
            let (low, mut high) = (self.within(-2.0, 0.5), self.within(0.5, 3.0));
            // An estimate that does not move.
            if self.within(0.0, 1.0) < 0.2 {
                high = low;
            }
            let _ = write!(
                text,
                "[[regressor]]\ntheta_hat = [{low:e}, {high:e}]\ntheta = [{:e}, {:e}]\nmagnitude = {:e}\nrate = {:e}\n",
                self.within(low, 0.5),
                self.within(0.5, high.max(0.5)),
                self.within(0.0, 4.0),
                self.within(0.0, 10.0),
            );
        }
        // A slew rate that is met, or one that is not.
        if self.within(0.0, 1.0) < 0.5 {
            let slew = format!("slew = {:e}\nbeta = ", self.within(5.0, 70.0).powi(2));
            text = text.replacen("beta = ", &slew, 1);
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

fn examples() -> Vec<Proof> {
    ["gains_table2.toml", "gains_own.toml", "gains_refused.toml"]
        .map(|name| parse(&std::fs::read_to_string(example(name)).unwrap(), name).unwrap())
        .to_vec()
}

/// `gains_own.toml` with another limit of the command.
fn limited(command: &str) -> Proof {
    let own = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let limit = format!("command = {command}");
    parse(&own.replace("command = 60.0", &limit), "limited").unwrap()
}

#[test]
fn another_program_agrees_on_a_limit_that_may_be_met() {
    let (met, weak) = (limited("41.0"), limited("40.0"));
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
fn scaled(exact: &str, by: i32) -> String {
    let (mantissa, exponent) = exact.split_once("*2^").unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    format!("{mantissa}*2^{}", exponent + by)
}

/// A little off: the mantissa's last of 40 bits.
fn nudged(exact: &str, by: i128) -> String {
    let (mantissa, exponent) = exact.split_once("*2^").unwrap();
    let (mantissa, exponent): (i128, i32) = (mantissa.parse().unwrap(), exponent.parse().unwrap());
    let up = mantissa.leading_zeros() - (128 - 40).min(mantissa.leading_zeros());
    let mantissa = (mantissa << up) + by;
    #[allow(clippy::cast_possible_wrap)]
    let exponent = exponent - up as i32;
    format!("{mantissa}*2^{exponent}")
}

#[test]
fn each_inequality_with_a_number_changed_is_caught() {
    let good = examples().remove(1);
    let mut mutated = Vec::new();
    for i in 0..good.inequalities.len() {
        for by in [-1, 1] {
            let mut left = good.clone();
            left.inequalities[i].left.exact = scaled(&good.inequalities[i].left.exact, by);
            let mut right = good.clone();
            right.inequalities[i].right.exact = scaled(&good.inequalities[i].right.exact, by);
            mutated.extend([left, right]);
        }
        // Too favourable by a millionth of a millionth.
        let mut left = good.clone();
        left.inequalities[i].left.exact = nudged(&good.inequalities[i].left.exact, -(1 << 20));
        let mut right = good.clone();
        right.inequalities[i].right.exact = nudged(&good.inequalities[i].right.exact, 1 << 20);
        mutated.extend([left, right]);
    }
    for i in 0..good.at_the_limit.len() {
        for by in [-1, 1] {
            let mut left = good.clone();
            left.at_the_limit[i].left.exact = scaled(&good.at_the_limit[i].left.exact, by);
            mutated.push(left);
        }
    }
    let text = std::fs::read_to_string(example("gains_own.toml")).unwrap();
    let slewed = text.replace("command = 60.0", "slew = 500.0\ncommand = 60.0");
    let slewed = parse(&slewed, "slewed").unwrap();
    assert!(slewed.proved);
    for by in [-1, 1] {
        let (mut left, mut right) = (slewed.clone(), slewed.clone());
        let sides = |own: &mut Proof| own.slew.take().unwrap();
        let (mut a, mut b) = (sides(&mut left), sides(&mut right));
        a.left.exact = scaled(&a.left.exact, by);
        b.right.exact = scaled(&b.right.exact, by);
        (left.slew, right.slew) = (Some(a), Some(b));
        mutated.extend([left, right]);
    }
    // A smaller box than was proved, and a refusal that is called a proof.
    let mut smaller = good.clone();
    smaller.s.exact = scaled(&good.s.exact, -1);
    let mut refused = examples().remove(2);
    refused.proved = true;
    let mut claimed = examples().remove(2);
    claimed.proved = true;
    claimed.inequalities[1].holds = true;
    mutated.extend([smaller, refused, claimed]);
    let Some(said) = checked(&mutated) else {
        return;
    };
    for (i, line) in said.iter().enumerate() {
        assert!(
            !line.ends_with(": ok"),
            "mutation {i} was not caught: {line}"
        );
    }
}
