//! Figures 5 and 6: the damper's share of the energy, and the energies over time at resonance.

use super::family::{Family, share};
use super::item::Item;
use super::measures::{best_tmd, recorded, rounded, tmd_words};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_dynamics::{Parameter, Point, independent};
use retune_model::{Scene, energy_ratios};
use retune_report::colour::{BLACK, BLUE, Colour, ORANGE, VERMILION};
use retune_report::document::Verdict;
use retune_report::table::{Cell, Table};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, cells};
use retune_solver::{Sample, simulate};

/// Seconds between the points of Figure 6.
const INTERVAL: f64 = 0.05;
const LINES: [(Stroke, &str); 3] = [
    (Stroke::new(BLACK, 0.5, Dash::Solid), "E1, PS without damper"),
    (Stroke::new(VERMILION, 0.7, Dash::Solid), "E1, PS with damper"),
    (Stroke::new(ORANGE, 0.7, Dash::Solid), "E2, damper"),
];

pub fn figure6(plan: &Plan) -> Result<Item, Error> {
    let scenes = plan.scenes(plan.tuned())?;
    let omega = scenes[1].forcing.frequency.get();
    let mut item =
        Item::new(plan.made_by(&format!("ω = {omega} rad/s, from rest, shown every {INTERVAL} s.")));
    over_time(plan, &scenes, &mut item)?;
    // The exact maxima, not those of the drawn samples.
    let largest = |scene: &Scene| -> Result<[f64; 3], Error> {
        let run = simulate(scene, plan.window(), &plan.settings())?;
        let [e1, e2] = [run.e1_max.value, run.e2_max.value];
        Ok([e1, e2, energy_ratios(e1, e2)[1]])
    };
    let best = best_tmd(plan)?;
    let words = tmd_words(&best);
    let [none, ..] = largest(&scenes[0])?;
    let [ssvi, tmd, best] = [largest(&scenes[1])?, largest(&scenes[2])?, largest(&best)?];
    let row = |name: &str, [e1, e2, r2]: [f64; 3]| {
        cells![name, format!("{e1:.1}"), format!("{e2:.1}"), format!("{r2:.3}")]
    };
    let dampers = ["SSVI NES, the paper's", "TMD, the paper's", &format!("TMD, {words}")];
    let rows = dampers.into_iter().zip([ssvi, tmd, best]).map(|(name, numbers)| row(name, numbers));
    let table = Table::headed("damper | E1max, J | E2max, J | R2").with(rows);
    let ([e1, e2, r2], [tmd_e1, tmd_e2, tmd_r2], [best_e1, _, best_r2]) = (ssvi, tmd, best);
    item.table("Largest energies after the transient, and the damper's R2, beside the TMD that is tuned (k2 and c2 free, least worst case over 5 to 8 rad/s)", table);
    item.statement(
        "Both dampers effectively reduce the maximum energy of the PS at resonance",
        "The paper gives no number. Holds if the largest energy after the transient is at most half of that without damper, with each damper.",
        Verdict::of_all(&[e1 < 0.5 * none, tmd_e1 < 0.5 * none]),
        format!("after the transient {none:.0} J without damper, {e1:.0} J with the SSVI NES, {tmd_e1:.0} J with the TMD"),
    );
    item.statement(
        "The SSVI NES takes energy from the PS somewhat better than the TMD",
        "Holds if after the transient E1max is the smaller and R2 the larger with the SSVI NES than with the paper's TMD; in part if only one is.",
        Verdict::of_all(&[e1 < tmd_e1, r2 > tmd_r2]),
        format!("largest E1 {e1:.0} J against {tmd_e1:.0} J, largest E2 {e2:.0} J against {tmd_e2:.0} J, R2 {r2:.2} against {tmd_r2:.2}. But the paper's TMD is mistuned: the best one ({words}) has E1 {best_e1:.0} J and R2 {best_r2:.3}"),
    );
    Ok(item)
}

