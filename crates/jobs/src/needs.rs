//! The needs of a damper and the motion of the structure, compared with no damper and with the best linear one: the largest values over
//! everything that the objective covers. Every report on a design has them.

use crate::amount::Amount;
use crate::contacts::Contacts;
use retune_model::{Measure, Parameter, Scene};
use retune_optim::{Goal, Limit, Limits, Need, Response};
use retune_study::{Search, Study, rounded, short};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

/// Relative difference above which the value in the objective is reported besides that of the whole run, and above which a larger value
/// than without a damper is a warning.
const NOTABLE: f64 = 0.01;
/// Relative improvement above which a linear damper counts as better.
const BETTER: f64 = 1e-3;

/// The quantities reported for a damper: the room and strength that it needs, and the motion of the structure.
pub const REPORTED: [Measure; 5] = [
    Measure::Stroke,
    Measure::ContactForce,
    Measure::Displacement,
    Measure::Acceleration,
    Measure::GroundForce,
];

/// The needs of a design, and of the alternatives.
#[derive(Clone, Debug, Serialize)]
pub struct Needs {
    pub damper: Largest,
    /// Its contacts in the whole run, from rest on, with the largest contact force; none if it touches no wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contacts: Option<Contacts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub none: Option<Largest>,
    /// The best damper of the same mass without walls, for the same objective, regardless of the study's limits and bounds. None under a
    /// forcing given in time; for a damper without walls, only if it is better.
    #[serde(rename = "TMD", skip_serializing_if = "Option::is_none")]
    pub linear: Option<Linear>,
}

/// The largest value of each measure over the band, the stiffnesses, the members and the terms of an objective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest(pub retune_optim::Needs);

#[derive(Clone, Debug, Serialize)]
pub struct Linear {
    /// Its spring, N/m.
    pub k2: f64,
    /// Its damping, N·s/m.
    pub c2: f64,
    #[serde(flatten)]
    value: Amount,
    /// Why the search could not find it, if it is better than the design found.
    #[serde(skip_serializing_if = "Option::is_none")]
    better_but: Option<String>,
    pub needs: Largest,
    /// Whether the value is a weighted sum.
    #[serde(skip)]
    of_sum: bool,
}

impl Serialize for Largest {
    /// For each measure by name: the largest value from rest on with its place; and that in the objective where it is lower by more than 1
    /// %.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Place {
            value: f64,
            omega: f64,
            k1: f64,
            #[serde(rename = "in_objective", skip_serializing_if = "Option::is_none")]
            own: Option<f64>,
        }
        let mut map = serializer.serialize_map(Some(Measure::ALL.len()))?;
        for measure in Measure::ALL {
            let Need { value, omega, k1, .. } = self.0.whole.get(measure);
            map.serialize_entry(measure.name(), &Place { value, omega, k1, own: self.own(measure) })?;
        }
        map.end()
    }
}

impl Largest {
    /// The largest values of a scene by the objective of a study, regardless of limits; none where it cannot be run.
    pub fn of(study: &Study, scene: &Scene) -> Option<Self> {
        study.goal().needs(scene, &study.solver.settings(), &|| true).ok().map(Self)
    }

    /// The largest value of a measure, from rest on.
    pub fn value(&self, measure: Measure) -> f64 {
        self.0.whole.get(measure).value
    }

    /// The largest value in the part of the response that the objective covers, where it is lower by more than 1 %.
    pub fn own(&self, measure: Measure) -> Option<f64> {
        let own = self.0.own.get(measure).value;
        (own.is_finite() && own < (1.0 - NOTABLE) * self.value(measure)).then_some(own)
    }

    /// The largest value from rest on with its unit; the displacement in mm.
    pub fn sized(&self, measure: Measure) -> String {
        sized(measure, self.value(measure))
    }

    /// The frequency of the largest value, rad/s.
    pub fn omega(&self, measure: Measure) -> f64 {
        self.0.whole.get(measure).omega
    }

    /// A value with its unit and its place: `31.6 m/s² at 5.85 rad/s`.
    pub fn words(&self, measure: Measure) -> String {
        let Need { value, omega, .. } = self.0.whole.get(measure);
        format!("{}{}", sized(measure, value), at(omega))
    }

    /// The [`REPORTED`] values in a list.
    pub fn list(&self) -> String {
        REPORTED.map(|measure| format!("{} {}", measure.short_name(), self.sized(measure))).join(", ")
    }

