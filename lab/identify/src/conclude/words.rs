//! The sentences of the findings, in one table.

use super::errors::percent;
use super::finding::Finding;
use super::numbers::{number, with_interval};
use crate::alteration::{Alteration, Suspicion};
use crate::ledger::{CoarseChannel, FileApart};
use crate::scale::PART;
use crate::score::explains::Explained;
use crate::score::ranges::Outside;

impl Finding {
    /// The finding in a sentence or two.
    #[must_use]
    #[allow(clippy::too_many_lines)] // A table: an arm for each finding.
    pub fn words(&self) -> String {
        match self {
            // The reasons why there is no model.
            Self::OutputIntegrates { input, output, may_creep } => {
                let swap = match may_creep {
                    false => "they are in the wrong order".to_owned(),
                    true => format!("`{input}` is the force and `{output}` is the motion (a spring in series with a dashpot creeps under a constant force)"),
                };
                format!("The output is the integral of the input: the rate of `{output}`, not its value, follows `{input}`. The program did not search for terms. Differentiate `{output}` first, or swap the columns if {swap}.")
            }
            Self::FilesScaled { files, of, unit } => scaled(files, *of, unit.as_deref()),
            Self::LoggedDifferently(suspicion) => suspected(suspicion),
            Self::RowsShuffled { input, output } => format!("No model can be identified from this record. Neighbouring rows of the input `{input}` are unrelated, but `{output}` follows `{input}` row by row. Are the rows in time order?"),
            Self::InputAtRest { input } => format!("No model can be identified from this record, because the input `{input}` is at rest and shows only sensor noise. Record a motion."),
            Self::ChannelTakesOver { input, explains, channels, alone } => format!(
                "This is not a model of the transmission. In the final model {}, although in the baseline model the input explains {}. One of the channels repeats the output, as an angle downstream of a spring does. Omit its column.",
                explained(input, *explains, *channels),
                share(*alone)
            ),
            Self::NothingExplained { input, explains, channels } => format!(
                "No model can be identified from this record: {}. Is `{input}` the right input in the right file, and is its sensor connected?",
                explained(input, *explains, *channels)
            ),
            // The reasons why the model must not be used on other data.
            Self::RigChanged { fit, held_out, since, output, terms } => {
                let since = since.map(|t| format!(" (after {t:.3} s)")).unwrap_or_default();
                let added = match terms.as_slice() {
                    [] => String::new(),
                    terms => format!(" The search added {}.", terms.join(", then ")),
                };
                format!(
                    "The model does not transfer. Its error is {} of the output's standard deviation on the fit segment and {} on the held-out segment{since}. Do not use this model on other data. Has the rig or the sensor of `{output}` changed between the two segments?{added}",
                    percent(*fit),
                    percent(*held_out),
                )
            }
            Self::HeldOutFileScaled { path, gain, offset, unit, error } => format!(
                "With a gain of {gain:.4} and an offset of {offset:.4}{}, the error on {path} is {:.2} %. Does a sensor have a different unit, sign or zero in that file? `--per-file gains` fits the gains of each file separately.",
                spaced(unit.as_deref()),
                100.0 * error,
            ),
            Self::HeldOutFileDiffers => {
                "Use `--per-file gains` to find out whether only the gains differ in the held-out file.".to_owned()
            }
            Self::WorseThanConstant { before, after } => format!(
                "On the held-out segment, the model is worse than a constant. Its error changes {}. Do not use this model on other data.",
                from_to((*before, *after))
            ),
            Self::HeldOutRises { ratio, before, after, terms, falls_up_to } => {
                let mut text = format!(
                    "The held-out error rises by a factor of {ratio:.1}, {}. Do not use this model on other data.",
                    from_to((*before, *after))
                );
                if !terms.is_empty() {
                    text += &format!(" The search added {}.", terms.join(", then "));
                    text += &match *falls_up_to {
                        0 => " The first term already raises the error.".to_owned(),
                        n if n < terms.len() => format!(" The error falls up to and including {}, but {} raises it.", terms[n - 1], terms[n]),
                        _ => " Only the final fit, which uses more data, raises the error.".to_owned(),
                    };
                }
                text
            }
            // The residual.
            Self::ResidualIsNoise => "The residual is sensor noise.".to_owned(),
            Self::HeldOutAboveNoise { held_out } => format!("The residual is sensor noise on the fit segment, but {held_out:.1} times this noise on the held-out segment. The two segments differ."),
            Self::ResidualAboveNoise { floors, is_white, terms } => {
                let size = match floors {
                    Some([fit, held_out]) => format!("The residual is {fit:.1} times the noise floor on the fit segment and {held_out:.1} times on the held-out segment"),
                    None => "The noise floor of the record is unknown, because the cut-off frequency is too close to half the sampling rate".to_owned(),
                };
                let colour = match (is_white, terms) {
                    (None, _) => "",
                    (Some(true), _) => ". The residual is white and depends on no measured quantity",
                    // The first sentence already says that no effect was found.
                    (Some(false), 0) => ". The residual is coloured",
                    (Some(false), _) => ". The residual is coloured, but no further effect in the catalogue explains it",
                };
                format!("{size}{colour}.")
            }
            Self::NoNameForCurve { variable, by_effects } => {
                // A reader who sees "95 %" asks why no effect is named: the refit and test decide.
                let but = match *by_effects >= 1.0 - PART {
                    true => ", but all of them are rejected after a refit",
                    false => "",
                };
                format!(
                    "The residual depends on {variable}. To first order, the best one or two effects in the catalogue explain {:.0} % of the squared error that a curve explains{but}.",
                    100.0 * by_effects
                )
            }
            Self::TermsConfounded { pairs } => {
                format!("This record cannot distinguish {}.", pairs.join(", or "))
            }
            Self::TooFewBlocks { terms } => {
                let names = match terms {
                    0 => "so only a large effect would be found",
                    _ => "so the named terms are only candidates",
                };
                format!("The record has too few independent blocks for a test, {names}.")
            }
            Self::PoorModel { error } => {
                format!("The model is poor: its error is {} of the output's standard deviation.", percent(*error))
            }
            // About the record.
            Self::DefectiveMeasurement { defects } => {
                let all = defects.iter();
                let all = all.map(|d| format!("{} ({})", d.channel, d.kind.name()));
                let all: Vec<String> = all.collect();
                format!("The measurement is defective: {}. Correct the cause and record again.", all.join(", "))
            }
            Self::OneStroke { input } => format!("`{input}` reverses fewer than two times on the fit segment. Therefore sigma and n are not identified, and the model holds only for this stroke. Record strokes in both directions."),
            Self::InputIsVelocity { input } => format!("Is `{input}` a velocity? The input must be a displacement. Use the position as the input, or integrate this column."),
            Self::Extrapolation(Outside { channel, unit, seen, here, .. }) => {
                let unit = spaced(unit.as_deref());
                let ends = |[low, high]: [f64; 2]| format!("{} to {}", four_digits(low), four_digits(high));
                format!(
                    "`{channel}` covers {}{unit} on the fit segment, but {}{unit} on the held-out segment. The held-out error is therefore an extrapolation error.",
                    ends(*seen),
                    ends(*here)
                )
            }
            Self::MotionUnseen { input } => format!("The motion of `{input}` during the gap is unknown, but affects the hysteresis after the gap."),
            Self::FilesOfSeveralRigs { together, own } => format!(
                "These files do not seem to come from one rig. On the fit segments, one model for all files has an error of {:.1} % of the output's standard deviation. With separate gains for each file, the error is {:.1} %. `--per-file gains` fits separate gains.",
                100.0 * together,
                100.0 * own
            ),
            Self::ZeroDiffers { path, may_fit_gains } => {
                let gains = match may_fit_gains {
                    true => " `--per-file gains` fits an offset for each file.",
                    false => "",
                };
                format!("The preload changes abruptly at the start of `{path}`. Does a sensor have a different zero in this file?{gains}")
            }
            Self::CoarseSensor { channel, unit } => coarse(channel, unit.as_deref()),
            Self::OutputLeads { seconds } => format!("In the model, the output leads the input by about {:.1} ms, which is not causal. Were both signals logged with the same clock? If so, the model lacks an effect that produces a phase lead.", 1e3 * seconds),
            Self::SegmentsDiffer { fit, held_out } => match fit > held_out {
                true => format!("The output moves {:.0} times as much on the fit segment as on the held-out segment, so the percentages of the two segments are not comparable.", fit / held_out),
                false => format!("The output moves {:.0} times as much on the held-out segment as on the fit segment, so the percentages of the two segments are not comparable.", held_out / fit),
            },
            // About the model.
            Self::PreslidingIsBacklash { sign_tells } => {
                let own = match sign_tells {
                    true => ". With the same sign as kappa_x, the term is a slipping spring. With the opposite sign, it is slack",
                    false => "",
                };
                format!("Presliding and backlash are the same function with opposite signs, so either name is correct{own}.")
            }
            Self::CreepStartsOutside { output } => format!("The fitted initial state of the creep is at its bound, outside the range of the input. Is this a drift of `{output}`, for example of a sensor that warms up? To find out, record again after the rig has run for longer."),
            Self::HysteresisLeftOut => "The model excludes the baseline hysteresis, because this record cannot distinguish it from a spring and an offset.".to_owned(),
            Self::HysteresisCancelled { share } => format!(
                "On this record, the hysteresis differs from a spring and an offset by only {} of the output. The gains of these three parts nearly cancel, so the model holds only within the recorded range.",
                percent(*share)
            ),
            Self::TonesOfMotion { terms } => format!("The frequency of {} is a sum, a difference or a multiple of the motion's frequencies. Missing friction can cause such spectral lines without an external disturbance.", terms.join(", ")),
            Self::FrictionWithTension => "The effect `position-hysteresis` on the torque is eta times the torque, so the friction of the cable grows with its tension, as described by the capstan equation.".to_owned(),
            Self::FrictionWithTemperature { channel } => format!("The effect `position-hysteresis` on `{channel}` is eta times `{channel}`, so the friction changes with the temperature."),
            Self::OutputFalls { input, output } => format!("`{output}` falls while `{input}` rises. One of the two signs is probably reversed. `bowden design` rejects the model until you correct the sign."),
            Self::LoopReversed { kappa_eta, terms } => format!("The fitted hysteresis loop is traversed in the opposite direction to the measured loop (kappa_eta {kappa_eta:.3}). Its gain and the effect of {} partly cancel, so neither is a property of the rig by itself.", terms.join(", ")),
            Self::ChannelRepeatsOutput { channel } => format!("Nearly all of the model's output comes from `{channel}`, although the baseline model does not need this channel. Does `{channel}` measure the output, as an angle downstream of a spring does? If so, omit its column."),
            Self::LoadFollowsChannel { channel, input } => format!("Nearly all of the model's output comes from `{channel}` and none from `{input}`. In this record, the load follows `{channel}`, so the model describes only this load. Record again with a different load, or name the transmission's terms in --baseline."),
            Self::SearchStopped { seconds: Some(seconds), .. } => format!("The search stopped after {seconds} s, as requested. This is the best model so far, and further terms may be missing."),
            Self::SearchStopped { terms: None | Some(0), .. } => "The program did not search for terms, as requested.".to_owned(),
            Self::SearchStopped { terms: Some(1), .. } => "The search stopped after one term, as requested. Further terms may be missing.".to_owned(),
            Self::SearchStopped { terms: Some(most), .. } => format!("The search stopped after {most} terms, as requested. Further terms may be missing."),
            Self::RoundRaises { term, after: 0 } => format!("On held-out data, the first term, {term}, already raises the error."),
            Self::RoundRaises { term, after } => format!("On held-out data, the error falls up to and including term {after}, but {term} raises it."),
            Self::FileWorse { path, before, after } => format!("The error rises for {path}: {:.1} % → {:.1} %.", 100.0 * before, 100.0 * after),
            Self::ManyTerms { .. } => "Terms after the third have little physical meaning, because several effects would fit equally well.".to_owned(),
            // Of a validation.
            Self::ErrorAsExpected { error, own } => format!("The model holds: its error is {} of this record's output, compared with {} on the held-out part of its own record. Nothing was refitted.", percent(*error), percent(*own)),
            Self::ErrorAsExpectedInUnit { rmse: [here, own], unit, error, holds } => {
                let unit = spaced(unit.as_deref());
                let amount = |rmse: f64| number(rmse, Some(0.05 * rmse));
                let verdict = match holds {
                    true => "The model holds",
                    false => "This record is inconclusive",
                };
                let advice = match holds {
                    true => "",
                    false => " Record a larger motion.",
                };
                format!("{verdict}: its error is {}{unit}, compared with {}{unit} on the held-out part of its own record. The output moves less in this record, so this error is {} of its standard deviation.{advice}", amount(*here), amount(*own), percent(*error))
            }
            Self::ErrorIsNoise { error } => format!("The model holds: its error, {} of this record's output, is sensor noise. Nothing was refitted.", percent(*error)),
            Self::ErrorTooLarge { error, own, with_line } => {
                let own = own.map_or_else(
                    || ". The model file does not contain the error on its own record".to_owned(),
                    |own| format!(", compared with {} on the held-out part of its own record", percent(own)),
                );
                format!("The model does not hold: its error is {} of this record's output{own}. With a different gain and offset, the error is {}.", percent(*error), percent(*with_line))
            }
            Self::ErrorAtLimit { error, limit } => format!("This record is inconclusive: the error is {} of its output, and the limit is {}. Use a record with the same motion as the model's own record.", percent(*error), percent(*limit)),
            Self::ErrorWithoutLimit { error } => format!("This record is inconclusive: the error is {} of its output and exceeds the noise, and the model file contains no error for comparison.", percent(*error)),
            Self::OutputAtNoise => "The output moves by little more than the noise. Record a larger motion.".to_owned(),
            Self::LineChanged { gain, offset, unit, error, limit } => {
                let offset = format!("{}{}", number(*offset, Some(0.05 * offset.abs())), spaced(unit.as_deref()));
                let what = match gain {
                    None => format!("The offset has changed by {offset}"),
                    Some(gain) => format!("The gain has changed by a factor of {} (and the offset by {offset})", with_interval(gain.value, gain.ci95)),
                };
                format!("{what}. With this correction the error is {}, and the limit is {}.", percent(*error), percent(*limit))
            }
            Self::OutputUnitDiffers { output } => format!("Does `{output}` have a different unit or calibration in this record?"),
            Self::ModelInexact { own } => format!("The model had an error of {} on its own record. On another motion, such a model may have a larger error, even if the rig is the same.", percent(*own)),
            Self::ModelNotTransferable => "The verdict of the model file is `not-transferable`. Do not use the model on another record.".to_owned(),
            Self::ResidualDependsOn { variable: None, .. } => "The residual depends on no measured quantity, as far as this record shows.".to_owned(),
            Self::ResidualDependsOn { variable: Some(variable), is_tested } => {
                let proposal = match is_tested {
                    true => "",
                    false => " (tentative: too few independent blocks for a test)",
                };
                format!("The residual depends on {variable}{proposal}.")
            }
            Self::RangesExceeded { ranges } => {
                let ranges: Vec<String> = ranges.iter().map(|one| format!("the {} of {}", one.quantity, one.channel)).collect();
                format!("The record exceeds the range of the model in {}. The model extrapolates there.", ranges.join(", "))
            }
            Self::InputContributesLittle { input, share } => format!("The model hardly depends on `{input}`, which contributes only {} of this record's output. This validation would hardly show a change in that part of the transmission.", percent(*share)),
        }
    }
}

