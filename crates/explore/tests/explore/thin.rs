//! Thinning keeps every peak.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use retune_explore::thin::{Spread, Thinning};

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    /// Of each quantity, the least and the largest value in every column of pixels stay, at their times, and no more than two rows for
    /// each quantity and the first and the last.
    #[test]
    fn invariant_every_peak_stays(
        rows in prop::collection::vec((0.0..1.0_f64, -1e3..1e3_f64, -1.0..1.0_f64), 1..600),
        columns in 1..50_usize,
    ) {
        let mut rows = rows;
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut thinning = Thinning::<2>::new([0.0, 1.0], columns);
        rows.iter().for_each(|(t, a, b)| thinning.push(*t, [*a, *b]));
        let thin = thinning.finish();
        prop_assert!(thin.t.windows(2).all(|pair| pair[0] <= pair[1]));
        let column = |t: f64| (t * columns as f64).floor() as i64;
        for at in 0..=columns as i64 {
            let all: Vec<_> = rows.iter().filter(|row| column(row.0) == at).collect();
            let kept: Vec<usize> = (0..thin.t.len()).filter(|i| column(thin.t[*i]) == at).collect();
            prop_assert!(kept.len() <= 6 && kept.is_empty() == all.is_empty());
            for quantity in 0..2 {
                let of = |row: &&(f64, f64, f64)| if quantity == 0 { row.1 } else { row.2 };
                let (least, largest) = all.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
                let own = kept.iter().map(|i| thin.columns[quantity][*i]);
                let found = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
                prop_assert_eq!(found, (least, largest));
            }
        }
        for (i, t) in thin.t.iter().enumerate() {
            prop_assert!(rows.contains(&(*t, thin.columns[0][i], thin.columns[1][i])));
        }
    }
}

#[test]
fn exact_a_spread_is_the_least_and_the_largest_of_each_column() {
    let mut spread = Spread::new([10.0, 20.0], 2);
    for (t, value) in [(10.0, 1.0), (12.0, 3.0), (14.9, 2.0), (15.0, 7.0), (20.0, 5.0)] {
        spread.push(t, value);
    }
    assert_eq!(spread.ends, [[1.0, 3.0], [5.0, 7.0]]);
    assert_eq!([spread.at(0), spread.at(1)], [12.5, 17.5]);
}