    /// The room and the strength that the damper needs.
    fn damper_words(&self) -> String {
        let stroke = self.words(Measure::Stroke);
        if self.value(Measure::ContactForce).is_infinite() {
            format!("a stroke of {stroke}; the force of its impacts with rigid walls has no bound")
        } else if self.value(Measure::ContactForce) > 0.0 {
            format!("a stroke of {stroke}, and walls for {}", self.words(Measure::ContactForce))
        } else {
            format!("a stroke of {stroke}; it touches no wall")
        }
    }

    /// The motion of the structure and its force on the ground.
    fn structure_words(&self) -> String {
        let of = [Measure::Displacement, Measure::Acceleration, Measure::GroundForce];
        let [x1, a1, force] = of.map(|measure| self.words(measure));
        format!("moves by {x1}, accelerates by {a1} and loads the ground with {force}")
    }

    /// The values in the objective, where they are lower, in words.
    fn objective_words(&self, study: &Study) -> Option<String> {
        let less = REPORTED.into_iter().filter_map(|measure| {
            Some(format!("{} {}", measure.short_name(), sized(measure, self.own(measure)?)))
        });
        let less: Vec<String> = less.collect();
        let part = match study.objective().terms().first().map(|(_, term)| term.response) {
            Some(Response::Settled) => "once settled".to_owned(),
            Some(Response::Steady) if !study.objective().is_stationary() => "in the steady motion".to_owned(),
            Some(Response::Motions) => "over all motions that are found".to_owned(),
            _ => format!("from {} s on", short(study.window.t0.get())),
        };
        (!less.is_empty()).then(|| format!("{part}: {}", less.join(", ")))
    }
}

/// A value with its unit; the displacement in mm, the pressure in MPa.
pub(crate) fn sized(measure: Measure, value: f64) -> String {
    match measure {
        _ if !value.is_finite() => "without bound".to_owned(),
        Measure::Displacement => format!("{} mm", rounded(1e3 * value, 4)),
        Measure::ContactPressure => format!("{} MPa", rounded(1e-6 * value, 4)),
        _ => format!("{} {}", rounded(value, 4), measure.unit()),
    }
}

impl Needs {
    /// The needs of a design that a search found, with its value; none where it cannot be run.
    pub fn new(study: &Study, search: &Search, design: &Scene, value: f64) -> Option<Self> {
        let goal = Goal { limits: Limits::default(), ..study.goal() };
        let settings = study.solver.settings();
        let (damper, (none, linear)) = rayon::join(
            || Largest::of(study, design),
            || {
                let none = Largest::of(study, &Scene { damper: None, ..*design });
                let linear = goal.best_linear(design, &settings).and_then(|scene| {
                    let found = goal.evaluate(&scene, &settings, f64::INFINITY).ok()?;
                    let damper = scene.damper?;
                    let better = found.value < (1.0 - BETTER) * value;
                    // A damper without walls is itself the best TMD if none is better.
                    let own = design.damper.is_some_and(|own| own.contact.is_none());
                    if own && !better {
                        return None;
                    }
                    let needs = Largest::of(study, &scene)?;
                    Some(Linear {
                        k2: damper.stiffness.get(),
                        c2: damper.damping.get(),
                        value: Amount::new(study.quantity(), found.value),
                        better_but: better.then(|| excluded(study, search, design, &scene, &needs)),
                        needs,
                        of_sum: !study.objective().sum.is_empty(),
                    })
                });
                (none, linear)
            },
        );
        let damper = damper?;
        let contacts = Contacts::hardest(study, design, damper.0.whole.get(Measure::ContactForce));
        Some(Self { damper, contacts, none, linear })
    }