impl Finding {
    /// What to check before anything else, if the finding questions the data themselves.
    #[must_use]
    pub fn headline(&self) -> Option<String> {
        Some(match self {
            Self::OutputIntegrates { input, output, .. } => {
                format!("CHECK THE COLUMNS: {output} is the integral of {input}")
            }
            Self::FilesScaled { files, .. } => {
                format!(
                    "CHECK {}: its output has a different gain",
                    files.first()?.path
                )
            }
            Self::LoggedDifferently(suspicion) => {
                let place = suspicion.path.as_deref().unwrap_or("THE COLUMNS");
                let asked = question(&suspicion.alteration).replace('`', "");
                format!(
                    "CHECK {place}: {}{}?",
                    asked[..1].to_lowercase(),
                    &asked[1..]
                )
            }
            Self::RowsShuffled { .. } => "CHECK THE ROWS: are they in time order?".to_owned(),
            Self::InputIsVelocity { input } => format!("CHECK THE COLUMNS: is {input} a velocity?"),
            Self::FilesOfSeveralRigs { .. } => "CHECK THE FILES: are they from one rig?".to_owned(),
            _ => return None,
        })
    }
}

/// The unit after a number.
pub(super) fn spaced(unit: Option<&str>) -> String {
    unit.map_or_else(String::new, |unit| format!(" {unit}"))
}

