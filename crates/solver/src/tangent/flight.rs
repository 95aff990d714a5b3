//! Derivatives in flight: Taylor series over whole steps, kept as matrices, and over the rest of the flight.

use super::series::{BRIEF, EquationSensitivity, Moment, Row, Series, applied, dot, identity, sum};
use retune_model::{Coupled, Excitation, Parameter};
use wide::f64x4;

/// Length of a whole step times the rate of the flow, and the terms after which the series has converged (`1.25²⁰/20! = 4e-17`).
const STEP: f64 = 1.25;
const TERMS: u32 = 20;
/// Limit on terms of a series, the first included.
pub(super) const MOST: usize = TERMS as usize + 1;

/// Components of the start of a flight: the state, the force, and 1 for the constant terms.
const WIDTH: usize = 7;

/// The linear equations of a flight and their derivatives by some parameters.
pub(super) struct Flight {
    /// `[x1'', x2'']`: coefficients of the state, of the force, and constant.
    rows: [[f64; 6]; 2],
    /// Their derivatives by each parameter: coefficients of the state, and constant.
    rows_by: Vec<[[f64; 5]; 2]>,
    /// Whether each parameter is ω.
    turning: Vec<bool>,
    omega: f64,
    rate: f64,
    step: f64,
    /// The map from the start of a whole step to the state after it, and its derivatives by each parameter: column by column.
    whole: [[f64; 4]; WIDTH],
    whole_by: Vec<[[f64; 4]; WIDTH]>,
}

impl Flight {
    pub(super) fn new(system: &Coupled, parameters: &[Parameter]) -> Self {
        let unit = |j: usize| -> [f64; 4] { std::array::from_fn(|i| f64::from(u8::from(i == j))) };
        let accelerations = |force: f64, y: &[f64; 4]| {
            let [_, a1, _, a2] = system.derivative_under([force, 0.0], y, 0.0);
            [a1, a2]
        };
        let constant = accelerations(0.0, &[0.0; 4]);
        let by_state: [[f64; 2]; 4] = std::array::from_fn(|j| accelerations(0.0, &unit(j)));
        let by_force = accelerations(1.0, &[0.0; 4]);
        let rows = [0, 1].map(|row| {
            let [a, b, c, d] = by_state.map(|column| column[row] - constant[row]);
            [a, b, c, d, by_force[row] - constant[row], constant[row]]
        });
        let rows_by = |&parameter: &Parameter| {
            let by = |y: &[f64; 4]| system.acceleration_by(parameter, y, [0.0; 2]);
            let constant = by(&[0.0; 4]);
            let columns: [[f64; 2]; 4] = std::array::from_fn(|j| by(&unit(j)));
            [0, 1].map(|row| {
                let [a, b, c, d] = columns.map(|column| column[row] - constant[row]);
                [a, b, c, d, constant[row]]
            })
        };
        let rate = system.rate();
        let mut flight = Self {
            rows,
            rows_by: parameters.iter().map(rows_by).collect(),
            turning: parameters.iter().map(|parameter| *parameter == Parameter::Omega).collect(),
            omega: system.bare().frequency(),
            rate,
            step: STEP / rate,
            whole: [[0.0; 4]; WIDTH],
            whole_by: vec![[[0.0; 4]; WIDTH]; parameters.len()],
        };
        let none = Moment { y: [0.0; 4], force: [0.0; 2] };
        for j in 0..WIDTH {
            let mut from = none;
            match j {
                0..4 => from.y = unit(j),
                4 => from.force = [1.0, 0.0],
                5 => from.force = [0.0, 1.0],
                _ => {}
            }
            let mut by = vec![none; parameters.len()];
            flight.series(flight.step, f64::from(u8::from(j == 6)), &mut from, &mut [], &mut by);
            flight.whole[j] = from.y;
            for (matrix, by) in flight.whole_by.iter_mut().zip(by) {
                matrix[j] = by.y;
            }
        }
        flight
    }

