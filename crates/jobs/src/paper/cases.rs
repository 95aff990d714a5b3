//! Figure 7: three irregular motions and their regimes.

use super::item::{Grid, Item, Verdict, numbers};
use super::judgement::definitions;
use super::plan::{Plan, stiffness};
use crate::Error;
use rayon::prelude::*;
use retune_dynamics::{Kind, Parameter, Regime, Stretch, Zone, classify, follow};
use retune_model::Scene;
use retune_report::colour::{BLACK, BLUE, GREEN};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, Width, drawing};
use retune_solver::{Rows, Sample, Window, trajectory};
use retune_study::Setting;

/// A case of the paper.
struct Case {
    letter: &'static str,
    k1: f64,
    omega: f64,
    paper: &'static str,
    zone: Zone,
}

const CASES: [Case; 3] = [
    Case {
        letter: "a",
        k1: 3.95e4,
        omega: 6.65,
        paper: "Intermittency with unilateral impacts",
        zone: Zone::PrimaryOnly,
    },
    Case {
        letter: "b",
        k1: 3.00e4,
        omega: 6.10,
        paper: "Transient chaos with unilateral impacts",
        zone: Zone::PrimaryOnly,
    },
    Case {
        letter: "c",
        k1: 5.00e4,
        omega: 7.10,
        paper: "Chaotic motion with bilateral impacts",
        zone: Zone::Bilateral,
    },
];

/// Radii for which the classification is repeated, m: the paper does not give its own.
const RADII: [f64; 5] = [0.1, 0.5, 2.0, 5.0, 10.0];
const INTERVAL: f64 = 0.0025;
/// Time for which the motions are shown beyond the end of the paper's studies, s: bursts are rare.
const MORE: f64 = 100.0;

impl Case {
    fn scene(&self, plan: &Plan) -> Result<Scene, Error> {
        let [_, scene, _] = plan.scenes(self.k1)?;
        Ok(Parameter::Omega.at(scene, self.omega)?)
    }

    /// Whether a regime agrees with the paper's name for it.
    fn agrees(&self, regime: &Regime) -> bool {
        match self.letter {
            "a" => regime.kind == Kind::Intermittent,
            "b" => regime.transient.is_some(),
            _ => matches!(regime.kind, Kind::Chaotic),
        }
    }
}

fn judge(scene: &Scene, plan: &Plan) -> Result<Regime, Error> {
    Ok(classify(&follow(scene, None, Stretch { settle: 1000, observe: 1000 }, &plan.settings())?))
}

/// Makes Figure 7.
///
/// # Errors
/// A run fails.
pub fn figure7(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(
        "figure7",
        "Figure 7. Three irregular motions",
        "x2(t), phase trajectory and contact forces (on the PS blue, on the obstacle green): (a) intermittency, (b) transient chaos, (c) chaos.",
        plan.made_by("Shown from t0 to T + 100 s of a run from rest; judged over 2000 periods, of which the last 1000 count as settled."),
    );
    let mut grid = Grid::new(
        "Our judgement of each case, and how it depends on what the paper leaves out",
        &[
            "case",
            "R, m",
            "ω, rad/s",
            "motion",
            "largest exponent, 1/s",
            "laminar share",
            "bursts",
            "confidence",
        ],
    );
    let near = [-0.02, -0.01, 0.01, 0.02];
    let bar = plan.watch.progress("figure 7", (CASES.len() * (RADII.len() + near.len())) as u64);
    for case in &CASES {
        let scene = case.scene(plan)?;
        draw(plan, case, &scene, &mut item)?;
        let own = plan.ssvi.value_of(Parameter::R).unwrap_or(f64::NAN);
        let mut variants: Vec<(f64, f64)> = vec![(own, case.omega)];
        if !plan.is_brief {
            variants.extend(near.map(|shift| (own, case.omega + shift)));
            variants
                .extend(RADII.iter().filter(|&&radius| radius != own).map(|&radius| (radius, case.omega)));
        }
        let judged: Vec<Result<Regime, Error>> = variants
            .par_iter()
            .map(|&(radius, omega)| {
                let settings = [(Parameter::K1, case.k1), (Parameter::Omega, omega), (Parameter::R, radius)]
                    .map(|(name, value)| Setting::new(name, value));
                let scene = plan.ssvi.scene_with(&settings)?;
                let regime = judge(&scene, plan);
                bar.inc(1);
                regime
            })
            .collect();
        let judged = judged.into_iter().collect::<Result<Vec<_>, _>>()?;
        for (&(radius, omega), regime) in variants.iter().zip(&judged) {
            grid.rows.push(vec![
                case.letter.into(),
                format!("{radius}"),
                format!("{omega:.2}"),
                regime.label(),
                format!("{:.3} ± {:.3}", regime.exponent.value, regime.exponent.error),
                format!("{:.2}", regime.laminar),
                regime.bursts.to_string(),
                format!("{:.2}", regime.confidence),
            ]);
        }
        state(case, &scene, &variants, &judged, plan, &mut item)?;
        item.notes.extend(creeping(case, &judged[0]));
    }
    bar.finish();
    item.grids.push(grid);
    item.grids.push(definitions());
    Ok(item)
}

