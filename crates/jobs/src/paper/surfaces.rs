//! Figure 2: the surfaces over two parameters at a time.

use super::item::Item;
use super::measures::over_band;
use super::plan::{Plan, damper};
use crate::Error;
use crate::amount;
use crate::tune::pictures::label;
use rayon::prelude::*;
use retune_dynamics::parameter::evenly;
use retune_model::Measure;
use retune_optim::{DesignObjective, Goal, Objective, Parameter, Response};
use retune_report::document::Verdict;
use retune_report::table::Table;
use retune_report::{Nodes, Place, Scale, Sheet, Width, cells, heat_map};
use retune_study::short;

/// Nodes per side at one frequency, and in the worst case.
const POINTS: [usize; 2] = [41, 31];
/// Nodes per side where only the verdicts are needed.
const BRIEF: [usize; 2] = [21, 16];
/// Samples of the band of the worst case.
const SAMPLES: usize = 31;
/// A point counts as an optimum read from a surface if at most this share of the nodes is better.
const AMONG: f64 = 0.05;

struct Surface {
    name: &'static str,
    variables: [Parameter; 2],
    ranges: [(f64, f64); 2],
    /// Stiffest spring of the nodes ranked in the worst case, N/m: for the TMD that of its row, for the SSVI NES slightly more.
    stiffest: f64,
}

/// The surface of the TMD, and the two of the SSVI NES.
const SURFACES: [Surface; 3] = [
    Surface {
        name: "figure2-tmd",
        variables: [Parameter::K2, Parameter::C2],
        ranges: [(100.0, 4000.0), (20.0, 500.0)],
        stiffest: 600.0,
    },
    Surface {
        name: "figure2-ssvi-k2-c2",
        variables: [Parameter::K2, Parameter::C2],
        ranges: [(50.0, 800.0), (40.0, 440.0)],
        stiffest: 300.0,
    },
    Surface {
        name: "figure2-ssvi-D-C",
        variables: [Parameter::D, Parameter::C],
        ranges: [(0.01, 0.2), (0.05, 0.65)],
        stiffest: f64::INFINITY,
    },
];

/// A point of a surface and its energy, J.
#[derive(Clone, Copy)]
struct Point {
    at: [f64; 2],
    energy: f64,
}

/// The result for a surface.
struct Outcome {
    best: Point,
    paper: Point,
    /// Whether the paper's point is no further than one step of the grid from the best node, in both directions.
    is_near: bool,
    /// Number of ranked nodes, and of those among them that are better than the paper's point.
    nodes: usize,
    better: usize,
}

pub fn figure2(plan: &Plan) -> Result<Item, Error> {
    let [fine, coarse] = if plan.is_brief { BRIEF } else { POINTS };
    let mut item = Item::new(plan.made_by(&format!(
        "{0} × {0} runs a surface; the other two parameters at the paper's optimum.",
        POINTS[0]
    )));
    let bar = plan.watch.progress("figure 2", (3 * (fine * fine + coarse * coarse)) as u64);
    let done = || bar.inc(1);
    let mut outcomes = Vec::new();
    for (is_worst, points) in [(false, fine), (true, coarse)] {
        for surface in &SURFACES {
            outcomes.push(surface.compute(plan, is_worst, points, &mut item, &done)?);
        }
    }
    bar.finish();
    let [at_one, worst] = [0, 3].map(|first| &outcomes[first..first + 3]);
    let words = |Outcome { best, paper, .. }: &Outcome| {
        let ([x, y], [paper_x, paper_y]) = (best.at.map(short), paper.at);
        let (least, own) = (best.energy, paper.energy);
        format!("best node ({x}, {y}): {least:.0} J; the paper's point ({paper_x}, {paper_y}): {own:.0} J")
    };
    let rule = "Holds if the paper's point is no further than one step of the grid from the best node, in both directions: so near is what can be read from a surface.";
    item.statement(
        "The surface gives the approximate optimum of the TMD",
        rule,
        Verdict::of(at_one[0].is_near),
        words(&at_one[0]),
    );
    item.statement(
        "The surface gives the approximate optimum of the SSVI NES",
        rule,
        Verdict::of_all(&[1, 2].map(|i| at_one[i].is_near)),
        format!("over k2 and c2, {}; over D and C, {}", words(&at_one[1]), words(&at_one[2])),
    );
    let [tmd, k2_c2, d_c] = [0, 1, 2].map(|i| {
        let Outcome { better, nodes, paper: Point { at: [x, y], .. }, .. } = &worst[i];
        format!("{better} of {nodes} nodes are better than the paper's point ({x}, {y}) by the same coarse samples")
    });
    item.conjecture(
        "the surfaces showed the worst over ω, with k2 bounded",
        "The paper names neither the objective nor the ranges of its surfaces. Under the worst E1max over 5 to 8 rad/s, with k2 at most 600 N/m (TMD) and 300 N/m (SSVI NES), holds if on all three surfaces at most one node in twenty is better than the paper's point; in part if on one or two.",
        Verdict::of_all(&[0, 1, 2].map(|i| worst[i].better as f64 <= AMONG * worst[i].nodes as f64)),
        format!("TMD: {tmd}; SSVI NES over k2 and c2: {k2_c2}; over D and C: {d_c}"),
    );
    item.notes.push("The SSVI NES's surfaces are rugged where the motion is chaotic: neighbouring nodes differ by tens of joules, and a best node is partly luck.".into());
    Ok(item)
}