/// A number with four digits.
pub(super) fn four_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// "from 2.23 % to 0.14 % of the output's standard deviation", as on the line of errors.
pub(super) fn from_to((before, after): (f64, f64)) -> String {
    format!(
        "from {} to {} of the output's standard deviation",
        percent(before),
        percent(after)
    )
}

/// A fraction of the output's variance: "63 %", "0.4 %", "0 %".
fn share(share: f64) -> String {
    let digits = if (0.001..0.1).contains(&share) { 1 } else { 0 };
    format!("{:.digits$} %", 100.0 * share)
}

/// The fractions explained by the input, the other channels and functions of time, in one clause.
fn explained(input: &str, explains: Explained, channels: usize) -> String {
    let own = format!(
        "the input `{input}` explains {} of the held-out output",
        share(explains.input)
    );
    let more = [
        (channels > 0).then_some((explains.channels, "the other channels explain")),
        Some((explains.time, "functions of time explain")),
    ];
    let more = more.into_iter().flatten().filter(|more| more.0 >= 0.005);
    let more = more.map(|(explained, who)| format!("{who} {}", share(explained)));
    let all: Vec<String> = std::iter::once(own).chain(more).collect();
    match &all[..] {
        [first, second] => format!("{first}, and {second}"),
        [first, second, third] => format!("{first}, {second}, and {third}"),
        all => all.concat(),
    }
}

