//! Products of columns, however they are kept.

use super::*;

#[test]
fn products_are_the_same_grown_or_not() {
    let column = |k: usize| (0..48).map(move |i| ((i * (k + 3) + k) % 17) as f64 - 7.5);
    let all: Vec<Arc<Stretch>> = (0..80).map(|k| Arc::new(column(k).collect())).collect();
    let rows: Vec<usize> = (0..48).collect();
    let blocks: Vec<Range<usize>> = (0..4).map(|b| 12 * b..12 * (b + 1)).collect();
    let whole = Grams::new(&all, &rows, &blocks);
    let mut grown = Grams::new(&all[..10], &rows, &blocks);
    grown.extend(&all[..70], &rows, &blocks);
    grown.extend(&all, &rows, &blocks);
    let kept: Vec<usize> = (0..80).filter(|k| k % 7 != 3).collect();
    let mut some = whole.only(&kept);
    for (part, own) in whole.parts.iter().zip(&some.parts) {
        for (i, &column) in kept.iter().enumerate() {
            for (j, &other) in kept.iter().enumerate().take(i + 1) {
                assert_eq!(own[place(i, j)], part[place(column, other)]);
            }
        }
    }
    assert_eq!(whole.parts, grown.parts);
    assert_eq!((whole.whole, whole.scale), (grown.whole, grown.scale));
    some.extend(&all[..kept.len() + 1], &rows, &blocks);
    assert_eq!(some.size(), kept.len() + 1);
}
