//! Settings in C: each struct starts from its macro, and no constructor takes floats that can be
//! exchanged.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

#[allow(dead_code)]
mod compiler;
mod objects;

use bowden::*;
use compiler::{compiler, first_of, library, root, said, scratch, FLAGS, HOST_LIBRARIES};
use objects::blank;
use std::ffi::CStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::ptr::null_mut;

const C: [&str; 3] = ["cc", "gcc", "clang"];
const CPP: [&str; 3] = ["c++", "g++", "clang++"];

fn header() -> String {
    std::fs::read_to_string(root().join("include/bowden.h")).unwrap()
}

/// The code and the text of a refusal.
fn refusal(mut init: impl FnMut(*mut bowden_about) -> bowden_result) -> (bowden_result, String) {
    let mut about = blank::<bowden_about>();
    let code = init(&mut about);
    let text = unsafe { CStr::from_ptr(about.text.as_ptr()) };
    (code, text.to_str().unwrap().to_owned())
}

macro_rules! refused {
    ($object:ident, $f:ident, $init:expr) => {
        pastey::paste! {{
            let init: unsafe fn(
                *mut [<bowden_ $object _ $f>],
                *const [<bowden_ $object _settings_ $f>],
                *mut bowden_about,
            ) -> bowden_result = $init;
            let name = concat!("bowden_", stringify!($object), "_settings_", stringify!($f), "_init");
            let macro_name = name.to_uppercase();
            for byte in [0x00, 0xa5] {
                let mut settings = blank::<[<bowden_ $object _settings_ $f>]>();
                unsafe { (&raw mut settings).write_bytes(byte, 1) };
                let mut object = blank::<[<bowden_ $object _ $f>]>();
                let told = refusal(|about| unsafe { init(&mut object, &settings, about) });
                let text =
                    format!("settings not started from {macro_name}: assign it first, then set the fields");
                assert_eq!(told, (bowden_result::ErrorSettings, text));
                assert!(object.opaque.iter().all(|word| *word == 0), "{name}");
            }
            // With the mark, what is still to be set is named: the macro itself is no setting.
            let settings = [<bowden_ $object _settings_ $f>]::defaults();
            let mut object = blank();
            let (code, text) = refusal(|about| unsafe { init(&mut object, &settings, about) });
            assert_ne!(code, bowden_result::Ok, "{name}");
            assert_ne!(code, bowden_result::ErrorSettings, "{name}");
            assert!(!text.is_empty() && !text.contains("INIT"), "{name}: {text}");
        }};
    };
}

#[test]
fn settings_that_did_not_start_from_their_macro_are_refused_with_its_name() {
    macro_rules! each {
        ($f:ident) => {
            pastey::paste! {
                refused!(pid, $f, |o, s, a| unsafe { [<bowden_pid_init_ $f>](o, s, a) });
                refused!(adaptive, $f, |o, s, a| unsafe { [<bowden_adaptive_init_ $f>](o, s, a) });
                refused!(observer, $f, |o, s, a| unsafe { [<bowden_observer_init_ $f>](o, s, a) });
                refused!(rates, $f, |o, s, a| unsafe { [<bowden_rates_init_ $f>](o, s, a) });
                refused!(biquad, $f, |o, s, a| unsafe { [<bowden_biquad_init_notch_ $f>](o, s, a) });
                refused!(biquad, $f, |o, s, a| unsafe { [<bowden_biquad_init_low_pass_ $f>](o, s, a) });
                refused!(edge_velocity, $f, |o, s, a| unsafe { [<bowden_edge_velocity_init_ $f>](o, s, a) });
                refused!(plausible, $f, |o, s, a| unsafe { [<bowden_plausible_init_ $f>](o, s, a) });
                refused!(relay, $f, |o, s, a| unsafe { [<bowden_relay_init_ $f>](o, s, a) });
                refused!(hysteresis, $f, |o, s, a| unsafe { [<bowden_hysteresis_init_ $f>](o, s, a) });
                refused!(cable, $f, |o, s, a| unsafe { [<bowden_cable_init_ $f>](o, s, a) });
                let mut arrays = [[0.0; 100]; 2];
                let [first, second] = arrays.each_mut().map(|array| array.as_mut_ptr());
                let settings = blank::<[<bowden_iterative_learning_settings_ $f>]>();
                let told = refusal(|about| unsafe {
                    [<bowden_iterative_learning_init_ $f>](&mut blank(), &settings, first, second, 100, about)
                });
                assert_eq!(told.0, bowden_result::ErrorSettings);
                assert!(told.1.contains(&stringify!([<bowden_iterative_learning_settings_ $f _init>]).to_uppercase()));
                let settings = blank();
                let told = refusal(|about| unsafe {
                    [<bowden_inverse_init_ $f>](&mut blank(), &settings, about)
                });
                assert_eq!(told.0, bowden_result::ErrorSettings);
            }
        };
    }
    each!(f32);
    each!(f64);
}