/// Files with a different gain.
fn scaled(files: &[FileApart], of: usize, unit: Option<&str>) -> String {
    let Some((first, others)) = files.split_first() else {
        return String::new();
    };
    let where_it_is = match of {
        2 => "in one of the two files",
        _ => "in that file",
    };
    let asked = match first.gain < 0.0 {
        true => format!("Does a sensor have the opposite sign {where_it_is}?"),
        false => format!(
            "Does a sensor have a different unit or calibration {where_it_is}, or is this a different rig?"
        ),
    };
    let also = match others {
        [] => String::new(),
        [second] => format!(
            " In `{}` the gain is {}.",
            second.path,
            four_digits(second.gain)
        ),
        more => format!(" {} more files have a different gain.", more.len()),
    };
    format!(
        "No single model describes these files. In `{}` the output is {} times the output that the gains of `{}` give, plus an offset of {}{}. The error is {:.1} % of the output's standard deviation with this correction, and {:.0} % without it.{also} {asked} Correct the file, or fit the gains of each file with `--per-file gains`.",
        first.path,
        four_digits(first.gain),
        first.than,
        four_digits(first.offset),
        spaced(unit),
        100.0 * first.after,
        100.0 * first.before
    )
}

/// The question about an alteration, without its question mark.
fn question(alteration: &Alteration) -> String {
    match alteration {
        Alteration::Reversed { column } => format!("Does `{column}` have the opposite sign"),
        Alteration::Scaled { column, .. } => format!("Does `{column}` have a different unit"),
        Alteration::Swapped { column, other } => format!("Are `{column}` and `{other}` swapped"),
        Alteration::Late { .. } => {
            "Is the output delayed or logged with a different clock".to_owned()
        }
    }
}

