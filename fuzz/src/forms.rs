//! The TOML forms: the model file and the setup of `compare`.

use bowden_lab::compare::setup::Setup;
use bowden_lab::export::ModelFile;

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
    let Ok(read) = toml::from_str::<ModelFile>(text) else {
        return;
    };
    let written = read
        .toml("written")
        .expect("a model that was read is written");
    let again: ModelFile = toml::from_str(&written).expect("what was written is read");
    // By text, for NaN differs from itself.
    assert_eq!(format!("{read:?}"), format!("{again:?}"));
    assert_eq!(again.toml("written").expect("written again"), written);
    let _ = read.rust("written");
    if let Err(refusal) = read.model::<8>() {
        assert!(!refusal.is_empty());
    }
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
