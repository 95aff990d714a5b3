//! Quantities as polynomials in the state, and bounds on their derivatives: the search for a largest value rests on them.

mod contact;
mod slope;

use super::knot::Jet;
use super::polynomial::{BLOCKS, Polynomial};
use crate::system::{Linear, LinearSystem};
use slope::SlopeInFlight;
use wide::f64x4;

/// `R` over `M h⁶`.
pub const QUINTIC: f64 = 1.0 / 46080.0;

/// A quantity as a polynomial of degree two in the deviation `d = y - y0` from rest, and linear in its rate:
/// `constant + linear · d + rated · d' + Σ weight/2 (row · d)²`.
#[derive(Clone, Copy, Debug)]
pub struct Form<const N: usize> {
    linear: [f64; N],
    rated: Option<RateTerm<N>>,
    squares: [(f64, [f64; N]); 2],
    rest: [f64; N],
    /// Coefficients `[b0, b1, b2]` of a bound in flight, see [`Form::sixth_in_flight`].
    sixth: [f64; 3],
    /// Coefficients of a bound on the second derivative in flight.
    second: [f64; 3],
    /// Coefficients of a bound on the quantity itself, see [`Form::upper_bound`].
    most: [f64; 3],
    slope: SlopeInFlight<N>,
}

/// The part of a quantity that is linear in the rate of the state.
#[derive(Clone, Copy, Debug)]
struct RateTerm<const N: usize> {
    row: [f64; N],
    /// Its magnitude in flight: a weight for the magnitude of each component of the state, and the contribution of the force.
    size: [f64; N],
    force: f64,
    /// Where the contribution of the force is left out: the row of the state that remains in flight, and the weight of the force that is
    /// left out.
    unforced: Option<([f64; N], f64)>,
}

/// `|dᵏ(row · d)/dtᵏ| <= bounds[k][0] e + bounds[k][1]` in flight, wherever the energy norm of `d` is at most `e` (√J).
///
/// From `d⁽ᵏ⁾ = Aᵏ d + Σ_j A^(k-1-j) b (P cos ωt)⁽ʲ⁾`: the dual energy norm of `row Aᵏ`, and the sum of the terms of the force. A force
/// that is linear in time has two terms.
pub fn derivative_bounds<S: LinearSystem<N>, const N: usize, const K: usize>(
    system: &S,
    row: [f64; N],
) -> [[f64; 2]; K] {
    derivative_bounds_of(system, &system.linear(), row)
}

/// [`derivative_bounds`] for a motion with these linear equations.
pub fn derivative_bounds_of<S: LinearSystem<N>, const N: usize, const K: usize>(
    system: &S,
    linear: &Linear<N>,
    row: [f64; N],
) -> [[f64; 2]; K] {
    let amplitude = system.amplitude();
    let dot = |a: &[f64; N], b: &[f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let slope = system.structure().force_bounds()[1];
    let (mut row, mut forced, mut latest) = (row, 0.0, 0.0);
    std::array::from_fn(|_| {
        let bound = [system.dual_energy_norm(&row), amplitude * forced];
        let gain = dot(&row, &linear.input);
        let gain = linear.partner.map_or(gain.abs(), |partner| gain.hypot(dot(&row, &partner)));
        forced = if linear.returns == 0.0 {
            gain + if slope > 0.0 { slope / amplitude * latest } else { 0.0 }
        } else {
            forced * linear.frequency + gain
        };
        latest = gain;
        row = linear.columns.map(|column| dot(&row, &column));
        bound
    })
}

/// Terms of the polynomials of a motion in flight.
const TERMS: usize = 4 * BLOCKS;

/// Binomial coefficients `5! / k! (5 - k)!`.
const FIFTH: [f64; 6] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];

/// A product of bounds: zero if one factor is zero, even if the other is infinite.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// The row that picks a component of the state.
fn unit<const N: usize>(i: usize) -> [f64; N] {
    std::array::from_fn(|j| f64::from(u8::from(i == j)))
}

impl<const N: usize> Form<N> {
    /// `row · d`.
    pub fn linear<S: LinearSystem<N>>(system: &S, row: [f64; N]) -> Self {
        let [_, _, [bend, driven], .., [slope, offset]] = derivative_bounds::<S, N, 7>(system, row);
        let (squares, rest) = ([(0.0, row); 2], system.linear().origin);
        let at_rest = row.iter().zip(rest).map(|(weight, rest)| weight * rest).sum();
        Self {
            most: [at_rest, system.dual_energy_norm(&row), 0.0],
            linear: row,
            rated: None,
            squares,
            rest,
            sixth: [offset, slope, 0.0],
            second: [driven, bend, 0.0],
            slope: SlopeInFlight::new(system, &row, &squares),
        }
    }

