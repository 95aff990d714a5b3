//! The equations of a periodic motion, by multiple shooting, and their solution by Newton's iteration.

use super::forced::{Damped, Flow, Forced, settings_of};
use crate::parameter::Error;
use crate::record::weights;
use nalgebra::{DMatrix, DVector, Matrix4, Matrix6, Vector4};
use retune_model::{Coupled, NonNegative, Parameter, Scene};
use retune_solver::Settings;

/// Largest gap between segments of a solution, relative to the size of the motion.
const CLOSED: f64 = 2e-11;
/// Most Newton iterations. They converge fast or not at all.
const ITERATIONS: usize = 9;
/// A change larger than this share of the motion leaves the neighbourhood in which the iteration can be trusted.
const FAR: f64 = 0.5;
/// The stiffness given to a damper without a spring, as a share of `m2 ω²`. Without it a motion that touches no wall can be shifted freely,
/// so it is neither stable nor isolated; with it the motion about the place of rest is. Any other motion changes by about this share of its
/// size.
const FLOATING: f64 = 1e-8;

/// The equations of motions with a number of periods of the force, along a parameter.
///
/// Their unknowns are the states at the beginnings of the segments, in units of the motion's size, and the parameter in units of `span`.
#[derive(Clone, Debug)]
pub struct Shooting<S = Damped> {
    /// The system and the parameter.
    pub forced: S,
    /// Periods of the force.
    pub periods: usize,
    /// Number of segments.
    pub segments: usize,
    /// The unit of the parameter.
    pub span: f64,
    /// Factors that scale the state.
    pub scale: Vector4<f64>,
    /// Whether the damper has no spring of its own.
    pub is_floating: bool,
}

/// The equations at some unknowns.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// The gaps between the segments.
    pub gaps: DVector<f64>,
    /// Their derivatives by the unknowns.
    pub jacobian: DMatrix<f64>,
    /// The derivative of the state at the end of each segment by that at its beginning, in units.
    pub transitions: Vec<Matrix4<f64>>,
}

/// A solution.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The unknowns.
    pub x: DVector<f64>,
    /// The equations there.
    pub at: Linearised,
    /// Iterations that it took.
    pub iterations: usize,
}

impl Shooting {
    /// The equations of motions of a damper of about the size `size` (√J, see [`crate::record::coordinates`]), with one segment a period. A
    /// damper without a spring is given a tiny one.
    pub fn new(
        mut scene: Scene,
        parameter: Parameter,
        periods: usize,
        (span, size): (f64, f64),
        settings: &Settings,
    ) -> Self {
        let scale = Vector4::from(weights(&scene)) / size;
        let omega = scene.forcing.frequency.get();
        let is_floating = scene.damper.is_some_and(|damper| damper.is_floating());
        if let Some(damper) = scene.damper.as_mut().filter(|_| is_floating) {
            let spring = NonNegative::new(FLOATING * damper.mass.get() * omega * omega);
            damper.stiffness = spring.unwrap_or(damper.stiffness);
        }
        let forced = Damped { scene, parameter, settings: settings_of(settings) };
        Self { forced, periods, segments: periods, span, scale, is_floating }
    }

    /// The equations along another parameter, at a value of this one.
    ///
    /// # Errors
    /// The value is out of range.
    pub fn along(&self, value: f64, parameter: Parameter, span: f64) -> Result<Self, Error> {
        let forced = Damped { scene: self.scene_at(value)?, parameter, ..self.forced };
        Ok(Self { forced, span, ..self.clone() })
    }

    /// The scene at a value of the parameter.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn scene_at(&self, value: f64) -> Result<Scene, Error> {
        self.forced.scene_at(value)
    }

    /// The system at a value of the parameter.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn system(&self, value: f64) -> Result<Coupled, Error> {
        self.forced.system(value)
    }

    /// The settings of the runs.
    pub fn settings(&self) -> &Settings {
        &self.forced.settings
    }
}

