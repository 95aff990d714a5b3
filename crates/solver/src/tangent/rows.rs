//! Rows: what changes do to four numbers, the components of a state for instance, in the four lanes of a vector.

use super::series::Moment;
use wide::f64x4;

/// What a change of `(y, force)` does to four numbers, in four lanes.
pub(super) type Row = [f64x4; 6];

/// The state itself, times a factor.
pub(super) fn identity(factor: f64) -> Row {
    std::array::from_fn(|i| f64x4::from(std::array::from_fn(|lane| if lane == i { factor } else { 0.0 })))
}

/// What a row makes of a state and its force.
pub(super) fn applied(row: &Row, moment: &Moment) -> f64x4 {
    let [a, b, c, d, e, f] = *row;
    let ([x1, v1, x2, v2], [cosine, sine]) = (moment.y, moment.force);
    a * x1 + b * v1 + c * x2 + d * v2 + e * cosine + f * sine
}

/// What changes of the equations do to four numbers along a motion: one sum over its terms for all parameters.
pub(super) struct Along {
    /// Of either acceleration by each component of the state and constant.
    pub by: [[f64x4; 5]; 2],
    /// Of the rate of the force.
    pub turned: f64x4,
}

impl Along {
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
