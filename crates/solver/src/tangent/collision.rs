//! Derivatives through a contact that was computed at once, by the implicit function theorem.
//!
//! A small change moves touch-down by `s`, the indentation at each node by `δz` and the duration by `δT`. The collocated equations (see
//! `contact/collocation/solve.rs`), differentiated, are as many linear equations as there are unknowns; their matrix is the true
//! Jacobian at the solution, not the one that Newton's iteration is preconditioned with. So these are the derivatives of what is
//! computed, and as accurate.

use super::flight::Flight;
use super::series::{Moment, Series};
use crate::contact::collocation::nodes::MOMENTS;
use crate::contact::linearised::LinearContact;
use nalgebra::{DMatrix, DVector};
use retune_model::{Coupled, Parameter, Side};

/// `A^k b` of a contact with a wall, and its derivatives by each parameter.
pub(super) struct Kicks {
    own: [[f64; 4]; MOMENTS],
    by: Vec<[[f64; 4]; MOMENTS]>,
}

impl Kicks {
    pub(super) fn new(system: &Coupled, flight: &Flight, side: Side, parameters: &[Parameter]) -> Self {
        let push = -side.sign() * system.hertz(side);
        let mut own = [[0.0; 4]; MOMENTS];
        own[0] = system.derivative_under([0.0; 2], &system.rest(), push);
        for k in 1..MOMENTS {
            own[k] = flight.linear(own[k - 1]);
        }
        let by = |(number, &parameter): (usize, &Parameter)| {
            let mut by = [[0.0; 4]; MOMENTS];
            let contact = [push, push * system.hertz_by(parameter)];
            let with = system.acceleration_by(parameter, &system.rest(), contact);
            let without = system.acceleration_by(parameter, &system.rest(), [0.0; 2]);
            by[0] = [0.0, with[0] - without[0], 0.0, with[1] - without[1]];
            for k in 1..MOMENTS {
                let [more, own] = [flight.linear_by(number, own[k - 1]), flight.linear(by[k - 1])];
                by[k] = std::array::from_fn(|i| own[i] + more[i]);
            }
            by
        };
        let by = parameters.iter().enumerate().map(by).collect();
        Self { own, by }
    }
}

/// The change that is carried over a contact.
pub(super) struct Change {
    /// Of the state at the time of touch-down, and of the force there.
    pub at: Moment,
    /// The number of the parameter whose change it is; none for a change of the first state.
    pub parameter: Option<usize>,
    /// The change of the wall's position, m.
    pub wall: f64,
}

/// The linear equations of one contact.
pub(super) struct Crossing<'a> {
    system: &'a Coupled,
    flight: &'a Flight,
    kicks: &'a Kicks,
    contact: LinearContact,
    /// The motion without contact from touch-down on.
    free: Series,
    solver: nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
    /// What changes of `z` at the nodes and of the duration do to the state at lift-off.
    end_by: Vec<[f64; 4]>,
}

impl<'a> Crossing<'a> {
    pub(super) fn new(
        system: &'a Coupled,
        flight: &'a Flight,
        kicks: &'a Kicks,
        contact: LinearContact,
    ) -> Self {
        let (n, sign, duration) = (contact.roots.len(), contact.side.sign(), contact.duration);
        let free = flight.free(Moment { y: contact.touch.y, force: contact.touch.excitation });
        let gains: Vec<f64> = kicks.own.iter().map(|kick| -sign * (kick[2] - kick[0])).collect();
        let share = |i: usize, j: usize| -> f64 {
            let along = contact.shares[i][j].iter().zip(&gains).take(contact.terms);
            1.5 * contact.roots[j] * along.map(|(share, gain)| share * gain).sum::<f64>()
        };
        // An integral of order `k` grows as the duration to the power `k + 1`.
        let growth = |impulses: &[f64; MOMENTS], weights: &dyn Fn(usize) -> f64| -> f64 {
            let terms = impulses.iter().enumerate().take(contact.terms);
            terms.map(|(k, impulse)| (k + 1) as f64 / duration * impulse * weights(k)).sum()
        };
        let matrix = DMatrix::from_fn(n + 1, n + 1, |i, j| {
            if j < n {
                return f64::from(u8::from(i == j)) + share(i, j);
            }
            let time = contact.times[i];
            let [v1, _, v2, _] = free.rate(time * duration);
            growth(&contact.impulses[i], &|k| gains[k]) - sign * (v2 - v1) * time
        });
        let mut end_by: Vec<[f64; 4]> = (0..n)
            .map(|j| {
                let along = contact.shares[n][j].iter().zip(&kicks.own).take(contact.terms);
                let mut sum = [0.0; 4];
                for (share, kick) in along {
                    for i in 0..4 {
                        sum[i] += 1.5 * contact.roots[j] * share * kick[i];
                    }
                }
                sum
            })
            .collect();
        let rate = free.rate(duration);
        let growing = |i: usize| growth(&contact.impulses[n], &|k| kicks.own[k][i]);
        end_by.push(std::array::from_fn(|i| rate[i] + growing(i)));
        Self { system, flight, kicks, free, solver: matrix.lu(), end_by, contact }
    }

    /// The change of the state at the time of lift-off.
    pub(super) fn carry(&self, change: &Change) -> [f64; 4] {
        let contact = &self.contact;
        let (n, sign, touch) = (contact.roots.len(), contact.side.sign(), &contact.touch);
        let Change { at, parameter, wall } = change;
        // Touch-down moves to where the gap closes; up to there the motion is that without contact.
        let begin = self.system.derivative_under(touch.excitation, &touch.y, 0.0);
        let later = (wall - (at.y[2] - at.y[0])) / (begin[2] - begin[0]);
        let turn = self.flight.turn(touch.excitation);
        let at = Moment {
            y: std::array::from_fn(|i| at.y[i] + begin[i] * later),
            force: [0, 1].map(|i| at.force[i] + turn[i] * later),
        };
        let free = self.flight.changed(&self.free, *parameter, at);
        let kicks = parameter.map(|number| &self.kicks.by[number]);
        let impulse = |place: usize, weight: &dyn Fn(&[f64; 4]) -> f64| -> f64 {
            let all = kicks.into_iter().flatten().zip(&contact.impulses[place]).take(contact.terms);
            all.map(|(kick, impulse)| impulse * weight(kick)).sum()
        };
        let mut right = DVector::from_fn(n + 1, |i, _| {
            let r = free.separation(contact.times[i] * contact.duration);
            sign * (r - wall + impulse(i, &|kick| kick[2] - kick[0]))
        });
        self.solver.solve_mut(&mut right);
        let mut end = free.state(contact.duration);
        for i in 0..4 {
            end[i] += impulse(n, &|kick| kick[i]);
            end[i] += self.end_by.iter().zip(right.iter()).map(|(by, change)| by[i] * change).sum::<f64>();
        }
        // Back to the time at which the contact itself ended.
        let force = self.free.force(contact.duration);
        let rate = self.system.derivative_under(force, &contact.end, 0.0);
        std::array::from_fn(|i| end[i] - rate[i] * (later + right[n]))
    }
}