/// A record that may have been logged differently.
fn suspected(suspicion: &Suspicion) -> String {
    let Suspicion {
        alteration,
        path,
        terms,
        before,
        after,
    } = suspicion;
    let place = path
        .as_ref()
        .map_or_else(String::new, |path| format!(" in `{path}`"));
    let undone = match alteration {
        Alteration::Reversed { .. } => "With its sign reversed".to_owned(),
        Alteration::Scaled { factor, .. } => {
            let degrees = match (50.0..60.0).contains(factor) {
                true => " (degrees instead of radians?)",
                false => "",
            };
            format!(
                "With its values divided by {}{degrees}",
                four_digits(*factor)
            )
        }
        Alteration::Swapped { .. } => "With the two columns swapped".to_owned(),
        Alteration::Late { seconds } => {
            let direction = if *seconds > 0.0 { "earlier" } else { "later" };
            format!(
                "With the output {} ms {direction}",
                four_digits(1e3 * seconds.abs())
            )
        }
    };
    let found = match terms.as_slice() {
        [] => String::new(),
        terms => format!(" the search finds {} and", terms.join(", then ")),
    };
    format!(
        "{}{place}? {undone},{found} the error is {} of the output's standard deviation instead of {}.",
        question(alteration),
        percent(*after),
        percent(*before)
    )
}

/// A channel whose resolution matters.
fn coarse(one: &CoarseChannel, unit: Option<&str>) -> String {
    let names = match one.names.as_slice() {
        [] => String::new(),
        names => format!(" ({})", names.join(", ")),
    };
    format!(
        "`{}` has a resolution of {}{}, 1/{} of its range, and its quantisation steps account for much of the residual. Terms that depend on its velocity or its reversals{names} are uncertain.",
        one.channel,
        four_digits(one.step),
        spaced(unit),
        one.counts
    )
}
