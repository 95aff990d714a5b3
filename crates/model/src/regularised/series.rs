//! The motion in a contact without loss as Taylor series in `θ`: all right-hand sides are polynomials, so that each term follows from those before.

use super::bounds::{Change, Forces, Growth, ORDERS};
use super::{RegularisedContact, RegularisedState};
use crate::Excitation;
use wide::f64x4;

/// Maximum number of terms of a series.
const MOST: usize = 28;

/// Taylor coefficients in `θ` about a state in contact, in a unit scaled to the motion: powers of a fixed unit would overflow.
#[derive(Clone, Debug)]
pub struct ContactSeries {
    /// The number of terms of each series, even; all later ones are zero.
    terms: usize,
    /// The unit, s/√m.
    unit: f64,
    /// Of `[q, v1, P cos ωt, P sin ωt]`.
    driving: [f64x4; MOST],
    /// Of `[z, dw/dt, a1, q³]`.
    forced: [f64x4; MOST],
    /// Of `[x1, w, t, 0]`.
    carried: [f64x4; MOST],
}

// The series in the order of [`ContactSeries::bounds`].
const DRIVING: usize = 0;
const FORCED: usize = 1;
const CARRIED: usize = 2;

/// A series evaluated at one moment.
pub struct SeriesMoment {
    /// The state.
    pub state: RegularisedState,
    /// The force and its quarter-turn, N.
    pub excitation: Excitation,
}

impl ContactSeries {
    /// Room for the fewest terms of which the last adds less than `share` to an oscillation over `turn` radians.
    pub fn for_turn(turn: f64, share: f64) -> Self {
        let mut last = turn;
        let mut terms = 2;
        while terms < MOST && last > share {
            last *= turn * turn / (terms * (terms + 1)) as f64;
            terms += 2;
        }
        let none = [f64x4::ZERO; MOST];
        Self { terms, unit: 1.0, driving: none, forced: none, carried: none }
    }

    /// The unit of `θ`, s/√m.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// How many terms there are.
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// Expands the series about a state under an excitation (N), in units of `unit` (s/√m).
    pub fn expand(
        &mut self,
        equations: &RegularisedContact,
        &[q0, w, x1, v1, t]: &RegularisedState,
        [cos, sin]: Excitation,
        unit: f64,
    ) {
        self.unit = unit;
        let (terms, root) = (self.terms, f64x4::splat(q0));
        let [driving, forced, carried] =
            [&mut self.driving, &mut self.forced, &mut self.carried].map(|series| &mut series[..terms]);
        driving[0] = f64x4::new([q0, v1, cos, sin]);
        carried[0] = f64x4::new([x1, w, t, 0.0]);
        for k in 0..terms {
            // Cauchy products with q: those of the forces lack their last term.
            let (mut moved, mut pushed) = (root * driving[k], f64x4::ZERO);
            for i in 0..k {
                let q = f64x4::splat(driving[k - i].as_array()[0]);
                moved += q * driving[i];
                pushed += q * forced[i];
            }
            let [z, along, of_cos, of_sin] = moved.to_array();
            let [cube, by_rate, by_a1, _] = pushed.to_array();
            let ([q, v1, cos, _], [x1, w, ..]) = (driving[k].to_array(), carried[k].to_array());
            let cube = cube + q0 * z;
            let stretch = if k == 0 { z + equations.stretch } else { z };
            let [rate, a1] = equations.balance(cube, [stretch, w, x1, v1], cos);
            forced[k] = f64x4::new([z, rate, a1, cube]);
            if k + 1 < terms {
                let next = unit / (k + 1) as f64;
                let (w_next, v1_next) = (by_rate + q0 * rate, by_a1 + q0 * a1);
                driving[k + 1] =
                    f64x4::new([0.5 * w, v1_next, -equations.omega * of_sin, equations.returns * of_cos])
                        * next;
                carried[k + 1] = f64x4::new([along, w_next, q, 0.0]) * next;
            }
        }
    }

    /// The moment at `θ`, s/√m.
    pub fn at(&self, theta: f64) -> SeriesMoment {
        let [[q, v1, cos, sin], [x1, w, t, _]] =
            [&self.driving, &self.carried].map(|series| self.sum(series, theta).to_array());
        SeriesMoment { state: [q, w, x1, v1, t], excitation: [cos, sin] }
    }

