//! Sentences about terms that the record cannot separate.

use std::collections::HashSet;

/// "presliding from backlash, delay" for each name with its alternatives. Each pair appears once,
/// whichever of the two was named, and however often.
#[must_use]
pub fn each_pair_once(named: impl IntoIterator<Item = (String, Vec<String>)>) -> Vec<String> {
    let mut told = HashSet::new();
    let words = named.into_iter().filter_map(|(own, mut rivals)| {
        rivals.retain(|rival| {
            let mut pair = [own.clone(), rival.clone()];
            pair.sort();
            told.insert(pair)
        });
        (!rivals.is_empty()).then(|| format!("{own} from {}", rivals.join(", ")))
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::each_pair_once;

    fn named(all: &[(&str, &[&str])]) -> Vec<(String, Vec<String>)> {
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        let all = all.iter();
        all.map(|(own, rivals)| ((*own).to_owned(), owned(rivals)))
            .collect()
    }

    #[test]
    fn a_pair_stands_once_in_either_order_and_other_rivals_stay() {
        let all = named(&[
            ("backlash", &["presliding"]),
            ("presliding", &["backlash", "delay"]),
            ("presliding", &["backlash"]),
            ("delay", &["lag", "presliding"]),
        ]);
        assert_eq!(
            each_pair_once(all),
            [
                "backlash from presliding",
                "presliding from delay",
                "delay from lag"
            ]
        );
        assert!(each_pair_once(named(&[])).is_empty());
    }
}
