//! Another output of the same records, on the same grids.

use super::blind::bridged;
use super::build::Grid;
use super::uniform::{usual_step, Uniform};
use super::{filtered, Prepared, ZeroPhase};
use crate::record::{Column, Record};

impl Prepared {
    /// The `target` for an output of each record with these values, one per sample.
    ///
    /// Equivalent to preparing the records again with their input, their cut-off and this output,
    /// but without repeating the common steps.
    ///
    /// # Errors
    /// A message if these are not the records that were prepared.
    pub(crate) fn answered(
        &self,
        records: &[Record],
        outputs: Vec<Vec<f64>>,
    ) -> Result<Vec<f64>, String> {
        let steps: Vec<f64> = records.iter().map(|r| usual_step(&r.time)).collect();
        let step = steps.iter().copied().fold(f64::INFINITY, f64::min);
        let thinning = Grid::new(step, self.cutoff).thinning;
        let smoother = ZeroPhase::new(2.5 * self.cutoff, 1.0 / step);
        let mut on_work = Vec::with_capacity(self.output.len());
        let all = records.iter().zip(steps).zip(outputs).zip(&self.pieces);
        for (((record, own), values), piece) in all {
            let uniform = Uniform::new(&record.time, own, step)?;
            let output = Column {
                values,
                name: record.output.name.clone(),
                unit: None,
                definition: None,
            };
            let smoothed = smoother.apply(&uniform.signal(&bridged(record, &output)));
            let thinned = smoothed.iter().step_by(thinning).copied();
            on_work.extend(thinned.take(piece.work.len()));
        }
        if on_work.len() != self.output.len() {
            return Err(
                "the model's output cannot be resampled to the time grid of the record".to_owned(),
            );
        }
        Ok(filtered(
            &self.smoother,
            &self.pieces,
            self.stride,
            &on_work,
        ))
    }
}

#[cfg(test)]
mod tests {
    use crate::problem::{HeldOut, Preparation, Prepared};
    use crate::record::{parse, Options, Record};
    use std::f64::consts::TAU;
    use std::fmt::Write as _;

    /// 40 s at a rate, with a sensor that is stuck for two seconds, and a gap.
    fn record(rate: f64, gain: f64) -> Record {
        let mut text = "t [s],x [mm],f [N]\n".to_owned();
        for i in 0..(40.0 * rate) as usize {
            let t = i as f64 / rate;
            let at = if (20.0..22.0).contains(&t) { 20.0 } else { t };
            let x = 9.0 * (TAU * 0.7 * t).sin() + 2.0 * (TAU * 0.31 * t).sin();
            if !(30.0..30.5).contains(&t) {
                let _ = writeln!(text, "{t},{x},{}", gain * (TAU * 0.7 * at + 0.4).sin() + at);
            }
        }
        parse(text.as_bytes(), "made.csv", &Options::default()).unwrap()
    }

    #[test]
    fn another_output_lies_where_preparing_its_record_anew_puts_it() {
        let records = [record(200.0, 3.0), record(125.0, 4.0)];
        assert!(records.iter().all(|r| r.defects.len() > 1), "stuck and gap");
        for (records, held_out) in [
            (&records[..1], HeldOut::Trailing),
            (&records[..], HeldOut::LastRecord),
        ] {
            let data = Prepared::joined(records, Preparation::default(), held_out).unwrap();
            let mut others = records.to_vec();
            for (k, own) in others.iter_mut().enumerate() {
                let squared = |y: &mut f64| *y = *y * *y + k as f64;
                own.output.values.iter_mut().for_each(squared);
            }
            let cutoff = Some(data.cutoff);
            let anew = Prepared::joined(&others, Preparation { cutoff }, held_out).unwrap();
            let outputs = others.into_iter().map(|r| r.output.values).collect();
            assert_eq!(data.answered(records, outputs), Ok(anew.target));
        }
        assert!(Prepared::new(&records[0], Preparation::default())
            .unwrap()
            .answered(&[], Vec::new())
            .is_err());
    }
}
