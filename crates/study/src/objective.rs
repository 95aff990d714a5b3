//! The rules for objectives and limits that their types cannot express, and the objective of a study.

use super::format::{Coarse, Study};
use super::rule::Rule;
use retune_model::{Forcing, Measure, Of, Parameter, Rms, Scene};
use retune_optim::{
    Ensemble, FrequencyBand, Goal, Limit, Limits, Objective, Part, Response, Statistic, StiffnessRange,
    Stiffnesses,
};
use retune_solver::Settle;

/// Most samples of a band: at a third of a millisecond each, three seconds for each design.
pub(super) const MOST_SAMPLES: usize = 10_000;
/// Most starts at a frequency.
const MOST_STARTS: usize = 1000;

/// Checks the rules that serde cannot; `path` is the path of this objective in the study.
pub(super) fn check(objective: &Objective, path: &str, scene: &Scene) -> Result<(), Rule> {
    let forcing = &scene.forcing;
    let omega = forcing.frequency.get();
    let passes = forcing.is_transient();
    let field = |name: &str| format!("{path}.{name}");
    let bad =
        |field: String, value: String, allowed: &'static str| Err(Rule::not_allowed(field, value, allowed));
    if !objective.sum.is_empty() {
        let alone = Objective { sum: Vec::new(), ..objective.clone() };
        if !alone.is_default() {
            return Err(Rule::SumAndMore { path: path.to_owned() });
        }
        let part =
            |(i, part): (usize, &Part)| check(&part.objective, &field(&format!("sum[{i}].objective")), scene);
        objective.sum.iter().enumerate().try_for_each(part)?;
        let other = objective.sum.iter().position(|part| part.objective.quantity() != objective.quantity());
        return match other {
            Some(i) => bad(
                field(&format!("sum[{i}].objective.quantity")),
                objective.sum[i].objective.quantity().name().to_owned(),
                "the same quantity in all parts, for only values of one unit can be added",
            ),
            None => Ok(()),
        };
    }
    if objective.response == Response::Steady && objective.quantity.is_of_walls() {
        let allowed = "another quantity, or another response: what is steady touches no wall";
        return bad(field("quantity"), objective.quantity.name().to_owned(), allowed);
    }
    if let Some(starts) = objective.starts.filter(|starts| !(1..=MOST_STARTS).contains(starts)) {
        let allowed = "a whole number from 1 to 1000";
        return bad(field("starts"), starts.to_string(), allowed);
    }
    if !objective.records.is_empty() || objective.records_by.is_some() {
        check_records(objective, path, forcing)?;
    }
    if objective.is_stationary() {
        return check_stationary(objective, path, scene);
    }
    if passes && (objective.omega.is_some() || objective.response != Response::Window) {
        let name = if objective.omega.is_some() { "omega" } else { "response" };
        let allowed = "nothing: a free decay, a pulse and a record have no frequency, and all there is of the motion is in the window (under a \
                       `spectrum` the stationary motion has root mean squares: give `quantity` \"x1rms\" with `response` \"steady\")";
        return bad(field(name), "what is given".to_owned(), allowed);
    }
    let band = |name: &str, unit, [from, to]: [f64; 2], samples: usize| {
        if from >= to {
            return Err(Rule::EmptyBand { field: field(name), unit, from, to });
        }
        match samples {
            2..=MOST_SAMPLES => Ok(()),
            _ => {
                bad(field(&format!("{name}.samples")), samples.to_string(), "a whole number from 2 to 10000")
            }
        }
    };
    if let Some(FrequencyBand { from, to, samples, relative }) = objective.omega {
        band("omega", if relative { "" } else { " rad/s" }, [from.get(), to.get()], samples)?;
    }
    match &objective.k1 {
        Some(Stiffnesses::Set(set)) if set.is_empty() => {
            return bad(field("k1.set"), "an empty list".to_owned(), "at least one stiffness, N/m");
        }
        Some(Stiffnesses::Range(StiffnessRange { from, to, samples })) => {
            band("k1.range", " N/m", [from.get(), to.get()], *samples)?;
        }
        _ => {}
    }
    match &objective.restitution {
        Some(set) if set.is_empty() => {
            return bad(field("restitution"), "an empty list".to_owned(), "at least one restitution");
        }
        Some(_) if Parameter::Restitution.of(scene).is_none() => {
            let allowed = "nothing: the contacts of the scene have another loss, or there are none";
            return bad(field("restitution"), "a list".to_owned(), allowed);
        }
        _ => {}
    }
    let Settle { periods, blocks, .. } = objective.settle;
    if !(1..=10_000).contains(&periods) {
        return bad(field("settle.periods"), periods.to_string(), "a whole number from 1 to 10000");
    }
    if !(2..=100).contains(&blocks) {
        return bad(field("settle.blocks"), blocks.to_string(), "a whole number from 2 to 100");
    }
    if objective.omega.is_none()
        && omega == 0.0
        && !passes
        && (objective.ensemble.is_some() || objective.response == Response::Settled)
    {
        return bad(
            "scene.forcing.omega".to_owned(),
            "0".to_owned(),
            "a frequency above 0, for this objective counts periods",
        );
    }
    let Some(Ensemble { members, errors, statistic, .. }) = objective.ensemble else { return Ok(()) };
    if !(1..=retune_optim::MOST_MEMBERS).contains(&members) {
        return bad(field("ensemble.members"), members.to_string(), "a whole number from 1 to 65536");
    }
    if !(0.0..1.0).contains(&errors) {
        return bad(field("ensemble.errors"), errors.to_string(), "a number not below 0 and below 1");
    }
    match statistic {
        Statistic::Quantile(share) if !(share > 0.0 && share <= 1.0) => {
            bad(field("ensemble.statistic.quantile"), share.to_string(), "a number above 0 and at most 1")
        }
        _ => Ok(()),
    }
}

