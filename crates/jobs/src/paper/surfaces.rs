//! Figure 2: the surfaces over two parameters at a time.

use super::item::{Item, Verdict, numbers};
use super::measures::over_band;
use super::plan::Plan;
use crate::Error;
use crate::amount;
use crate::tune::pictures::label;
use rayon::prelude::*;
use retune_dynamics::parameter::evenly;
use retune_model::Measure;
use retune_optim::{DesignObjective, Goal, Objective, Parameter, Response};
use retune_report::{Nodes, Place, Scale, Sheet, Width, heat_map, svg};
use retune_study::Study;
use retune_study::short;

/// A surface of Figure 2.
struct Surface {
    name: &'static str,
    title: &'static str,
    variables: [Parameter; 2],
    ranges: [(f64, f64); 2],
}

const POINTS: usize = 41;
/// The same where only the verdicts are wanted.
const BRIEF: [usize; 2] = [21, 16];
/// Nodes of a side, and samples of the band, of the surfaces of the worst case.
const COARSE: usize = 31;
const SAMPLES: usize = 31;
/// Stiffest spring of a node that is ranked, N/m: of the TMD that of its row, of the SSVI NES a little above that of its row.
const STIFFEST: [f64; 2] = [600.0, 300.0];
/// Share of the nodes among which a point passes for an optimum that was read from a surface.
const AMONG: f64 = 0.05;
const TMD: Surface = Surface {
    name: "figure2-tmd",
    title: "TMD",
    variables: [Parameter::K2, Parameter::C2],
    ranges: [(100.0, 4000.0), (20.0, 500.0)],
};
const SSVI: [Surface; 2] = [
    Surface {
        name: "figure2-ssvi-k2-c2",
        title: "SSVI NES",
        variables: [Parameter::K2, Parameter::C2],
        ranges: [(50.0, 800.0), (40.0, 440.0)],
    },
    Surface {
        name: "figure2-ssvi-D-C",
        title: "SSVI NES",
        variables: [Parameter::D, Parameter::C],
        ranges: [(0.01, 0.2), (0.05, 0.65)],
    },
];

/// The result for a surface.
struct Found {
    best: [f64; 2],
    best_value: f64,
    paper: [f64; 2],
    paper_value: f64,
    /// Between nodes.
    step: [f64; 2],
    /// Nodes with springs no stiffer than plotted for, and those among them that are better than the paper's point.
    nodes: usize,
    better: usize,
}

/// An objective of the surfaces.
struct Plotted {
    /// What is added to names and titles.
    name: &'static str,
    words: &'static str,
    points: usize,
    objective: Objective,
    stiffest: f64,
}

/// Makes Figure 2.
///
/// # Errors
/// A study without a damper.
pub fn figure2(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(
        "figure2",
        "Figure 2. The surf surfaces",
        "Two surfaces of E1max at k1 = 3.95e4 N/m on which approximate optima were read with the Data Tip. Axes and ranges are not in the text.",
        plan.made_by(&format!(
            "{POINTS} × {POINTS} runs a surface; the other two parameters at the paper's optimum."
        )),
    );
    let [fine, coarse] = if plan.is_brief { BRIEF } else { [POINTS, COARSE] };
    let bar = plan.watch.progress("figure 2", (3 * (fine * fine + coarse * coarse)) as u64);
    let done = || bar.inc(1);
    let at_one = Plotted {
        name: "",
        words: "at ω = 6.28 rad/s",
        points: fine,
        objective: Objective::default(),
        stiffest: f64::INFINITY,
    };
    let worst = |response, stiffest| Plotted {
        name: "-worst",
        words: "at its worst over 5 to 8 rad/s (coarse)",
        points: coarse,
        objective: over_band(SAMPLES, response),
        stiffest,
    };
    let tmd = surface(plan, &plan.tmd, &TMD, &at_one, &mut item, &done)?;
    let ssvi = [
        surface(plan, &plan.ssvi, &SSVI[0], &at_one, &mut item, &done)?,
        surface(plan, &plan.ssvi, &SSVI[1], &at_one, &mut item, &done)?,
    ];
    let steady = worst(Response::Steady, STIFFEST[0]);
    let tmd_worst = surface(plan, &plan.tmd, &TMD, &steady, &mut item, &done)?;
    let bounded = worst(Response::Window, STIFFEST[1]);
    let ssvi_worst = [
        surface(plan, &plan.ssvi, &SSVI[0], &bounded, &mut item, &done)?,
        surface(plan, &plan.ssvi, &SSVI[1], &bounded, &mut item, &done)?,
    ];
    bar.finish();
    let near =
        |found: &Found| (0..2).all(|side| (found.paper[side] - found.best[side]).abs() <= found.step[side]);
    let words = |found: &Found| {
        format!(
            "best node ({}, {}): {:.0} J; the paper's point ({}, {}): {:.0} J",
            short(found.best[0]),
            short(found.best[1]),
            found.best_value,
            found.paper[0],
            found.paper[1],
            found.paper_value
        )
    };
    let rule = "Holds if the paper's point is no further than one step of the grid from the best node, in both directions: so near is what can be read from a surface.";
    item.statement(
        "The surface gives the approximate optimum of the TMD",
        rule,
        Verdict::of(near(&tmd)),
        words(&tmd),
    );
    let verdict = Verdict::of_all(&ssvi.each_ref().map(near));
    let found = format!("over k2 and c2, {}; over D and C, {}", words(&ssvi[0]), words(&ssvi[1]));
    item.statement("The surface gives the approximate optimum of the SSVI NES", rule, verdict, found);
    let ranked = |found: &Found| {
        format!(
            "{} of {} nodes are better than the paper's point ({}, {}) by the same coarse samples",
            found.better, found.nodes, found.paper[0], found.paper[1]
        )
    };
    let among = |found: &Found| found.better as f64 <= AMONG * found.nodes as f64;
    item.conjecture(
        "the surfaces showed the worst over ω, with k2 bounded",
        "The paper names neither the objective nor the ranges of its surfaces. Under the worst E1max over 5 to 8 rad/s, with k2 at most 600 N/m (TMD) and 300 N/m (SSVI NES), holds if on all three surfaces at most one node in twenty is better than the paper's point; in part if on one or two.",
        Verdict::of_all(&[among(&tmd_worst), among(&ssvi_worst[0]), among(&ssvi_worst[1])]),
        format!(
            "TMD: {}; SSVI NES over k2 and c2: {}; over D and C: {}",
            ranked(&tmd_worst),
            ranked(&ssvi_worst[0]),
            ranked(&ssvi_worst[1])
        ),
    );
    item.notes.push("The SSVI NES's surfaces are rugged where the motion is chaotic: neighbouring nodes differ by tens of joules, and a best node is partly luck.".into());
    Ok(item)
}

