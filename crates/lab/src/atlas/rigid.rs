//! The rigid limit: contacts of stiffness K × 10^n against instantaneous elastic impacts.
//!
//! The duration of a contact is proportional to `K^(-2/5)` at a given speed (W. Goldsmith, Impact, 1960, ch. IV), so the motion
//! must converge to the rigid one at that rate.

use super::{WAYS, Way};
use crate::own;
use crate::panel::{Drawn, Line, WIDTHS, panel, sheet};
use crate::scenes::{Case, Numbers, SSVI, scene, system};
use retune_figures::colour::{BLACK, BLUE, GREEN, GREY, VERMILION};
use retune_figures::{Axis, Shape};
use retune_model::{Coupled, Scene, Side};
use retune_solver::observe::{Observer, PrimaryEnergy, RunningMaximum, Segment};
use retune_solver::{Contacts, Hybrid, Method, Motion, Phase, Settings, SolverError};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// The motion between rigid walls.
#[derive(Clone, Copy, Debug)]
pub struct Rigid {
    /// Largest E1, J.
    pub e1_max: f64,
    /// State at the end.
    pub state: [f64; 4],
    /// Impacts.
    pub impacts: usize,
}

/// Flight up to a touch-down; the rest is ignored.
struct Flight<'a> {
    peak: RunningMaximum<PrimaryEnergy<'a>>,
    last: Option<(f64, [f64; 4])>,
    touched: Option<Side>,
}

impl Observer<4> for Flight<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        if self.touched.is_none() {
            self.peak.segment(segment);
            let end = segment.ends()[1];
            self.last = Some((end.t, end.y));
        }
    }
    fn touch_down(&mut self, _t: f64, side: Side) {
        self.touched.get_or_insert(side);
    }
    fn satisfied(&self) -> bool {
        self.touched.is_some()
    }
}

/// Velocities after an instantaneous elastic impact of `m1` and `m2`: momentum and energy are conserved, the relative velocity
/// changes its sign.
fn bounce([m1, m2]: [f64; 2], y: &mut [f64; 4]) {
    let closing = y[3] - y[1];
    y[1] += 2.0 * m2 / (m1 + m2) * closing;
    y[3] -= 2.0 * m1 / (m1 + m2) * closing;
}

/// Runs a scene from rest to `to` (s): exact flight, instantaneous elastic impacts.
///
/// # Errors
/// No damper; a run that failed; more than 10,000 impacts.
pub fn rigid(scene: &Scene, to: f64) -> Result<Rigid, Box<dyn Error>> {
    let system: Coupled = system(scene).ok_or("no damper")?;
    let masses = [scene.primary.mass.get(), scene.damper.ok_or("no damper")?.mass.get()];
    let peak = RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
    let mut watch = Flight { peak, last: None, touched: None };
    let mut hybrid = Hybrid::new(&system, 1e-10, to, 10_000_000);
    let mut now = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    for impacts in 0..10_000 {
        let end = hybrid.propagate(now, to, &mut watch)?;
        let (Some(side), Some((t, mut y))) = (watch.touched.take(), watch.last) else {
            return Ok(Rigid { e1_max: watch.peak.record().value, state: end.y, impacts });
        };
        y[2] = y[0] + system.wall(side);
        bounce(masses, &mut y);
        now = Motion { t, y, phase: Phase::Leaving(side) };
    }
    Err(Box::new(SolverError::TooManySteps { t: now.t, limit: 10_000, evaluations: None }))
}

/// The two-sided SSVI with its contacts 10^n times as stiff, 10 s.
///
/// # Errors
/// A value out of range.
pub fn case(n: i32) -> Result<Case, Box<dyn Error>> {
    let numbers = Numbers { stiffer: 10f64.powi(n), ..SSVI };
    Ok(Case { name: "stiff", label: "", scene: scene(numbers)?, to: 10.0 })
}

/// Exponents of the stiffness.
const EXPONENTS: std::ops::RangeInclusive<i32> = -2..=8;

/// Distance of the Hertzian motion at K × 10^n from the rigid one: E1max and final state, relative.
///
/// # Errors
/// A run that failed.
pub fn distance(n: i32) -> Result<[f64; 2], Box<dyn Error>> {
    let case = case(n)?;
    let limit = rigid(&case.scene, case.to)?;
    let found = own::run(&case, &own::settings(Method::Hybrid, Contacts::Located, 1e-11), false)?;
    let as_found = crate::record::Found { e1_max: limit.e1_max, final_state: limit.state, ..found.clone() };
    let [e1, state, _] = crate::record::errors(&found, &as_found, case.scene.forcing.frequency.get());
    Ok([e1, state])
}

