//! Measures of single weaknesses: stable steps, energy over many impacts, contacts jumped over, the objective's own scatter.

use crate::own;
use crate::scenes::{Case, SSVI, scene};
use nalgebra::SMatrix;
use retune_model::{Coupled, NonNegative, Side};
use retune_solver::dop853::Dop853;
use retune_solver::euler::Euler;
use retune_solver::observe::{Observer, Segment};
use retune_solver::ode23::Ode23;
use retune_solver::ode23s::Ode23s;
use retune_solver::ode45::Ode45;
use retune_solver::onestep::{OneStep, Run};
use retune_solver::rk4::Rk4;
use retune_solver::{Contacts, Hybrid, Method, Motion, Phase, Settings, System, Window, e1_max, simulate};
use std::error::Error;
use std::fmt::Write;

/// `y' = A y` with eigenvalues `±i` (an oscillator at rate 1) or `-1` twice.
struct Test {
    oscillates: bool,
}

impl System<2> for Test {
    fn derivative(&self, _t: f64, y: &[f64; 2]) -> [f64; 2] {
        if self.oscillates { [y[1], -y[0]] } else { [-y[0], -y[1]] }
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        let rows = if self.oscillates { [0.0, 1.0, -1.0, 0.0] } else { [-1.0, 0.0, 0.0, -1.0] };
        SMatrix::<f64, 2, 2>::from_row_slice(&rows)
    }
    fn time_derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
}

/// Spectral radius of one step of length `h`.
fn radius<M: OneStep<2>>(test: &Test, h: f64) -> f64 {
    let image =
        |y: [f64; 2]| M::attempt(test, 0.0, &y, &test.derivative(0.0, &y), h).map_or([f64::NAN; 2], |a| a.y);
    let ([a, c], [b, d]) = (image([1.0, 0.0]), image([0.0, 1.0]));
    let (half, det) = (0.5 * (a + d), a * d - b * c);
    let disc = half * half - det;
    if disc < 0.0 { det.sqrt() } else { half.abs() + disc.sqrt() }
}

/// The largest `h` (in units of the inverse eigenvalue) up to which steps do not grow; infinite if 1e6 does not.
fn stable<M: OneStep<2>>(oscillates: bool) -> f64 {
    let test = Test { oscillates };
    let grows = |h: f64| radius::<M>(&test, h) > 1.0 + 1e-7;
    match (1..2000).map(|k| 0.01 * f64::from(k)).find(|&h| grows(h)) {
        Some(h) if h < 0.02 => 0.0,
        Some(h) => {
            let (mut low, mut high) = (h - 0.01, h);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if grows(middle) { high = middle } else { low = middle }
            }
            low
        }
        None => f64::INFINITY,
    }
}

/// Largest stable steps measured, beside theory where it is in the books (Hairer & Wanner II, IV.2), and the steps they
/// mean at a contact of the SSVI frozen at its deepest.
///
/// # Errors
/// A number that cannot be.
pub fn stable_steps() -> Result<String, Box<dyn Error>> {
    let scene = scene(SSVI)?;
    let damper = scene.damper.ok_or("no damper")?;
    let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
    let frozen =
        |z: f64| (1.5 * system.hertz(Side::Primary) * z.sqrt() * system.inverse_effective_mass()).sqrt();
    let rate = frozen(2e-3);
    let mut text = format!(
        "method,imaginary_axis,theory,real_axis,theory,step_at_frozen_contact_s\n# a contact pressed in by 2 mm oscillates at {rate:.0} rad/s\n"
    );
    for (name, imaginary, i_theory, real, r_theory) in [
        ("hybrid", f64::INFINITY, "unbounded (exact flow)", f64::INFINITY, "unbounded (exact flow)"),
        (
            "ode23s",
            stable::<Ode23s>(true),
            "unbounded (L-stable)",
            stable::<Ode23s>(false),
            "unbounded (L-stable)",
        ),
        ("ode23", stable::<Ode23>(true), "1.7321", stable::<Ode23>(false), "2.5127"),
        ("ode45", stable::<Ode45>(true), "about 1.0", stable::<Ode45>(false), "3.3066"),
        ("dop853", stable::<Dop853>(true), "", stable::<Dop853>(false), "about 6"),
        ("rk4", stable::<Rk4>(true), "2.8284", stable::<Rk4>(false), "2.7853"),
        ("euler", stable::<Euler>(true), "2", f64::NAN, "not defined"),
    ] {
        writeln!(text, "{name},{imaginary:.4},{i_theory},{real:.4},{r_theory},{:.2e}", imaginary / rate)?;
    }
    Ok(text)
}

