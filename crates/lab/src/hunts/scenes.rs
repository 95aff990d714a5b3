//! Random scenes for the comparison with DOP853, drawn as in the tests of the solver.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use retune_model::Scene;
use retune_testkit::anything::{Anything, DRAWS};

/// `count` scenes with dampers, with parameters over 6, 10.5 and 15 orders of magnitude about the paper's.
pub fn drawn(count: usize) -> Vec<Scene> {
    let config = ProptestConfig { rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() };
    let mut runner = TestRunner::new(config);
    let any = prop::collection::vec(0.0..=1.0_f64, DRAWS);
    let mut scene = |width: f64| {
        let all = any.new_tree(&mut runner).expect("numbers can always be drawn").current();
        let mut draws: [f64; DRAWS] = std::array::from_fn(|i| all[i]);
        draws[..16].iter_mut().for_each(|draw| *draw = 0.5 + width * (*draw - 0.5));
        draws[26] = 0.9; // with a damper
        Anything::new(&draws).scene
    };
    let widths = [0.4, 0.7, 1.0].into_iter().flat_map(|width| std::iter::repeat_n(width, count / 3));
    widths.map(&mut scene).collect()
}