fn over_time(plan: &Plan, scenes: &[Scene; 3], item: &mut Item) -> Result<(), Error> {
    let window = plan.whole_run();
    let record = |scene| recorded(plan, scene, window, INTERVAL);
    let [none, ssvi, tmd] = [record(&scenes[0])?, record(&scenes[1])?, record(&scenes[2])?];
    let top = none.iter().map(|s| s.e1).fold(0.0, f64::max) * 1.05;
    let line = |samples: &[Sample], energy: fn(&Sample) -> f64, i: usize| {
        Layer::line(samples.iter().map(|s| (s.t, energy(s))), LINES[i].0)
    };
    let charts = [("(a) SSVI NES", &ssvi), ("(b) TMD", &tmd)].map(|(title, damper)| {
        let (x, y) = (Axis::linear("t, s", (0.0, window.to)), Axis::linear("E, J", (0.0, top)));
        let layers = vec![line(&none, |s| s.e1, 0), line(damper, |s| s.e1, 1), line(damper, |s| s.e2, 2)];
        Chart { title: title.to_owned(), ..Chart::of(x, y, layers, 150.0) }
    });
    let sheet = Sheet {
        legend: LINES.map(|(stroke, words)| (Key::Line(stroke), words.to_owned())).to_vec(),
        ..Sheet::page(
            "Energies over time at resonance",
            "E1 of the structure without damper and with one, and E2 of the damper, from rest: (a) SSVI NES, (b) TMD.",
            charts.to_vec(),
        )
    };
    item.picture("figure6", &sheet, "Energies from rest.");
    let rows = none.iter().zip(&ssvi).zip(&tmd);
    let rows = rows.map(|((n, s), t)| cells![rounded(n.t), n.e1, s.e1, s.e2, t.e1, t.e2]);
    let table = Table::named("t_s,E1_none_J,E1_SSVI_J,E2_SSVI_J,E1_TMD_J,E2_TMD_J");
    item.data("figure6", table.with(rows));
    Ok(())
}

/// A graph of the figure: both dampers over one abscissa.
struct Graph<'a> {
    title: String,
    label: &'static str,
    range: (f64, f64),
    /// The name of the abscissa in files.
    column: &'static str,
    ssvi: &'a [Point],
    tmd: &'a [Point],
}