#[test]
fn a_running_loop_refuses_settings_that_did_not_start_from_their_macro() {
    let mut settings = bowden_pid_settings_f32::defaults();
    settings.k_p = 2.0;
    (settings.limits.low, settings.limits.high) = (0.0, 1.0);
    (settings.longest_dt, settings.fallback.after) = (0.005, 20);
    let (mut pid, zero) = (blank::<bowden_pid_f32>(), blank());
    unsafe {
        assert_eq!(
            bowden_pid_init_f32(&mut pid, &settings, null_mut()),
            bowden_result::Ok
        );
        let words = pid.opaque;
        let changed = bowden_pid_change_f32(&mut pid, &zero, null_mut());
        assert_eq!(changed, bowden_result::ErrorSettings);
        assert_eq!(pid.opaque, words);
    }
}

/// Builds a program in C99 or C++11 against the library.
fn built(test: &str, program: &str, standard: &str, text: &str) -> PathBuf {
    let extension = if standard.starts_with("c++") {
        "cpp"
    } else {
        "c"
    };
    let folder = scratch(test);
    let (source, built) = (
        folder.join(format!("{test}.{extension}")),
        folder.join(test),
    );
    std::fs::write(&source, text).unwrap();
    let mut command = Command::new(program);
    command.arg(format!("-std={standard}")).args(FLAGS);
    command
        .arg("-I")
        .arg(root().join("include"))
        .arg(source)
        .arg(library(None));
    said(command.args(HOST_LIBRARIES).arg("-o").arg(&built));
    built
}

/// The macro's numbers, which a program writes as bytes, are the library's defaults.
fn macros_are_the_defaults(test: &str, program: &str, standard: &str) {
    macro_rules! each {
        ($($name:ident)*) => {
            [$((
                stringify!($name),
                (|bytes: &[u8]| {
                    assert_eq!(bytes.len(), size_of::<$name>());
                    let there = unsafe { bytes.as_ptr().cast::<$name>().read_unaligned() };
                    assert_eq!(there, $name::defaults());
                }) as fn(&[u8]),
                size_of::<$name>(),
            )),*]
        };
    }
    let all = each!(
        bowden_pid_settings_f32 bowden_pid_settings_f64
        bowden_adaptive_settings_f32 bowden_adaptive_settings_f64
        bowden_estimator_f32 bowden_estimator_f64
        bowden_observer_settings_f32 bowden_observer_settings_f64
        bowden_iterative_learning_settings_f32 bowden_iterative_learning_settings_f64
        bowden_rates_settings_f32 bowden_rates_settings_f64
        bowden_biquad_settings_f32 bowden_biquad_settings_f64
        bowden_edge_velocity_settings_f32 bowden_edge_velocity_settings_f64
        bowden_plausible_settings_f32 bowden_plausible_settings_f64
        bowden_relay_settings_f32 bowden_relay_settings_f64
        bowden_hysteresis_settings_f32 bowden_hysteresis_settings_f64
        bowden_cable_settings_f32 bowden_cable_settings_f64
    );
    // None is missing here.
    assert_eq!(header().matches("uint32_t init_mark;").count(), all.len());
    let mut text = "#include \"bowden.h\"\n#include <stdio.h>\nint main(void) {\n".to_owned();
    for (name, ..) in &all {
        let upper = name.to_uppercase();
        text += &format!("    static const {name} own_{name} = {upper}_INIT;\n");
    }
    for (name, ..) in &all {
        text += &format!("    fwrite(&own_{name}, sizeof own_{name}, 1, stdout);\n");
    }
    text += "    return 0;\n}\n";
    let program = built(test, program, standard, &text);
    let written = Command::new(program).output().unwrap().stdout;
    let mut rest = &written[..];
    for (_, check, size) in all {
        let (own, behind) = rest.split_at(size);
        check(own);
        rest = behind;
    }
    assert!(rest.is_empty());
}

