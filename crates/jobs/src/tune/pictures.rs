//! The figures of a search: Figure 2's surfaces, and the convergence of the refinement.

use super::log::value_words;
use super::refine::Refined;
use super::surf::Surf;
use crate::summary::MadeBy;
use crate::{Error, amount};
use retune_optim::{Parameter, value_of};
use retune_report::colour::BLUE;
use retune_report::{Axis, Chart, Layer, Nodes, Place, Scale, Sheet, Stroke, scale_for, svg};
use retune_store::Directory;
use retune_study::{Search, Study};

pub(super) fn draw(
    study: &Study,
    search: &Search,
    surf: Option<&Surf>,
    refined: &Refined,
    results: &Directory,
) -> Result<(), Error> {
    if let Some(surf) = surf {
        let free: Vec<usize> =
            (0..surf.variables.len()).filter(|&axis| surf.grid.axes()[axis].points() > 1).collect();
        for (i, &x) in free.iter().enumerate() {
            for &y in &free[i + 1..] {
                let name = format!("surf-{}-{}.svg", surf.variables[x], surf.variables[y]);
                results.write(&name, &heat_map(surf, [x, y], search, refined, study))?;
            }
        }
    }
    results.write("convergence.svg", &convergence(search, refined, study))?;
    Ok(())
}

/// The surface over two axes of the grid: the least E1max over all other axes.
fn heat_map(surf: &Surf, [x, y]: [usize; 2], search: &Search, refined: &Refined, study: &Study) -> String {
    let quantity = study.quantity();
    let [columns, lines] = [x, y].map(|axis| surf.grid.axes()[axis].points());
    let mut least = vec![f64::INFINITY; columns * lines];
    let mut steps = vec![0; surf.grid.dim()];
    let most = study.coarse().up_to();
    for (i, &value) in surf.values.iter().enumerate().filter(|(_, value)| **value < most) {
        surf.grid.steps(i, &mut steps);
        let cell = &mut least[steps[y] * columns + steps[x]];
        *cell = cell.min(value_of(value)); // NaN (an infeasible design) is never the smaller
    }
    let best = surf.point(surf.best);
    let found = |axis: usize| {
        let variable = surf.variables[axis];
        let place = search.variables.iter().position(|other| *other == variable);
        place.map_or(f64::NAN, |place| refined.best().minimum.x[place])
    };
    let others = (0..surf.variables.len()).filter(|axis| *axis != x && *axis != y);
    let others: Vec<String> = others.map(|axis| surf.variables[axis].to_string()).collect();
    let what = match others.as_slice() {
        [] => format!("{} at each point of the grid{}.", quantity.name(), study.coarse()),
        others => {
            format!("Least {} over the grid in {}{}.", quantity.name(), others.join(" and "), study.coarse())
        }
    };
    let above = |most| format!(" Grey: none below {}.", value_words(most, quantity));
    let what = what + &study.coarse().most.map_or_else(String::new, above);
    let places = [
        Place {
            at: (best[x], best[y]),
            label: format!("best of the grid, {}", value_words(surf.least, quantity)),
        },
        Place {
            at: (found(x), found(y)),
            label: format!("refined, {}", value_words(refined.best().minimum.value, quantity)),
        },
    ];
    let (chart, legend) = retune_report::heat_map(
        &[x, y].map(|axis| nodes(surf, axis)),
        &least,
        &amount::label(quantity),
        &places,
    );
    let [over, and] = [x, y].map(|axis| surf.variables[axis]);
    svg(&Sheet {
        description: format!(
            "A map of {columns} by {lines} cells. {what} Marked: {}.",
            places.map(|place| place.label).join("; ")
        ),
        legend,
        caption: vec![what, MadeBy::new(study).to_string()],
        ..Sheet::of(format!("{} over {over} and {and}", quantity.name()), vec![chart])
    })
}

/// An axis of the grid as an axis of a figure.
fn nodes(surf: &Surf, axis: usize) -> Nodes {
    let along = &surf.grid.axes()[axis];
    let values = (0..along.points()).map(|i| along.value(i)).collect();
    let scale = match along.scale() {
        retune_optim::Scale::Linear => Scale::Linear,
        retune_optim::Scale::Log => Scale::Log,
    };
    Nodes { label: label(surf.variables[axis]), scale, values }
}

/// The objective and each tuned parameter against the iteration of the best run.
fn convergence(search: &Search, refined: &Refined, study: &Study) -> String {
    let quantity = study.quantity();
    let rows = &refined.best().rows;
    let chart = |label: String, scale: Option<Scale>, values: Vec<f64>, height: f64| {
        let x = rows.iter().map(|row| row.iteration as f64);
        let y = Axis::around(label, scale.unwrap_or_else(|| scale_for(&values)), values.iter().copied());
        let points = x.clone().zip(values).collect();
        let layers = vec![Layer::Steps { points, stroke: Stroke::solid(BLUE) }];
        Chart::of(Axis::exact("iteration", Scale::Linear, x), y, layers, height)
    };
    let energies: Vec<f64> = rows.iter().map(|row| value_of(row.value)).collect();
    let ends = [energies.first(), energies.last()].map(|e| e.copied().unwrap_or(f64::NAN));
    let mut charts = vec![chart(amount::label(quantity), None, energies, 95.0)];
    for (i, &variable) in search.variables.iter().enumerate() {
        let values = rows.iter().map(|row| row.best[i]).collect();
        charts.push(chart(label(variable), Some(Scale::Linear), values, 65.0));
    }
    if let Some(last) = charts.last_mut() {
        last.height += 25.0;
    }
    let name = quantity.name();
    let what = format!("Best vertex of the simplex, start {} of {}.", refined.winner + 1, refined.runs.len());
    svg(&Sheet {
        description: format!(
            "{name} and the tuned parameters against the iteration, one below the other. {what} {name} from {} to {} in {} iterations.",
            value_words(ends[0], quantity),
            value_words(ends[1], quantity),
            rows.last().map_or(0, |row| row.iteration)
        ),
        stacked: true,
        caption: vec![what, MadeBy::new(study).to_string()],
        ..Sheet::of("Convergence of the refinement", charts)
    })
}

/// A parameter's symbol and unit, for an axis.
pub fn label(variable: Parameter) -> String {
    format!("{variable}, {}", variable.unit())
}