    /// Carries the motion, its derivatives by the first state and those by the parameters over `seconds` of flight. The forces of the
    /// derivatives are given at the beginning of each step by `force_by(number, t)`, `t` seconds after the beginning of the flight.
    pub(super) fn fly(
        &self,
        seconds: f64,
        mut now: [f64; 4],
        force: impl Fn(f64) -> Excitation,
        by_state: &mut [[f64; 4]; 4],
        by: &mut [[f64; 4]],
        force_by: impl Fn(usize, f64) -> Excitation,
    ) {
        let count = (seconds / self.step) as usize;
        for k in 0..count {
            let elapsed = k as f64 * self.step;
            let [c, s] = force(elapsed);
            let from = [now[0], now[1], now[2], now[3], c, s, 1.0];
            for (number, column) in by.iter_mut().enumerate() {
                let [c, s] = force_by(number, elapsed);
                let start = [column[0], column[1], column[2], column[3], c, s, 0.0];
                *column = sum(product(&self.whole, &start), product(&self.whole_by[number], &from));
            }
            for column in &mut *by_state {
                *column = product(&self.whole, column);
            }
            now = product(&self.whole, &from);
        }
        let elapsed = count as f64 * self.step;
        let mut from = Moment { y: now, force: force(elapsed) };
        let moment = |(number, y): (usize, &[f64; 4])| Moment { y: *y, force: force_by(number, elapsed) };
        let mut moments: Vec<Moment> = by.iter().enumerate().map(moment).collect();
        self.series(seconds - elapsed, 1.0, &mut from, by_state, &mut moments);
        for (column, moment) in by.iter_mut().zip(moments) {
            *column = moment.y;
        }
    }

    /// The Taylor series over `h` seconds, `|h| <=` a whole step; `constant` is 1, or 0 without the constant terms of the equations.
    fn series(&self, h: f64, constant: f64, from: &mut Moment, by_state: &mut [[f64; 4]], by: &mut [Moment]) {
        let mut terms = [*from; MOST];
        let (mut count, mut size) = (1, 1.0);
        while count < MOST && size > 1e-18 {
            let share = h / count as f64;
            size *= self.rate * share.abs();
            let constant = if count == 1 { constant } else { 0.0 };
            terms[count] = self.derivative(&terms[count - 1], constant).times(share);
            count += 1;
        }
        let rows = self.functionals(count, h, |_| identity(1.0));
        for column in by_state {
            *column = applied(&rows[0], &Moment { y: *column, force: [0.0; 2] }).to_array();
        }
        let sensitivity = if by.is_empty() {
            None
        } else {
            Some(EquationSensitivity::new(&terms[..count], &rows, h, constant))
        };
        for ((number, by), sensitivity) in by.iter_mut().enumerate().zip(sensitivity.iter().cycle()) {
            by.y = (applied(&rows[0], by) + self.parameter_effect(number, sensitivity)).to_array();
        }
        for term in &terms[1..count] {
            from.y = sum(from.y, term.y);
        }
    }

    /// The effect of a change of each coefficient of a Taylor series in steps of `h` on four numbers, as rows of `(y, force)`. `direct(k)`
    /// is the direct effect of the coefficient of order `k`; a change also propagates into all later coefficients.
    pub(super) fn functionals(&self, count: usize, h: f64, direct: impl Fn(usize) -> Row) -> [Row; MOST] {
        let mut rows = [[f64x4::ZERO; 6]; MOST];
        for k in (0..count).rev() {
            let mut row = direct(k);
            if k + 1 < count {
                let share = h / (k + 1) as f64;
                for (weight, later) in row.iter_mut().zip(self.transposed(&rows[k + 1])) {
                    *weight += later * share;
                }
            }
            rows[k] = row;
        }
        rows
    }

    /// The effect on the four numbers, along a motion, of the change of the equations by the parameter of this number.
    pub(super) fn parameter_effect(&self, number: usize, sensitivity: &EquationSensitivity) -> f64x4 {
        let mut sum = if self.turning[number] { sensitivity.turned } else { f64x4::ZERO };
        for (by, rows) in sensitivity.by.iter().zip(&self.rows_by[number]) {
            for (by, row) in by.iter().zip(rows) {
                sum += *by * *row;
            }
        }
        sum
    }

