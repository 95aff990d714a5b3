//! Stationary random motion of the linear scenes, without a damper or with one that has no walls: its mean energy and root mean squares
//! under a one-sided spectral density.
//!
//! Under white noise the covariance `P` of the state solves the Lyapunov equation `A P + P Aᵀ + π S B Bᵀ = 0`. Under a density in a table
//! each mean square is `∫ |H(ω)|² S(ω) dω` over the table, by the rule of Gauss and Kronrod on pieces that are halved until their two sums
//! agree.

mod integral;

use crate::{Course, Damper, History, Of, Primary, Rms, Scene, Spectrum};
use nalgebra::{Complex, SMatrix, SVector};
use std::f64::consts::PI;

/// A stationary random motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stationary {
    /// Mean squares of x1, v1, a1, k1 x1 + c1 v1 and the spring's deflection.
    squares: Squares,
    /// k1 and m1.
    weights: [f64; 2],
    /// Relative difference of the two sums of the integral; 0 for white noise.
    pub error: f64,
}

/// Mean squares of x1, v1, a1, k1 x1 + c1 v1 and the spring's deflection, or of their parts at a frequency.
type Squares = [f64; 5];

impl Stationary {
    /// The motion of a scene under the spectrum of its forcing; the sums of the integral agree to `tolerance`. None where it has no
    /// spectrum, or where the motion never becomes stationary: a mode without damping, or a damper without a spring.
    pub fn new(scene: &Scene, tolerance: f64) -> Option<Self> {
        let History { of, course: course @ Course::Made(made) } = scene.forcing.history()? else {
            return None;
        };
        let (recipe, spectrum) = (made.recipe(), course.spectrum()?);
        let linear = Linear::new(&scene.primary, scene.damper.as_ref(), *of);
        let size = recipe.unit.1 * recipe.unit.1;
        let (squares, error) = match spectrum.white_density() {
            Some(density) => (linear.under_white(size * density)?, 0.0),
            None => {
                linear.under(spectrum, tolerance).map(|(all, error)| (all.map(|one| size * one), error))?
            }
        };
        let weights = [scene.primary.stiffness.get(), scene.primary.mass.get()];
        Some(Self { squares, weights, error })
    }

    /// A root mean square, or the mean energy, in the SI unit; infinite for the acceleration under white noise on the structure itself.
    pub fn get(&self, rms: Rms) -> f64 {
        let [x1, v1, a1, ground, stroke] = self.squares;
        match rms {
            Rms::Energy => 0.5 * (self.weights[0] * x1 + self.weights[1] * v1),
            Rms::Displacement => x1.sqrt(),
            Rms::Velocity => v1.sqrt(),
            Rms::Acceleration => a1.sqrt(),
            Rms::GroundForce => ground.sqrt(),
            Rms::Stroke => stroke.sqrt(),
        }
    }
}

/// Equation (1) without contacts, under a force on the structure or on an accelerated base.
struct Linear {
    m1: f64,
    c1: f64,
    k1: f64,
    /// m2, k2 and c2.
    damper: Option<[f64; 3]>,
    on_base: bool,
}

impl Linear {
    fn new(primary: &Primary, damper: Option<&Damper>, of: Of) -> Self {
        Self {
            m1: primary.mass.get(),
            c1: primary.damping.get(),
            k1: primary.stiffness.get(),
            damper: damper.map(|damper| [damper.mass.get(), damper.stiffness.get(), damper.damping.get()]),
            on_base: of == Of::BaseAcceleration,
        }
    }

    /// The squares of the sizes of the outputs for a harmonic input of size 1 at an angular frequency, rad/s.
    fn squares_at(&self, omega: f64) -> Squares {
        let &Self { m1, c1, k1, damper, on_base } = self;
        let omega2 = omega * omega;
        let ground = Complex::new(k1, omega * c1);
        // In coordinates that move with the base every mass m feels the force -m times the base's acceleration.
        let driven = if on_base { -m1 } else { 1.0 };
        let (x1, stroke) = match damper {
            None => (driven / (ground - m1 * omega2), Complex::new(0.0, 0.0)),
            Some([m2, k2, c2]) => {
                let spring = Complex::new(k2, omega * c2);
                let dynamic = spring - m2 * omega2;
                let carried = if on_base { -m2 } else { 0.0 };
                let primary = ground + spring - m1 * omega2;
                let determinant = primary * dynamic - spring * spring;
                let x1 = (dynamic * driven + spring * carried) / determinant;
                let x2 = (primary * carried + spring * driven) / determinant;
                (x1, x2 - x1)
            }
        };
        let a1 = -omega2 * x1 + if on_base { 1.0 } else { 0.0 };
        let x2 = x1.norm_sqr();
        [x2, omega2 * x2, a1.norm_sqr(), (ground * x1).norm_sqr(), stroke.norm_sqr()]
    }