    /// `row · d + rated · d'`.
    pub fn rated<S: LinearSystem<N>>(system: &S, row: [f64; N], rated: [f64; N]) -> Self {
        let of_row = Self::linear(system, row);
        let [_, _, _, bends, .., sevenths] = derivative_bounds::<S, N, 8>(system, rated);
        let with = |[b0, b1, b2]: [f64; 3], [slope, offset]: [f64; 2]| [b0 + offset, b1 + slope, b2];
        let (sixth, second) = (with(of_row.sixth, sevenths), with(of_row.second, bends));
        let linear = system.linear();
        let size =
            |of: &[f64; N]| rated.iter().zip(of).map(|(weight, a)| times(weight.abs(), a.abs())).sum::<f64>();
        let rated = RateTerm {
            row: rated,
            size: linear.columns.map(|column| size(&column)),
            force: times(system.amplitude(), size(&linear.input)),
            unforced: None,
        };
        // In a contact it has no bound by the energy alone.
        let most = [f64::INFINITY, 0.0, 0.0];
        Self { rated: Some(rated), sixth, second, most, ..of_row }
    }

    /// The form without the contribution of the force to the rate of the state. Its bounds are those with the force, whose terms all enter
    /// by magnitude; only the sharp bound is that of its own polynomial.
    #[must_use]
    pub fn unforced<S: LinearSystem<N>>(self, system: &S) -> Self {
        let linear = system.linear();
        let row = |of: [f64; N]| linear.columns.map(|column| of.iter().zip(column).map(|(w, a)| w * a).sum());
        let added = |of: [f64; N]| of.iter().zip(linear.input).map(|(w, b)| w * b).sum();
        let rated =
            self.rated.map(|rated| RateTerm { unforced: Some((row(rated.row), added(rated.row))), ..rated });
        Self { rated, ..self }
    }

    /// The largest contribution of the force in flight.
    pub fn size_of_force(&self) -> f64 {
        self.rated.map_or(0.0, |rated| rated.force)
    }

    /// Whether it depends on the rate of the state, and with it on the force.
    #[inline(always)]
    pub fn is_rated(&self) -> bool {
        self.rated.is_some()
    }

    /// `(mass v² + stiffness x²) / 2` of the components `x` and `v = x'` of the deviation from rest.
    ///
    /// It changes at the rate `v G`, with `G = mass v' + stiffness x` the sum of all forces but this spring's; so its sixth derivative is
    /// the fifth of a product, bounded by Leibniz's rule and the bounds of both factors.
    pub fn energy<S: LinearSystem<N>>(system: &S, [mass, stiffness]: [f64; 2], [x, v]: [usize; 2]) -> Self {
        let linear = system.linear();
        let mut force: [f64; N] = std::array::from_fn(|j| mass * linear.columns[j][v]);
        force[x] += stiffness;
        let speeds: [[f64; 2]; 6] = derivative_bounds(system, unit(v));
        let mut forces: [[f64; 2]; 6] = derivative_bounds(system, force);
        let gain = mass * linear.input[v].abs();
        let mut driving = gain * system.amplitude();
        for (order, force) in forces.iter_mut().enumerate() {
            force[1] += driving;
            driving = match order {
                _ if linear.returns != 0.0 => driving * linear.frequency,
                0 => gain * system.structure().force_bounds()[1],
                _ => 0.0,
            };
        }
        // Leibniz's rule for a derivative of the product.
        let derivative = |binomials: &[f64]| {
            let mut sum = [0.0; 3];
            for (k, binomial) in binomials.iter().enumerate() {
                let ([a, b], [c, d]) = (speeds[k], forces[binomials.len() - 1 - k]);
                sum[2] += binomial * times(a, c);
                sum[1] += binomial * (times(a, d) + times(b, c));
                sum[0] += binomial * times(b, d);
            }
            sum
        };
        let (sixth, second) = (derivative(&FIFTH), derivative(&[1.0, 1.0]));
        let (none, squares) = ([0.0; N], [(mass, unit(v)), (stiffness, unit(x))]);
        let slope = SlopeInFlight::new(system, &none, &squares);
        // The structure's energy is a part of the total energy; the paper's energy of the damper is not, because its spring has another
        // deflection.
        let norms = [v, x].map(|i| system.dual_energy_norm(&unit(i)).powi(2));
        let share = if x == 0 { 0.5 } else { 0.5 * (times(mass, norms[0]) + times(stiffness, norms[1])) };
        let most = [0.0, 0.0, share];
        Self { linear: none, rated: None, squares, rest: linear.origin, sixth, second, most, slope }
    }

    /// The quantity and its first two time derivatives in flight, from the derivatives of the motion.
    #[cold]
    pub fn rates(&self, jet: &Jet<N>) -> [f64; 3] {
        let dot =
            |row: &[f64; N], d: &[f64; N]| row.iter().zip(d).map(|(row, d)| times(*row, *d)).sum::<f64>();
        let linear = |order: usize| {
            let rated = self.rated.map_or(0.0, |rated| {
                let added = rated.unforced.map_or(0.0, |(_, added)| added * jet.force[order]);
                dot(&rated.row, &jet.states[order + 1]) - added
            });
            dot(&self.linear, &jet.states[order]) + rated
        };
        let mut rates = [dot(&self.linear, &self.rest) + linear(0), linear(1), linear(2)];
        for (weight, row) in self.squares.iter().filter(|(weight, _)| *weight != 0.0) {
            let [value, slope, curvature] = [0, 1, 2].map(|order| dot(row, &jet.states[order]));
            rates[0] += 0.5 * weight * value * value;
            rates[1] += weight * value * slope;
            rates[2] += weight * (slope * slope + value * curvature);
        }
        rates
    }

