//! The value of a design with walls other than the study's: with other restitutions, softer and stiffer.

use super::certificate::measured::Sensitivity;
use super::certificate::verdict::or_none;
use crate::Error;
use crate::amount::{Amount, measured};
use rayon::prelude::*;
use retune_model::{Contact, Damper, Loss, Measure, Parameter, Scene};
use retune_optim::{Evaluation, Goal, Limits, Response, Unusable};
use retune_study::{Study, joined};
use serde::Serialize;

/// Restitutions, the same at every speed; the first is that of lossless walls.
const RESTITUTIONS: [f64; 5] = [1.0, 0.9, 0.8, 0.7, 0.6];
/// Multiples of the stiffness K of both walls.
const FACTORS: [f64; 2] = [0.5, 2.0];

/// The values of a design with other walls, with words that compare them with `own` and `sensitivity`; none where it touches no wall, or
/// where the objective is steady and so excludes contacts.
pub(super) fn other_walls(
    study: &Study,
    own: Amount,
    sensitivity: &[Sensitivity],
    strikes: bool,
) -> Option<Walls> {
    let (scene, goal) = (&study.scene, study.goal());
    scene.damper?.contact?;
    if goal.objective.is_steady() || !(strikes || touches(study)) {
        return None;
    }
    // Each restitution replaces the losses of the study and of the objective.
    let mut with_loss = goal.clone();
    with_loss.objective.for_each_term(&mut |term| term.restitution = None);
    let settings = study.solver.settings();
    let found = |goal: &Goal, scene: Result<Scene, Unusable>| {
        let found = scene.and_then(|scene| goal.evaluate(&scene, &settings, f64::INFINITY));
        Outcome::new(found.map_err(Error::from), !goal.limits.is_empty())
    };
    let at = |&e: &f64| Changed {
        change: Change::Restitution(e),
        found: found(&with_loss, with_restitution(*scene, e)),
    };
    let stiffness = Parameter::Q.of(scene); // K is proportional to q; rigid walls have none
    let softer = |&factor: &f64| {
        let scene = with(*scene, Parameter::Q, factor * stiffness?);
        Some(Changed { change: Change::Factor(factor), found: found(&goal, scene) })
    };
    let (restitutions, stiffness) = rayon::join(
        || RESTITUTIONS.par_iter().map(at).collect(),
        || FACTORS.par_iter().filter_map(softer).collect(),
    );
    let mut walls = Walls { facts: String::new(), contacts: String::new(), restitutions, stiffness };
    walls.facts = walls.summary(study, own, sensitivity);
    walls.contacts = format!("{}{}", walls.facts, walls.advice(study, own));
    Some(walls)
}

/// Whether the damper touches a wall in a run from rest over the band of the objective; true where a run fails.
fn touches(study: &Study) -> bool {
    let mut goal = Goal { limits: Limits::default(), peaks: false, ..study.goal() };
    goal.window.from = 0.0;
    goal.objective.for_each_term(&mut |term| {
        (term.quantity, term.response) = (Measure::ContactForce, Response::Window);
        term.restitution = None; // the loss does not matter until there is a contact
    });
    let found = goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY);
    !found.is_ok_and(|found| found.worst.largest <= 0.0)
}

/// The scene with a restitution in place of any loss.
fn with_restitution(mut scene: Scene, restitution: f64) -> Result<Scene, Unusable> {
    if let Some(Damper { contact: Some(Contact::Hertz(surfaces)), .. }) = &mut scene.damper {
        (surfaces.loss, surfaces.loss_obstacle) = (Loss::default(), None);
    }
    with(scene, Parameter::Restitution, restitution)
}

fn with(mut scene: Scene, parameter: Parameter, value: f64) -> Result<Scene, Unusable> {
    parameter.set(&mut scene, value).map_err(|source| Unusable::Value { parameter, source })?;
    Ok(scene)
}

