//! "This stiff set of equations is integrated with the stiff solver ode23s": what it costs beside explicit methods.

use super::item::{Grid, Item, Verdict};
use super::plan::Plan;
use crate::Error;
use retune_solver::{Method, Settings, Window, simulate};

/// Seconds over which methods are compared, before a chaotic motion has magnified their errors.
const EARLY: f64 = 10.0;
/// Tolerances of the methods, looser ones first.
const TOLERANCES: [f64; 8] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// Errors of the state at the end that the methods are compared at, relative.
const ERRORS: [f64; 3] = [1e-1, 1e-2, 1e-3];
/// The paper's method first, then an explicit one of its order, then one of a higher order.
const METHODS: [(Method, &str); 3] =
    [(Method::Ode23s, "2, stiff"), (Method::Ode23, "2(3), explicit"), (Method::Ode45, "5, explicit")];

/// Adds the table of evaluations, and the statement that it decides.
///
/// # Errors
/// A run fails.
pub fn stiffness(plan: &Plan, item: &mut Item) -> Result<(), Error> {
    let window = Window { from: 0.0, to: EARLY.min(plan.window().to) };
    let scene = plan.ssvi.scene;
    let exact = simulate(&scene, window, &plan.settings())?.final_state;
    let size = exact.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    let run = |method: Method, rtol: f64| -> Result<(f64, u64), Error> {
        let settings = Settings { method, rtol, atol: 0.01 * rtol, ..plan.settings() };
        let run = simulate(&scene, window, &settings)?;
        let error = run.final_state.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        Ok((error / size, run.work.evaluations))
    };
    let caption =
        "Evaluations of the equations for an error of the state after 10 s, and the rtol that they take";
    let mut grid = Grid::new(caption, &["method", "order", "error 1e-1", "error 1e-2", "error 1e-3"]);
    let mut costs = Vec::new();
    for (method, order) in METHODS {
        let runs =
            TOLERANCES.map(|rtol| run(method, rtol).map(|(error, evaluations)| (rtol, error, evaluations)));
        let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
        // The loosest tolerance from which on every tighter one comes as near: a lucky run does not count.
        let cost = |most: f64| {
            let first = runs.iter().rposition(|(_, error, _)| *error > most).map_or(0, |last| last + 1);
            runs.get(first).map(|&(rtol, _, evaluations)| (rtol, evaluations))
        };
        let cost = ERRORS.map(cost);
        let cell = |cost: &Option<(f64, u64)>| {
            cost.map_or("not reached".to_owned(), |(rtol, evaluations)| {
                format!("{evaluations} (rtol {rtol:e})")
            })
        };
        let mut row = vec![method.name().to_owned(), order.to_owned()];
        row.extend(cost.iter().map(cell));
        grid.rows.push(row);
        costs.push(cost.map(|cost| cost.map_or(u64::MAX, |(_, evaluations)| evaluations)));
    }
    let [stiff, explicit, higher] = [0, 1, 2].map(|method| costs[method]);
    let cheaper = |other: [u64; 3]| ERRORS.iter().enumerate().filter(|(i, _)| stiff[*i] < other[*i]).count();
    let of = ERRORS.len();
    item.statement(
        "The equations are stiff, and integrated with the stiff solver ode23s",
        "Stiff are equations that a stiff method integrates with less work than an explicit one of the same order. Holds if ode23s needs fewer evaluations than ode23 at each error of the state after 10 s from a tenth to a thousandth, all with contacts located; in part if at some. A contact is short, not stiff: its time scale limits the step of any method that follows it.",
        Verdict::of_all(&[0, 1, 2].map(|i| stiff[i] < explicit[i])),
        format!(
            "ode23s needs fewer than ode23 at {} of {of} errors, and fewer than ode45, whose order is higher, at {} (table)",
            cheaper(explicit),
            cheaper(higher)
        ),
    );
    item.grids.push(grid);
    Ok(())
}