/// Rules of a stationary random motion: only root mean squares, of a linear system under a spectrum.
fn check_stationary(objective: &Objective, path: &str, scene: &Scene) -> Result<(), Rule> {
    let bad = |name: &str, value: &str, allowed| {
        Err(Rule::not_allowed(format!("{path}.{name}"), value.to_owned(), allowed))
    };
    let quantity = objective.quantity.name();
    let history = scene.forcing.history();
    let spectrum = history.and_then(|history| Some((history.of, history.course.spectrum()?)));
    let Some((of, spectrum)) = spectrum else {
        return bad(
            "quantity",
            quantity,
            "a largest value: only a motion under a `spectrum` is stationary and random",
        );
    };
    if objective.response != Response::Steady {
        return bad(
            "quantity",
            quantity,
            "a largest value, or `response` \"steady\" beside it: a window has largest values",
        );
    }
    if scene.damper.is_some_and(|damper| damper.contact.is_some()) {
        let allowed = "a largest value in a window: a random stroke exceeds every gap at some time, and contacts make the motion nonlinear; \
                       leave out `contact` for the damper without walls";
        return bad("quantity", quantity, allowed);
    }
    let of_force = of == Of::Force && spectrum.white_density().is_some();
    if objective.quantity == Measure::Stationary(Rms::Acceleration) && of_force {
        return bad(
            "quantity",
            quantity,
            "another quantity: white noise that acts on a mass accelerates it without bound; or give a table",
        );
    }
    if objective.omega.is_some() || objective.ensemble.is_some() || !objective.records.is_empty() {
        return bad(
            "quantity",
            quantity,
            "without omega, ensemble and records beside it: it is that under the spectrum of the scene",
        );
    }
    Ok(())
}

