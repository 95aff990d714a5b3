//! Drift of the mechanical energy over 1,000 impacts without any loss: no damping, no force.

use crate::own;
use crate::panel::{Drawn, Line, look, panel, sheet};
use crate::scenes::{SSVI, scene, system};
use retune_figures::Axis;
use retune_model::{Coupled, NonNegative, Parameter, Side};
use retune_solver::observe::{Observer, Segment};
use retune_solver::{Contacts, Method, Settings};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// Impacts.
pub const IMPACTS: u64 = 1000;
/// Time limit, s: a method that has not made the impacts by then has lost energy.
const PATIENCE: f64 = 1000.0;
/// The damper's initial speed, m/s.
const SPEED: f64 = 4.0;

struct Touched(u64);

impl Observer<4> for Touched {
    fn segment(&mut self, _segment: &impl Segment<4>) {}
    fn touch_down(&mut self, _t: f64, _side: Side) {
        self.0 += 1;
    }
    fn satisfied(&self) -> bool {
        self.0 >= IMPACTS
    }
}

/// The drift of the energy.
pub struct Drift {
    /// The method and its setting.
    pub settings: Settings,
    /// Tolerance, or step (s).
    pub setting: f64,
    /// Impacts until the end.
    pub impacts: u64,
    /// Relative change of the true mechanical energy, or why there is none.
    pub change: Result<f64, String>,
}

/// The two-sided SSVI without damping or force, with an initial speed of the damper towards a wall.
fn lossless() -> Result<Coupled, Box<dyn Error>> {
    let mut scene = scene(SSVI)?;
    scene.primary.damping = NonNegative::new(0.0)?;
    Parameter::P.set(&mut scene, 0.0)?;
    if let Some(damper) = &mut scene.damper {
        damper.damping = NonNegative::new(0.0)?;
    }
    system(&scene).ok_or_else(|| "no damper".into())
}

/// Follows the lossless motion through its impacts.
///
/// # Errors
/// A value out of range.
pub fn drift(method: Method, contacts: Contacts, setting: f64) -> Result<Drift, Box<dyn Error>> {
    let system = lossless()?;
    let settings = Settings { max_steps: 48_000_000, ..own::settings(method, contacts, setting) };
    let start = [0.0, 0.0, SSVI.d, SPEED];
    let mut seen = Touched(0);
    let end = own::follow(&system, start, PATIENCE, &settings, &mut seen);
    let change = end
        .map(|y| system.total_energy(&y) / system.total_energy(&start) - 1.0)
        .map_err(|error| error.to_string());
    Ok(Drift { settings, setting, impacts: seen.0, change })
}

/// Methods with their settings.
fn runs() -> Vec<(Method, Vec<f64>)> {
    let decades = |from: i32, to: i32| (from..=to).map(|k| 10f64.powi(-k)).collect::<Vec<_>>();
    vec![
        (Method::Ode23, decades(2, 7)),
        (Method::Ode45, decades(2, 10)),
        (Method::Dop853, decades(2, 12)),
        (Method::Rk4, vec![1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
        (Method::Euler, vec![1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
        (Method::Ode23s, decades(2, 7)),
        (Method::Hybrid, decades(2, 12)),
    ]
}

/// The table, and its chart.
///
/// # Errors
/// A value out of range, or a file that cannot be written.
pub fn table(chart: &Path) -> Result<String, Box<dyn Error>> {
    let mut all = Vec::new();
    for (method, settings) in runs() {
        let ways: &[Contacts] = match method {
            Method::Hybrid => &[Contacts::Located],
            _ => &[Contacts::Located, Contacts::Stepped],
        };
        for &contacts in ways {
            for &setting in &settings {
                all.push(drift(method, contacts, setting)?);
            }
        }
    }
    let mut text = String::from("method,contacts,rtol_or_step_s,impacts,energy_change,failure\n");
    for d in &all {
        let (change, said) = match &d.change {
            Ok(change) => (format!("{change:.2e}"), String::new()),
            Err(said) => (String::new(), said.replace(',', ";")),
        };
        let (name, way) = (d.settings.method.name(), own::way(&d.settings));
        writeln!(text, "{name},{way},{:e},{},{change},{said}", d.setting, d.impacts)?;
    }
    draw(chart, &all)?;
    Ok(text)
}

fn draw(path: &Path, all: &[Drift]) -> Drawn {
    let one = |fixed: bool, contacts: Contacts, title: &str| {
        let lines = runs()
            .into_iter()
            .filter(|(method, _)| method.has_fixed_step() == fixed)
            .map(|(method, _)| {
                let mut gains = 0;
                let mut blown = 0;
                let of: Vec<&Drift> = all
                    .iter()
                    .filter(|d| d.settings.method == method)
                    .filter(|d| method == Method::Hybrid || d.settings.contacts == contacts)
                    .collect();
                let points = of
                    .iter()
                    .filter_map(|d| match d.change {
                        Ok(change) => {
                            gains += u32::from(change > 0.0);
                            Some((d.setting, change.abs()))
                        }
                        Err(_) => {
                            blown += 1;
                            None
                        }
                    })
                    .collect();
                let how = match (gains as usize, blown) {
                    (0, 0) => ", loses",
                    (g, 0) if g == of.len() => ", gains",
                    (_, 0) => ", loses or gains",
                    _ => ", blows up",
                };
                Line::new(&format!("{}{how}", method.name()), points, look(method))
            })
            .collect();
        let x = if fixed {
            Axis::log("step, s", (1e-5, 1e-1))
        } else {
            Axis::log("relative tolerance of a step", (1e-13, 1e-1))
        };
        let y = Axis::log("relative change of the energy", (1e-12, 1e3));
        panel(title, x, y, lines, 165.0)
    };
    let panels = vec![
        one(false, Contacts::Located, "contacts located"),
        one(false, Contacts::Stepped, "contacts stepped over"),
        one(true, Contacts::Stepped, "fixed step, stepped over"),
    ];
    let note =
        "No damping, no force: every change is the method's error. Runs that blew up are in energy.csv.";
    sheet(path, "Change of the energy over 1,000 lossless impacts", &[note], 2, panels)
}
