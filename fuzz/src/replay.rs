//! The seeds, replayed: what fuzzing has found stays found, on any toolchain.

use std::path::Path;

fn replay(target: &str, check: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("seeds")
        .join(target);
    let mut seeds = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        check(&std::fs::read(entry.unwrap().path()).unwrap());
        seeds += 1;
    }
    assert!(seeds > 0, "{} holds no seed", folder.display());
}

macro_rules! replayed {
    ($($target:ident)+) => {$(
        #[test]
        fn $target() {
            replay(stringify!($target), crate::$target::check);
        }
    )+};
}

replayed!(pid adaptive compensator hysteresis model inverse record forms constructors states);
