//! The text of the commands on a terminal, at 80 and at 120 columns.

use crate::shell::{example, has, said, Folder};
use bowden_cli::view::{certificates, compare, design, plan_text, power_text, proof};
use bowden_cli::view::{text, Report, Width};
use bowden_lab::facts::{
    close, plan, Answer, Asked, Close as Question, Facts, Plan, PowerFacts, PowerRow,
};
use bowden_synth::stored_csv;
use bowden_trials::facts as trials;
use std::sync::OnceLock;

/// What the built-in record gives, found once.
fn facts() -> &'static Facts {
    static FACTS: OnceLock<Facts> = OnceLock::new();
    FACTS.get_or_init(|| {
        let (asked, csv) = (Asked::default(), stored_csv());
        let record = asked.read_text(csv.as_bytes(), "built-in record");
        let question = Question::new(asked);
        close(&[record.unwrap()], &question, &|_| ()).unwrap().facts
    })
}

fn identified(width: Width, verbose: bool) -> String {
    let report = Report {
        width,
        verbose,
        chosen_cutoff: false,
    };
    text(facts(), report)
}

/// Prose of more than 100 columns is hard to read, however wide the terminal is.
fn assert_fits(text: &str, columns: u16) {
    let widest = text.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(widest <= usize::from(columns).min(100), "{widest}\n{text}");
    assert!(columns < 80 || text.lines().count() <= 25, "{text}");
}

/// Compares the text with its golden file, and its size with the terminal.
fn golden(command: &str, print: impl Fn(Width) -> String) {
    for columns in [80, 120] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden");
        let path = format!("{folder}/{command}-{columns}.txt");
        let text = print(Width::of(columns));
        let text = anstream::adapter::strip_str(&text).to_string();
        assert_fits(&text, columns);
        if std::env::var_os("BOWDEN_WRITE_PAGES").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        assert_eq!(
            text,
            std::fs::read_to_string(&path).unwrap(),
            "if this is meant: BOWDEN_WRITE_PAGES=1 cargo test -p bowden-cli --test cli layout"
        );
    }
}

#[test]
fn the_text_of_identify_is_the_golden_one() {
    golden("identify", |width| identified(width, false));
    for columns in [60, 100] {
        let text = identified(Width::of(columns), false);
        assert_fits(&anstream::adapter::strip_str(&text).to_string(), columns);
    }
    assert!(identified(Width::of(80), true).contains("blocks improved"));
}

/// A cable whose output never falls while its input rises, so that a bound is proved.
const SOFT: &str = include_str!("shell/soft.toml");

fn designed(model: &str, delay: f64) -> trials::Designed {
    let question = trials::DesignQuestion {
        rate: 1000.0,
        delay,
        noise: 0.0,
        drive_gain: 1.0,
    };
    trials::design(model, "model.toml", &question).unwrap()
}

#[test]
fn the_text_of_design_is_the_golden_one() {
    let soft = designed(SOFT, 0.0001);
    golden("design", |width| design::text(&soft, width, false));
    // After a reversal its output falls, and no bound exists.
    let steep = SOFT
        .replace("rho = 0.2", "rho = 0.4")
        .replace("sigma = 0.6", "sigma = 3.0");
    let units = "[about.units]\ninput = \"N·m\"\noutput = \"N·m\"\n";
    let steep = designed(&format!("{steep}{units}"), 0.006);
    golden("design-steep", |width| design::text(&steep, width, false));
    for line in ["required: gain margin 2", "admissible: k_p below"] {
        assert!(design::text(&soft, Width::of(80), true).contains(line));
    }
}

fn compared(question: &trials::Question<'_>) -> trials::Compared {
    trials::compare(&trials::Question {
        seconds: 8.0,
        ..question.clone()
    })
    .unwrap()
}

#[test]
fn the_text_of_compare_is_the_golden_one() {
    let paper = compared(&trials::Question {
        seeds: 2,
        ..trials::Question::default()
    });
    golden("compare", |width| compare::text(&paper, width, false));
    let [plain, verbose] = [false, true].map(|all| compare::text(&paper, Width::of(80), all));
    let best = "Smallest error without a plant model: matched-pi";
    has(&plain, &["pi-observer (uses a plant model)", best]);
    has(&verbose, &["Transient"]);

    let folder = Folder::new();
    let file = designed(SOFT, 0.006).gains.toml().unwrap();
    let [model, gains] = [("model.toml", SOFT), ("gains.toml", &file)]
        .map(|(name, text)| std::path::PathBuf::from(folder.file(name, text)));
    let own = compared(&trials::Question {
        seeds: 1,
        setup: Some(&model),
        gains: Some(&gains),
        ..trials::Question::default()
    });
    golden("compare-own", |width| compare::text(&own, width, false));
}

