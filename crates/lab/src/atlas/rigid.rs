//! The rigid limit: contacts of stiffness K × 10^n against instantaneous elastic impacts.
//!
//! The duration of a contact is proportional to `K^(-2/5)` at a given speed (W. Goldsmith, Impact, 1960, ch. IV), so the motion
//! must converge to the rigid one at that rate.

use super::{WAYS, Way};
use crate::panel::{Line, WIDTHS, panel, sheet};
use crate::records::{number, records};
use crate::runs::{Found, errors, run, settings};
use crate::scenes::{Case, SSVI, stiffer};
use crate::{Any, decades};
use retune_model::Side;
use retune_report::colour::{BLACK, BLUE, Colour, GREEN, GREY, VERMILION};
use retune_report::{Axis, Shape};
use retune_solver::observe::{Observer, PrimaryEnergy, RunningMaximum, Segment};
use retune_solver::{Contacts, Hybrid, Method, Motion, Phase};
use std::fmt::Write;
use std::path::Path;

/// Observes flight up to a touch-down and ignores the rest.
struct Flight<'a> {
    peak: RunningMaximum<PrimaryEnergy<'a>>,
    last: Option<(f64, [f64; 4])>,
    touched: Option<Side>,
}

impl Observer<4> for Flight<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
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

/// Largest E1 (J) and final state of the two-sided SSVI between rigid walls from rest to `to` (s): exact flight, instantaneous elastic impacts.
fn rigid(to: f64) -> Any<(f64, [f64; 4])> {
    let system = SSVI.coupled();
    let peak = RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
    let mut watch = Flight { peak, last: None, touched: None };
    let mut hybrid = Hybrid::new(&system, 1e-10, to, 10_000_000);
    let mut now = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    for _ in 0..10_000 {
        let end = hybrid.propagate(now, to, &mut watch)?;
        let (Some(side), Some((t, mut y))) = (watch.touched.take(), watch.last) else {
            return Ok((watch.peak.record().value, end.y));
        };
        y[2] = y[0] + system.wall(side);
        bounce([SSVI.m1, SSVI.m2], &mut y);
        now = Motion { t, y, phase: Phase::Leaving(side) };
    }
    Err("more than 10000 impacts".into())
}

/// The two-sided SSVI with its contacts 10^n times as stiff, 10 s.
fn case(n: i32) -> Case {
    Case { name: "stiff", label: "", scene: stiffer(10f64.powi(n)).scene(), to: 10.0 }
}

/// Relative difference between the Hertzian motion at K × 10^n and the rigid one: E1max and final state.
pub fn distance(n: i32) -> Any<[f64; 2]> {
    let case = case(n);
    let (e1_max, final_state) = rigid(case.to)?;
    let found = run(&case, &settings(Method::Hybrid, Contacts::Located, 1e-11), false)?;
    let limit = Found { e1_max, final_state, ..found.clone() };
    let [e1, state, _] = errors(&found, &limit, case.omega());
    Ok([e1, state])
}

/// The table.
pub fn table() -> Any<String> {
    let mut text = String::from(
        "stiffness_factor,method,setting,E1max_error,final_state_error,impacts,expected_impacts,evaluations,E1max_from_rigid,final_state_from_rigid,failure\n",
    );
    for n in -2..=8 {
        let case = case(n);
        let reference = run(&case, &settings(Method::Hybrid, Contacts::Located, 1e-12), false)?;
        let expected = reference.impacts;
        let from_rigid = distance(n)?;
        let from_rigid = format!("{:.2e},{:.2e}", from_rigid[0], from_rigid[1]);
        for way in &WAYS {
            write!(text, "1e{n},{},{:e},", way.name, way.setting)?;
            match run(&case, &way.settings(), false) {
                Ok(found) => {
                    let [e1, state, _] = errors(&found, &reference, case.omega());
                    let Found { impacts, evaluations, .. } = found;
                    write!(text, "{e1:.2e},{state:.2e},{impacts},{expected},{evaluations},")?;
                    writeln!(text, "{from_rigid},")?;
                }
                Err(said) => writeln!(text, ",,,{expected},,{from_rigid},{}", said.replace(',', ";"))?,
            }
        }
    }
    Ok(text)
}

/// The methods that share a frame, with its title.
const GROUPS: [(&str, &[Method]); 2] = [
    ("explicit, steps by an estimate", &[Method::Dop853, Method::Ode45, Method::Ode23]),
    ("stiff, and fixed steps", &[Method::Ode23s, Method::Rk4, Method::Euler]),
];

const fn look(way: &Way) -> (Colour, f64, Shape) {
    let [thin, normal, _, boldest] = WIDTHS;
    match (way.method, way.contacts) {
        (Method::Hybrid, _) => (VERMILION, boldest, Shape::Disc),
        (Method::Ode23s, _) => (BLACK, normal, if way.setting > 1e-4 { Shape::Square } else { Shape::Disc }),
        (Method::Rk4, _) => (GREEN, normal, Shape::Disc),
        (Method::Euler, _) => (GREEN, normal, Shape::Square),
        (Method::Ode23, _) => (BLUE, thin, Shape::Cross),
        (Method::Ode45, Contacts::Located) => (BLUE, normal, Shape::Disc),
        (Method::Ode45, _) => (BLUE, thin, Shape::Ring),
        (_, Contacts::Located) => (BLUE, normal, Shape::Triangle),
        _ => (BLUE, thin, Shape::Square),
    }
}

/// The chart of the table.
pub fn draw(path: &Path, table: &str) -> Any<()> {
    let [thin, normal, bold, _] = WIDTHS;
    let rows = records(table);
    let points = |of: &str, column: &str| -> Vec<(f64, f64)> {
        let own = rows.iter().filter(|row| row["method"] == of);
        own.map(|row| (number(row, "stiffness_factor"), number(row, column))).collect()
    };
    let x = || Axis::log("stiffness of the contact, times that of the SSVI", (1e-2, 1e8));
    let mut panels = Vec::new();
    for (what, column, label, range) in [
        ("Final state", "final_state_error", "relative error", (1e-10, 10.0)),
        ("Cost", "evaluations", "evaluations of the right-hand side", (1e2, 1e6)),
    ] {
        for (group, methods) in GROUPS {
            let own = |way: &&Way| way.method == Method::Hybrid || methods.contains(&way.method);
            let all = WAYS.iter().rev().filter(own);
            let all = all.map(|way| Line::new(way.name, points(way.name, column), look(way)));
            panels.push(panel(
                &format!("{what}: {group}"),
                x(),
                Axis::log(label, range),
                all.collect(),
                170.0,
            ));
        }
    }
    let [e1, state] =
        ["E1max_from_rigid", "final_state_from_rigid"].map(|column| points(WAYS[0].name, column));
    let (first, at) = state.last().map_or((1.0, 1.0), |p| *p);
    let slope = decades(-8, 2).into_iter().rev().map(|f| (f, at * (f / first).powf(-0.4))).collect();
    panels.push(panel(
        "Hertz's contact against rigid walls",
        x(),
        Axis::log("distance from rigid walls", (1e-8, 1e2)),
        vec![
            Line { name: "slope −2/5".to_owned(), points: slope, colour: GREY, width: thin, shape: None },
            Line::new("E1max", e1, (BLUE, normal, Shape::Disc)),
            Line::new("final state", state, (VERMILION, bold, Shape::Disc)),
        ],
        170.0,
    ));
    let note = "Two-sided SSVI, 10 s. Lines end where a method gave up or blew up. Below: the hybrid against instantaneous elastic impacts; a contact lasts as long as K^(−2/5). Hollow squares on the frame: points beyond it.";
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
