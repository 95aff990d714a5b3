//! Figure 2: the surfaces over two parameters at a time.

use super::item::{Item, Verdict, numbers};
use super::plan::Plan;
use rayon::prelude::*;
use retune_dynamics::parameter::evenly;
use retune_figures::{Nodes, Place, Scale, Sheet, Width, heat_map, svg};
use retune_model::Measure;
use retune_optim::{PeakEnergy, Variable};
use retune_study::Study;
use retune_study::short;
use retune_workbench::Error;
use retune_workbench::amount;
use retune_workbench::tune::pictures::label;

/// A surface of Figure 2.
struct Surface {
    name: &'static str,
    title: &'static str,
    variables: [Variable; 2],
    ranges: [(f64, f64); 2],
}

const POINTS: usize = 41;
const TMD: Surface = Surface {
    name: "figure2-tmd",
    title: "TMD",
    variables: [Variable::K2, Variable::C2],
    ranges: [(100.0, 4000.0), (20.0, 500.0)],
};
const SSVI: [Surface; 2] = [
    Surface {
        name: "figure2-ssvi-k2-c2",
        title: "SSVI NES",
        variables: [Variable::K2, Variable::C2],
        ranges: [(50.0, 800.0), (40.0, 440.0)],
    },
    Surface {
        name: "figure2-ssvi-D-C",
        title: "SSVI NES",
        variables: [Variable::D, Variable::C],
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
    let bar = plan.watch.progress("figure 2", (3 * POINTS * POINTS) as u64);
    let done = || bar.inc(1);
    let tmd = surface(plan, &plan.tmd, &TMD, &mut item, &done)?;
    let ssvi = [
        surface(plan, &plan.ssvi, &SSVI[0], &mut item, &done)?,
        surface(plan, &plan.ssvi, &SSVI[1], &mut item, &done)?,
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
    item.notes.push("The SSVI NES's surfaces are rugged where the motion is chaotic: neighbouring nodes differ by tens of joules, and a best node is partly luck.".into());
    Ok(item)
}

fn surface(
    plan: &Plan,
    study: &Study,
    surface: &Surface,
    item: &mut Item,
    done: &(impl Fn() + Sync),
) -> Result<Found, Error> {
    let refuse = |problem: String| Error::Figure { name: surface.name.to_owned(), problem };
    let damper = study.scene.damper.ok_or_else(|| refuse("the study has no damper".into()))?;
    let objective =
        PeakEnergy::new(study.scene, damper, surface.variables.to_vec(), plan.window(), plan.settings());
    let [xs, ys] = surface.ranges.map(|(from, to)| evenly(from, to, POINTS));
    let designs: Vec<[f64; 2]> = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect();
    let value = |design: &[f64; 2]| {
        let value = objective.value(design, f64::INFINITY);
        done();
        value
    };
    let values: Vec<f64> = designs.par_iter().map(value).collect();
    let best = (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
    let paper = surface.variables.map(|variable| variable.get(&damper));
    let found = Found {
        best: designs[best],
        best_value: values[best],
        paper,
        paper_value: objective.value(&paper, f64::INFINITY),
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
        title: format!("{}: E1max over {a} and {b}", surface.title),
        description: format!(
            "A map of {POINTS} by {POINTS} cells. Marked: {}.",
            places.map(|place| place.label).join("; ")
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: Vec::new(),
    });
    item.picture(surface.name, svg, &format!("{}: E₁max over {a} and {b}.", surface.title));
    let rows = designs.iter().zip(&values).map(|(design, value)| vec![design[0], design[1], *value]);
    item.data.push((format!("{}.csv", surface.name), numbers(&format!("{a},{b},E1max_J"), rows)));
    Ok(found)
}
