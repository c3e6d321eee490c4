//! The TOML forms: the model file, by the core and by the lab, and the setup of `compare`.

use bowden::model::Model;
use bowden_lab::export::ModelFile;
use bowden_trials::setup::Setup;

const TERMS: usize = 8;

/// Whatever the text: what is read, written and read again is the same; what is refused is
/// refused in one line that names the file.
pub fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    model(text);
    setup(text);
}

fn model(text: &str) {
    let core = toml::from_str::<Model<f64, TERMS>>(text).ok();
    if let Some(model) = &core {
        let written = toml::to_string(model).expect("a model that was read is written");
        let again = toml::from_str::<Model<f64, TERMS>>(&written);
        assert!(again.as_ref() == Ok(model), "{written}");
        let file: ModelFile = toml::from_str(&written).expect("the lab reads what the core writes");
        assert!(file.model::<TERMS>().as_ref() == Ok(model), "{written}");
    }
    let Ok(read) = toml::from_str::<ModelFile>(text) else {
        return;
    };
    let written = read.toml().expect("a model that was read is written");
    let again: ModelFile = toml::from_str(&written).expect("what was written is read");
    // By text, for NaN differs from itself.
    assert_eq!(format!("{read:?}"), format!("{again:?}"));
    assert_eq!(again.toml().expect("written again"), written);
    let _ = read.rust();
    match read.model::<TERMS>() {
        Err(refusal) => assert!(!refusal.is_empty() && core.is_none()),
        // One format: what the lab reads the core reads, to the same model.
        Ok(model) if is_strict(&read) => assert!(core.as_ref() == Some(&model), "{text}"),
        Ok(_) => {}
    }
}

/// What the core checks and the lab's own reader leaves to it.
fn is_strict(file: &ModelFile) -> bool {
    let names = &file.channels;
    let is_new = |(k, name): (usize, &String)| !names[..k].contains(name);
    file.schema == "bowden.model/1"
        && matches!(file.mode.as_str(), "torque" | "displacement")
        && names.len() <= 256
        && names.iter().enumerate().all(is_new)
}

fn setup(text: &str) {
    match Setup::parse(text, "setup.toml") {
        Ok(read) => {
            let written = toml::to_string(&read).expect("a setup that was read is written");
            let again = Setup::parse(&written, "again.toml").expect("what was written is read");
            assert_eq!(format!("{read:?}"), format!("{again:?}"));
        }
        Err(refusal) => {
            assert!(refusal.starts_with("setup.toml:"), "{refusal:?}");
            assert!(!refusal.contains('\n'), "{refusal:?}");
        }
    }
}