    /// A bound on the quantity wherever the energy norm of the state is at most `energy` (√J); NaN or infinite where there is none.
    #[inline(always)]
    pub fn upper_bound(&self, energy: f64) -> f64 {
        let [m0, m1, m2] = self.most;
        m0 + (m1 + m2 * energy) * energy
    }

    /// A bound on the sixth time derivative in flight, wherever the energy norm of the state is at most `energy` (√J).
    #[inline(always)]
    pub fn sixth_in_flight(&self, energy: f64) -> f64 {
        at_energy(self.sixth, energy)
    }

    /// A bound on the second time derivative in flight, as [`Self::sixth_in_flight`].
    #[inline(always)]
    pub fn second_in_flight(&self, energy: f64) -> f64 {
        at_energy(self.second, energy)
    }

    /// The sum of the magnitudes of its terms in flight, which sets its rounding error.
    pub fn size(&self, y: &[f64; N]) -> f64 {
        let size = |row: &[f64; N]| {
            row.iter()
                .zip(y)
                .zip(&self.rest)
                .map(|((r, y), y0)| times(r.abs(), y.abs() + y0.abs()))
                .sum::<f64>()
        };
        // For a square, the rounding error of its root times that root: far below the square of the terms that cancel in it.
        let square = |(weight, row): &(f64, [f64; N])| {
            let (size, deviations) = (size(row), y.iter().zip(&self.rest).map(|(y, y0)| y - y0));
            let root: f64 = row.iter().zip(deviations).map(|(r, d)| times(*r, d)).sum();
            0.5 * weight * size * root.abs().max(f64::EPSILON * size)
        };
        let squares = self.squares.iter().map(square);
        let rated = self.rated.as_ref().map_or(0.0, |rated| size(&rated.size) + rated.force);
        size(&self.linear) + squares.sum::<f64>() + rated
    }

    /// A bound on the deviation of the quantity from the quintic that meets its value, slope and curvature at both ends, over `length`
    /// seconds in which the components of the state are these polynomials in time.
    ///
    /// The quantity is itself a polynomial there, `Σ_j q_j τʲ` with `τ = t / length`; its sixth derivative is at most
    /// `Σ_j |q_j| j! / (j - 6)!`, and `j! / (j - 6)! 46080` is the binomial coefficient `j` over 6, over 64.
    pub fn quintic_error(&self, motion: &[Polynomial<BLOCKS>; N], length: f64) -> f64 {
        let mut q = [0.0; 2 * TERMS];
        self.combined(&self.linear, motion, length).into_iter().zip(&mut q).for_each(|(term, q)| *q += term);
        if let Some(rated) = &self.rated {
            let rated = match &rated.unforced {
                Some((row, _)) => self.combined(row, motion, length),
                None => {
                    let rates = motion.each_ref().map(Polynomial::derivative);
                    Self { rest: [0.0; N], ..*self }.combined(&rated.row, &rates, length)
                }
            };
            rated.into_iter().zip(&mut q).for_each(|(term, q)| *q += term);
        }
        for (weight, row) in self.squares.iter().filter(|(weight, _)| *weight != 0.0) {
            let row = self.combined(row, motion, length);
            for (i, a) in row.into_iter().enumerate() {
                let scaled = 0.5 * weight * a;
                for (k, b) in row.iter().enumerate() {
                    q[i + k] += scaled * b;
                }
            }
        }
        let (mut error, mut binomial) = (0.0, 1.0 / 64.0);
        for (j, q) in q.iter().enumerate().skip(6) {
            error += binomial * q.abs();
            binomial *= (j + 1) as f64 / (j - 5) as f64;
        }
        error
    }

    /// `row · d` as a polynomial in `t / length`.
    fn combined(&self, row: &[f64; N], motion: &[Polynomial<BLOCKS>; N], length: f64) -> [f64; TERMS] {
        let mut sum = [f64x4::ZERO; BLOCKS];
        let mut constant = 0.0;
        for ((weight, motion), rest) in row.iter().zip(motion).zip(&self.rest) {
            constant += weight * (motion.coefficient(0) - rest);
            for (sum, block) in sum.iter_mut().zip(motion.0) {
                *sum += block * *weight;
            }
        }
        let sum = Polynomial(sum).with_constant(constant);
        let mut power = 1.0;
        std::array::from_fn(|k| {
            let term = sum.coefficient(k) * power;
            power *= length;
            term
        })
    }
}

/// A bound with these coefficients at an energy norm.
#[inline(always)]
fn at_energy([b0, b1, b2]: [f64; 3], energy: f64) -> f64 {
    let bound = b0 + (b1 + b2 * energy) * energy;
    if bound.is_nan() { f64::INFINITY } else { bound }
}

#[cfg(test)]
mod tests;
