//! Missed contacts: steps that begin and end in flight although the exact motion from their beginning touches a wall and
//! leaves it again before they end.

use crate::panel::{Line, look, panel, sheet};
use crate::records::{Record, number, records};
use crate::runs::{Touches, follow, ways};
use crate::scenes::{Case, Numbers, TMD, cases};
use crate::{Any, system};
use retune_model::{Coupled, Side};
use retune_report::Axis;
use retune_solver::observe::{Observer, Segment};
use retune_solver::{Contacts, Hybrid, Method, Motion, Phase, Settings};
use std::fmt::Write;
use std::path::Path;

/// Counts contacts found and jumped over.
struct Count<'a> {
    system: &'a Coupled,
    exact: Hybrid<'a>,
    seen: u64,
    jumped: u64,
}

impl Observer<4> for Count<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [from, to] = segment.ends();
        let open = |y: &[f64; 4]| self.system.indentation(y).iter().all(|z| *z <= 1e-12);
        if from.clock != [1.0, 0.0] || !open(&from.y) || !open(&to.y) {
            return;
        }
        let mut touches = Touches { count: 0, enough: u64::MAX };
        let begin = Motion { t: from.t, y: from.y, phase: Phase::Flight };
        // A step that ends at a located touch-down has not missed it.
        let until = to.t - 1e-6 * (to.t - from.t);
        if let Ok(end) = self.exact.propagate(begin, until, &mut touches) {
            let unfinished = matches!(end.phase, Phase::InContact(_));
            self.jumped += touches.count - u64::from(unfinished).min(touches.count);
        }
    }
    fn touch_down(&mut self, _t: f64, _side: Side) {
        self.seen += 1;
    }
}

/// The impacts of a run with a limited step size.
pub struct Missed {
    pub seen: u64,
    pub jumped: u64,
    /// The error of the method, if any.
    pub said: Option<String>,
}

impl Missed {
    /// The fraction of all impacts that were missed.
    fn share(&self) -> f64 {
        self.jumped as f64 / (self.jumped + self.seen).max(1) as f64
    }
}

/// Runs a scene with a damper from rest at MATLAB's default tolerance with steps no longer than `step` (s).
pub fn missed(case: &Case, method: Method, contacts: Contacts, step: f64) -> Any<Missed> {
    let system = system(&case.scene).ok_or("no damper")?;
    let settings =
        Settings { method, contacts, rtol: 1e-3, atol: 1e-6, step: Some(step), max_steps: 1_000_000 };
    let exact = Hybrid::new(&system, 1e-9, case.to, u64::MAX);
    let mut count = Count { system: &system, exact, seen: 0, jumped: 0 };
    let error = follow(&system, system.rest(), case.to, &settings, &mut count).err();
    Ok(Missed { seen: count.seen, jumped: count.jumped, said: error.map(|error| error.to_string()) })
}

/// The two-sided scene, the near-rigid one, and the TMD with a wall at a fraction of its steady stroke without walls.
pub fn subjects() -> Vec<Case> {
    let free = TMD.coupled();
    let swing = free.steady(free.bare().frequency()).stroke();
    let grazing = [("grazing 1 %", 0.99), ("grazing 0.1 %", 0.999)].map(|(name, share)| {
        let scene = Numbers { d: share * swing, c: 5.0, ..TMD }.scene();
        Case { name, label: name, scene, to: 100.0 }
    });
    let struck = cases().into_iter().filter(|c| ["two-sided", "near-rigid"].contains(&c.name));
    struck.chain(grazing).collect()
}

/// Longest steps, s.
const STEPS: [f64; 8] = [3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0];

/// The table.
pub fn table() -> Any<String> {
    let mut text =
        String::from("scene,method,contacts,longest_step_s,seen,jumped_over,missed_share,noticed\n");
    for case in &subjects() {
        for method in Method::ALL {
            for &(contacts, way) in ways(method) {
                for step in STEPS {
                    let found = missed(case, method, contacts, step)?;
                    let noticed = match (&found.said, found.jumped) {
                        (Some(error), _) => error.replace(',', ";"),
                        (None, 0) => "nothing missed".into(),
                        (None, _) => "no".into(),
                    };
                    let (scene, method, share) = (case.name, method.name(), found.share());
                    let Missed { seen, jumped, .. } = found;
                    writeln!(text, "{scene},{method},{way},{step:e},{seen},{jumped},{share:.3},{noticed}")?;
                }
            }
        }
    }
    Ok(text)
}

/// The methods that share a frame, with its title.
const GROUPS: [(&str, &[Method]); 2] = [
    ("steps by an estimate", &[Method::Ode23, Method::Ode23s, Method::Dop853, Method::Ode45]),
    ("fixed steps", &[Method::Euler, Method::Rk4]),
];

/// The chart of the table.
pub fn draw(path: &Path, table: &str) -> Any<()> {
    let rows = records(table);
    // The missed fraction of a method at each longest step; a line ends where the method reports an error.
    let line = |scene: &str, way: &str, method: Method| {
        let way = if method == Method::Hybrid { "exact" } else { way };
        let own =
            |row: &&Record<'_>| [row["scene"], row["method"], row["contacts"]] == [scene, method.name(), way];
        let own: Vec<&Record<'_>> = rows.iter().filter(own).collect();
        let completed = |row: &&&Record<'_>| ["no", "nothing missed"].contains(&row["noticed"]);
        let points = own
            .iter()
            .filter(completed)
            .map(|row| (number(row, "longest_step_s"), 100.0 * number(row, "missed_share")));
        let points: Vec<(f64, f64)> = points.collect();
        let end = if points.len() < own.len() { ", then blows up" } else { "" };
        Line::new(&format!("{}{end}", method.name()), points, look(method))
    };
    let mut panels = Vec::new();
    for (scene, wall) in [("grazing 1 %", "99 %"), ("grazing 0.1 %", "99.9 %")] {
        for (way, words) in [("located", "located"), ("stepped", "stepped over")] {
            for (group, methods) in GROUPS {
                let x = Axis::log("longest step allowed, s", (2e-4, 1.5));
                let y = Axis::linear("jumped over, per cent", (-3.0, 103.0));
                let all = methods.iter().chain([&Method::Hybrid]).map(|method| line(scene, way, *method));
                panels.push(panel(&format!("wall at {wall}, {words}: {group}"), x, y, all.collect(), 125.0));
            }
        }
    }
    let note = "A TMD that grazes its wall, at a share of its free swing, 100 s, at MATLAB's default tolerance 1e-3.";
    let more = "Nobody noticed: where a line is above zero the run ended without a word. Lines end where the motion blew up.";
    sheet(path, "Contacts that steps jump over", &[note, more], 2, panels)
}