/// A slow approach to a periodic orbit can look like a transient: states its rate.
fn creeping(case: &Case, regime: &Regime) -> Option<String> {
    let slow = regime.kind == Kind::Periodic && regime.transient.is_none() && regime.exponent.value < 0.0;
    slow.then(|| {
        format!(
            "Case ({}): the motion from rest creeps towards {}, and its exponent is the rate of that: with {:.3} /s it takes {:.0} s to come e times nearer, so in a run of 100 s it need not look periodic; but neighbours do not part at any time, which transient chaos would need.",
            case.letter,
            regime.label(),
            regime.exponent.value,
            -1.0 / regime.exponent.value
        )
    })
}

fn state(
    case: &Case,
    scene: &Scene,
    variants: &[(f64, f64)],
    judged: &[Regime],
    plan: &Plan,
    item: &mut Item,
) -> Result<(), Error> {
    let window = plan.window();
    let run = retune_solver::simulate(scene, window, &plan.settings())?;
    let zone = Zone::of(run.impacts);
    let elsewhere: Vec<String> = variants
        .iter()
        .zip(judged)
        .skip(1)
        .filter(|(_, r)| case.agrees(r))
        .map(|((radius, omega), _)| format!("R = {radius} m, ω = {omega:.2}"))
        .collect();
    let own = &judged[0];
    let verdict = Verdict::of_all(&[case.agrees(own), zone == case.zone]);
    let found = format!(
        "{} (exponent {:.3} ± {:.3} /s, laminar {:.0} % of the time, confidence {:.2}); {} impacts on the PS and {} on the obstacle in {}–{} s; the paper's word fits also at: {}",
        own.label(),
        own.exponent.value,
        own.exponent.error,
        100.0 * own.laminar,
        own.confidence,
        run.impacts[0],
        run.impacts[1],
        window.from,
        window.to,
        if elsewhere.is_empty() {
            "none of the other settings tried".to_owned()
        } else {
            elsewhere.join("; ")
        }
    );
    item.statement(
        &format!(
            "({}) {} at ω = {:.2} rad/s, k1 = {} N/m",
            case.letter,
            case.paper,
            case.omega,
            stiffness(case.k1)
        ),
        "Holds if the motion from rest has this name by our definitions (table below) and strikes the walls that the paper says; in part if only one is so.",
        verdict,
        found,
    );
    Ok(())
}

fn draw(plan: &Plan, case: &Case, scene: &Scene, item: &mut Item) -> Result<(), Error> {
    let window = Window { to: plan.window().to + MORE, ..plan.window() };
    let mut samples: Vec<Sample> = Vec::new();
    trajectory(scene, window, &plan.settings(), Rows::every(INTERVAL), &mut |sample| samples.push(*sample))?;
    let range = |value: fn(&Sample) -> f64| {
        let (low, high) = samples
            .iter()
            .map(value)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let room = 0.06 * (high - low).max(1e-9);
        (low - room, high + room)
    };
    let top = samples.iter().map(|s| s.forces[0].max(s.forces[1])).fold(1.0, f64::max) * 1.06;
    let some: Vec<&Sample> = samples.iter().step_by(16).collect();
    let thin = |colour, width| Stroke::new(colour, width, Dash::Solid);
    let force = |side: usize, colour| Layer::Line {
        points: samples
            .windows(3)
            .filter(|near| near.iter().any(|s| s.forces[side] > 0.0))
            .map(|near| (near[1].t, near[1].forces[side]))
            .collect(),
        stroke: thin(colour, 0.6),
    };
    let time = || Axis::linear("t, s", (window.from, window.to));
    let x2 =
        Layer::Line { points: samples.iter().map(|s| (s.t, s.state[2])).collect(), stroke: thin(BLACK, 0.6) };
    let phase = Layer::Line {
        points: samples.iter().step_by(2).map(|s| (s.state[2], s.state[3])).collect(),
        stroke: thin(BLACK, 0.3),
    };
    let title = format!("({}) ω = {:.2} rad/s, k1 = {} N/m", case.letter, case.omega, stiffness(case.k1));
    let chart = |title: &str, x, y, layers| Chart { title: title.into(), x, y, layers, height: 135.0 };
    let displacement = || Axis::linear("x2, m", range(|s| s.state[2]));
    let charts = vec![
        chart(&title, time(), displacement(), vec![x2]),
        chart(
            "Contact forces",
            time(),
            Axis::linear("F, N", (0.0, top)),
            vec![force(0, BLUE), force(1, GREEN)],
        ),
        chart(
            "Phase trajectory",
            displacement(),
            Axis::linear("v2, m/s", range(|s| s.state[3])),
            vec![phase],
        ),
    ];
    let sheet = Sheet {
        title,
        description: format!(
            "x2 and the contact forces over time, and the phase trajectory. The paper: {}.",
            case.paper
        ),
        width: Width::Page,
        charts,
        columns: 1,
        stacked: false,
        legend: vec![
            (Key::Line(Stroke::solid(BLUE)), "force on the PS".to_owned()),
            (Key::Line(Stroke::solid(GREEN)), "force on the obstacle".to_owned()),
        ],
        caption: Vec::new(),
    };
    item.picture(
        &format!("figure7-{}", case.letter),
        drawing(&sheet),
        &format!("({}) The paper: {}.", case.letter, case.paper),
    );
    let rows = some.iter().map(|s| {
        vec![
            (1e6 * s.t).round() / 1e6,
            s.state[0],
            s.state[1],
            s.state[2],
            s.state[3],
            s.forces[0],
            s.forces[1],
        ]
    });
    item.data.push((
        format!("figure7-{}.csv", case.letter),
        numbers("t_s,x1_m,v1_m_per_s,x2_m,v2_m_per_s,F_PS_N,F_obstacle_N", rows),
    ));
    Ok(())
}