struct Touched(u64);

impl Observer<4> for Touched {
    fn segment(&mut self, _segment: &impl Segment<4>) {}
    fn touch_down(&mut self, _t: f64, _side: Side) {
        self.0 += 1;
    }
}

/// Relative change of the true mechanical energy over at least 1,000 conservative impacts, by method and setting.
///
/// # Errors
/// A number that cannot be.
pub fn energy_drift() -> Result<String, Box<dyn Error>> {
    let mut scene = scene(SSVI)?;
    scene.primary.damping = NonNegative::new(0.0)?;
    scene.forcing.amplitude = NonNegative::new(0.0)?;
    let mut damper = scene.damper.ok_or("no damper")?;
    damper.damping = NonNegative::new(0.0)?;
    let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
    let (start, to) = ([0.0, 0.0, 0.06, 4.0], 110.0);
    let energy = system.total_energy(&start);
    let mut text = String::from("method,contacts,setting,impacts,energy_change,failure\n");
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let mut seen = Touched(0);
        let begin = Motion { t: 0.0, y: start, phase: Phase::Flight };
        let end = Hybrid::new(&system, rtol, to, 10_000_000).propagate(begin, to, &mut seen)?;
        writeln!(
            text,
            "hybrid,exact,{rtol:e},{},{:.2e},",
            seen.0,
            system.total_energy(&end.y) / energy - 1.0
        )?;
    }
    let both: &[(Contacts, &str)] = &[(Contacts::Located, "located"), (Contacts::Stepped, "stepped")];
    let mut line = |name: &str, method, settings: &[f64], follow: Follow<'_>| -> Result<(), Box<dyn Error>> {
        for &(contacts, way) in both {
            for &value in settings {
                let settings = Settings { max_steps: 3_000_000, ..own::settings(method, contacts, value) };
                let mut seen = Touched(0);
                let mut run = Run::new(&system, &settings, 0.0, start, settings.longest_step(to));
                let (change, said) = match follow(&mut run, to, &mut seen) {
                    Ok(()) => {
                        (format!("{:.2e}", system.total_energy(&run.state()) / energy - 1.0), String::new())
                    }
                    Err(error) => (String::new(), error.to_string().replace(',', ";")),
                };
                writeln!(text, "{name},{way},{value:e},{},{change},{said}", seen.0)?;
            }
        }
        Ok(())
    };
    line("ode45", Method::Ode45, &[1e-3, 1e-5, 1e-7, 1e-9], &|run, to, seen| {
        run.integrate::<Ode45>(to, seen)
    })?;
    line("dop853", Method::Dop853, &[1e-3, 1e-6, 1e-9, 1e-12], &|run, to, seen| {
        run.integrate::<Dop853>(to, seen)
    })?;
    line("ode23", Method::Ode23, &[1e-3, 1e-5, 1e-7], &|run, to, seen| run.integrate::<Ode23>(to, seen))?;
    line("ode23s", Method::Ode23s, &[1e-3, 1e-5, 1e-7], &|run, to, seen| run.integrate::<Ode23s>(to, seen))?;
    line("rk4", Method::Rk4, &[1e-2, 1e-3, 1e-4], &|run, to, seen| run.integrate::<Rk4>(to, seen))?;
    line("euler", Method::Euler, &[1e-2, 1e-3, 1e-4], &|run, to, seen| run.integrate::<Euler>(to, seen))?;
    Ok(text)
}