#[test]
fn the_macros_are_c99_and_have_the_librarys_defaults() {
    if let Some(cc) = first_of("the macros in C99", &C) {
        macros_are_the_defaults("macros_c99", cc, "c99");
    }
}

#[test]
fn the_macros_are_cpp11_and_have_the_librarys_defaults() {
    if let Some(cpp) = first_of("the macros in C++11", &CPP) {
        macros_are_the_defaults("macros_cpp11", cpp, "c++11");
    }
}

/// What a program in C forgets is refused with the field's name, not taken for zero.
#[test]
fn a_setting_that_has_no_default_is_refused_by_name_until_it_is_set() {
    let refused = |name: &str| (bowden_result::ErrorOutOfRange, name.to_owned());
    let no_choice = |name: &str| (bowden_result::ErrorChoice, name.to_owned());
    let well = (bowden_result::Ok, String::new());
    let mut cable = bowden_cable_settings_f32::defaults();
    (cable.rho, cable.sigma, cable.n) = (0.1, 0.6, 3.0);
    let try_cable = |settings: &bowden_cable_settings_f32| {
        refusal(|about| unsafe { bowden_cable_init_f32(&mut blank(), settings, about) })
    };
    assert_eq!(try_cable(&cable), refused("gain"));
    cable.gain = 1.0;
    assert_eq!(try_cable(&cable), refused("kappa_eta"));
    cable.kappa_eta = 0.0;
    assert_eq!(try_cable(&cable), no_choice("mode"));
    cable.mode = bowden_mode::Torque as u32;
    assert_eq!(try_cable(&cable), well);

    let mut observer = bowden_observer_settings_f64::defaults();
    (observer.gain, observer.natural_frequency) = (0.6, 25.0);
    (observer.time_constant, observer.limit) = (0.016, 30.0);
    observer.longest_dt = 0.005;
    let try_observer = |settings: &bowden_observer_settings_f64| {
        refusal(|about| unsafe { bowden_observer_init_f64(&mut blank(), settings, about) })
    };
    assert_eq!(try_observer(&observer), refused("damping_ratio"));
    observer.damping_ratio = 0.0;
    assert_eq!(try_observer(&observer), well);

    let mut learning = bowden_iterative_learning_settings_f32::defaults();
    (learning.gain, learning.limit) = (0.5, 12.0);
    let mut arrays = [[0.0_f32; 100]; 2];
    let [first, second] = arrays.each_mut().map(|array| array.as_mut_ptr());
    let try_learning = |settings: &bowden_iterative_learning_settings_f32| {
        refusal(|about| unsafe {
            bowden_iterative_learning_init_f32(&mut blank(), settings, first, second, 100, about)
        })
    };
    assert_eq!(try_learning(&learning), refused("lead"));
    learning.lead = 0;
    assert_eq!(try_learning(&learning), refused("half_width"));
    learning.half_width = 0;
    assert_eq!(try_learning(&learning), well);

    let mut law = bowden_adaptive_settings_f32::defaults();
    (law.longest_dt, law.fallback.after) = (0.005, 5);
    let try_law = |settings: &bowden_adaptive_settings_f32| {
        refusal(|about| unsafe { bowden_adaptive_init_f32(&mut blank(), settings, about) })
    };
    assert_eq!(try_law(&law), no_choice("form"));
    (law.form, law.step) = (bowden_form::FirstOrder as u32, 0.001);
    let empty = (bowden_result::ErrorInadmissible, "low < high".to_owned());
    // Neither end of the range is zero by default.
    law.limits.high = 60.0;
    assert_eq!(try_law(&law), empty);
    law.limits = bowden_adaptive_settings_f32::defaults().limits;
    law.limits.low = -20.0;
    assert_eq!(try_law(&law), empty);
    law.limits.high = 60.0;
    assert_eq!(try_law(&law), refused("plant_gain"));
    law.plant_gain = 1.0;
    law.epsilon = 0.1;
    assert_eq!(try_law(&law), well);

    // An estimate by name would not adapt, and its box would end at zero.
    let mut unmarked = blank::<bowden_estimator_f32>();
    (unmarked.initial, unmarked.high) = (1.0, 3.0);
    let text =
        "settings not started from BOWDEN_ESTIMATOR_F32_INIT: assign it first, then set the fields";
    let told = (bowden_result::ErrorSettings, text.to_owned());
    law.theta[0] = unmarked;
    assert_eq!(try_law(&law), well); // The law has no regressor: it does not read theta.
    law.regressors = 1;
    assert_eq!(try_law(&law), told);
    law.theta[0] = bowden_estimator_f32::defaults();
    assert_eq!(try_law(&law), well);
    for beta in [true, false] {
        let mut other = law;
        let place = if beta {
            &mut other.beta
        } else {
            &mut other.delta
        };
        *place = unmarked;
        assert_eq!(try_law(&other), told);
    }
}

