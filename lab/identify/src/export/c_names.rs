//! C identifiers from the names of files and channels.

use std::collections::BTreeSet;

/// Prefixes with which the header would have names that `bowden.h` has itself.
const TAKEN: [&str; 2] = ["bowden", "bowden_model"];

/// The prefix of all names in the C header with this file name (without its ending).
///
/// Several file names may have one prefix (`rig-1`, `rig_1`, `RIG 1`); two such headers with
/// different contents in one program cause a compiler error.
///
/// # Errors
/// A message if the name contains no Latin or Greek letter, or if the names would be those of the
/// library.
pub fn prefix(name: &str) -> Result<String, String> {
    let own = signs(name).to_lowercase();
    if !own.contains(|c: char| c.is_ascii_alphabetic()) {
        return Err(
            "C names are derived from this name, so it must contain a letter from a to z or a Greek letter, as in rig or rig_1"
                .to_owned(),
        );
    }
    let prefix = match own.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("model_{own}"),
        false => own,
    };
    if TAKEN.contains(&prefix.as_str()) {
        return Err(
            "the library uses this name, so names derived from it would be defined twice; choose another name"
                .to_owned(),
        );
    }
    Ok(prefix)
}

/// The names of the channels in macros, each another one; that of a name without any sign that
/// C has is its place.
pub(super) fn macros(channels: &[String]) -> Vec<String> {
    let upper: Vec<String> = channels.iter().map(|n| signs(n).to_uppercase()).collect();
    // No `CHANNEL_S`, which is easily read as `CHANNELS`.
    let mut taken = BTreeSet::from(["S".to_owned()]);
    taken.extend(upper.iter().cloned());
    let mut names = Vec::new();
    for (index, own) in upper.iter().enumerate() {
        let is_nameless = own.is_empty();
        let mut own = match is_nameless {
            true => index.to_string(),
            false => own.clone(),
        };
        // The first channel of a name has it; what the others become is nobody's name.
        if is_nameless || own == "S" || upper.iter().position(|other| *other == own) != Some(index)
        {
            while !taken.insert(own.clone()) {
                own = format!("{own}_{index}");
            }
        }
        names.push(own);
    }
    names
}

/// The characters of a name that are valid in C, with `_` instead of the others, but not at the
/// start: in C, macros that begin with `_` are reserved. Greek letters are spelt out; `µ` becomes
/// u, as in `um`.
fn signs(name: &str) -> String {
    let mut kept = String::new();
    for sign in name.chars() {
        match (sign.is_ascii_alphanumeric(), spelt(sign)) {
            (true, _) => kept.push(sign),
            (false, Some(letters)) => kept.push_str(letters),
            (false, None) => kept.push('_'),
        }
    }
    let own = kept.trim_start_matches('_');
    match own.contains(|c: char| c.is_ascii_alphanumeric()) {
        true => own.to_owned(),
        false => String::new(),
    }
}

/// A Greek letter in Latin ones.
fn spelt(sign: char) -> Option<&'static str> {
    Some(match sign {
        // The micro sign, and the letter that many keyboards and programs put in its place.
        '\u{b5}' | '\u{3bc}' => "u",
        'α' | 'Α' => "alpha",
        'β' | 'Β' => "beta",
        'γ' | 'Γ' => "gamma",
        'δ' | 'Δ' | '\u{2206}' => "delta",
        'ε' | 'ϵ' | 'Ε' => "epsilon",
        'ζ' | 'Ζ' => "zeta",
        'η' | 'Η' => "eta",
        'θ' | 'ϑ' | 'Θ' => "theta",
        'ι' | 'Ι' => "iota",
        'κ' | 'Κ' => "kappa",
        'λ' | 'Λ' => "lambda",
        'Μ' => "mu",
        'ν' | 'Ν' => "nu",
        'ξ' | 'Ξ' => "xi",
        'ο' | 'Ο' => "omicron",
        'π' | 'Π' => "pi",
        'ρ' | 'Ρ' => "rho",
        'σ' | 'ς' | 'Σ' => "sigma",
        'τ' | 'Τ' => "tau",
        'υ' | 'Υ' => "upsilon",
        'φ' | 'ϕ' | 'Φ' => "phi",
        'χ' | 'Χ' => "chi",
        'ψ' | 'Ψ' => "psi",
        'ω' | 'Ω' | '\u{2126}' => "omega",
        _ => return None,
    })
}