#[test]
fn the_text_of_certify_is_the_golden_one() {
    let all = trials::certify(None).unwrap();
    let print = |width, verbose| certificates::text(&all, None, width, verbose);
    golden("certify", |width| print(width, false));
    assert!(print(Width::of(80), true).contains("no dynamics between u and y"));
    for name in ["own", "refused"] {
        let path = example(&format!("gains_{name}.toml"));
        let proved = trials::prove(path.as_ref()).unwrap();
        let print = |width, verbose| proof::text(&proved, "gains.toml", width, verbose);
        golden(&format!("certify-{name}"), |width| print(width, false));
        assert!(print(Width::of(80), true).contains("no dynamics between u and y"));
    }
}

/// One effect of the table.
fn planted(name: &str, answer: Answer) -> PowerRow {
    PowerRow {
        family: "family",
        effect: "effect",
        name: name.to_owned(),
        channel: "phi_p".to_owned(),
        shapes: Vec::new(),
        gain_unit: Some("N·m·s/rad".to_owned()),
        answer,
    }
}

#[test]
fn the_text_of_power_is_the_golden_one() {
    let found = (1..=14_u8).map(|k| {
        let amplitude = 0.004 * f64::from(k);
        let answer = Answer::Found {
            amplitude,
            gain: 3.0 * amplitude,
            times: 10,
            screened: amplitude,
        };
        planted(&format!("effect-number-{k}@phi_p"), answer)
    });
    let others = [
        planted("creep@phi_d", Answer::NotFound { tried: 0.3 }),
        planted("offset", Answer::NotExcited),
        planted("stiffness-linear", Answer::NotExcited),
        planted("viscous@phi_p", Answer::InModel),
    ];
    let power = PowerFacts {
        label: "record.csv".to_owned(),
        record: facts().record.clone(),
        model: ["bouc-wen", "viscous@phi_p"].map(str::to_owned).into(),
        trials: 10,
        named_without: 1,
        rows: found.chain(others).collect(),
    };
    golden("power", |width| power_text(&power, width, false));
    assert!(power_text(&power, Width::of(80), true).contains("effect-number-1@phi_p"));
}

#[test]
fn the_text_of_plan_is_the_golden_one() {
    let made = said("generate --mode displacement --seed 1 --effect stiffness-cubic:0.6");
    let asked = Asked::default();
    let record = asked.read_text(made.as_bytes(), "record.csv").unwrap();
    let planned = plan(&[record], &asked, &|_| ()).unwrap();
    golden("plan", |width| plan_text("record.csv", &planned, width));
    let none = Plan {
        planned: None,
        undescribed: None,
        inseparable: vec!["presliding from backlash".to_owned()],
        together: vec![["phi_p", "phi_d"].map(str::to_owned)],
        unidentified: ["sigma", "n"].map(str::to_owned).into(),
    };
    golden("plan-none", |width| plan_text("record.csv", &none, width));
}

#[test]
fn the_readme_shows_lines_and_pictures_of_it() {
    let readme = include_str!("../../../../README.md");
    let (_, block) = readme.split_once("```text\nbowden identify").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    let text = identified(Width::of(80), false);
    let text = anstream::adapter::strip_str(&text).to_string();
    let lines = block.lines().skip(1);
    let shown = lines.filter(|line| !line.trim().is_empty() && line.trim() != "…");
    let shown: Vec<&str> = shown.collect();
    assert!(shown.len() >= 5, "{block}");
    for line in shown {
        assert!(text.lines().any(|own| own == line), "not printed: {line}");
    }
    // `bowden identify --plot docs/pictures/NAME.svg --figure NAME` draws them.
    let folder = Folder::new();
    for figure in ["loop", "residual"] {
        let drawn = folder.path("drawn.svg");
        said(&format!("identify --figure {figure} --plot {drawn}"));
        let kept = example(&format!("../../docs/pictures/{figure}.svg"));
        let kept = std::fs::read_to_string(kept).unwrap();
        assert_eq!(folder.read("drawn.svg"), kept, "{figure}");
    }
}