    /// Mean squares under a tabulated density, with the measured error.
    fn under(&self, spectrum: &Spectrum, tolerance: f64) -> Option<(Squares, f64)> {
        let of_damper = self.damper.map(|[m2, k2, _]| (k2 / m2).sqrt());
        let resonances = [Some((self.k1 / self.m1).sqrt()), of_damper];
        let mut nodes: Vec<f64> = spectrum.omega.iter().map(|omega| omega.get()).collect();
        let [from, to] = spectrum.ends();
        nodes.extend(resonances.into_iter().flatten().filter(|omega| *omega > from && *omega < to));
        nodes.sort_by(f64::total_cmp);
        let part = |omega: f64| {
            let density = spectrum.density_at(omega);
            self.squares_at(omega).map(|square| density * square)
        };
        integral::integral(part, &nodes, tolerance)
    }

    /// Mean squares under white noise of one-sided density `density`, whose covariance is `π S δ(τ)`.
    fn under_white(&self, density: f64) -> Option<Squares> {
        let &Self { m1, c1, k1, damper, on_base } = self;
        let intensity = PI * density;
        let by = if on_base { -1.0 } else { 1.0 / m1 };
        let at_once = if on_base { 0.0 } else { f64::INFINITY };
        let Some([m2, k2, c2]) = damper else {
            // S. H. Crandall and W. D. Mark, Random Vibration in Mechanical Systems, 1963, section 2.2.
            let v1 = intensity * by * by * m1 / (2.0 * c1);
            let x1 = v1 * m1 / k1;
            let ground = k1 * k1 * x1 + c1 * c1 * v1;
            let a1 = ground / (m1 * m1) + if density > 0.0 { at_once } else { 0.0 };
            return [x1, v1].iter().all(|one| one.is_finite()).then_some([x1, v1, a1, ground, 0.0]);
        };
        // The state is x1 and x2 - x1 - D, both times a frequency, and their rates, so that all have one unit.
        let unit = ((k1 + k2) / m1).sqrt();
        let acceleration = [-k1 / (m1 * unit), -c1 / m1, k2 / (m1 * unit), c2 / m1];
        let relative = [0.0, 0.0, -k2 / (m2 * unit), -c2 / m2];
        let mut a = SMatrix::<f64, 4, 4>::zeros();
        (a[(0, 1)], a[(2, 3)]) = (unit, unit);
        for j in 0..4 {
            a[(1, j)] = acceleration[j];
            a[(3, j)] = relative[j] - acceleration[j];
        }
        let carried = if on_base { -1.0 } else { 0.0 };
        let driven = SVector::from([0.0, by, 0.0, carried - by]);
        let covariance = lyapunov(&a, &(driven * driven.transpose() * intensity))?;
        let square = |of: [f64; 4]| {
            let of = SVector::from(of);
            (of.transpose() * covariance * of)[(0, 0)]
        };
        let x1 = covariance[(0, 0)] / (unit * unit);
        let stroke = covariance[(2, 2)] / (unit * unit);
        let felt = square(acceleration) + if density > 0.0 { at_once } else { 0.0 };
        let all = [x1, covariance[(1, 1)], felt, square([k1 / unit, c1, 0.0, 0.0]), stroke];
        [x1, stroke, all[1]].iter().all(|one| one.is_finite() && *one >= 0.0).then_some(all)
    }
}

/// The symmetric `P` of `A P + P Aᵀ + Q = 0`, by its ten equations; none where they have no solution.
fn lyapunov(a: &SMatrix<f64, 4, 4>, q: &SMatrix<f64, 4, 4>) -> Option<SMatrix<f64, 4, 4>> {
    const PAIRS: [(usize, usize); 10] =
        [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];
    let place = |i: usize, j: usize| PAIRS.iter().position(|pair| *pair == (i.min(j), i.max(j))).unwrap_or(0);
    let mut equations = SMatrix::<f64, 10, 10>::zeros();
    let mut right = SVector::<f64, 10>::zeros();
    for (row, (i, j)) in PAIRS.into_iter().enumerate() {
        right[row] = -q[(i, j)];
        for k in 0..4 {
            equations[(row, place(k, j))] += a[(i, k)];
            equations[(row, place(i, k))] += a[(j, k)];
        }
    }
    let found = equations.lu().solve(&right)?;
    Some(SMatrix::from_fn(|i, j| found[place(i, j)]))
}