    /// `Σ c_k θ^k`, even and odd terms apart.
    fn sum(&self, c: &[f64x4; MOST], theta: f64) -> f64x4 {
        let theta = theta / self.unit;
        let square = f64x4::splat(theta * theta);
        let (mut even, mut odd) = (f64x4::ZERO, f64x4::ZERO);
        for pair in c[..self.terms].chunks_exact(2).rev() {
            (even, odd) = (even * square + pair[0], odd * square + pair[1]);
        }
        even + odd * theta
    }

    /// Terms of `q`, in the unit of `θ`.
    pub fn root(&self) -> [f64; MOST] {
        self.driving.map(|terms| terms.to_array()[0])
    }

    /// The length (s/√m), at most `most`, over which the last two terms of `q` (√m), `w` and `v1` (m/s) stay below these sizes.
    pub fn reach(&self, [q, w, v1]: [f64; 3], most: f64) -> f64 {
        let share = |k: usize| {
            let [of_q, of_v1, ..] = self.driving[k].to_array();
            let [_, of_w, ..] = self.carried[k].to_array();
            (of_q.abs() / q).max(of_w.abs() / w).max(of_v1.abs() / v1)
        };
        let within = |most: f64, k: usize| {
            let share = share(k);
            if share * most.powi(k as i32) <= 1.0 { most } else { share.powf(-1.0 / k as f64).min(most) }
        };
        self.unit * [self.terms - 2, self.terms - 1].into_iter().fold(most / self.unit, within)
    }

    /// Bounds on the first `K` Taylor coefficients in `θ` of all series anywhere in their first `length` (s/√m), by the sizes of all terms.
    pub fn bounds<const K: usize>(&self, length: f64) -> [[f64x4; K]; 3] {
        [&self.driving, &self.forced, &self.carried].map(|series| {
            let (mut terms, length) = (series.map(f64x4::abs), length / self.unit);
            for order in 0..K {
                for k in (order..self.terms - 1).rev() {
                    let above = terms[k + 1];
                    terms[k] += above * length;
                }
            }
            std::array::from_fn(|k| terms[k] * self.unit.powi(-(k as i32)))
        })
    }
}

impl RegularisedContact {
    /// The residual of the series at a moment: the error of its rate of the speed into the wall against the equations, m/s².
    pub fn defect(&self, series: &ContactSeries, theta: f64, moment: &SeriesMoment) -> f64 {
        let [q, w, x1, v1, _] = moment.state;
        let [expected, _] = self.balance(q * q * q, [q * q + self.stretch, w, x1, v1], moment.excitation[0]);
        (series.sum(&series.forced, theta).to_array()[1] - expected).abs()
    }

    /// The [`Change`] over a piece of a series, of length `h` between two of its states, from [`ContactSeries::bounds`].
    pub fn change_in_series(
        &self,
        [driving, forced, carried]: &[[f64x4; 2]; 3],
        h: f64,
        [from, to]: [&RegularisedState; 2],
    ) -> Change {
        let [[_, [q, v1, cos, _]], [[_, rate, a1, _], [z, by_rate, by_a1, cube]], [_, [x1, w, ..]]] =
            [driving, forced, carried].map(|bounds| bounds.map(f64x4::to_array));
        // No number departs from the nearer state by more than half of the piece at its greatest rate.
        let within = |at: &dyn Fn(&RegularisedState) -> f64, slope: f64| {
            let of = 0.5 * h * slope;
            [at(from).abs().max(at(to).abs()) + of, of]
        };
        let (v1, w) = (within(&|y| y[3], v1), within(&|y| y[1], w));
        let turned = 0.5 * h * cos;
        Change {
            states: [within(&|y| y[2], x1), v1, within(&|y| y[0] * y[0] + self.stretch, z), w],
            rates: [v1, [a1, 0.5 * h * by_a1], w, [rate, 0.5 * h * by_rate]],
            root: within(&|y| y[0], q),
            forces: Some(Forces {
                contact: within(&|y| y[0].powi(3), cube),
                turn: if turned == 0.0 { 0.0 } else { turned / self.amplitude },
                kick: self.kick(),
            }),
        }
    }

    /// [`RegularisedContact::growth_of_rates`] over a series, from [`ContactSeries::bounds`].
    pub fn growth_in_series(&self, bounds: &[[f64x4; ORDERS]; 3]) -> [Growth<ORDERS>; 2] {
        let of = |series: usize, lane: usize| bounds[series].map(|bounds| bounds.to_array()[lane]);
        let (x1, v1, w) = (of(CARRIED, 0), of(DRIVING, 1), of(CARRIED, 1));
        let mut stretch = of(FORCED, 0);
        stretch[0] += self.stretch.abs();
        [[x1, v1, stretch, w], [v1, of(FORCED, 2), w, of(FORCED, 1)]]
    }
}
