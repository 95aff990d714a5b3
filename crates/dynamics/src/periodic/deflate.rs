//! Other motions at the same value of the parameter, by deflation (P. E. Farrell, Á. Birkisson and S. W. Funke, SIAM J. Sci. Comput. 37
//! (2015) A2026): Newton's iteration on the gaps times `Π (1/|x - x_k|² + 1)`, which is repelled by the known motions `x_k`, whatever crest
//! of the force they begin at.

use super::forced::Forced;
use super::settle::{SAME, least_periods};
use super::shooting::{Shooting, Solution};
use nalgebra::DVector;

/// Most iterations.
const ITERATIONS: usize = 40;
/// The longest change of an iteration, in units of the motion's size.
const LONGEST: f64 = 0.5;
/// After a change shorter than this, plain Newton's iteration takes over.
const SHORT: f64 = 1e-2;
/// The iteration gives up farther than this from its start, in the same units.
const FAR: f64 = 10.0;

/// A motion at the value of the parameter in `start` other than the `known`; none if the iteration does not lead to one.
pub fn another<S: Forced>(
    shooting: &Shooting<S>,
    start: &DVector<f64>,
    known: &[DVector<f64>],
) -> Option<Solution> {
    let known: Vec<DVector<f64>> =
        shooting.crests().flat_map(|shift| known.iter().map(move |x| shooting.shifted(x, shift))).collect();
    let mut x = start.clone();
    for _ in 0..ITERATIONS {
        let change = shooting.change_at_value(&x)?;
        let size = shooting.norm(&change);
        if !size.is_finite() {
            return None;
        }
        if size < SHORT {
            let found = shooting.correct_at_value(&x).filter(|found| {
                let apart = |known| shooting.nearest(known, &found.x).1 > SAME;
                known.iter().all(apart) && least_periods(shooting, &found.x) == shooting.periods
            });
            if found.is_some() {
                return found;
            }
        }
        // The change by the deflated equations is Newton's times `1/(1 - ∇ ln Π · change)`.
        let slope = known.iter().map(|known| {
            let away = &x - known;
            let square = shooting.inner(&away, &away);
            -2.0 * shooting.inner(&away, &change) / (square * (1.0 + square))
        });
        let longer = 1.0 / (1.0 - slope.sum::<f64>());
        x += change * longer.clamp(-LONGEST / size, LONGEST / size);
        let away = shooting.norm(&(&x - start));
        if away.is_nan() || away > FAR {
            return None;
        }
    }
    None
}
