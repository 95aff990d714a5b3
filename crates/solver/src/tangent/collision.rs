//! Derivatives through a contact that was computed at once, by the implicit function theorem.
//!
//! A small change moves touch-down by `s`, the indentation at each node by `δz` and the duration by `δT`. The collocated equations (see
//! `contact/collocation/solve.rs`), differentiated, are as many linear equations as there are unknowns; their matrix is the true Jacobian
//! at the solution, not the one that Newton's iteration is preconditioned with. So these are the derivatives of what is computed, and as
//! accurate. Only four numbers of each solution are needed, the change of the state after the contact: four solutions of the transposed
//! equations give them for any number of changes.

use super::flight::Flight;
use super::series::{BRIEF, EquationSensitivity, Moment, Row, applied, identity};
use crate::motion::linearised::{LinearContact, MOMENTS};
use nalgebra::DMatrix;
use retune_model::{Coupled, Parameter, Side};
use wide::f64x4;

/// The derivatives of `A^k b` of a contact with a wall by each parameter.
pub(super) struct Kicks {
    by: Vec<[[f64; 4]; MOMENTS]>,
}

impl Kicks {
    pub(super) fn new(system: &Coupled, flight: &Flight, side: Side, parameters: &[Parameter]) -> Self {
        let push = -side.sign() * system.hertz(side);
        let mut kicks = [[0.0; 4]; MOMENTS];
        kicks[0] = system.derivative_under([0.0; 2], &system.rest(), push);
        for k in 1..MOMENTS {
            kicks[k] = flight.linear(kicks[k - 1]);
        }
        let by = |(number, &parameter): (usize, &Parameter)| {
            let mut by = [[0.0; 4]; MOMENTS];
            let contact = [push, push * system.hertz_by(parameter)];
            let with = system.acceleration_by(parameter, &system.rest(), contact);
            let without = system.acceleration_by(parameter, &system.rest(), [0.0; 2]);
            by[0] = [0.0, with[0] - without[0], 0.0, with[1] - without[1]];
            for k in 1..MOMENTS {
                let [direct, carried] = [flight.linear_by(number, kicks[k - 1]), flight.linear(by[k - 1])];
                by[k] = std::array::from_fn(|i| carried[i] + direct[i]);
            }
            by
        };
        Self { by: parameters.iter().enumerate().map(by).collect() }
    }
}

/// The change that is carried over a contact.
pub(super) struct Change {
    /// Of the state at the time of touch-down, and of the force there.
    pub at: Moment,
    /// The number of the parameter whose change it is; `None` for a change of the first state.
    pub parameter: Option<usize>,
    /// The change of the wall's position, m.
    pub wall: f64,
    /// Whether it is a change of λ.
    pub loss: bool,
}

/// The linear map of changes over one contact.
pub(super) struct ContactMap<'a> {
    flight: &'a Flight,
    kicks: &'a Kicks,
    contact: LinearContact,
    /// The change of the state after the contact per unit change of the state and the force at touch-down; `by_wall`, of the wall's
    /// position; `by_delay`, of the time of touch-down.
    row: Row,
    /// The effect of changes of the equations on it, along the motion without contact from touch-down on.
    sensitivity: EquationSensitivity,
    by_wall: f64x4,
    by_delay: f64x4,
    /// `d(x2 - x1)/dt` at touch-down.
    closing: f64,
    /// The effect of a change of the push of each order on it through the indentation.
    pushes: [f64x4; MOMENTS],
    /// The effect of a small loss on it, per unit of λ, if requested.
    by_loss: f64x4,
}