impl<S: Forced> Shooting<S> {
    /// The equations for another number of periods, with as many segments.
    #[must_use]
    pub fn of_periods(&self, periods: usize) -> Self {
        Self { periods, segments: periods, ..self.clone() }
    }

    /// The equations with another number of segments.
    #[must_use]
    pub fn in_segments(&self, segments: usize) -> Self {
        Self { segments, ..self.clone() }
    }

    /// The unknowns for the states at the beginnings of the segments and a value of the parameter.
    pub fn unknowns(&self, states: &[[f64; 4]], value: f64) -> DVector<f64> {
        let scaled = states.iter().flat_map(|y| (0..4).map(|i| y[i] * self.scale[i]));
        DVector::from_iterator(4 * states.len() + 1, scaled.chain([value / self.span]))
    }

    /// The parameter's value in unknowns.
    pub fn value(&self, x: &DVector<f64>) -> f64 {
        x[4 * self.segments] * self.span
    }

    /// The states in unknowns.
    pub fn states(&self, x: &DVector<f64>) -> Vec<[f64; 4]> {
        (0..self.segments).map(|k| std::array::from_fn(|i| x[4 * k + i] / self.scale[i])).collect()
    }

    /// The norm of a vector of unknowns: a root mean square over the segments, and the parameter.
    pub fn norm(&self, x: &DVector<f64>) -> f64 {
        self.inner(x, x).sqrt()
    }

    /// The inner product of [`Self::norm`].
    pub fn inner(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        let last = 4 * self.segments;
        let states: f64 = (0..last).map(|i| a[i] * b[i]).sum();
        states / self.segments as f64 + a[last] * b[last]
    }

    /// The shift in segments that brings `b` nearest to `a`, and the largest difference of their states then: a motion of several periods
    /// may begin at any crest of the force.
    pub fn nearest(&self, a: &DVector<f64>, b: &DVector<f64>) -> (usize, f64) {
        let n = 4 * self.segments;
        let gap = |shift: usize| (0..n).map(|i| (a[i] - b[(i + 4 * shift) % n]).abs()).fold(0.0, f64::max);
        let all = self.crests().map(|shift| (shift, gap(shift)));
        all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
    }

    /// The segments that begin at a crest of the force; only the first if the periods do not all have equally many segments.
    pub fn crests(&self) -> impl Iterator<Item = usize> + use<S> {
        let whole = self.segments.is_multiple_of(self.periods);
        (0..self.segments).step_by(if whole { self.segments / self.periods } else { self.segments })
    }

    /// Unknowns or a direction, shifted cyclically by `shift` segments.
    pub fn shifted(&self, x: &DVector<f64>, shift: usize) -> DVector<f64> {
        let n = 4 * self.segments;
        DVector::from_fn(n + 1, |i, _| if i < n { x[(i + 4 * shift) % n] } else { x[n] })
    }

    /// The equations and their derivatives.
    ///
    /// # Errors
    /// The system cannot be run there.
    pub fn linearised(&self, x: &DVector<f64>) -> Result<Linearised, Error> {
        let (m, states) = (self.segments, self.states(x));
        let mut gaps = DVector::zeros(4 * m);
        let mut jacobian = DMatrix::zeros(4 * m, 4 * m + 1);
        let mut transitions = Vec::with_capacity(m);
        let flows = self.forced.flows(self.value(x), self.periods, &states)?;
        for (k, Flow { end, by_state, by_value }) in flows.into_iter().enumerate() {
            let next = (k + 1) % m;
            let transition = Matrix4::from_fn(|i, j| by_state[(i, j)] * self.scale[i] / self.scale[j]);
            for i in 0..4 {
                gaps[4 * k + i] = (end[i] - states[next][i]) * self.scale[i];
                jacobian[(4 * k + i, 4 * m)] = by_value[i] * self.scale[i] * self.span;
                jacobian[(4 * k + i, 4 * next + i)] -= 1.0;
                for j in 0..4 {
                    jacobian[(4 * k + i, 4 * k + j)] += transition[(i, j)];
                }
            }
            transitions.push(transition);
        }
        Ok(Linearised { gaps, jacobian, transitions })
    }

