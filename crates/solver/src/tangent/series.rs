//! Taylor series of a motion and of its changes; and rows: the effects of changes on four numbers, the components of a state for instance,
//! in the four lanes of a vector.

use retune_model::Excitation;
use wide::f64x4;

/// A state and the force, or their derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub y: [f64; 4],
    pub force: Excitation,
}

impl Moment {
    pub(super) fn times(self, share: f64) -> Self {
        Self { y: self.y.map(|v| v * share), force: self.force.map(|v| v * share) }
    }
}

/// Terms of a series over the brief contact that is computed at once: `0.3¹³/13! = 3e-17`.
pub(super) const BRIEF: usize = 13;

/// A Taylor series of a motion or of its change, to as many terms as count.
#[derive(Clone, Copy)]
pub(super) struct Series {
    terms: [Moment; BRIEF],
    count: usize,
}

impl Series {
    /// The series that begins with `from`; `rate` gives the derivative of a term, from the order of the next one and the term.
    pub(super) fn new(from: Moment, count: usize, rate: impl Fn(usize, &Moment) -> Moment) -> Self {
        let mut terms = [from; BRIEF];
        for k in 1..count {
            terms[k] = rate(k, &terms[k - 1]).times(1.0 / k as f64);
        }
        Self { terms, count }
    }

    pub(super) fn terms(&self) -> &[Moment] {
        &self.terms[..self.count]
    }

    /// The rate of the state after `t` seconds.
    pub(super) fn rate(&self, t: f64) -> [f64; 4] {
        let terms = self.terms().iter().enumerate().skip(1).rev();
        terms.fold([0.0; 4], |sum, (k, term)| std::array::from_fn(|i| sum[i] * t + k as f64 * term.y[i]))
    }

    pub(super) fn force(&self, t: f64) -> Excitation {
        self.terms().iter().rev().fold([0.0; 2], |sum, term| [0, 1].map(|i| sum[i] * t + term.force[i]))
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn sum(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The effect of a change of `(y, force)` on four numbers, in four lanes.
pub(super) type Row = [f64x4; 6];

/// The state itself, times a factor.
pub(super) fn identity(factor: f64) -> Row {
    std::array::from_fn(|i| f64x4::from(std::array::from_fn(|lane| if lane == i { factor } else { 0.0 })))
}

/// A row applied to a state and its force.
pub(super) fn applied(row: &Row, moment: &Moment) -> f64x4 {
    let [a, b, c, d, e, f] = *row;
    let ([x1, v1, x2, v2], [cosine, sine]) = (moment.y, moment.force);
    a * x1 + b * v1 + c * x2 + d * v2 + e * cosine + f * sine
}

/// The effects of changes of the equations on four numbers along a motion: one sum over its terms for all parameters.
pub(super) struct EquationSensitivity {
    /// Of changes of either acceleration: of each coefficient of the state, and of the constant.
    pub by: [[f64x4; 5]; 2],
    /// Of a change of the force's frequency ω.
    pub turned: f64x4,
}

impl EquationSensitivity {
    /// For a motion with these terms, in steps of `h`; the rows are those of its coefficients.
    pub(super) fn new(terms: &[Moment], rows: &[Row], h: f64, constant: f64) -> Self {
        let (mut by, mut turned) = ([[f64x4::ZERO; 5]; 2], f64x4::ZERO);
        for k in 1..terms.len() {
            let Moment { y, force: [c, s] } = terms[k - 1];
            let share = h / k as f64;
            for (by, row) in by.iter_mut().zip([rows[k][1], rows[k][3]]) {
                for i in 0..4 {
                    by[i] += row * (share * y[i]);
                }
            }
            turned += rows[k][5] * (share * c) - rows[k][4] * (share * s);
        }
        for (by, row) in by.iter_mut().zip([rows[1][1], rows[1][3]]) {
            by[4] = row * (h * constant);
        }
        Self { by, turned }
    }
}
