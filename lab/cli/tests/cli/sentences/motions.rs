//! One sound rig, moved in the ways in which rigs are moved, by a load cell that does what load cells do.

use crate::sentences::files::{noise, Rows};
use crate::shell::{bowden, Folder};

/// Forty seconds of a spring with a hysteresis of that size [N]; `zero` is what the cell adds.
fn moved(hysteresis: f64, x: impl Fn(f64) -> f64, zero: impl Fn(f64) -> f64) -> Rows {
    let (rate, mut z, mut before) = (500.0, 0.0, x(0.0));
    let rows = (0..20_000).map(|i| {
        let t = i as f64 / rate;
        for k in 1..=10 {
            let now = x(t - (10 - k) as f64 / (10.0 * rate));
            let dx = now - before;
            z += 0.9 * (dx - 0.8 * dx.abs() * z - 0.2 * dx * z.abs());
            before = now;
        }
        let force = 2.0 * x(t) + hysteresis * z + zero(t);
        vec![t, x(t), force + 0.01 * noise(i)]
    });
    Rows {
        header: "t,x [mm],f [N]".to_owned(),
        rows: rows.collect(),
    }
}

fn tones(t: f64) -> f64 {
    3.0 * (2.5 * t).sin() + 1.6 * (0.9 * t + 0.4).sin() + 0.5 * (6.1 * t).sin()
}

/// A corner and the filter in front of the hysteresis do not commute: what is rounded looks like a lag.
#[test]
fn a_sound_rig_that_is_moved_by_a_triangle_lacks_nothing() {
    for (period, rounded) in [(10.0, 0.04), (4.0, 0.0)] {
        let triangle = |t: f64| {
            let straight = |t: f64| 20.0 * ((t / period).rem_euclid(1.0) - 0.5).abs() - 5.0;
            // The drive takes some time to turn back.
            let parts = (-10..=10).map(|k| straight(t + rounded * f64::from(k) / 20.0));
            parts.sum::<f64>() / 21.0
        };
        let closed = moved(4.0, triangle, |_| 0.0).close(&[]);
        assert!(closed.names().is_empty(), "{}", closed.sentence());
        assert_eq!(closed.verdict(), "explained", "{}", closed.sentence());
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_cell_that_warms_up_is_asked_about_where_creep_is_named() {
    // A noisier cell: where less is left than this, the record tells the drift from a creep.
    let noisy = |t: f64| 0.04 * noise(7_000_000 + (500.0 * t) as usize);
    let warms = |t: f64| 0.8 * (1.0 - (-t / 10.0).exp()) + noisy(t);
    let closed = moved(4.0, tones, warms).close(&[]);
    assert_eq!(
        closed.names().first(),
        Some(&"creep"),
        "{}",
        closed.sentence()
    );
    closed.says(&["Is this a drift of `f`", "warms up"]);
}

/// The clamp has slipped by 0.8 N of the spring, and stays so.
#[test]
fn a_model_of_a_rig_that_has_slipped_is_that_of_the_rig_after_it_and_tells_when_that_changes() {
    let folder = Folder::new();
    let slips = |t: f64| if t > 13.0 { 0.8 } else { 0.0 };
    let record = moved(4.0, tones, slips).write(&folder, "slips.csv");
    let model = folder.path("model.toml");
    let closed = bowden(&["identify", &record, "--model-out", &model]);
    assert!(closed.status.success(), "{closed:?}");
    let text = std::fs::read_to_string(&model).unwrap();
    let table: toml::Table = toml::from_str(&text).unwrap();
    let number = |name: &str| table["transmission"][name].as_float().unwrap();
    // Both are known to a few parts in ten thousand without the slip.
    assert!((number("gain") - 2.0).abs() < 0.01, "{text}");
    assert!((number("offset") - 0.8).abs() < 0.02, "{text}");
    for (hysteresis, verdict) in [(4.0, "holds"), (4.8, "does-not-hold")] {
        let next = |t: f64| tones(t + 50.0);
        let next = moved(hysteresis, next, |_| 0.8).write(&folder, "next.csv");
        let said = bowden(&["validate", &model, &next, "--json"]).stdout;
        let check: serde_json::Value = serde_json::from_slice(&said).unwrap();
        assert_eq!(check["verdict"], verdict, "{}", check["summary"]);
    }
}
