//! The largest stable step for the eigenvalues of the scenes, measured with each method's own step and predicted by its stability
//! function (E. Hairer & G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. 1996, IV.2 and IV.7).

use crate::panel::{Line, WIDTHS, look, panel, sheet};
use crate::runs::settings;
use crate::scenes::{Case, cases};
use crate::{Any, system};
use nalgebra::{Complex, SMatrix};
use retune_model::{Bare, Side};
use retune_report::colour::BLACK;
use retune_report::{Axis, Shape};
use retune_solver::methods::{Dop853, Euler, Ode23, Ode23s, Ode45, OneStep, Rk4};
use retune_solver::{Contacts, Method, System, Window, simulate};
use std::fmt::Write;
use std::path::Path;

type Matrix = SMatrix<f64, 4, 4>;

/// `y' = A y`.
pub struct Frozen(Matrix);

impl System<4> for Frozen {
    fn derivative(&self, _t: f64, y: &[f64; 4]) -> [f64; 4] {
        (self.0 * nalgebra::Vector4::from_column_slice(y)).into()
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 4]) -> Matrix {
        self.0
    }
    fn time_derivative(&self, _t: f64, _y: &[f64; 4]) -> [f64; 4] {
        [0.0; 4]
    }
}

/// Growth per step tolerated as rounding.
const SLACK: f64 = 1e-7;

/// Whether steps of length `h` grow, by the spectral radius of the step itself.
fn grows<M: OneStep<4>>(frozen: &Frozen, h: f64) -> bool {
    let column = |i: usize| {
        let unit: [f64; 4] = std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
        let end = M::attempt(frozen, 0.0, &unit, &frozen.derivative(0.0, &unit), h).map(|a| a.y);
        nalgebra::Vector4::from(end.unwrap_or([f64::MAX; 4]))
    };
    let step = Matrix::from_columns(&[0, 1, 2, 3].map(column));
    step.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max) > 1.0 + SLACK
}

/// The largest step, in units of `1 / rate`, below which nothing grows; infinite if none up to 40 does.
fn largest(grows: impl Fn(f64) -> bool, rate: f64) -> f64 {
    let Some(first) = (1..8000).map(|k| 0.005 * f64::from(k)).find(|&s| grows(s / rate)) else {
        return f64::INFINITY;
    };
    let (mut low, mut high) = (first - 0.005, first);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if grows(middle / rate) { high = middle } else { low = middle }
    }
    low / rate
}

/// Coefficients of the stability function of an explicit method, from `z⁰` up. Those of DOP853 beyond `z⁸ / 8!` follow from its
/// tableau, `b A^(k-1) 1`.
fn polynomial(method: Method) -> &'static [f64] {
    match method {
        Method::Ode23 => &[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0],
        Method::Rk4 => &[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0],
        Method::Ode45 => &[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 600.0],
        _ => &[
            1.0,
            1.0,
            1.0 / 2.0,
            1.0 / 6.0,
            1.0 / 24.0,
            1.0 / 120.0,
            1.0 / 720.0,
            1.0 / 5040.0,
            1.0 / 40320.0,
            2.6916922001690827e-6,
            2.341345108209781e-7,
            1.494736485459155e-8,
            3.613324578128244e-10,
        ],
    }
}

/// Whether steps of length `h` of semi-implicit Euler grow in theory. It treats positions and velocities differently and has
/// no stability function of one eigenvalue: its step is `I + h A + h² E A`, where `E` gives each position its velocity's rate. (An
/// oscillator of damping ratio ζ alone: `hω <= 2 (√(1 + ζ²) - ζ)`.)
fn euler_grows_in_theory(a: &Matrix, h: f64) -> bool {
    let positions = Matrix::from_fn(|i, j| if i % 2 == 0 { a[(i + 1, j)] } else { 0.0 });
    let step = Matrix::identity() + a * h + positions * (h * h);
    step.complex_eigenvalues().iter().any(|z| z.norm() > 1.0 + SLACK)
}

/// Whether steps of length `h` of any other method grow in theory, for an eigenvalue.
fn grows_in_theory(method: Method, lambda: Complex<f64>, h: f64) -> bool {
    let z = lambda * h;
    let factor = match method {
        Method::Hybrid => return false, // e^z: the exact flow
        Method::Ode23s => {
            let d = 1.0 / (2.0 + std::f64::consts::SQRT_2);
            ((z * (1.0 - 2.0 * d) + 1.0) / (Complex::from(1.0) - z * d).powi(2)).norm()
        }
        _ => polynomial(method).iter().rev().fold(Complex::from(0.0), |sum, c| sum * z + c).norm(),
    };
    factor > 1.0 + SLACK
}

/// A scene linearised at a moment.
pub struct Moment {
    pub name: String,
    pub matrix: Matrix,
}

impl Moment {
    /// The magnitude of its fastest eigenvalue, rad/s.
    pub fn rate(&self) -> f64 {
        self.matrix.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }
}

