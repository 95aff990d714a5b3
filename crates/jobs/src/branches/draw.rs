//! The figures of `branches`: E1max of all stable and unstable motions along the parameter, with the bifurcations; the stroke below it; and
//! the basins.

use crate::branches::motions::{Motions, energy};
use crate::pages::abscissa;
use retune_dynamics::periodic::{Basins, Branch, EventKind, Orbit};
use retune_model::Measure;
use retune_report::colour::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION};
use retune_report::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Nodes, Place, Scale, Shape, Sheet, Stroke, Width,
    category_map, drawing, svg,
};
use retune_study::rounded;

const STABLE: Stroke = Stroke::new(BLUE, 1.4, Dash::Solid);
const UNSTABLE: Stroke = Stroke::new(ORANGE, 0.9, Dash::Short);
/// Runs from rest, and those from other starts.
const REST: Mark = Mark::new(Shape::Disc, BLACK, 2.6);
const OTHERS: Mark = Mark::new(Shape::Ring, GREY, 3.6);
const IRREGULAR: f64 = 0.18;
/// Most events of one kind that are marked on a branch: a cascade has any number of them.
const MOST: usize = 40;

fn mark(kind: EventKind) -> Mark {
    match kind {
        EventKind::Fold => Mark { rim: true, ..Mark::new(Shape::Triangle, VERMILION, 5.5) },
        EventKind::BranchPoint => Mark { rim: true, ..Mark::new(Shape::Disc, ORANGE, 5.0) },
        EventKind::PeriodDoubling => Mark { rim: true, ..Mark::new(Shape::Square, PURPLE, 4.5) },
        EventKind::NeimarkSacker => Mark { rim: true, ..Mark::new(Shape::Disc, GREEN, 5.0) },
        EventKind::Grazing => Mark::new(Shape::Cross, BLACK, 4.0),
    }
}

/// All motions along the parameter.
pub fn draw(motions: &Motions) -> Drawing {
    let mut legend = vec![
        (Key::Line(STABLE), "stable motions".to_owned()),
        (Key::Line(UNSTABLE), "unstable motions".to_owned()),
        (Key::Mark(REST), "runs from rest".to_owned()),
        (Key::Mark(OTHERS), "runs from other starts".to_owned()),
    ];
    for kind in EventKind::ALL {
        if motions.branches.branches.iter().any(|branch| branch.events.iter().any(|event| event.kind == kind))
        {
            legend.push((Key::Mark(mark(kind)), kind.name().to_owned()));
        }
    }
    let [_, irregular] = motions.branches.stable_and_irregular();
    if !irregular.is_empty() {
        legend.push((Key::Area(GREY, IRREGULAR), "no stable periodic motion known".to_owned()));
    }
    let stroke = |orbit: &Orbit| orbit.seen.largest(Measure::Stroke);
    let charts = vec![chart(motions, "E1max, J", energy, true), chart(motions, "stroke, m", stroke, false)];
    let caption = vec![motions.made_by()];
    let sheet =
        Sheet { width: Width::Page, stacked: true, legend, caption, ..Sheet::of("Periodic motions", charts) };
    let description = format!(
        "E1max and stroke of all periodic motions that were found, against {}: {}.",
        motions.over().symbol(),
        sheet.legend_words()
    );
    drawing(&Sheet { description, ..sheet })
}

fn chart(motions: &Motions, label: &str, value: fn(&Orbit) -> f64, is_first: bool) -> Chart {
    let plan = &motions.branches.plan;
    let [_, irregular] = motions.branches.stable_and_irregular();
    let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
    let mut layers: Vec<Layer> = irregular
        .iter()
        .map(|[from, to]| Layer::Band { x: (*from, *to), y: everywhere, colour: GREY, opacity: IRREGULAR })
        .collect();
    let branches = &motions.branches.branches;
    let mut values: Vec<f64> = branches.iter().flat_map(|branch| branch.points.iter().map(value)).collect();
    let samples = &motions.branches.samples;
    let attractors = |from_rest: bool| {
        let all = samples.iter().flat_map(|sample| &sample.attractors);
        all.filter(move |one| one.from_rest == from_rest).map(|one| (one.orbit.value, value(&one.orbit)))
    };
    let (mut rest, mut others): (Vec<_>, Vec<_>) = (attractors(true).collect(), attractors(false).collect());
    if is_first {
        for sample in samples {
            for (i, seen) in sample.irregular.iter().enumerate() {
                let point = (sample.value, seen.largest(Measure::Energy));
                if i == 0 && sample.rest_is_irregular { rest.push(point) } else { others.push(point) }
            }
        }
    }
    values.extend(others.iter().chain(&rest).map(|(_, value)| *value));
    layers.extend(branches.iter().map(|branch| line(branch, value, false)));
    layers.extend(branches.iter().map(|branch| line(branch, value, true)));
    layers.push(Layer::Marks { points: others, mark: OTHERS });
    layers.push(Layer::Marks { points: rest, mark: REST });
    for branch in branches {
        for kind in EventKind::ALL.into_iter().rev() {
            let events = branch.events.iter().filter(|event| event.kind == kind).take(MOST);
            let points = events.map(|event| (event.orbit.value, value(&event.orbit))).collect();
            layers.push(Layer::Marks { points, mark: mark(kind) });
        }
    }
    let (y, [from, to]) = (Axis::fitting(label, &values), plan.range);
    let x = abscissa(plan.parameter, Scale::Linear, (from, to), is_first);
    Chart::of(x, y, layers, if is_first { 240.0 } else { 150.0 })
}

