//! The periodic motion to which a run converges, and the distance of the run from it many periods later.
//!
//! Near a periodic motion the map from one period to the next is linear: it multiplies the remaining transient by the monodromy matrix `M`.
//! So Newton's iteration finds the motion from a state close to it, and a power of `M` gives the transient that will be left. Both neglect
//! the square of the present transient, and `M`, from finite differences, is accurate only to about the root of the tolerance. Both are
//! therefore checked: the iteration continues with the same matrix until the state converges; a period that was followed gives the error of
//! the linear prediction; and the motion is taken as stable only if the power of `M` shrinks every difference.
//!
//! `retune-dynamics` solves the same equation for orbits that may be unstable, along a parameter, with exact derivatives over several
//! segments (`periodic::shooting`). Inside a run that costs more than it saves: here one matrix serves all iterations, and none is made where
//! the motion is not stable.

use nalgebra::{Matrix4, Vector4};

/// Limit on iterations after the first.
const ITERATIONS: usize = 4;
/// Largest ratio of the changes in successive iterations, and largest norm of the power of `M`.
const SHRINKS: f64 = 0.1;
/// What may be neglected, as a share of the tolerance.
pub const NEGLECTED: f64 = 0.1;

/// A periodic motion, and a run that converges to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// State of the periodic motion.
    pub state: [f64; 4],
    /// The difference of the run from it after the requested number of maps.
    pub left: [f64; 4],
    /// The number of further maps after which that difference can be neglected, at most the second of [`LimitOptions::counts`].
    pub more: u32,
}

/// What [`limit`] is to predict, and how accurately.
pub struct LimitOptions<F: Fn(&[f64; 4]) -> f64> {
    /// The number of maps after which the state is predicted, and the most for which the run is then followed.
    pub counts: [u32; 2],
    /// The size of a change of the state, relative to that of the motion.
    pub share: F,
    /// Tolerance on such shares.
    pub tolerance: f64,
    /// Changes of each component as large as the motion.
    pub scales: [f64; 4],
}

/// The stable fixed point to which iterates of `map` converge from `now`; `None` if it, or the transient that will be left, cannot be
/// determined. Takes six maps and one more for each iteration after the first.
pub fn limit(
    mut map: impl FnMut([f64; 4]) -> Option<[f64; 4]>,
    now: [f64; 4],
    options: &LimitOptions<impl Fn(&[f64; 4]) -> f64>,
) -> Option<Limit> {
    let LimitOptions { counts: [count, most], tolerance, scales, .. } = options;
    let share = |change: Vector4<f64>| (options.share)(&change.into());
    let may_be_neglected = |change: Vector4<f64>| share(change) <= NEGLECTED * tolerance;
    let after = Vector4::from(map(now)?);
    let mut monodromy = Matrix4::zeros();
    for (i, scale) in scales.iter().enumerate() {
        let (mut perturbed, step) = (now, tolerance.sqrt() * scale);
        perturbed[i] += step;
        monodromy.set_column(i, &((Vector4::from(map(perturbed)?) - after) / step));
    }
    let power = monodromy.pow(count.saturating_sub(1));
    let units = Matrix4::from_diagonal(&Vector4::from(*scales));
    let size = (units.try_inverse()? * power * monodromy * units).norm();
    if size.is_nan() || size > SHRINKS {
        return None;
    }
    let equations = (Matrix4::identity() - monodromy).lu();
    let now = Vector4::from(now);
    let mut change = equations.solve(&(after - now))?;
    let mut state = now + change;
    for _ in 0..ITERATIONS {
        let gap = Vector4::from(map(state.into())?) - state;
        let next = equations.solve(&gap).filter(|next| share(*next) <= SHRINKS * share(change))?;
        state += next;
        change = next;
        if may_be_neglected(change) {
            let prediction_error = after - state - monodromy * (now - state);
            let left = power * monodromy * (now - state);
            let (mut later, mut more) = (left, 0);
            while more < *most && !may_be_neglected(later) {
                later = monodromy * later;
                more += 1;
            }
            let is_accurate = may_be_neglected(power * prediction_error * f64::from(*count));
            return is_accurate.then(|| Limit { state: state.into(), left: left.into(), more });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map with the fixed point `(1, -2, 3, 0.5)`, a matrix of these multipliers (the second pair a rotation), and some curvature.
    fn map(multipliers: [f64; 3], curvature: f64) -> impl Fn([f64; 4]) -> [f64; 4] {
        move |y| {
            let [a, b, c, d]: [f64; 4] = std::array::from_fn(|i| y[i] - FIXED[i]);
            let [one, two, turned] = multipliers;
            let curved = curvature * (a * a + c * d);
            [
                1.0 + one * a + 0.3 * b + curved,
                two * b - 2.0,
                3.0 + turned * d - curved,
                0.5 - turned * c + curved,
            ]
        }
    }

    const FIXED: [f64; 4] = [1.0, -2.0, 3.0, 0.5];

    fn options(count: u32) -> LimitOptions<impl Fn(&[f64; 4]) -> f64> {
        let share = |change: &[f64; 4]| change.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        LimitOptions { counts: [count, 50], share, tolerance: 1e-9, scales: [3.0; 4] }
    }

    fn found(map: impl Fn([f64; 4]) -> [f64; 4], count: u32) -> Option<Limit> {
        limit(|y| Some(map(y)), [1.001, -2.002, 3.001, 0.499], &options(count))
    }

    #[test]
    fn exact_limit_and_what_is_left_are_those_of_the_powers_of_the_map() {
        for curvature in [0.0, 0.2] {
            let map = map([0.6, -0.5, 0.4], curvature);
            let Limit { state, left, more } = found(&map, 25).expect("a stable motion");
            let mut y = [1.001, -2.002, 3.001, 0.499];
            for _ in 0..25 {
                y = map(y);
            }
            for i in 0..4 {
                assert!((state[i] - FIXED[i]).abs() < 1e-10, "{state:?}");
                assert!((state[i] + left[i] - y[i]).abs() < 2e-10, "{left:?} {y:?}");
            }
            // 1e-10 may be neglected, and each map leaves 0.6.
            let later = left[0].abs() * 0.6_f64.powi(more as i32);
            assert!(more > 3 && (0.59e-10..1.01e-10).contains(&later), "{more} {later:e}");
        }
    }

    #[test]
    fn contract_no_limit_where_it_is_unstable_or_cannot_be_told() {
        assert!(found(map([0.6, -0.5, 0.4], 0.2), 25).is_some());
        assert_eq!(found(map([1.1, -0.5, 0.4], 0.2), 25), None, "unstable, but found by Newton's iteration");
        assert_eq!(found(map([0.6, -1.001, 0.4], 0.2), 25), None, "a period doubling");
        assert_eq!(found(map([0.97, -0.5, 0.4], 0.2), 25), None, "too slow to be sure that it is stable");
        assert_eq!(found(map([0.6, -0.5, 0.4], 100.0), 25), None, "too far from it");
        assert_eq!(found(map([0.9, -0.5, 0.4], 5.0), 25), None, "what is left cannot be told");
        assert_eq!(found(|y| y, 25), None, "any state is one of its own");
        assert_eq!(found(|_| [f64::NAN; 4], 25), None);
        assert_eq!(limit(|_| None, FIXED, &options(25)), None, "a map that fails");
    }
}
