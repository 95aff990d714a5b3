//! The loss of a contact, in intervals: the factor of Hertz's force (`docs/theory.md`, "Contacts that lose energy").

use crate::{Failure, Interval};
use retune_model::Loss;

/// The factor of Hertz's force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// 1.
    None,
    /// `1 + λ w`, as long as that is positive.
    Damping(Interval),
    /// `1 + χ w/v`: the same restitution at every speed.
    Restoring(Interval),
}

/// The least restitution at every speed that is covered.
const LEAST: f64 = 0.2;
/// Terms of the series of Langevin's function.
const TERMS: u32 = 40;

impl Factor {
    /// The factor of a loss, whose number encloses the decimal in the file.
    ///
    /// # Errors
    /// The restitution is too small.
    pub fn new(loss: &Loss) -> Result<Self, Failure> {
        match *loss {
            _ if loss.is_none() => Ok(Self::None),
            Loss::Damping(lambda) => Ok(Self::Damping(Interval::decimal(lambda.get()))),
            Loss::Restoring(e) if e.get() < LEAST => Err(Failure::Scene("a restitution below 0.2")),
            Loss::Restoring(e) => chi(Interval::decimal(e.get()))
                .map(Self::Restoring)
                .ok_or(Failure::Scene("a restitution next to 1")),
        }
    }
}

/// An approximation, by bisection in doubles, of the touch-down speed `v` of the undisturbed collision through a state: `S = v² G(w/v)`.
pub fn touch_down(chi: f64, stored: f64, w: f64) -> f64 {
    let excess = |v: f64| {
        let h = w / v;
        v * v * ((1.0 - h) - (chi.ln_1p() - (chi * h).ln_1p()) / chi) / chi - stored
    };
    let (mut low, mut high) = (w.abs(), 2.0 * w.abs() + 1e-9);
    while (excess(high) <= 0.0 || excess(high).is_nan()) && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        // NaN is beyond lift-off.
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    high
}

/// χ from e: `L(a) = (1 - e)/(1 + e)` with `a = χ (1 + e)/2` and Langevin's function `L(a) = coth a - 1/a`, which increases. So `a` is
/// between two numbers at which `L` is below and above.
fn chi(e: Interval) -> Option<Interval> {
    let wanted = (Interval::ONE - e) / (Interval::ONE + e);
    let (mut low, mut high) = (0.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if langevin(middle).mid() < wanted.mid() { low = middle } else { high = middle }
    }
    let a = (0..40).map(|n| 1e-16 * f64::from(1u32 << (n / 2).min(30))).find_map(|off| {
        let [low, high] = [low - off * 16.0 * low, high + off * 16.0 * high];
        let holds = (wanted - langevin(low)).is_positive() && (langevin(high) - wanted).is_positive();
        (low > 0.0 && holds).then(|| Interval::new(low, high))
    })?;
    Some(Interval::point(2.0) * a / (Interval::ONE + e))
}

/// `coth a - 1/a` for `a` from 0 to 4.5, as `a Σ 2k a²ᵏ⁻²/(2k+1)! / Σ a²ᵏ/(2k+1)!`: all terms are positive, and the omitted ones sum to
/// less than the last one, as each is less than half of the one before.
fn langevin(a: f64) -> Interval {
    let a = Interval::point(a);
    let (mut term, mut above, mut below) = (Interval::ONE, Interval::ZERO, Interval::ZERO);
    for k in 0..TERMS {
        let n = f64::from(2 * k);
        below = below + term;
        term = term * a.square() / Interval::point((n + 2.0) * (n + 3.0));
        above = above + Interval::point(n + 2.0) * term;
    }
    let left_out = Interval::new(0.0, 1e3 * term.hi());
    (above + left_out) / (a * (below + left_out))
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_model::{Positive, Restitution};

    /// `Loss::restoring_at` at a speed of 1 m/s has χ as its λ.
    #[test]
    fn reference_chi_of_the_model_is_enclosed() {
        for e in [0.2, 0.3, 0.6, 0.7, 0.8, 0.9, 0.99] {
            let restitution = Restitution::new(e).expect("in (0, 1]");
            let Ok(Loss::Damping(own)) =
                Loss::restoring_at(restitution, Positive::new(1.0).expect("above 0"))
            else {
                panic!("no loss: {e}")
            };
            let Ok(Factor::Restoring(chi)) = Factor::new(&Loss::Restoring(restitution)) else {
                panic!("none: {e}")
            };
            let own = own.get();
            assert!(chi.wider(1e-14 * own).contains(own) && chi.width() < 1e-12 * own, "{e}: {own} {chi}");
        }
    }

    /// Langevin's function increases: at the ends of `a = χ (1 + e)/2` it is below and above the required value.
    #[test]
    fn exact_langevins_function_is_below_and_above_at_the_ends_of_chi() {
        for e in [0.2, 0.25, 0.3, 0.5, 0.6, 0.7, 0.75, 0.8, 0.9, 0.99] {
            let e = Interval::decimal(e);
            let a = chi(e).expect("a number") * (Interval::ONE + e) / Interval::point(2.0);
            let wanted = (Interval::ONE - e) / (Interval::ONE + e);
            assert!((wanted - langevin(a.lo())).is_positive(), "{e}: {a}");
            assert!((langevin(a.hi()) - wanted).is_positive(), "{e}: {a}");
        }
    }
}