    /// Warnings: a better damper that the study excludes, and quantities that the damper makes worse.
    pub fn warnings(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.contacts.iter().flat_map(Contacts::warnings).collect();
        if let Some(Linear { k2, c2, value, better_but: Some(why), needs, of_sum }) = &self.linear {
            let (k2, c2) = (rounded(*k2, 4), rounded(*c2, 4));
            let sum = if *of_sum { "a weighted sum of " } else { "" };
            lines.push(format!(
                "a linear damper of the same mass is better: k2 = {k2} N/m, c2 = {c2} N·s/m has {sum}{} {}, a stroke of {} and no \
                 impacts; {why}",
                value.quantity.name(),
                value.words(),
                sized(Measure::Stroke, needs.value(Measure::Stroke)),
            ));
        }
        let Some(none) = &self.none else { return lines };
        let measures =
            [Measure::Displacement, Measure::Velocity, Measure::Acceleration, Measure::GroundForce];
        for measure in measures {
            let (own, without) = (self.damper.value(measure), none.value(measure));
            if own > (1.0 + NOTABLE) * without {
                let linear = self.linear.as_ref().map_or(String::new(), |linear| {
                    format!(", {} with the best TMD", linear.needs.sized(measure))
                });
                let ([from, to], words) =
                    ([without, own].map(|value| sized(measure, value)), measure.words());
                lines.push(format!("it raises {words} from {from} (no damper{linear}) to {to}"));
            }
        }
        lines
    }

    /// The lines of an answer: their labels and words.
    pub fn lines(&self, study: &Study) -> Vec<(&'static str, String)> {
        // A stationary random motion has no largest value: the reported ones are of one draw.
        let draw = if study.objective().is_stationary() { ", in the draw of the study" } else { "" };
        let mut lines = vec![
            ("needs", format!("{}{draw}", self.damper.damper_words())),
            ("there", format!("the structure {}", self.damper.structure_words())),
        ];
        let place = self.damper.omega(Measure::ContactForce);
        let place = if place > 0.0 { format!(",{}", at(place)) } else { String::new() };
        let contacts = self.contacts.iter().flat_map(Contacts::words);
        lines.extend(contacts.map(|words| ("contact", format!("{words}{place}"))));
        lines.extend(self.damper.objective_words(study).map(|words| ("later", words)));
        let none = self.none.iter().map(|none| format!("no damper: {}", alternative(none, false)));
        let linear = self.linear.iter().map(|Linear { k2, c2, needs, .. }| {
            format!("best TMD (k2 {}, c2 {}): {}", rounded(*k2, 4), rounded(*c2, 4), alternative(needs, true))
        });
        let others: Vec<String> = none.chain(linear).collect();
        if !others.is_empty() {
            lines.push(("beside", others.join("; ")));
        }
        lines
    }
}

/// The values of an alternative, briefly.
fn alternative(largest: &Largest, damped: bool) -> String {
    let of =
        |measure: Measure| format!("{} {}", measure.short_name(), sized(measure, largest.value(measure)));
    let structure = [Measure::Displacement, Measure::Acceleration, Measure::GroundForce].map(of).join(", ");
    if damped { format!("{structure}, {}", of(Measure::Stroke)) } else { structure }
}

/// Why a search did not find a better damper without walls.
fn excluded(study: &Study, search: &Search, design: &Scene, linear: &Scene, needs: &Largest) -> String {
    let mut why = Vec::new();
    let (Some(found), Some(other)) = (design.damper, linear.damper) else { return String::new() };
    for variable in [Parameter::K2, Parameter::C2] {
        let value = variable.get(&other);
        let place = search.variables.iter().position(|known| *known == variable);
        match place.and_then(|place| search.options.bounds.get(place)) {
            None if variable.get(&found) != value => why.push(format!("does not vary {variable}")),
            Some(bounds) => {
                let unit = variable.unit();
                if let Some(upper) = bounds.upper.filter(|upper| value > *upper) {
                    why.push(format!("bounds {variable} by {} {unit}", short(upper)));
                }
                if let Some(lower) = bounds.lower.filter(|lower| value < *lower) {
                    why.push(format!("bounds {variable} by at least {} {unit}", short(lower)));
                }
            }
            None => {}
        }
    }
    let limits = study.goal().limits;
    for limit in limits.set() {
        let reached = if let Limit::Of(measure) = limit {
            needs.value(measure)
        } else {
            2.0 * needs.value(Measure::Stroke)
        };
        if limits.get(limit).is_some_and(|allowed| reached > allowed) {
            why.push(format!("limits {limit}"));
        }
    }
    if !why.is_empty() {
        return format!("the study excludes it: it {}", why.join(" and "));
    }
    "the bounds of the study on k2 and c2 allow it".to_owned()
}
/// The frequency of a value, to follow it; empty for a motion without one.
fn at(omega: f64) -> String {
    if omega > 0.0 { format!(" at {} rad/s", rounded(omega, 4)) } else { String::new() }
}
