//! Products of columns, however they are kept.

use super::*;

#[test]
fn products_are_the_same_prepared_or_not_and_grown_or_not() {
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
    let mut prepared = whole.clone();
    prepared.prepare(&[3, 79]);
    for half in [&[0, 2][..], &[3]] {
        for (column, count) in [(0, 80), (3, 80), (3, 2), (41, 60), (79, 80)] {
            let direct: Vec<f64> = (0..count).map(|j| whole.sum_at(half, column, j)).collect();
            assert_eq!(whole.sum_of_row(half, column, count), direct);
            assert_eq!(prepared.sum_of_row(half, column, count), direct);
            assert_eq!(grown.sum_of_row(half, column, count), direct);
        }
        for (place, &column) in kept.iter().enumerate() {
            assert_eq!(
                some.sum_at(half, place, 5),
                whole.sum_at(half, column, kept[5])
            );
        }
    }
    assert_eq!((whole.whole, whole.scale), (grown.whole, grown.scale));
    some.extend(&all[..kept.len() + 1], &rows, &blocks);
    assert_eq!(some.size(), kept.len() + 1);
}