impl Surface {
    /// Computes the energies at the nodes, and draws them: at one frequency, or in the worst case.
    fn compute(
        &self,
        plan: &Plan,
        is_worst: bool,
        points: usize,
        item: &mut Item,
        done: &(impl Fn() + Sync),
    ) -> Result<Outcome, Error> {
        let (title, study, response) = match self.name {
            "figure2-tmd" => ("TMD", &plan.tmd, Response::Steady),
            _ => ("SSVI NES", &plan.ssvi, Response::Window),
        };
        let damper = damper(study)?;
        let (suffix, words, objective, stiffest) = if is_worst {
            let words = "at its worst over 5 to 8 rad/s (coarse)";
            ("-worst", words, over_band(SAMPLES, response), self.stiffest)
        } else {
            ("", "at ω = 6.28 rad/s", Objective::default(), f64::INFINITY)
        };
        let words = format!("{title}: E1max {words}");
        let goal = Goal { objective, ..plan.window().into() };
        let objective =
            DesignObjective::new(study.scene, damper, self.variables.to_vec(), goal, plan.settings());
        let point = |at: [f64; 2]| Point { at, energy: objective.value(&at, f64::INFINITY) };
        let sides = self.ranges.map(|(from, to)| evenly(from, to, points));
        let [xs, ys] = &sides;
        let designs: Vec<[f64; 2]> = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect();
        let nodes: Vec<Point> = designs.par_iter().map(|design| point(*design)).inspect(|_| done()).collect();
        let paper = point(self.variables.map(|variable| variable.get(&damper)));
        let best = nodes.iter().copied().min_by(|a, b| a.energy.total_cmp(&b.energy)).unwrap_or(paper);
        self.draw(&format!("{}{suffix}", self.name), &words, &sides, &nodes, [best, paper], item);
        let ranked = nodes.iter().filter(|node| node.at[0] <= stiffest);
        let step = [xs[1] - xs[0], ys[1] - ys[0]];
        Ok(Outcome {
            best,
            paper,
            is_near: (0..2).all(|side| (paper.at[side] - best.at[side]).abs() <= step[side]),
            nodes: ranked.clone().count(),
            better: ranked.filter(|node| node.energy < paper.energy).count(),
        })
    }

    fn draw(
        &self,
        file: &str,
        words: &str,
        sides: &[Vec<f64>; 2],
        nodes: &[Point],
        [best, paper]: [Point; 2],
        item: &mut Item,
    ) {
        let sides = [0, 1].map(|side| Nodes {
            label: label(self.variables[side]),
            scale: Scale::Linear,
            values: sides[side].clone(),
        });
        let places = [("best node", best), ("the paper's", paper)].map(|(name, point)| Place {
            at: point.at.into(),
            label: format!("{name}, {:.0} J", point.energy),
        });
        let energies: Vec<f64> = nodes.iter().map(|node| node.energy).collect();
        let (chart, legend) = heat_map(&sides, &energies, &amount::label(Measure::Energy), &places);
        let [a, b] = self.variables;
        let points = sides[0].values.len();
        let marked = places.map(|place| place.label).join("; ");
        let sheet = Sheet {
            width: Width::Column,
            legend,
            ..Sheet::page(
                format!("{words} over {a} and {b}"),
                format!("A map of {points} by {points} cells. Marked: {marked}."),
                vec![chart],
            )
        };
        item.picture(file, &sheet, &format!("{} over {a} and {b}.", words.replace("E1max", "E₁max")));
        let rows = nodes.iter().map(|Point { at: [x, y], energy }| cells![*x, *y, *energy]);
        item.data(file, Table::named(&format!("{a},{b},E1max_J")).with(rows));
    }
}