/// Growth of the value above which the design should be tuned for all restitutions.
const GROWTH: f64 = 0.1;

/// The values of a design with other restitutions and other stiffnesses of its walls.
#[derive(Clone, Debug, Serialize)]
pub struct Walls {
    /// The values in words, without advice on the study.
    #[serde(skip)]
    facts: String,
    contacts: String,
    /// The values for [`RESTITUTIONS`], each in place of the study's loss.
    restitutions: Vec<Changed>,
    /// Empty for rigid walls.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    stiffness: Vec<Changed>,
}

/// A difference from the study.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Change {
    /// The restitution, the same at every speed.
    Restitution(f64),
    /// The stiffness K of both walls, by this factor.
    Factor(f64),
    /// The record, in words.
    Under(String),
}

/// The value with a change.
#[derive(Clone, Debug, Serialize)]
pub struct Changed {
    #[serde(flatten)]
    pub change: Change,
    #[serde(flatten)]
    pub found: Outcome,
}

#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// The objective, in the unit of its quantity; null where it has none.
    pub value: f64,
    /// Frequency of the worst run, rad/s.
    pub omega: f64,
    /// Whether the limits are kept, if the study has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    keeps_limits: Option<bool>,
    /// Runs that should have settled and did not: their value is that of the window.
    #[serde(skip_serializing_if = "retune_study::is_default")]
    unsettled: u64,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

impl Outcome {
    /// The outcome of an evaluation; `limits` tells whether the study has limits.
    pub fn new(found: Result<Evaluation, Error>, limits: bool) -> Self {
        let none =
            Self { value: f64::INFINITY, omega: f64::NAN, keeps_limits: None, unsettled: 0, reason: None };
        match found {
            Ok(found) => Self {
                value: found.value,
                omega: found.worst.scene.forcing.frequency.get(),
                keeps_limits: limits.then_some(found.violation == 0.0),
                unsettled: found.unsettled,
                reason: None,
            },
            Err(error) => Self { reason: Some(error.to_string()), ..none },
        }
    }
}

impl Changed {
    /// The change in words, to follow a value.
    pub fn place(&self) -> String {
        match &self.change {
            Change::Restitution(e) => format!("at e = {e}"),
            Change::Factor(factor) => format!("with {factor} K"),
            Change::Under(words) => words.clone(),
        }
    }

    /// The value with the change.
    pub fn words(&self, quantity: Measure) -> String {
        format!("{} {}", or_none(self.found.value, quantity), self.place())
    }
}

impl Walls {
    pub fn words(&self) -> &str {
        &self.contacts
    }

    /// The same without advice on the study.
    pub fn facts(&self) -> &str {
        &self.facts
    }

    pub fn all(&self) -> impl Iterator<Item = &Changed> {
        self.restitutions.iter().chain(&self.stiffness)
    }

    /// The restitution with the largest value, the largest of equal ones; none where none has a value.
    pub fn worst(&self) -> Option<(f64, &Outcome)> {
        let known = self.restitutions.iter().filter_map(|one| match one.change {
            Change::Restitution(e) if one.found.value.is_finite() => Some((e, &one.found)),
            _ => None,
        });
        known.reduce(|worst, one| if one.1.value > worst.1.value { one } else { worst })
    }

    fn summary(&self, study: &Study, own: Amount, sensitivity: &[Sensitivity]) -> String {
        let mut words = self.largest(study, own, sensitivity);
        if !self.stiffness.is_empty() {
            let each = self.stiffness.iter().map(|one| one.words(own.quantity));
            words += &format!("; {}, the stiffness of both walls", joined(&each.collect::<Vec<_>>(), ", "));
        }
        words += &self.reservations();
        if self.stiffness.iter().any(|one| one.found.value > (1.0 + GROWTH) * own.value) {
            words += "; measure the stiffness of the walls before you build the damper";
        }
        words
    }

