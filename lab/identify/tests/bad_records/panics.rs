//! No bytes make the reader panic.

use super::*;
use bowden_lab::record::{parse, Options};
use proptest::prelude::*;

/// What a reader owes its caller, whatever the bytes were.
fn holds(bytes: &[u8], options: &Options) {
    match parse(bytes, "r.csv", options) {
        Ok(record) => {
            assert!(record.samples() >= 200 && record.time[0] == 0.0);
            assert!(record.time.windows(2).all(|pair| pair[1] > pair[0]));
            let ends = [&record.input, &record.output];
            for column in ends.into_iter().chain(&record.channels) {
                assert_eq!(column.values.len(), record.samples());
                assert!(column.values.iter().all(|value| value.is_finite()));
            }
        }
        Err(error) => {
            let line = error.to_string();
            let is_one_line = !line.contains(char::is_control);
            assert!(line.starts_with("r.csv:") && is_one_line, "{line:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        holds(&bytes, &Options::default());
    }

    #[test]
    fn no_text_makes_the_reader_panic(
        text in "(t|x|f|tau_i|[-+0-9.eE,;\t\r\n\"\\[\\] ]|\\PC){0,200}",
    ) {
        holds(text.as_bytes(), &Options::default());
        let options = with(|o| o.rate = Some(1.0));
        holds(format!("t,x,f\n{text}").as_bytes(), &options);
    }

    #[test]
    fn no_json_makes_the_reader_panic(
        text in "[\\[{]([tx\"]|\"t\":|\"x\":|null|NaN|[-0-9.e,:{}\\[\\] \n]){0,120}",
    ) {
        holds(text.as_bytes(), &Options::default());
        let own = rows().join("],[");
        holds(format!("[[\"t\",\"x\",\"f\"],[{own}],{text}").as_bytes(), &Options::default());
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        damage in proptest::collection::vec(
            (any::<prop::sample::Index>(), any::<u8>(), 0..3_usize), 1..6),
        skip in -1.0..5.0_f64,
    ) {
        let mut bytes = fine::plain().into_bytes();
        for (at, byte, kind) in damage {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        holds(&bytes, &with(|o| o.skip = skip));
    }

    #[test]
    fn no_gaps_make_the_reader_panic(
        cells in proptest::collection::vec(
            (0..700_i32, any::<Option<i8>>(), any::<Option<i8>>(), 0..12_u8), 300..700),
        order in 0..3_usize,
        drop_bad in any::<bool>(),
        skip in -1.0..2.0_f64,
    ) {
        let mut cells = cells;
        match order {
            0 => cells.sort_by_key(|(t, ..)| *t),
            1 => cells.sort_by_key(|(t, x, ..)| (x.is_none(), *t)),
            _ => {}
        }
        let cell = |own: Option<i8>| own.map_or_else(String::new, |own| own.to_string());
        let row = |(t, x, f, kind): (i32, Option<i8>, Option<i8>, u8)| match kind {
            0 => "t,x,f".to_owned(),
            1 => format!("# {t}"),
            2 => format!("{t},{},{}", cell(x), cell(f)),
            _ if x.is_some() => format!("{t},{},", cell(x)),
            _ => format!("{t},,{}", cell(f)),
        };
        let rows: Vec<String> = cells.into_iter().map(row).collect();
        let skip = skip.max(0.0);
        let options = Options { drop_bad, skip, ..Options::default() };
        holds(csv("t,x,f", &rows).as_bytes(), &options);
        let options = Options { segment: Some(1), ..options };
        holds(csv("t,x,f", &rows).as_bytes(), &options);
    }

    #[test]
    fn no_numbers_make_the_reader_panic(
        values in proptest::collection::vec((any::<f64>(), any::<f64>(), any::<f64>()), 200..210),
        rate in any::<f64>(),
    ) {
        let rows: Vec<_> = values.iter().map(|(t, x, f)| format!("{t},{x},{f}")).collect();
        holds(csv("t,x,f", &rows).as_bytes(), &Options::default());
        let mild = |(t, x, f): &(f64, f64, f64)| format!("{t},{},{}", x % 1e150, f % 1e150);
        let rows: Vec<_> = values.iter().map(mild).collect();
        let options = with(|o| o.rate = Some(rate));
        holds(csv("t,x,f", &rows).as_bytes(), &options);
    }
}