/// What is not the struct may be shorter than it: behind its first word nothing is read.
#[cfg(unix)]
#[test]
fn the_mark_is_read_before_the_other_fields() {
    let Some(cc) = first_of("settings at the end of memory", &C) else {
        return;
    };
    let text = include_str!("c_program/mark_first.c");
    let lines = said(&mut Command::new(built("mark_first", cc, "c99", text)));
    let mut wanted = String::new();
    for object in [
        "pid",
        "adaptive",
        "observer",
        "rates",
        "edge_velocity",
        "plausible",
        "relay",
        "hysteresis",
        "cable",
    ] {
        wanted += &format!("{object} -10 -10\n");
    }
    assert_eq!(lines, wanted + "learning -10\n");
}

/// C fills what is not named with zero: full set-point weight would become none.
#[test]
fn a_designated_initialiser_without_the_macro_is_refused_in_c() {
    let Some(cc) = first_of("a designated initialiser", &C) else {
        return;
    };
    let program = built(
        "designated",
        cc,
        "c99",
        include_str!("c_program/designated.c"),
    );
    let lines = said(&mut Command::new(program));
    let text = "settings not started from BOWDEN_PID_SETTINGS_F32_INIT: assign it first, then set the fields";
    assert_eq!(lines, format!("-10 {text}\n0 \n"));
}

/// The prototypes of the header, each on a line.
fn prototypes(header: &str) -> Vec<String> {
    let mut all = Vec::new();
    for (at, _) in header.match_indices("\nbowden_result ") {
        let text = header[at..].split_once(';').unwrap().0;
        all.push(text.split_whitespace().collect::<Vec<_>>().join(" "));
    }
    all
}

/// Two floats of different meaning next to each other can be exchanged without a warning.
#[test]
fn no_constructor_takes_more_than_one_float() {
    let header = header();
    let constructors: Vec<String> = prototypes(&header)
        .into_iter()
        .filter(|text| {
            ["_init_f", "_load_f", "_set_", "_resume_f"]
                .iter()
                .any(|part| text.contains(part))
        })
        .collect();
    assert!(constructors.len() > 24, "{}", constructors.len());
    for text in constructors {
        let parameters = text.split_once('(').unwrap().1;
        let floats = parameters
            .split(',')
            .filter(|one| {
                let one = one.trim_start();
                !one.contains('*') && (one.starts_with("float ") || one.starts_with("double "))
            })
            .count();
        assert!(floats <= 1, "{text}");
    }
}

/// The call that exchanged period and longest gap without a word.
#[test]
fn rates_are_not_started_from_numbers_in_c() {
    let Some(cc) = first_of("rates from numbers", &C) else {
        return;
    };
    let folder = scratch("rates_from_numbers");
    let compiles = |name: &str, call: &str| {
        let source: &Path = &folder.join(name);
        let text = format!(
            "#include \"bowden.h\"\nint main(void) {{ bowden_rates_f32 r; bowden_about a;\n\
             bowden_rates_settings_f32 s = BOWDEN_RATES_SETTINGS_F32_INIT; (void)s; (void)r; (void)a;\n\
             return {call}; }}\n"
        );
        std::fs::write(source, text).unwrap();
        let mut command = compiler(cc);
        command.arg("-fsyntax-only").arg(source);
        command.output().unwrap().status.success()
    };
    assert!(compiles("settings.c", "bowden_rates_init_f32(&r, &s, &a)"));
    assert!(!compiles(
        "numbers.c",
        "bowden_rates_init_f32(&r, 0.008f, 16384.0f, 0.0f, &a)"
    ));
}
