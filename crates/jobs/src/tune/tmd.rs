//! The best TMD that a damper with walls can be: the gaps as wide as bounds and limits allow, the spring and dashpot optimal in closed
//! form.

use super::objective::searched;
use retune_model::{Damper, Measure, NonNegative, Parameter, Positive};
use retune_optim::{DesignObjective, Foot, Goal, Limit, Response};
use retune_study::{Search, Study};

/// Ranges of the spring and of the dashpot that are searched, as multiples of Den Hartog's optimum.
const TUNINGS: [[f64; 2]; 2] = [[0.03, 30.0], [0.03, 300.0]];
/// Width of a gap without a bound, as a multiple of the stroke.
const OPEN: f64 = 4.0;
/// Largest stroke, as a share of the gap.
const FREE: f64 = 0.999;
/// Share of a gap that stands where the limit of the cavity is why it is no wider, so that one built a little wider keeps it, if the stroke leaves as much.
const WITHIN: f64 = 0.99;

/// The tuned parameters of that TMD; none for a damper without walls, for a steady objective, or where it cannot be computed.
pub(super) fn tmd(study: &Study, search: &Search) -> Option<Vec<f64>> {
    let goal = study.goal();
    if search.damper.contact.is_none() || goal.objective.is_steady() {
        return None;
    }
    let cavity = goal.limits.get(Limit::Cavity);
    let gaps = gaps(search, cavity);
    let room = FREE * gaps[0].min(gaps[1]);
    let springs: Vec<usize> = (0..search.variables.len())
        .filter(|&i| matches!(search.variables[i], Parameter::K2 | Parameter::C2))
        .collect();
    let objective = steady(study, search, &springs, room)?;
    let bounds: Vec<_> = springs.iter().map(|&i| search.options.bounds[i]).collect();
    let (_, valley) = objective.valleys(TUNINGS, &bounds).into_iter().next()?;
    let best = objective.descend(&bounds, &valley).end.x;
    let stroke = objective
        .evaluate(&objective.scene(&best).ok()?, f64::INFINITY)
        .ok()?
        .reached
        .get(Limit::Of(Measure::Stroke));
    let mut tmd = search.own();
    for (&i, &value) in springs.iter().zip(&best) {
        tmd[i] = value;
    }
    let is_tight = cavity.is_some_and(|cavity| gaps[0] + gaps[1] > WITHIN * cavity);
    for (variable, gap) in [Parameter::D, Parameter::C].into_iter().zip(gaps) {
        if let Some(i) = search.variables.iter().position(|other| *other == variable) {
            let least = search.options.bounds[i].lower.unwrap_or(0.0);
            tmd[i] = match gap {
                f64::INFINITY => tmd[i].max(OPEN * stroke),
                _ if is_tight => gap.min((WITHIN * gap).max(stroke / FREE).max(least)),
                _ => gap,
            };
        }
    }
    Some(tmd)
}

/// The start and the end of a descent from the deepest valley of a grid over spring and dashpot, under all limits and bounds of the study;
/// none unless the objective is steady.
pub(super) fn best_steady(study: &Study, search: &Search) -> Option<(Vec<f64>, Foot)> {
    if !study.goal().objective.is_steady() {
        return None;
    }
    let objective = searched(study, search, &search.variables);
    let springs = |variable: &Parameter| matches!(variable, Parameter::K2 | Parameter::C2);
    let bounds = &search.options.bounds;
    // Other parameters, such as the mass, start at the study's values.
    let mut start = search.own();
    let which: Vec<usize> = (0..start.len()).filter(|&i| springs(&search.variables[i])).collect();
    let springs_only =
        searched(study, search, &which.iter().map(|&i| search.variables[i]).collect::<Vec<_>>());
    let spring_bounds: Vec<_> = which.iter().map(|&i| bounds[i]).collect();
    let (_, valley) =
        springs_only.valleys(TUNINGS, &spring_bounds).into_iter().next().filter(|_| !which.is_empty())?;
    which.iter().zip(valley).for_each(|(&i, value)| start[i] = value);
    let foot = objective.descend(bounds, &start);
    Some((start, foot))
}

/// The steady objective over the spring and the dashpot of the damper without its walls, with a stroke of at most `room`.
fn steady(study: &Study, search: &Search, springs: &[usize], room: f64) -> Option<DesignObjective> {
    let goal = study.goal();
    let mut objective = goal.objective;
    objective.for_each_term(&mut |term| {
        (term.response, term.starts, term.ensemble) = (Response::Steady, None, None);
    });
    let most = goal.limits.get(Limit::Of(Measure::Stroke)).unwrap_or(f64::MAX).min(room);
    let limits =
        Positive::new(most).map_or(goal.limits, |most| goal.limits.with(Limit::Of(Measure::Stroke), most));
    let none = NonNegative::new(0.0).ok()?;
    let damper = Damper { contact: None, rest_distance: none, clearance: none, ..search.damper };
    let variables = springs.iter().map(|&i| search.variables[i]).collect();
    let goal = Goal { objective, limits, ..goal };
    Some(DesignObjective::new(study.scene, damper, variables, goal, study.solver.searching()))
}

/// D and C that maximise the smaller of the two: at their upper bounds, or as close to half of the cavity's limit as the bounds allow.
/// Infinite where there is no bound.
fn gaps(search: &Search, cavity: Option<f64>) -> [f64; 2] {
    let range = |variable: Parameter| {
        let fixed = variable.get(&search.damper);
        let bounds = search.variables.iter().position(|other| *other == variable);
        bounds.map_or([fixed, fixed], |i| {
            let bounds = search.options.bounds[i];
            [bounds.lower.unwrap_or(0.0), bounds.upper.unwrap_or(f64::INFINITY)]
        })
    };
    let ([d_low, d], [c_low, c]) = (range(Parameter::D), range(Parameter::C));
    let Some(cavity) = cavity.filter(|cavity| d + c > *cavity) else { return [d, c] };
    let d = d.min((cavity / 2.0).max(cavity - c)).max(d_low);
    [d, c.min(cavity - d).max(c_low)]
}
