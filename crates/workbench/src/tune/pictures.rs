//! The figures of a search: Figure 2's surfaces, and the convergence of the refinement.

use super::log::worth;
use super::refine::Refined;
use super::surf::Surf;
use crate::Error;
use crate::summary::MadeBy;
use retune_figures::{Mark, Nodes, Panel, Scale, scale_for};
use retune_optim::{Variable, energy};
use retune_store::Directory;
use retune_study::{Search, Study};

/// The label of E1max.
pub const ENERGY: &str = "E_{1max}, J";

/// Draws all figures.
pub(super) fn draw(
    study: &Study,
    search: &Search,
    surf: Option<&Surf>,
    refined: &Refined,
    results: &Directory,
) -> Result<(), Error> {
    let made_by = MadeBy::new(study).to_string();
    if let Some(surf) = surf {
        let free: Vec<usize> =
            (0..surf.variables.len()).filter(|&axis| surf.grid.axes()[axis].points() > 1).collect();
        for (i, &x) in free.iter().enumerate() {
            for &y in &free[i + 1..] {
                let name = format!("surf-{}-{}.svg", surf.variables[x], surf.variables[y]);
                let svg = heat_map(surf, [x, y], search, refined, &made_by);
                results
                    .write(&name, &svg.map_err(|problem| Error::Figure { name: name.clone(), problem })?)?;
            }
        }
    }
    let name = "convergence.svg";
    let svg = convergence(search, refined, &made_by);
    results.write(name, &svg.map_err(|problem| Error::Figure { name: name.to_owned(), problem })?)?;
    Ok(())
}

/// The surface over two axes of the grid: the least E1max over all other axes.
fn heat_map(
    surf: &Surf,
    [x, y]: [usize; 2],
    search: &Search,
    refined: &Refined,
    made_by: &str,
) -> Result<String, String> {
    let [columns, lines] = [x, y].map(|axis| surf.grid.axes()[axis].points());
    let mut least = vec![f64::INFINITY; columns * lines];
    let mut steps = vec![0; surf.grid.dim()];
    for (i, &value) in surf.values.iter().enumerate() {
        surf.grid.steps(i, &mut steps);
        let cell = &mut least[steps[y] * columns + steps[x]];
        *cell = cell.min(energy(value)); // NaN (an infeasible design) is never the smaller
    }
    let best = surf.point(surf.best);
    let found = |axis: usize| {
        let variable = surf.variables[axis];
        let place = search.variables.iter().position(|other| *other == variable);
        place.map_or(f64::NAN, |place| refined.best().minimum.x[place])
    };
    let others: Vec<&str> = (0..surf.variables.len())
        .filter(|axis| *axis != x && *axis != y)
        .map(|axis| symbol(surf.variables[axis]))
        .collect();
    let what = match others.as_slice() {
        [] => "E_{1max} at each point of the grid.".to_owned(),
        others => format!("Least E_{{1max}} over the grid in {}.", others.join(" and ")),
    };
    let marks = [
        Mark::Grid {
            x: best[x],
            y: best[y],
            label: format!("best of the grid, {}", worth(surf.values[surf.best])),
        },
        Mark::Optimum {
            x: found(x),
            y: found(y),
            label: format!("refined, {}", worth(refined.best().minimum.value)),
        },
    ];
    retune_figures::heat_map(
        &[x, y].map(|axis| nodes(surf, axis)),
        &least,
        ENERGY,
        &marks,
        &[what, made_by.to_owned()],
    )
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

/// E1max and each tuned parameter against the iteration of the best run.
fn convergence(search: &Search, refined: &Refined, made_by: &str) -> Result<String, String> {
    let rows = &refined.best().rows;
    let x: Vec<f64> = rows.iter().map(|row| row.iteration as f64).collect();
    let energies: Vec<f64> = rows.iter().map(|row| energy(row.value)).collect();
    let mut panels = vec![Panel::new(ENERGY.to_owned(), scale_for(&energies), energies)];
    for (i, &variable) in search.variables.iter().enumerate() {
        let values = rows.iter().map(|row| row.best[i]).collect();
        panels.push(Panel::new(label(variable), Scale::Linear, values));
    }
    let what = format!("Best vertex of the simplex, start {} of {}.", refined.winner + 1, refined.runs.len());
    retune_figures::panels("iteration", &x, &panels, &[what, made_by.to_owned()])
}

/// A parameter's symbol and unit, for an axis.
pub fn label(variable: Variable) -> String {
    format!("{}, {}", symbol(variable), variable.unit())
}

/// A parameter's symbol in figures.
fn symbol(variable: Variable) -> &'static str {
    match variable {
        Variable::K2 => "k_{2}",
        Variable::C2 => "c_{2}",
        Variable::D => "D",
        Variable::C => "C",
    }
}
