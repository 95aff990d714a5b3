//! Counting motions: stretches whose answer is known.

use crate::common::{SSVI, scene};
use retune_dynamics::attractor::{distinct, motions, separation};
use retune_dynamics::poincare::Periods;
use retune_dynamics::record::coordinates;
use retune_dynamics::{Parameter, continuation, resumed};
use retune_solver::Settings;

fn states(count: usize, of: impl Fn(usize) -> f64) -> Vec<[f64; 4]> {
    (0..count).map(|i| [of(i), 0.0, 0.0, 1.0]).collect()
}

fn logistic(r: f64, start: f64, count: usize) -> Vec<[f64; 4]> {
    let mut x = start;
    let next = |_| {
        x = r * x * (1.0 - x);
        [x, 0.0, 0.0, 0.0]
    };
    (0..count).map(next).collect()
}

#[test]
fn exact_separation_of_points() {
    let (a, b) = (states(2, |_| 0.0), states(2, |i| 3.0 * i as f64));
    assert_eq!(separation(&a, &b), 1.5, "half of b lies 3 from a, all of a lies on b");
    assert_eq!(separation(&a, &a), 0.0);
}

#[test]
fn contract_a_periodic_motion_met_at_another_phase_is_the_same_motion() {
    let one = states(60, |i| (i % 3) as f64);
    let later = states(60, |i| ((i + 1) % 3) as f64);
    assert!(!distinct(&one, &later));
    assert!(distinct(&one, &states(60, |i| (i % 2) as f64)), "a period of two is another");
}

#[test]
fn contract_fixed_points_are_distinct_from_a_hundredth_of_their_size() {
    let at = |x: f64| states(20, |_| x);
    assert!(!distinct(&at(0.0), &at(0.009)) && distinct(&at(0.0), &at(0.011)));
}

#[test]
fn contract_chaos_is_one_motion_from_any_start_and_not_its_unstable_fixed_point() {
    let [one, other] = [0.3, 0.7123].map(|start| logistic(4.0, start, 400));
    assert!(!distinct(&one, &other));
    let fixed = vec![[0.75, 0.0, 0.0, 0.0]; 400];
    assert!(distinct(&one, &fixed));
}

/// The larger stretch still converges to the smaller.
#[test]
fn contract_a_motion_that_still_drifts_is_not_a_second_one() {
    let settling = states(100, |i| (-0.02 * i as f64).exp());
    assert!(!distinct(&settling, &states(100, |_| 0.0)));
}

#[test]
fn contract_motions_are_counted_once_each() {
    let [a, b] = [0.0, 1.0].map(|x| states(20, |_| x));
    assert_eq!(motions(&[&a, &b, &a]), [0, 1, 0]);
    assert_eq!(motions(&[&a, &a, &b]), [0, 0, 2]);
    assert!(motions(&[]).is_empty());
}

/// The last state of a sweep continues as the same motion.
#[test]
fn contract_resumed_motions_continue() {
    let scene = scene(3.95e4, 7.4, Some(SSVI));
    let sweep = |values: &[f64], settle| {
        continuation(
            &scene,
            Parameter::Omega,
            values,
            Periods { settle, record: 2 },
            &Settings::default(),
            || (),
        )
        .expect("a sweep")
    };
    let last = sweep(&[7.4], 300)[0].samples[1];
    let again = resumed(&scene, last).expect("a damper");
    assert_eq!((again.t, again.y), (0.0, last));
    let [a, b] = [sweep(&[7.4], 400)[0].samples[0], last].map(|y| coordinates(&scene, &y));
    assert!(!distinct(&[a, a], &[b, b]));
}

/// A sweep stays on its branch beyond the frequency where a start from rest leads to another: at k1 = 2.00e4 N/m and ω = 4.079
/// rad/s the damper strikes one wall in the upward sweep, and both from rest.
#[test]
fn regress_a_sweep_carries_its_motion_on() {
    let soft = scene(2.00e4, 4.079, Some(SSVI));
    let periods = Periods { settle: 300, record: 50 };
    let sweep = |values: &[f64]| {
        let orbits = continuation(&soft, Parameter::Omega, values, periods, &Settings::default(), || ());
        orbits.expect("a sweep").pop().expect("an orbit")
    };
    let (rest, up) = (sweep(&[4.079]), sweep(&[4.0, 4.02, 4.04, 4.05, 4.06, 4.07, 4.079]));
    let [here, there] = [&rest, &up]
        .map(|orbit| orbit.samples.iter().map(|y| coordinates(&soft, y)).collect::<Vec<[f64; 4]>>());
    assert!(distinct(&here, &there));
    assert_eq!((rest.impacts[1] > 0, up.impacts[1]), (true, 0), "{:?} {:?}", rest.impacts, up.impacts);
}