/// The flight of each scene, and the contacts of two of them at their largest indentation.
pub fn moments() -> Any<Vec<Moment>> {
    let mut all = Vec::new();
    for case in &cases() {
        let Some(system) = system(&case.scene) else {
            let (a, _) = Bare::new(&case.scene.primary, &case.scene.forcing).linear_part();
            // Two copies of the oscillator, since the methods here take four components.
            let matrix = Matrix::from_fn(|i, j| if i / 2 == j / 2 { a[(i % 2, j % 2)] } else { 0.0 });
            all.push(Moment { name: format!("{}, flight", case.label), matrix });
            continue;
        };
        if ["tmd", "two-sided", "near-critical"].contains(&case.name) {
            all.push(Moment { name: format!("{}, flight", case.label), matrix: system.linear_part().0 });
        }
        if ["two-sided", "near-rigid"].contains(&case.name) {
            all.push(deepest(case, &system)?);
        }
    }
    all.sort_by(|a, b| a.rate().total_cmp(&b.rate()));
    Ok(all)
}

/// The contact with the structure at its largest force.
fn deepest(case: &Case, system: &retune_model::Coupled) -> Any<Moment> {
    let tight = settings(Method::Hybrid, Contacts::Located, 1e-10);
    let force = simulate(&case.scene, Window { from: 0.0, to: case.to }, &tight)?.force_max[0];
    let depth = (force / system.hertz(Side::Primary)).powf(2.0 / 3.0);
    let matrix = system.jacobian(&[0.0, 0.0, -depth, 0.0]);
    Ok(Moment { name: format!("{}, contact {:.1e} m deep", case.label, depth), matrix })
}

/// A largest stable step.
pub struct Stable {
    pub method: Method,
    /// Measured on the method's own step, s.
    pub measured: f64,
    /// By its stability function, s.
    pub theory: f64,
}

/// The largest stable steps of every method at a moment.
pub fn stable(moment: &Moment) -> Vec<Stable> {
    let (frozen, rate) = (Frozen(moment.matrix), moment.rate());
    let eigenvalues = moment.matrix.complex_eigenvalues();
    let measure = |method| {
        let measured = match method {
            Method::Hybrid => f64::INFINITY,
            Method::Ode23s => largest(|h| grows::<Ode23s>(&frozen, h), rate),
            Method::Ode45 => largest(|h| grows::<Ode45>(&frozen, h), rate),
            Method::Ode23 => largest(|h| grows::<Ode23>(&frozen, h), rate),
            Method::Dop853 => largest(|h| grows::<Dop853>(&frozen, h), rate),
            Method::Rk4 => largest(|h| grows::<Rk4>(&frozen, h), rate),
            Method::Euler => largest(|h| grows::<Euler>(&frozen, h), rate),
        };
        let theory = match method {
            Method::Euler => largest(|h| euler_grows_in_theory(&moment.matrix, h), rate),
            _ => largest(|h| eigenvalues.iter().any(|&l| grows_in_theory(method, l, h)), rate),
        };
        Stable { method, measured, theory }
    };
    Method::ALL.into_iter().map(measure).collect()
}

/// The table, and its chart.
pub fn table(chart: &Path) -> Any<String> {
    let mut text = String::from("moment,fastest_rate_rad_per_s,method,measured_s,theory_s\n");
    let moments = moments()?;
    let steps: Vec<(f64, Vec<Stable>)> = moments.iter().map(|m| (m.rate(), stable(m))).collect();
    for (moment, (rate, list)) in moments.iter().zip(&steps) {
        for s in list {
            let name = moment.name.replace(',', ";");
            writeln!(text, "{name},{rate:.4},{},{:.5e},{:.5e}", s.method.name(), s.measured, s.theory)?;
        }
    }
    draw(chart, &steps)?;
    Ok(text)
}

fn draw(path: &Path, steps: &[(f64, Vec<Stable>)]) -> Any<()> {
    let mut lines = Vec::new();
    for method in [Method::Ode45, Method::Ode23, Method::Dop853, Method::Rk4, Method::Euler] {
        let of = |pick: fn(&Stable) -> f64| -> Vec<(f64, f64)> {
            steps
                .iter()
                .filter_map(|(rate, list)| Some((*rate, pick(list.iter().find(|s| s.method == method)?))))
                .filter(|p| p.1.is_finite())
                .collect()
        };
        let (colour, _, shape) = look(method);
        lines.push(Line::new(method.name(), of(|s| s.measured), (colour, WIDTHS[0], shape)));
        let theory =
            Line { shape: Some(Shape::Ring), ..Line::new("", of(|s| s.theory), (BLACK, 0.0, shape)) };
        lines.push(theory);
    }
    let panels = vec![panel(
        "",
        Axis::log("fastest eigenvalue of the scene, rad/s", (1.0, 1e5)),
        Axis::log("largest stable step, s", (1e-5, 10.0)),
        lines,
        180.0,
    )];
    let note = "Points: measured on the method's own step. Rings: by its stability function.";
    let more = "Left: flight; right: contacts frozen at their deepest. The hybrid's flight is exact and ode23s is L-stable: no limit.";
    sheet(path, "Which steps are stable", &[note, more], 1, panels)
}
