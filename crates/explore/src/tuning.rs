//! Tunes from the page's design: the refinement of the study's search, with its log, drawn over a map of the objective, and a descent by
//! derivatives from its end, as in `retune optimize`.

use crate::limits::{MOST_EVALUATIONS, MOST_EVALUATIONS_OF_DESCENT, MOST_RUNS, MOST_RUNS_OF_DESCENT};
use crate::protocol::{Answer, Place};
use crate::refused::Refused;
use crate::start::Start;
use retune_jobs::tune::{log, objective::searched};
use retune_model::Parameter;
use retune_optim::{DesignObjective, Foot, Objective, Response, Scale, Stop, minimize, value_of};
use retune_study::{Search, Study, rounded};
use std::ops::ControlFlow;

/// Cells of the map along each of its sides.
const CELLS: [usize; 2] = [25, 17];

/// Runs the search. `send` receives the map as it is computed, a row for each iteration, and finally the best design.
///
/// # Errors
/// The study cannot be tuned from this place.
pub fn tune(
    start: &Start,
    place: &Place,
    send: &(dyn Fn(Answer) + Sync),
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<(), Refused> {
    let study = Study { ..start.at(place)? };
    study.check().map_err(Refused::whole)?;
    let search = study.search().map_err(Refused::whole)?;
    let runs = runs(&study.objective());
    if runs > MOST_RUNS {
        let problem =
            format!("{runs} runs behind each value are too many for this page: `retune optimize` makes them");
        return Err(Refused::of("optimize.objective", problem));
    }
    let objective = searched(&study, &search, &search.variables).within(MOST_EVALUATIONS_OF_DESCENT);
    let first: Vec<f64> = search.variables.iter().map(|variable| variable.get(&search.damper)).collect();
    let map = Map::of(&search, &first);
    let quantity = study.quantity();
    let mut begin = Answer::new("tuning")
        .with("header", log::screen_header(&search.variables, quantity))
        .with("variables", &search.variables);
    if let Some(map) = &map {
        begin = map.describe(begin, &search, &first);
    }
    send(begin);

    let finished = std::sync::atomic::AtomicBool::new(false);
    let is_over = || is_stale() || finished.load(std::sync::atomic::Ordering::SeqCst);
    std::thread::scope(|scope| {
        if let Some(map) = &map {
            scope.spawn(|| map.draw(&objective, &first, send, is_stale));
        }
        let mut found = refine(&objective, &search, &first, send, &is_over);
        if let Ok(found) = &mut found
            && found.stop == Stop::Converged
            && objective.goal().has_pieces()
            && runs <= MOST_RUNS_OF_DESCENT
        {
            // In a kink, where several peaks are equally high, a simplex stops before it arrives.
            let Foot { end, counts, .. } = objective.descend(&search.options.bounds, &found.x);
            found.func_count += counts.evaluations;
            if end.value < found.value {
                (found.x, found.value) = (end.x, end.value);
            }
        }
        finished.store(true, std::sync::atomic::Ordering::SeqCst);
        let found = found.map_err(Refused::whole)?;
        let damper = objective.damper(&found.x).map_err(Refused::whole)?;
        let design: serde_json::Map<_, _> = Parameter::columns(&search.variables)
            .iter()
            .map(|column| (column.to_string(), serde_json::json!(column.get(&damper))))
            .filter(|(_, value)| !value.is_null())
            .collect();
        let words = match found.stop {
            Stop::Converged => "converged",
            Stop::Interrupted => "stopped; the best design so far is kept",
            Stop::MaxIter | Stop::MaxFunEvals => "ended at the most evaluations that it may make",
        };
        send(
            Answer::new("tuned")
                .with("design", design)
                .with("value", value_of(found.value))
                .with("worth", rounded(value_of(found.value), 6))
                .with("unit", quantity.unit())
                .with("stop", words)
                .with("iterations", found.iterations)
                .with("evaluations", found.func_count),
        );
        Ok(())
    })
}

fn refine(
    objective: &DesignObjective,
    search: &Search,
    first: &[f64],
    send: &(dyn Fn(Answer) + Sync),
    is_over: &(dyn Fn() -> bool + Sync),
) -> Result<retune_optim::Minimum, retune_optim::Error> {
    let mut options = search.options.clone();
    options.max_fun_evals =
        Some(options.max_fun_evals.map_or(MOST_EVALUATIONS, |most| most.min(MOST_EVALUATIONS)));
    // A stopped search makes no more runs: values not computed are infinite. The first value is always computed.
    let begun = std::cell::Cell::new(false);
    let value_at = |design: &[f64], cutoff: f64| {
        let first = !begun.replace(true);
        value(objective, design, cutoff, &|| first || !is_over())
    };
    minimize(value_at, first, options, |row| {
        if let Ok(damper) = objective.damper(&row.best) {
            let columns = Parameter::columns(&search.variables);
            let values: Vec<f64> = columns.iter().map(|column| column.get(&damper)).collect();
            let answer =
                Answer::new("row").with("text", log::screen(row, &values)).with("value", value_of(row.value));
            send(answer.with("best", &row.best));
        }
        if is_over() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
}

/// The value of a design for a search; infinite if it has none or the search is stopped.
fn value(
    objective: &DesignObjective,
    design: &[f64],
    cutoff: f64,
    proceed: &(dyn Fn() -> bool + Sync),
) -> f64 {
    let found = objective.scene(design).and_then(|scene| objective.evaluate_while(&scene, cutoff, proceed));
    found.map_or(f64::INFINITY, |found| found.ranked)
}

/// Number of runs behind a value, without those that locate the maxima of a band.
fn runs(objective: &Objective) -> usize {
    let term = |(_, term): (f64, &Objective)| {
        let k1 = term.k1.as_ref().map_or(1, |k1| k1.samples().len());
        let omega = term.omega.map_or(1, |band| band.samples);
        let members = term.ensemble.map_or(1, |ensemble| ensemble.members as usize);
        let motions = if term.response == Response::Motions { 100 } else { 1 };
        let losses = term.restitution.as_ref().map_or(1, Vec::len);
        omega.saturating_mul(k1).saturating_mul(losses).saturating_mul(members).saturating_mul(motions)
    };
    objective.terms().into_iter().map(term).fold(0, usize::saturating_add)
}

/// A slice through the start along the first two tuned parameters.
struct Map {
    axes: [(usize, Vec<f64>, bool); 2],
}

impl Map {
    fn of(search: &Search, first: &[f64]) -> Option<Self> {
        let axis = |place: usize| {
            let grid = search.surf.as_ref().and_then(|(over, grid)| {
                let at = over.iter().position(|variable| *variable == search.variables[place])?;
                let axis = &grid.axes()[at];
                Some((axis.from(), axis.to(), axis.scale() == Scale::Log))
            });
            let bounds = search.options.bounds.get(place)?;
            let value = first[place];
            let about = if value > 0.0 { [0.25 * value, 4.0 * value] } else { [0.0, 1.0] };
            let (from, to, log) = grid.unwrap_or_else(|| {
                let from = bounds.lower.map_or(about[0], |lower| about[0].max(lower));
                let to = bounds.upper.map_or(about[1], |upper| about[1].min(upper));
                (from, to, from > 0.0)
            });
            let (from, to) = (from.min(value), to.max(value));
            let log = log && from > 0.0;
            let cells = CELLS[place];
            let share = |cell: usize| cell as f64 / (cells - 1) as f64;
            let at = |cell: usize| match log {
                true => from * (to / from).powf(share(cell)),
                false => from + (to - from) * share(cell),
            };
            (from < to).then(|| (place, (0..cells).map(at).collect(), log))
        };
        (search.variables.len() >= 2).then_some(())?;
        Some(Self { axes: [axis(0)?, axis(1)?] })
    }

    fn describe(&self, mut answer: Answer, search: &Search, first: &[f64]) -> Answer {
        let others = search.variables.iter().zip(first).skip(2);
        let others: Vec<String> =
            others.map(|(v, value)| format!("{v} = {} {}", rounded(*value, 4), v.unit())).collect();
        answer = answer.with("at", others.join(", "));
        for (name, (place, values, log)) in ["x", "y"].into_iter().zip(&self.axes) {
            let variable = search.variables[*place];
            let label = format!("{variable}, {}", variable.unit());
            answer =
                answer.with(name, serde_json::json!({ "label": label, "log": log })).column(name, values);
        }
        answer
    }

    /// Computes the map row by row from below, which is easier to follow than from the middle outwards.
    fn draw(
        &self,
        objective: &DesignObjective,
        first: &[f64],
        send: &(dyn Fn(Answer) + Sync),
        is_stale: &(dyn Fn() -> bool + Sync),
    ) {
        let [(i, x, _), (j, y, _)] = &self.axes;
        let mut design = first.to_vec();
        for (row, y) in y.iter().enumerate() {
            let mut values = Vec::with_capacity(x.len());
            for x in x {
                if is_stale() {
                    return;
                }
                (design[*i], design[*j]) = (*x, *y);
                values.push(value_of(value(objective, &design, f64::INFINITY, &|| !is_stale())));
            }
            send(Answer::new("map").with("row", row).column("value", &values));
        }
    }
}