pub fn figure5(plan: &Plan) -> Result<Item, Error> {
    let stiffnesses = plan.file.k1_range.values();
    let lowest = plan.file.k1.iter().copied().fold(f64::INFINITY, f64::min);
    let bar = plan.watch.progress("figure 5", (2 * stiffnesses.len() + 7 * plan.file.omega.points) as u64);
    let curve = |scene: &Scene, omegas: &[f64]| {
        independent(scene, Parameter::Omega, omegas, plan.window(), &plan.settings(), || bar.inc(1))
    };
    let mut at_resonance = [Vec::new(), Vec::new()];
    for &k1 in &stiffnesses {
        let [_, ssvi, tmd] = plan.scenes(k1)?;
        for (scene, points) in [ssvi, tmd].iter().zip(&mut at_resonance) {
            let run = curve(scene, &[scene.primary.natural_frequency()])?;
            points.extend(run.into_iter().map(|point| Point { value: k1, ..point }));
        }
    }
    let soft = Family::compute(plan, lowest, &*bar)?;
    let tuned = Family::compute(plan, plan.tuned(), &*bar)?;
    let best = best_tmd(plan)?;
    let best_points = curve(&best, &plan.file.omega.values())?;
    bar.finish();
    let graphs = [
        Graph {
            title: "(a) at resonance".to_owned(),
            label: "k1, N/m",
            range: (plan.file.k1_range.from, plan.file.k1_range.to),
            column: "k1_N_per_m",
            ssvi: &at_resonance[0],
            tmd: &at_resonance[1],
        },
        Graph::over_omega(plan, "b", &soft),
        Graph::over_omega(plan, "c", &tuned),
    ];
    let mut item = Item::new(plan.made_by("(a) at resonance, ω = √(k1/m1), which the paper does not state; (b), (c) one run from rest at each frequency."));
    let key = |colour, ratio: usize, words: &str| (Key::Line(stroke(colour, ratio)), words.to_owned());
    let sheet = Sheet {
        legend: vec![
            key(VERMILION, 0, "R1, SSVI NES"),
            key(VERMILION, 1, "R2, SSVI NES"),
            key(BLUE, 0, "R1, TMD"),
            key(BLUE, 1, "R2, TMD"),
        ],
        ..Sheet::page(
            "Energy ratios R1 and R2",
            "R1 = E1max/(E1max + E2max) and R2 = E2max/(E1max + E2max) of the SSVI NES and the TMD: against k1 at resonance, and against ω at two stiffnesses.",
            graphs.iter().map(Graph::chart).collect(),
        )
    };
    item.picture(
        "figure5",
        &sheet,
        "Energy ratios; red the SSVI NES, blue the TMD; dashed the damper's share R₂.",
    );
    for (letter, graph) in ["a", "b", "c"].into_iter().zip(&graphs) {
        item.data(&format!("figure5{letter}"), graph.table());
    }
    let larger = |ssvi: &Point, tmd: &Point| ssvi.ratios()[1] > tmd.ratios()[1];
    let near = |family: &Family, tmd| share(family.near(&family.points[1], tmd, family.half_width), larger);
    let shares = [
        share(at_resonance[0].iter().zip(&at_resonance[1]), larger),
        near(&soft, &soft.points[2]),
        near(&tuned, &tuned.points[2]),
    ];
    let [a, b, c] = shares.map(|share| 100.0 * share);
    item.statement(
        "The SSVI NES realises the energy transfer from PS to damper somewhat better than the TMD (a larger R2)",
        "Holds if R2 is larger than with the paper's TMD at most places of each of the three graphs, of (b) and (c) within half the half-power width c1/(2 m1) of resonance, where a damper matters; in part if of one or two.",
        Verdict::of_all(&shares.map(|share| share > 0.5)),
        format!(
            "R2 is the larger with the SSVI NES at {a:.0} % of the stiffnesses of (a), and near resonance at {b:.0} % of the frequencies of (b) and {c:.0} % of (c). But the paper's TMD is mistuned: beside the best one ({}) the SSVI NES has the larger R2 near resonance at {:.0} % of the frequencies of (c)",
            tmd_words(&best),
            100.0 * near(&tuned, &best_points)
        ),
    );
    item.notes.push("E2 is the paper's, with (x2 - D)² in place of the stretch of the spring, and E1max and E2max are reached at different moments: R1 and R2 are no shares of one energy.".into());
    Ok(item)
}

/// The line of a ratio: R2 is dashed.
const fn stroke(colour: Colour, ratio: usize) -> Stroke {
    Stroke::new(colour, 1.1, if ratio == 0 { Dash::Solid } else { Dash::Long })
}

impl<'a> Graph<'a> {
    fn over_omega(plan: &Plan, letter: &str, family: &'a Family) -> Self {
        Self {
            title: format!("({letter}) k1 = {} N/m", stiffness(family.k1)),
            label: "ω, rad/s",
            range: (plan.file.omega.from, plan.file.omega.to),
            column: "omega_rad_per_s",
            ssvi: &family.points[1],
            tmd: &family.points[2],
        }
    }

    fn chart(&self) -> Chart {
        let line = |points: &[Point], colour, ratio: usize| {
            Layer::line(points.iter().map(|p| (p.value, p.ratios()[ratio])), stroke(colour, ratio))
        };
        let (x, y) = (Axis::linear(self.label, self.range), Axis::linear("R1, R2", (-0.03, 1.05)));
        let both = |points, colour| [0, 1].map(|ratio| line(points, colour, ratio));
        let layers = [both(self.ssvi, VERMILION), both(self.tmd, BLUE)].concat();
        Chart { title: self.title.clone(), ..Chart::of(x, y, layers, 125.0) }
    }

    fn table(&self) -> Table {
        let row = |(ssvi, tmd): (&Point, &Point)| {
            let ratios = [ssvi, tmd].map(Point::ratios).concat();
            cells![ssvi.value].into_iter().chain(ratios.into_iter().map(Cell::from)).collect()
        };
        let rows = self.ssvi.iter().zip(self.tmd).map(row);
        Table::named(&format!("{},R1_SSVI,R2_SSVI,R1_TMD,R2_TMD", self.column)).with(rows)
    }
}
