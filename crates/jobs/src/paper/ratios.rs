//! Figure 5: the damper's share of the energy.

use super::family::Family;
use super::item::{Item, Verdict, numbers};
use super::measures::{best_tmd, tmd_words};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_dynamics::{Parameter, Point, independent};
use retune_report::colour::{BLUE, Colour, VERMILION};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, Width, drawing};
use retune_solver::simulate;

/// Makes Figure 5.
///
/// # Errors
/// A run fails.
pub fn figure5(plan: &Plan) -> Result<Item, Error> {
    let stiffnesses = plan.file.k1_range.values();
    let lowest = plan.file.k1.iter().copied().fold(f64::INFINITY, f64::min);
    let bar = plan.watch.progress("figure 5", (2 * stiffnesses.len() + 7 * plan.file.omega.points) as u64);
    let mut at_resonance = [Vec::new(), Vec::new()];
    for &k1 in &stiffnesses {
        for (scene, place) in plan.scenes(k1)?[1..].iter().zip(&mut at_resonance) {
            let scene = Parameter::Omega.at(*scene, scene.primary.natural_frequency())?;
            let run = simulate(&scene, plan.window(), &plan.settings())?;
            bar.inc(1);
            let (e1_max, e2_max) = (run.e1_max.value, run.e2_max.value);
            place.push(Point {
                value: k1,
                e1_max,
                e2_max,
                impacts: run.impacts,
                relative_displacement_max: run.relative_displacement_max,
            });
        }
    }
    let soft = Family::compute(plan, lowest, &*bar)?;
    let tuned = Family::compute(plan, plan.tuned(), &*bar)?;
    let best = best_tmd(plan)?;
    let omegas = plan.file.omega.values();
    let tuned_tmd =
        independent(&best, Parameter::Omega, &omegas, plan.window(), &plan.settings(), || bar.inc(1))?;
    bar.finish();
    let mut item = Item::new(
        "figure5",
        "Figure 5. Energy ratios",
        "R1 = E1max/(E1max + E2max) and R2 = E2max/(E1max + E2max), against k1 (a) and against ω for k1 = 2.00e4 (b) and 3.95e4 N/m (c).",
        plan.made_by("(a) at resonance, ω = √(k1/m1), which the paper does not state; (b), (c) one run from rest at each frequency."),
    );
    let omega = (plan.file.omega.from, plan.file.omega.to);
    let charts = vec![
        chart(
            "(a) at resonance",
            "k1, N/m",
            (plan.file.k1_range.from, plan.file.k1_range.to),
            [&at_resonance[0], &at_resonance[1]],
        ),
        chart(
            &format!("(b) k1 = {} N/m", stiffness(soft.k1)),
            "ω, rad/s",
            omega,
            [&soft.points[1], &soft.points[2]],
        ),
        chart(
            &format!("(c) k1 = {} N/m", stiffness(tuned.k1)),
            "ω, rad/s",
            omega,
            [&tuned.points[1], &tuned.points[2]],
        ),
    ];
    let key = |colour, ratio: usize, words: &str| (Key::Line(stroke(colour, ratio)), words.to_owned());
    let sheet = Sheet {
        title: "Energy ratios R1 and R2".to_owned(),
        description: "R1 = E1max/(E1max + E2max) and R2 = E2max/(E1max + E2max) of the SSVI NES and the TMD: against k1 at resonance, and against ω at two stiffnesses.".to_owned(),
        width: Width::Page,
        charts,
        columns: 1,
        stacked: false,
        legend: vec![
            key(VERMILION, 0, "R1, SSVI NES"),
            key(VERMILION, 1, "R2, SSVI NES"),
            key(BLUE, 0, "R1, TMD"),
            key(BLUE, 1, "R2, TMD"),
        ],
        caption: Vec::new(),
    };
    item.picture(
        "figure5",
        drawing(&sheet),
        "Energy ratios; red the SSVI NES, blue the TMD; dashed the damper's share R₂.",
    );
    let csv = |ssvi: &[Point], tmd: &[Point], name: &str| {
        let rows = ssvi
            .iter()
            .zip(tmd)
            .map(|(s, t)| [vec![s.value], s.ratios().to_vec(), t.ratios().to_vec()].concat());
        numbers(&format!("{name},R1_SSVI,R2_SSVI,R1_TMD,R2_TMD"), rows)
    };
    item.data.push(("figure5a.csv".into(), csv(&at_resonance[0], &at_resonance[1], "k1_N_per_m")));
    item.data.push(("figure5b.csv".into(), csv(&soft.points[1], &soft.points[2], "omega_rad_per_s")));
    item.data.push(("figure5c.csv".into(), csv(&tuned.points[1], &tuned.points[2], "omega_rad_per_s")));
    let above = |ssvi: &[Point], tmd: &[Point]| {
        let more = ssvi.iter().zip(tmd).filter(|(s, t)| s.ratios()[1] > t.ratios()[1]).count();
        more as f64 / ssvi.len().max(1) as f64
    };
    let band = |family: &Family, tmd: &[Point]| {
        let near = |p: &&Point| (p.value - family.natural).abs() <= family.half_width;
        let [s, t] = [family.points[1].as_slice(), tmd]
            .map(|all| all.iter().filter(near).copied().collect::<Vec<_>>());
        above(&s, &t)
    };
    let shares = [
        above(&at_resonance[0], &at_resonance[1]),
        band(&soft, &soft.points[2]),
        band(&tuned, &tuned.points[2]),
    ];
    let verdict = Verdict::of_all(&shares.map(|share| share > 0.5));
    item.statement(
        "The SSVI NES realises the energy transfer from PS to damper somewhat better than the TMD (a larger R2)",
        "Holds if R2 is larger than with the paper's TMD at most places of each of the three graphs, of (b) and (c) within half the half-power width c1/(2 m1) of resonance, where a damper matters; in part if of one or two.",
        verdict,
        format!(
            "R2 is the larger with the SSVI NES at {:.0} % of the stiffnesses of (a), and near resonance at {:.0} % of the frequencies of (b) and {:.0} % of (c). But the paper's TMD is mistuned: beside the best one ({}) the SSVI NES has the larger R2 near resonance at {:.0} % of the frequencies of (c)",
            100.0 * shares[0],
            100.0 * shares[1],
            100.0 * shares[2],
            tmd_words(&best),
            100.0 * band(&tuned, &tuned_tmd)
        ),
    );
    item.notes.push("E2 is the paper's, with (x2 - D)² in place of the stretch of the spring, and E1max and E2max are reached at different moments: R1 and R2 are no shares of one energy.".into());
    Ok(item)
}

/// The line of a ratio: R2 is dashed.
const fn stroke(colour: Colour, ratio: usize) -> Stroke {
    Stroke::new(colour, 1.1, if ratio == 0 { Dash::Solid } else { Dash::Long })
}

fn chart(title: &str, label: &str, range: (f64, f64), dampers: [&[Point]; 2]) -> Chart {
    let mut layers = Vec::new();
    for (points, colour) in dampers.into_iter().zip([VERMILION, BLUE]) {
        for ratio in 0..2 {
            let points = points.iter().map(|p| (p.value, p.ratios()[ratio])).collect();
            layers.push(Layer::Line { points, stroke: stroke(colour, ratio) });
        }
    }
    Chart {
        title: title.to_owned(),
        x: Axis::linear(label, range),
        y: Axis::linear("R1, R2", (-0.03, 1.05)),
        layers,
        height: 125.0,
    }
}
