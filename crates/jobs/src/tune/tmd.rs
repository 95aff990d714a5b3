//! The best TMD that a damper with walls can be: its gaps as wide as bounds and limits allow, its spring and dashpot the best in closed form.

use super::objective::searched;
use retune_model::{Damper, Measure, NonNegative, Parameter, Positive};
use retune_optim::{DesignObjective, Foot, Goal, Limit, Response};
use retune_study::{Search, Study};

/// The springs and dashpots from which the best is taken, in those of Den Hartog's.
const TUNINGS: [[f64; 2]; 2] = [[0.03, 30.0], [0.03, 300.0]];
/// Gaps without a bound are so many times the stroke.
const OPEN: f64 = 4.0;
/// Share of a gap that a stroke may have.
const FREE: f64 = 0.999;
/// Share of a gap that stands where the limit of the cavity is why it is no wider, so that one built a little wider keeps it, if the stroke leaves as much.
const WITHIN: f64 = 0.99;

/// The tuned parameters of that TMD; none of a damper without walls, of one that is tuned as a TMD anyway, or where it cannot be computed.
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
    let of = steady(study, search, &springs, room)?;
    let bounds: Vec<_> = springs.iter().map(|&i| search.options.bounds[i]).collect();
    let (_, valley) = of.valleys(TUNINGS, &bounds).into_iter().next()?;
    let best = of.descend(&bounds, &valley).end.x;
    let stroke =
        of.evaluate(&of.scene(&best).ok()?, f64::INFINITY).ok()?.reached.get(Limit::Of(Measure::Stroke));
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

/// The best spring and dashpot of a steady objective, in closed form: the end of a descent from the deepest valley of a grid, under all limits and bounds
/// of the study. None of another objective.
pub(super) fn best_steady(study: &Study, search: &Search) -> Option<(Vec<f64>, Foot)> {
    if !study.goal().objective.is_steady() {
        return None;
    }
    let of = searched(study, search, &search.variables);
    let springs = |variable: &Parameter| matches!(variable, Parameter::K2 | Parameter::C2);
    let bounds = &search.options.bounds;
    // Another parameter, as the mass, begins at that of the study.
    let mut start = search.own();
    let which: Vec<usize> = (0..start.len()).filter(|&i| springs(&search.variables[i])).collect();
    let alone = searched(study, search, &which.iter().map(|&i| search.variables[i]).collect::<Vec<_>>());
    let own: Vec<_> = which.iter().map(|&i| bounds[i]).collect();
    let (_, valley) = alone.valleys(TUNINGS, &own).into_iter().next().filter(|_| !which.is_empty())?;
    which.iter().zip(valley).for_each(|(&i, value)| start[i] = value);
    let foot = of.descend(bounds, &start);
    Some((start, foot))
}

/// The steady objective over the spring and the dashpot of the damper without its walls, its stroke at most `room`.
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

/// D and C of the cavity in which the smaller is largest: at their bounds, or as near to half of the cavity's limit as these allow. Infinite
/// where there is no bound.
fn gaps(search: &Search, cavity: Option<f64>) -> [f64; 2] {
    let range = |variable: Parameter| {
        let own = variable.get(&search.damper);
        let bounds = search.variables.iter().position(|other| *other == variable);
        bounds.map_or([own, own], |i| {
            let bounds = search.options.bounds[i];
            [bounds.lower.unwrap_or(0.0), bounds.upper.unwrap_or(f64::INFINITY)]
        })
    };
    let ([d_low, d], [c_low, c]) = (range(Parameter::D), range(Parameter::C));
    let Some(cavity) = cavity.filter(|cavity| d + c > *cavity) else { return [d, c] };
    let d = d.min((cavity / 2.0).max(cavity - c)).max(d_low);
    [d, c.min(cavity - d).max(c_low)]
}