impl<'a> ContactMap<'a> {
    pub(super) fn new(
        system: &'a Coupled,
        flight: &'a Flight,
        kicks: &'a Kicks,
        contact: LinearContact,
    ) -> Self {
        let (n, sign, duration) = (contact.roots.len(), contact.side.sign(), contact.duration);
        let touch = &contact.touch;
        let free = flight.free(Moment { y: touch.y, force: touch.excitation }, duration);
        // An integral of order `k` grows as the duration to the power `k + 1`.
        let growth = |place: usize, weight: &dyn Fn(usize) -> f64| -> f64 {
            let terms = contact.impulses[place].iter().enumerate().take(contact.terms);
            terms.map(|(k, impulse)| (k + 1) as f64 / duration * impulse * weight(k)).sum()
        };
        let after = system.derivative_under(free.force(duration), &contact.end, 0.0);
        // The transposed equations: a row for each unknown, `δz` at the nodes and `δT`, a column for each place.
        let by_duration: Vec<f64> = (0..=n)
            .map(|i| {
                let [v1, _, v2, _] = free.rate(contact.times[i] * duration);
                growth(i, &|k| contact.gains[k]) - sign * (v2 - v1) * contact.times[i]
            })
            .collect();
        let matrix = DMatrix::from_fn(n + 1, n + 1, |j, i| match j {
            _ if j == n => by_duration[i],
            _ => f64::from(u8::from(i == j)) + 1.5 * contact.roots[j] * contact.reductions[(i, j)],
        });
        // What each unknown does to the state after the contact: at lift-off, less what passes until then.
        let rate = free.rate(duration);
        let mut weights = DMatrix::from_fn(n + 1, 4, |j, c| match j {
            _ if j == n => rate[c] + growth(n, &|k| contact.kicks[k][c]) - after[c],
            _ => 1.5 * contact.roots[j] * contact.additions[j][c],
        });
        matrix.lu().solve_mut(&mut weights);
        let (mut powers, mut pushes, mut by_loss) =
            ([f64x4::ZERO; BRIEF], [f64x4::ZERO; MOMENTS], f64x4::ZERO);
        for i in 0..=n {
            let time = contact.times[i] * duration;
            let mut power = f64x4::from(std::array::from_fn(|c| sign * weights[(i, c)]));
            for k in 0..contact.terms {
                pushes[k] += power * contact.impulses[i][k];
            }
            if let Some(drags) = contact.drags.get(i) {
                // A force at the place itself counts by the kernels, as `pushes` do in `carry`; at lift-off it moves the state, too.
                for (kick, drag) in contact.kicks.iter().zip(drags).take(contact.terms) {
                    by_loss += power * (drag * (kick[2] - kick[0]));
                    if i == n {
                        by_loss += f64x4::from(*kick) * *drag;
                    }
                }
            }
            for term in &mut powers {
                *term += power;
                power *= time;
            }
        }
        let mut passed = [1.0; BRIEF];
        for k in 1..BRIEF {
            passed[k] = passed[k - 1] * duration;
        }
        let rows = flight.functionals(free.terms().len(), 1.0, |k| {
            let mut row = identity(passed[k]);
            row[0] -= powers[k];
            row[2] += powers[k];
            row
        });
        let rate = system.derivative_under(touch.excitation, &touch.y, 0.0);
        let begin = Moment { y: rate, force: flight.force_rate(touch.excitation) };
        let by_delay = applied(&rows[0], &begin) - f64x4::from(after);
        let (by_wall, closing) = (-powers[0], rate[2] - rate[0]);
        let sensitivity = EquationSensitivity::new(free.terms(), &rows, 1.0, 1.0);
        Self {
            flight,
            kicks,
            contact,
            row: rows[0],
            sensitivity,
            by_wall,
            by_delay,
            closing,
            pushes,
            by_loss,
        }
    }

    /// The change of the state at the time of lift-off.
    pub(super) fn carry(&self, change: &Change) -> [f64; 4] {
        let Change { at, parameter, wall, loss } = change;
        // Touch-down moves to where the gap closes; up to there the motion is that without contact.
        let delay = (wall - (at.y[2] - at.y[0])) / self.closing;
        let mut end = applied(&self.row, at) + self.by_delay * delay + self.by_wall * *wall;
        if *loss {
            end += self.by_loss;
        }
        if let Some(number) = parameter {
            end += self.flight.parameter_effect(*number, &self.sensitivity);
            let last = &self.contact.impulses[self.contact.roots.len()];
            let pushes = self.kicks.by[*number].iter().zip(last).zip(&self.pushes).take(self.contact.terms);
            for ((kick, impulse), push) in pushes {
                end += f64x4::from(*kick) * *impulse + *push * (kick[2] - kick[0]);
            }
        }
        end.to_array()
    }
}