type Follow<'f> =
    &'f dyn Fn(&mut Run<'_, Coupled, 4>, f64, &mut Touched) -> Result<(), retune_solver::SolverError>;

/// Share of the impacts of the two-sided SSVI (10 s) that a method did not count, against the longest step it may take.
///
/// # Errors
/// A number that cannot be, or a reference that failed.
pub fn missed_contacts() -> Result<String, Box<dyn Error>> {
    let case = Case { name: "two-sided", label: "", scene: scene(SSVI)?, to: 10.0 };
    let expected = own::run(&case, &own::settings(Method::Hybrid, Contacts::Located, 1e-12), false)?.impacts;
    let mut text = String::from("method,contacts,longest_step_s,impacts,expected,missed_share,said\n");
    for method in Method::ALL {
        for (contacts, way) in [(Contacts::Located, "located"), (Contacts::Stepped, "stepped")] {
            for step in [1e-3, 3e-3, 1e-2, 3e-2, 1e-1] {
                let settings = Settings {
                    method,
                    contacts,
                    rtol: 1e-3,
                    atol: 1e-6,
                    step: Some(step),
                    ..Settings::default()
                };
                let name = format!("{method:?}").to_lowercase();
                match simulate(&case.scene, Window { from: 0.0, to: case.to }, &settings) {
                    Ok(found) => {
                        let impacts = (found.impacts[0] + found.impacts[1]) as usize;
                        let missed = 1.0 - impacts as f64 / expected as f64;
                        writeln!(text, "{name},{way},{step},{impacts},{expected},{missed:.3},")?;
                    }
                    Err(error) => writeln!(
                        text,
                        "{name},{way},{step},,{expected},,{}",
                        error.to_string().replace(',', ";")
                    )?,
                }
            }
        }
    }
    Ok(text)
}

/// How E1max of Table 2's SSVI (whole run, 100 s) moves with the tolerance, and over ±0.1 % of (k2, c2, D, C).
///
/// # Errors
/// A run that failed, or a number that cannot be.
pub fn objective() -> Result<String, Box<dyn Error>> {
    let window = Window { from: 0.0, to: 100.0 };
    let mut text = String::from("what,setting,E1max_J\n");
    for rtol in (4..=12).map(|k| 10f64.powi(-k)) {
        let found = e1_max(
            &scene(SSVI)?,
            window,
            &own::settings(Method::Hybrid, Contacts::Located, rtol),
            f64::INFINITY,
        )?;
        writeln!(text, "hybrid,{rtol:e},{:.8}", found.value)?;
    }
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6] {
        let found = e1_max(
            &scene(SSVI)?,
            window,
            &own::settings(Method::Ode23s, Contacts::Stepped, rtol),
            f64::INFINITY,
        )?;
        writeln!(text, "ode23s stepped,{rtol:e},{:.8}", found.value)?;
    }
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for k in 0..81 {
        let factor = |place: i32| 1.0 + 1e-3 * f64::from(k / 3_i32.pow(place as u32) % 3 - 1);
        let numbers = crate::scenes::Numbers {
            k2: SSVI.k2 * factor(0),
            c2: SSVI.c2 * factor(1),
            d: SSVI.d * factor(2),
            c: SSVI.c * factor(3),
            ..SSVI
        };
        let found = e1_max(
            &scene(numbers)?,
            window,
            &own::settings(Method::Hybrid, Contacts::Located, 1e-9),
            f64::INFINITY,
        )?;
        (least, most) = (least.min(found.value), most.max(found.value));
    }
    writeln!(
        text,
        "least of 81 points within 0.1 %,1e-9,{least:.8}\nlargest of 81 points within 0.1 %,1e-9,{most:.8}"
    )?;
    Ok(text)
}