/// The table, and its chart.
///
/// # Errors
/// A run of the hybrid that failed, or a file that cannot be written.
pub fn table(chart: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "stiffness_factor,method,setting,E1max_error,final_state_error,impacts,expected_impacts,evaluations,time_s,E1max_from_rigid,final_state_from_rigid,failure\n",
    );
    let mut errors: Vec<(Way, Vec<(f64, f64)>)> = WAYS.iter().map(|w| (*w, Vec::new())).collect();
    let mut costs: Vec<(Way, Vec<(f64, f64)>)> = WAYS.iter().map(|w| (*w, Vec::new())).collect();
    let mut limit: [Vec<(f64, f64)>; 2] = Default::default();
    for n in EXPONENTS {
        let (case, factor) = (case(n)?, 10f64.powi(n));
        let reference = own::run(&case, &own::settings(Method::Hybrid, Contacts::Located, 1e-12), false)?;
        let apart = distance(n)?;
        (0..2).for_each(|i| limit[i].push((factor, apart[i])));
        for (i, way) in WAYS.iter().enumerate() {
            let settings =
                Settings { max_steps: 400_000, ..own::settings(way.method, way.contacts, way.setting) };
            write!(text, "1e{n},{},{:e},", way.name, way.setting)?;
            match own::run(&case, &settings, true) {
                Ok(found) => {
                    let [e1, state, _] =
                        crate::record::errors(&found, &reference, case.scene.forcing.frequency.get());
                    writeln!(
                        text,
                        "{e1:.2e},{state:.2e},{},{},{},{:.3e},{:.2e},{:.2e},",
                        found.impacts,
                        reference.impacts,
                        found.evaluations,
                        found.seconds,
                        apart[0],
                        apart[1]
                    )?;
                    errors[i].1.push((factor, state));
                    costs[i].1.push((factor, found.evaluations as f64));
                }
                Err(said) => writeln!(
                    text,
                    ",,,{},,,{:.2e},{:.2e},{}",
                    reference.impacts,
                    apart[0],
                    apart[1],
                    said.replace(',', ";")
                )?,
            }
        }
    }
    draw(chart, errors, costs, limit)?;
    Ok(text)
}

fn draw(
    path: &Path,
    errors: Vec<(Way, Vec<(f64, f64)>)>,
    costs: Vec<(Way, Vec<(f64, f64)>)>,
    limit: [Vec<(f64, f64)>; 2],
) -> Drawn {
    let [thin, normal, bold, boldest] = WIDTHS;
    let look = |way: &Way| match (way.method, way.contacts) {
        (Method::Hybrid, _) => (VERMILION, boldest, Shape::Disc),
        (Method::Ode23s, _) => (BLACK, normal, if way.setting > 1e-4 { Shape::Square } else { Shape::Disc }),
        (Method::Rk4, _) => (GREEN, normal, Shape::Disc),
        (Method::Euler, _) => (GREEN, normal, Shape::Square),
        (Method::Ode23, _) => (BLUE, thin, Shape::Cross),
        (Method::Ode45, Contacts::Located) => (BLUE, normal, Shape::Disc),
        (Method::Ode45, _) => (BLUE, thin, Shape::Ring),
        (_, Contacts::Located) => (BLUE, normal, Shape::Triangle),
        _ => (BLUE, thin, Shape::Square),
    };
    let lines = |of: Vec<(Way, Vec<(f64, f64)>)>| {
        let line = |(way, points): (Way, Vec<(f64, f64)>)| Line::new(way.name, points, look(&way));
        of.into_iter().rev().map(line).collect::<Vec<_>>()
    };
    let x = || Axis::log("stiffness of the contact, times that of the SSVI", (1e-2, 1e8));
    let [e1, state] = limit;
    let (first, at) = state.last().map_or((1.0, 1.0), |p| *p);
    let slope = EXPONENTS.map(|n| 10f64.powi(n)).map(|f| (f, at * (f / first).powf(-0.4))).collect();
    let panels = vec![
        panel(
            "Error of the final state",
            x(),
            Axis::log("relative error", (1e-10, 10.0)),
            lines(errors),
            170.0,
        ),
        panel("Cost", x(), Axis::log("evaluations of the right-hand side", (1e2, 1e6)), lines(costs), 170.0),
        panel(
            "Hertz's contact against rigid walls",
            x(),
            Axis::log("distance from rigid walls", (1e-8, 1e2)),
            vec![
                Line {
                    name: "slope −2/5".to_owned(), points: slope, colour: GREY, width: thin, shape: None
                },
                Line::new("E1max", e1, (BLUE, normal, Shape::Disc)),
                Line::new("final state", state, (VERMILION, bold, Shape::Disc)),
            ],
            170.0,
        ),
    ];
    let note = "Two-sided SSVI, 10 s. Lines end where a method gave up or blew up. Below: the hybrid against instantaneous elastic impacts; a contact lasts as long as K^(−2/5). Points beyond the axes lie on their ends.";
    sheet(path, "Toward rigid walls", &[note], 2, panels)
}

#[cfg(test)]
mod tests {
    use super::bounce;

    #[test]
    fn invariant_a_bounce_keeps_momentum_and_energy_and_turns_the_relative_velocity() {
        let before = [0.3, 1.2, 0.3, -2.5];
        let mut after = before;
        bounce([1000.0, 60.0], &mut after);
        let momentum = |y: [f64; 4]| 1000.0 * y[1] + 60.0 * y[3];
        let energy = |y: [f64; 4]| 0.5 * (1000.0 * y[1] * y[1] + 60.0 * y[3] * y[3]);
        assert!((momentum(after) - momentum(before)).abs() < 1e-12 * 1000.0);
        assert!((energy(after) / energy(before) - 1.0).abs() < 1e-14);
        assert!((after[3] - after[1] + before[3] - before[1]).abs() < 1e-14);
        assert_eq!((after[0], after[2]), (before[0], before[2]));
    }
}