    /// What to change in the study, where losses make much of a difference.
    fn advice(&self, study: &Study, own: Amount) -> String {
        if self.worst().is_none_or(|(_, worst)| worst.value <= (1.0 + GROWTH) * own.value) {
            return String::new();
        }
        let law = match Parameter::Restitution.of(&study.scene) {
            Some(_) => "",
            None => "give `contact.loss` a restitution alone and ",
        };
        format!(
            "; {law}tune for all of these restitutions: `objective.restitution` (studies/ssvi-hedged.json)"
        )
    }

    /// The value without loss, the largest value, and over what it is the largest, in words.
    fn largest(
        &self,
        study: &Study,
        Amount { quantity, value: own, .. }: Amount,
        sensitivity: &[Sensitivity],
    ) -> String {
        let lossless = self.restitutions.first().map_or(f64::NAN, |one| one.found.value);
        let lossless = format!("{} {} without loss", quantity.name(), or_none(lossless, quantity));
        let all = joined(&RESTITUTIONS, ", ");
        let Some((restitution, found)) = self.worst() else {
            return format!("{lossless}, and none at the restitutions {all}");
        };
        let motions = study.objective().terms().iter().any(|(_, term)| term.response == Response::Motions);
        let runs = if motions { "" } else { " in runs from rest" };
        let which = format!("the largest of the restitutions {all}{runs}, not a bound");
        if restitution == 1.0 {
            return format!("{lossless}, {which}");
        }
        let less = |one: &Sensitivity| one.worst < found.value;
        let more = found.value > own && sensitivity.iter().all(less);
        let more = if more { ", more than any parameter off by 1 % gives" } else { "" };
        format!("{lossless}, {} at e = {restitution}{more}: {which}", measured(found.value, quantity))
    }

    /// Caveats on single values.
    fn reservations(&self) -> String {
        let places = |is: fn(&Outcome) -> bool| {
            let those = self.all().filter(|one| is(&one.found)).map(Changed::place);
            joined(&those.collect::<Vec<_>>(), ", ")
        };
        let mut words = String::new();
        for one in self.all().filter(|one| !one.found.value.is_finite()) {
            let reason = one.found.reason.as_ref().map_or(String::new(), |reason| format!(" ({reason})"));
            words += &format!("; no value {}{reason}", one.place());
        }
        for (what, places) in [
            ("a limit is broken", places(|found| found.keeps_limits == Some(false))),
            ("runs had not settled", places(|found| found.unsettled > 0)),
        ] {
            if !places.is_empty() {
                words += &format!("; {what} {places}");
            }
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(value: f64) -> Outcome {
        Outcome { value, omega: 6.0, keeps_limits: None, unsettled: 0, reason: None }
    }

    #[test]
    fn contract_what_has_no_value_or_breaks_a_limit_is_told() {
        let at = |e, found| Changed { change: Change::Restitution(e), found };
        let none = Outcome { reason: Some("too many steps".to_owned()), ..found(f64::INFINITY) };
        let broken = Outcome { keeps_limits: Some(false), ..found(300.0) };
        let late = Outcome { unsettled: 2, ..found(1.0) };
        let mut walls = Walls {
            facts: String::new(),
            contacts: String::new(),
            restitutions: vec![
                at(1.0, found(200.0)),
                at(0.9, none),
                at(0.8, broken.clone()),
                at(0.7, broken),
            ],
            stiffness: vec![Changed { change: Change::Factor(2.0), found: late }],
        };
        assert_eq!(
            walls.reservations(),
            "; no value at e = 0.9 (too many steps); a limit is broken at e = 0.8, at e = 0.7; runs had not settled with 2 K"
        );
        assert_eq!(walls.worst().map(|(e, _)| e), Some(0.8));
        walls.restitutions.truncate(1);
        walls.restitutions.push(at(0.9, found(f64::NAN)));
        assert_eq!(walls.reservations(), "; no value at e = 0.9; runs had not settled with 2 K");
    }
}