    /// The solution nearest to `start` in the plane through it whose normal is `normal`; none if Newton's iteration does not find one.
    pub fn correct(&self, start: &DVector<f64>, normal: &DVector<f64>) -> Option<Solution> {
        let mut x = start.clone();
        let mut before = f64::INFINITY;
        for iterations in 0..=ITERATIONS {
            let at = self.linearised(&x).ok()?;
            let change = self.change(&at, normal, self.inner(normal, &(&x - start)))?;
            let size = self.norm(&change);
            if at.gaps.amax() <= CLOSED {
                // The last change is free: its derivatives are known.
                x += change;
                return Some(Solution { x, at, iterations });
            }
            if !size.is_finite() || size > FAR || (iterations > 3 && size > before) {
                return None;
            }
            before = size;
            x += change;
        }
        None
    }

    /// The solution at the value of the parameter in `start`.
    pub fn correct_at_value(&self, start: &DVector<f64>) -> Option<Solution> {
        self.correct(start, &self.by_value())
    }

    /// Newton's change of the unknowns at a fixed value of the parameter.
    pub fn change_at_value(&self, x: &DVector<f64>) -> Option<DVector<f64>> {
        self.change(&self.linearised(x).ok()?, &self.by_value(), 0.0)
    }

    /// Newton's change for the equations `at`, with the distance `out` of the unknowns from the plane with this normal.
    fn change(&self, at: &Linearised, normal: &DVector<f64>, out: f64) -> Option<DVector<f64>> {
        let mut right = at.gaps.clone().insert_row(4 * self.segments, out);
        right.neg_mut();
        self.bordered(&at.jacobian, normal).lu().solve(&right)
    }

    /// The direction of the parameter alone.
    pub(super) fn by_value(&self) -> DVector<f64> {
        let last = 4 * self.segments;
        DVector::from_fn(last + 1, |i, _| f64::from(u8::from(i == last)))
    }

    /// The direction of the branch through a solution, of length 1, on the side of `before`; and the determinant of the equations with that direction
    /// as their last row, which changes sign where another branch crosses and not at a fold.
    pub fn tangent(&self, at: &Linearised, before: &DVector<f64>) -> Option<(DVector<f64>, f64)> {
        let lu = self.bordered(&at.jacobian, before).lu();
        let direction = lu.solve(&self.by_value())?;
        let length = self.norm(&direction);
        // The determinant is linear in its last row, and `before · direction` is 1.
        length.is_finite().then(|| (direction / length, lu.determinant() * length))
    }

    /// The Jacobian with one more row: the plane whose normal is `normal`.
    fn bordered(&self, jacobian: &DMatrix<f64>, normal: &DVector<f64>) -> DMatrix<f64> {
        let last = 4 * self.segments;
        let row = |j: usize| if j < last { normal[j] / self.segments as f64 } else { normal[j] };
        DMatrix::from_fn(last + 1, last + 1, |i, j| if i < last { jacobian[(i, j)] } else { row(j) })
    }
}

impl Linearised {
    /// The derivative of the state after all periods by the first one, in units.
    pub fn monodromy(&self) -> Matrix4<f64> {
        self.transitions.iter().fold(Matrix4::identity(), |product, transition| transition * product)
    }

    /// The second compound of the monodromy matrix: its eigenvalues are the products of two multipliers. Computed as a product of
    /// compounds, it is accurate to rounding even for a large and a small multiplier, which the multipliers themselves are not.
    pub fn compound(&self) -> Matrix6<f64> {
        const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        let minor = |m: &Matrix4<f64>, [i, j]: [usize; 2], [k, l]: [usize; 2]| {
            m[(i, k)] * m[(j, l)] - m[(i, l)] * m[(j, k)]
        };
        let compound = |m: &Matrix4<f64>| Matrix6::from_fn(|row, column| minor(m, PAIRS[row], PAIRS[column]));
        self.transitions
            .iter()
            .fold(Matrix6::identity(), |product, transition| compound(transition) * product)
    }
}