    /// The transposed equations of a flight.
    fn transposed(&self, &[x1, v1, x2, v2, c, s]: &Row) -> Row {
        let [first, second] = &self.rows;
        let weighted = |j: usize| v1 * first[j] + v2 * second[j];
        [
            weighted(0),
            x1 + weighted(1),
            weighted(2),
            x2 + weighted(3),
            weighted(4) + s * self.omega,
            c * -self.omega,
        ]
    }

    /// The series of the motion from a moment on, for `seconds` of a brief contact.
    pub(super) fn free(&self, from: Moment, seconds: f64) -> Series {
        let (mut count, mut size) = (1, 1.0);
        while count < BRIEF && size > 1e-18 {
            size *= self.rate * seconds / count as f64;
            count += 1;
        }
        Series::new(from, count, |k, term| self.derivative(term, f64::from(u8::from(k == 1))))
    }

    /// `A y`.
    pub(super) fn linear(&self, y: [f64; 4]) -> [f64; 4] {
        self.derivative(&Moment { y, force: [0.0; 2] }, 0.0).y
    }

    /// The derivative of `A` by the parameter of this number, times `y`.
    pub(super) fn linear_by(&self, number: usize, y: [f64; 4]) -> [f64; 4] {
        self.derivative_by(number, &Moment { y, force: [0.0; 2] }, 0.0).y
    }

    pub(super) fn force_rate(&self, [c, s]: Excitation) -> Excitation {
        [-self.omega * s, self.omega * c]
    }

    /// The derivatives of the equations of a flight by the parameter of this number.
    fn derivative_by(&self, number: usize, Moment { y, force: [c, s] }: &Moment, constant: f64) -> Moment {
        let rows = &self.rows_by[number];
        let [a1, a2] = [0, 1].map(|row| dot(&rows[row][..4], y) + rows[row][4] * constant);
        let force = if self.turning[number] { [-s, *c] } else { [0.0; 2] };
        Moment { y: [0.0, a1, 0.0, a2], force }
    }

    /// The equations of a flight.
    fn derivative(&self, Moment { y, force: [c, s] }: &Moment, constant: f64) -> Moment {
        let [a1, a2] = [0, 1].map(|row| {
            let row = &self.rows[row];
            dot(&row[..4], y) + row[4] * c + row[5] * constant
        });
        Moment { y: [y[1], a1, y[3], a2], force: self.force_rate([*c, *s]) }
    }

    /// `e^(A h) y` without force, for `h` seconds of at most a few whole steps, forward or backward.
    pub(super) fn decay(&self, h: f64, y: [f64; 4]) -> [f64; 4] {
        let (mut sum, mut term, mut size) = (y, y, 1.0);
        for k in 1..=3 * TERMS {
            let share = h / f64::from(k);
            size *= self.rate * share.abs();
            term = self.derivative(&Moment { y: term, force: [0.0; 2] }, 0.0).y.map(|v| v * share);
            for (sum, term) in sum.iter_mut().zip(term) {
                *sum += term;
            }
            if size < 1e-18 {
                break;
            }
        }
        sum
    }

    /// `row e^(A h)`.
    pub(super) fn row_decay(&self, h: f64, row: [f64; 4]) -> [f64; 4] {
        let (mut sum, mut term, mut size) = (row, row, 1.0);
        let [first, second] = &self.rows;
        for k in 1..=3 * TERMS {
            let share = h / f64::from(k);
            size *= self.rate * share.abs();
            let [x1, v1, x2, v2] = term;
            let weighted = |j: usize| v1 * first[j] + v2 * second[j];
            term = [weighted(0), x1 + weighted(1), weighted(2), x2 + weighted(3)].map(|v| v * share);
            for (sum, term) in sum.iter_mut().zip(term) {
                *sum += term;
            }
            if size < 1e-18 {
                break;
            }
        }
        sum
    }
}

/// The first columns of a matrix times a vector.
fn product(columns: &[[f64; 4]; WIDTH], vector: &[f64]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for (column, weight) in columns.iter().zip(vector) {
        for i in 0..4 {
            sum[i] += column[i] * weight;
        }
    }
    sum
}