/// Rules of an objective over several records: they replace the record of the scene.
fn check_records(objective: &Objective, path: &str, own: &Forcing) -> Result<(), Rule> {
    let bad = |field: String, value: String, allowed| Err(Rule::not_allowed(field, value, allowed));
    if objective.records.is_empty() {
        let allowed = "nothing without `records`, or `records` beside it";
        return bad(format!("{path}.records_by"), "a statistic".to_owned(), allowed);
    }
    if own.history().is_none() {
        let allowed = "nothing: `scene.forcing` is neither a record nor a pulse, whose place they could take";
        return bad(format!("{path}.records"), "a list".to_owned(), allowed);
    }
    if let Some(i) = objective.records.iter().position(|one| one.history().is_none()) {
        let allowed = "one of `pulse`, `record`, `harmonics`, `sweep` and `spectrum`";
        return bad(
            format!("{path}.records[{i}]"),
            format!("`{}`", objective.records[i].given_by()),
            allowed,
        );
    }
    match objective.records_by {
        Some(Statistic::Quantile(share)) if !(share > 0.0 && share <= 1.0) => {
            let allowed = "a number above 0 and at most 1";
            bad(format!("{path}.records_by.quantile"), share.to_string(), allowed)
        }
        _ => Ok(()),
    }
}

/// Refuses a study that minimises another quantity than E1max, for tables that hold energies.
pub(super) fn check_quantity(study: &Study) -> Result<(), Rule> {
    match study.quantity() {
        Measure::Energy => Ok(()),
        quantity => Err(Rule::not_allowed(
            "optimize.objective.quantity",
            quantity.name(),
            "E1max: the tables of this command hold energies",
        )),
    }
}

/// Checks the rules that serde cannot; `end` is the end of the run, s.
pub(super) fn check_limits(limits: &Limits, end: f64) -> Result<(), Rule> {
    match limits.from {
        Some(from) if from.get() >= end => {
            Err(Rule::not_allowed("optimize.limits.from", from.get(), "a time before T of `window`, s"))
        }
        _ => Ok(()),
    }
}

/// A decay time counts from the end of the forcing, which must be within the run.
pub(super) fn check_decay(goal: &Goal, forcing: &Forcing) -> Result<(), Rule> {
    let limit = goal.limits.get(Limit::Of(Measure::DecayTime));
    for (_, term) in goal.objective.terms() {
        let (field, value) = match limit {
            _ if term.quantity == Measure::DecayTime => {
                ("optimize.objective.quantity", Measure::DecayTime.name().to_owned())
            }
            Some(limit) => ("optimize.limits.decay_time", limit.to_string()),
            None => continue,
        };
        let own = std::slice::from_ref(forcing);
        let ends = if term.records.is_empty() { own } else { &term.records }.iter().map(Forcing::end);
        let end = ends.fold(0.0, f64::max);
        if end.is_infinite() {
            let allowed =
                "another quantity: a decay time is that after a pulse or a record, or of a free decay";
            return Err(Rule::not_allowed(field, value, allowed));
        }
        if end >= goal.window.to {
            let allowed =
                "a T of `window` beyond the end of every pulse and record, from which a decay time counts";
            return Err(Rule::not_allowed(field, format!("{value} with T = {} s", goal.window.to), allowed));
        }
    }
    Ok(())
}

impl Study {
    /// The objective of its search.
    pub fn objective(&self) -> Objective {
        self.optimize.as_ref().map(|optimize| optimize.objective.clone()).unwrap_or_default()
    }

    /// The quantity that its search minimises.
    pub fn quantity(&self) -> Measure {
        self.objective().quantity()
    }

    /// The objective of its search with its window and limits.
    pub fn goal(&self) -> Goal {
        let limits = self.optimize.as_ref().map(|optimize| optimize.limits).unwrap_or_default();
        Goal { objective: self.objective(), limits, ..self.window.window().into() }
    }

    /// How exact the values of its grid are.
    pub fn coarse(&self) -> Coarse {
        self.optimize.as_ref().map(|optimize| optimize.coarse).unwrap_or_default()
    }

    /// The objective for its structure without a damper; NaN if it has no value, infinite if it is unbounded.
    pub fn energy_without_damper(&self) -> f64 {
        self.energy(&Scene { damper: None, ..self.scene }).unwrap_or(f64::NAN)
    }

    /// The objective for a scene, regardless of the limits, in the unit of its quantity; `None` if it cannot be run.
    pub fn energy(&self, scene: &Scene) -> Option<f64> {
        Some(self.goal().evaluate(scene, &self.solver.settings(), f64::INFINITY).ok()?.value)
    }
}