fn surface(
    plan: &Plan,
    study: &Study,
    surface: &Surface,
    plotted: &Plotted,
    item: &mut Item,
    done: &(impl Fn() + Sync),
) -> Result<Found, Error> {
    let refuse = |problem: String| Error::Figure { name: surface.name.to_owned(), problem };
    let damper = study.scene.damper.ok_or_else(|| refuse("the study has no damper".into()))?;
    let &Plotted { name, words, points, stiffest, .. } = plotted;
    let goal = Goal { objective: plotted.objective.clone(), ..plan.window().into() };
    let objective =
        DesignObjective::new(study.scene, damper, surface.variables.to_vec(), goal, plan.settings());
    let [xs, ys] = surface.ranges.map(|(from, to)| evenly(from, to, points));
    let designs: Vec<[f64; 2]> = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect();
    let value = |design: &[f64; 2]| {
        let value = objective.value(design, f64::INFINITY);
        done();
        value
    };
    let values: Vec<f64> = designs.par_iter().map(value).collect();
    let best = (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
    let paper = surface.variables.map(|variable| variable.get(&damper));
    let paper_value = objective.value(&paper, f64::INFINITY);
    let springs = surface.variables[0] == Parameter::K2;
    let ranked: Vec<f64> = designs
        .iter()
        .zip(&values)
        .filter(|(design, _)| !springs || design[0] <= stiffest)
        .map(|(_, value)| *value)
        .collect();
    let found = Found {
        nodes: ranked.len(),
        better: ranked.iter().filter(|value| **value < paper_value).count(),
        best: designs[best],
        best_value: values[best],
        paper,
        paper_value,
        step: [xs[1] - xs[0], ys[1] - ys[0]],
    };
    let sides = [(0, &xs), (1, &ys)].map(|(side, nodes)| Nodes {
        label: label(surface.variables[side]),
        scale: Scale::Linear,
        values: nodes.clone(),
    });
    let places = [
        Place { at: (found.best[0], found.best[1]), label: format!("best node, {:.0} J", found.best_value) },
        Place { at: (paper[0], paper[1]), label: format!("the paper's, {:.0} J", found.paper_value) },
    ];
    let (chart, legend) = heat_map(&sides, &values, &amount::label(Measure::Energy), &places);
    let [a, b] = surface.variables;
    let svg = svg(&Sheet {
        title: format!("{}: E1max {words} over {a} and {b}", surface.title),
        description: format!(
            "A map of {points} by {points} cells. Marked: {}.",
            places.map(|place| place.label).join("; ")
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: Vec::new(),
    });
    let file = format!("{}{name}", surface.name);
    item.picture(&file, svg, &format!("{}: E₁max {words} over {a} and {b}.", surface.title));
    let rows = designs.iter().zip(&values).map(|(design, value)| vec![design[0], design[1], *value]);
    item.data.push((format!("{file}.csv"), numbers(&format!("{a},{b},E1max_J"), rows)));
    Ok(found)
}