/// The stable or the unstable motions of a branch.
fn line(branch: &Branch, value: fn(&Orbit) -> f64, stable: bool) -> Layer {
    let mut points = Vec::new();
    for (i, pair) in branch.points.windows(2).enumerate() {
        if branch.is_stable_after(i) == stable {
            points.extend(pair.iter().map(|orbit| (orbit.value, value(orbit))));
        } else {
            points.push((f64::NAN, f64::NAN));
        }
    }
    Layer::Line { points, stroke: if stable { STABLE } else { UNSTABLE } }
}

/// The basins: each start in a plane, coloured by the motion on which it ends.
pub fn basins(motions: &Motions, basins: &Basins) -> String {
    let place = motions.at(basins.sample.value, 6);
    let side = |label: &str, side: usize| Nodes {
        label: label.to_owned(),
        scale: Scale::Linear,
        values: basins.sides[side].clone(),
    };
    let sides = [side("x1 at the start, m", 0), side("v1 at the start, m/s", 1)];
    let names: Vec<String> = basins
        .sample
        .attractors
        .iter()
        .map(|one| format!("{}: E1max {} J", in_words(&one.orbit), rounded(energy(&one.orbit), 4)))
        .collect();
    let places = [Place { at: (0.0, 0.0), label: "the start from rest".to_owned() }];
    let none = "irregular, or none of these";
    let (chart, legend) = category_map(&sides, &basins.ends, &names, none, &places);
    let what = format!("The motion on which each start ends, at {place}.");
    let sheet = Sheet::of(format!("Basins at {place}"), vec![chart]);
    let sheet = Sheet { legend, caption: vec![what.clone(), motions.made_by()], ..sheet };
    let description = format!("{what} Colours and marks: {}.", sheet.legend_words());
    svg(&Sheet { description, ..sheet })
}

/// A motion in words that need no legend: "repeats every 2 periods, with 2 impacts on the obstacle and 1 on the structure".
fn in_words(orbit: &Orbit) -> String {
    let impacts = |side: char| orbit.seen.impacts.chars().filter(|letter| *letter == side).count();
    let every = if orbit.periods == 1 { "period".to_owned() } else { format!("{} periods", orbit.periods) };
    let counted = |count: usize, wall: &str| {
        format!("{count} {} on the {wall}", if count == 1 { "impact" } else { "impacts" })
    };
    let met = match [impacts('O'), impacts('S')] {
        [0, 0] => "touching no wall".to_owned(),
        [obstacle, 0] => format!("with {}", counted(obstacle, "obstacle")),
        [0, structure] => format!("with {}", counted(structure, "structure")),
        [obstacle, structure] => {
            format!("with {} and {structure} on the structure", counted(obstacle, "obstacle"))
        }
    };
    format!("repeats every {every}, {met}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_dynamics::periodic::seen::Seen;

    #[test]
    fn contract_a_motion_is_named_in_words() {
        let words = |periods, impacts: &str| {
            let seen = Seen { impacts: impacts.to_owned(), ..Seen::default() };
            in_words(&Orbit {
                value: 1.0,
                periods,
                states: Vec::new(),
                multipliers: Default::default(),
                seen,
            })
        };
        assert_eq!(words(1, ""), "repeats every period, touching no wall");
        assert_eq!(words(1, "O"), "repeats every period, with 1 impact on the obstacle");
        assert_eq!(words(3, "SS"), "repeats every 3 periods, with 2 impacts on the structure");
        assert_eq!(
            words(2, "OOS"),
            "repeats every 2 periods, with 2 impacts on the obstacle and 1 on the structure"
        );
    }
}
