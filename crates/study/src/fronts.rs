//! The study behind `retune fronts`: dampers to tune under successively looser bounds on the spring, the stroke or the contact force.

use super::built_in::read_plan_text;
use super::file::Kind;
use super::file::{StudyError, expect, parse};
use super::format::{Optimize, Study};
use super::objective::{MOST_SAMPLES, check_quantity};
use super::read::named;
use super::rule::Rule;
use super::search::clipped;
use retune_model::{Design, Measure, PerVariable, Positive};
use retune_optim::{Limit, Parameter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Pareto fronts of dampers: the least E1max under bounds on the spring stiffness, on the stroke and on the contact force, at least one of which must be given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fronts {
    /// The JSON Schema with which an editor completes and validates this file. Ignored by Retune.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// "fronts". A file without it is recognised by its other fields.
    #[serde(default = "kind")]
    #[schemars(extend("const" = "fronts"))]
    pub kind: Kind,
    /// The dampers. Each is compared with the first; its searches also start from the optimised designs of the dampers listed before it.
    #[schemars(length(min = 1))]
    pub dampers: Vec<FrontDamper>,
    /// Upper bounds on k2, N/m. Every damper is tuned under each of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub k2: Vec<Positive>,
    /// Limits on the stroke (spring deflection |x2 - x1 - D|), m, as `limits.stroke` of a study. Every damper is tuned under each of them, with k2 within the bounds of its study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stroke: Vec<Positive>,
    /// Limits on the contact force on either wall, N, as `limits.contact_force` of a study. Every damper is tuned under each of them, with k2 within the bounds of its study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact_force: Vec<Positive>,
    /// Number of band samples on which the optimised designs are refined and re-evaluated, so that they are compared on the same frequencies.
    #[serde(default = "samples")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
    /// Number of band samples on which they are evaluated once more. Designs whose E1max rises by more than 1 % are marked. Default: as `samples`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 10000))]
    pub check: Option<usize>,
    /// Maximum number of rounds of descents that follow the searches, each as long as the last gained anything; 0 for the searches alone, a first
    /// look in a fraction of the time.
    #[serde(default = "rounds", skip_serializing_if = "is_most")]
    #[schemars(range(max = 24))]
    pub rounds: usize,
    /// Number of designs to certify: those whose E1max is furthest below that of the first damper under the same bound.
    #[serde(default = "certificates")]
    pub certificates: usize,
}

/// A damper to tune.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontDamper {
    /// Its name in tables and figures.
    pub damper: String,
    /// The study that tunes it, which must tune k2; a path relative to this file. The damper of its scene is plotted beside the
    /// optimised ones, as reference design. A `surf` stage in it is ignored.
    pub study: PathBuf,
    /// Designs that are known from elsewhere: they stand beside those that the searches find, under every bound that they keep, and descents
    /// begin at them. What one leaves out is as in the scene of the study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub designs: Vec<PerVariable<f64>>,
}

/// The quantity that is bounded along a front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// The stiffness of the spring.
    K2,
    /// The stroke.
    Stroke,
    /// The contact force.
    ContactForce,
}

/// A file of fronts with the studies that it names.
#[derive(Clone, Debug)]
pub struct FrontsPlan {
    /// The file.
    pub said: Fronts,
    /// Each damper's name and study.
    pub dampers: Vec<(String, Study)>,
    /// The designs that are known from elsewhere, with the number of their damper.
    pub designs: Vec<(usize, Design)>,
}

fn kind() -> Kind {
    Kind::Fronts
}

fn samples() -> usize {
    61
}

/// Default maximum number of rounds: more than any front has needed so far.
const MOST_ROUNDS: usize = 24;

fn rounds() -> usize {
    MOST_ROUNDS
}

fn is_most(rounds: &usize) -> bool {
    *rounds == MOST_ROUNDS
}

fn certificates() -> usize {
    3
}

impl Sweep {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::K2, Self::Stroke, Self::ContactForce];

    /// Its name in studies and in the name of its table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::K2 => Parameter::K2.symbol(),
            Self::Stroke => Measure::Stroke.name(),
            Self::ContactForce => Measure::ContactForce.name(),
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::K2 => Parameter::K2.unit(),
            Self::Stroke => Measure::Stroke.unit(),
            Self::ContactForce => Measure::ContactForce.unit(),
        }
    }

    /// The limit that it sets; none for k2, which is bounded in the search itself.
    pub const fn limit(self) -> Option<Limit> {
        match self {
            Self::K2 => None,
            Self::Stroke => Some(Limit::Of(Measure::Stroke)),
            Self::ContactForce => Some(Limit::Of(Measure::ContactForce)),
        }
    }
}

impl FrontsPlan {
    /// The values of a bound, ascending, without duplicates.
    pub fn values(&self, sweep: Sweep) -> Vec<f64> {
        let given = match sweep {
            Sweep::K2 => &self.said.k2,
            Sweep::Stroke => &self.said.stroke,
            Sweep::ContactForce => &self.said.contact_force,
        };
        let mut values: Vec<f64> = given.iter().map(|value| value.get()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }

    /// The quantities that are bounded.
    pub fn sweeps(&self) -> Vec<Sweep> {
        Sweep::ALL.into_iter().filter(|sweep| !self.values(*sweep).is_empty()).collect()
    }

    /// Number of band samples of the second evaluation.
    pub fn check(&self) -> usize {
        self.said.check.unwrap_or(self.said.samples)
    }
}

/// The study of a damper under a bound; `starts` must satisfy it.
///
/// # Errors
/// The first [`Rule`] that is broken.
pub fn bounded(
    study: &Study,
    sweep: Sweep,
    value: f64,
    starts: Vec<PerVariable<f64>>,
) -> Result<Study, Rule> {
    let mut study = study.clone();
    let optimize = study.optimize.as_mut().ok_or(Rule::NoOptimize)?;
    optimize.surf = None;
    match sweep.limit().zip(Positive::new(value).ok()) {
        Some((limit, most)) => optimize.limits = optimize.limits.with(limit, most),
        None => {
            optimize.bounds.set(Parameter::K2, Some((least_k2(optimize), Some(value))));
            // A search that begins at the damper of the study begins at its nearest within the bound.
            let stiffer = study.scene.damper.filter(|damper| damper.stiffness.get() > value);
            if let Some(damper) = stiffer
                && starts.is_empty()
                && optimize.starts.is_empty()
                && optimize.global.is_none()
            {
                optimize.starts.push(clipped(&Design::of_varied(&damper, &optimize.vary), optimize));
            }
            for start in &mut optimize.starts {
                start.set(Parameter::K2, start.get(Parameter::K2).map(|k2| k2.min(value)));
            }
            if let Some(global) = &mut optimize.global {
                global.sides.set(Parameter::K2, None);
            }
        }
    }
    optimize.starts.extend(starts);
    study.check()?;
    Ok(study)
}

/// The smallest k2 that a search may take, N/m.
fn least_k2(optimize: &Optimize) -> f64 {
    optimize.bounds.get(Parameter::K2).map_or(0.0, |(lower, _)| lower)
}

/// A design from `said`, completed from the damper of the study; the error is a value that it cannot have.
fn known(study: &Study, said: &PerVariable<f64>) -> Result<Design, (Parameter, f64)> {
    let own = |parameter: Parameter| parameter.of(&study.scene);
    let foreign =
        |&parameter: &Parameter| Some((parameter, said.get(parameter).filter(|_| own(parameter).is_none())?));
    match Parameter::VARIED.iter().find_map(foreign) {
        Some(refused) => Err(refused),
        None => Design::new(|parameter| said.get(parameter).or_else(|| own(parameter)).unwrap_or(f64::NAN))
            .map_err(|(variable, _)| (variable, said.get(variable).unwrap_or(f64::NAN))),
    }
}

/// Reads a file of fronts with the studies that it names, and checks that each can be tuned under each bound.
///
/// # Errors
/// [`StudyError`], of the file or of a study that it names.
pub fn read_fronts(path: &Path) -> Result<FrontsPlan, StudyError> {
    let file = path.display().to_string();
    let text = read_plan_text(path)?;
    expect(Kind::Fronts, &text, &file)?;
    let said: Fronts = parse(&text, &file)?;
    let refuse = |field: &str, value: String, allowed| StudyError::Rule {
        file: file.clone(),
        rule: Rule::not_allowed(field, value, allowed),
    };
    if said.dampers.is_empty() {
        return Err(refuse("dampers", "an empty list".to_owned(), "at least one"));
    }
    if said.k2.is_empty() && said.stroke.is_empty() && said.contact_force.is_empty() {
        return Err(refuse(
            "k2",
            "an empty list".to_owned(),
            "at least one bound on k2, stroke or contact_force",
        ));
    }
    if said.rounds > MOST_ROUNDS {
        return Err(refuse("rounds", said.rounds.to_string(), "a whole number from 0 to 24"));
    }
    for (field, samples) in [("samples", Some(said.samples)), ("check", said.check)] {
        if let Some(samples) = samples.filter(|samples| !(2..=MOST_SAMPLES).contains(samples)) {
            return Err(refuse(field, samples.to_string(), "a whole number from 2 to 10000"));
        }
    }
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut plan = FrontsPlan { said, dampers: Vec::new(), designs: Vec::new() };
    for (number, FrontDamper { damper, study, designs }) in plan.said.dampers.clone().into_iter().enumerate()
    {
        let study_file = directory.join(&study);
        let study = named(&study_file)?;
        check_quantity(&study)
            .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
        let least = study.optimize.as_ref().map_or(0.0, least_k2);
        if let Some(place) = plan.said.k2.iter().position(|most| most.get() <= least) {
            let (field, value) = (format!("k2[{place}]"), plan.said.k2[place].get());
            let value = format!("{value} N/m, with a smallest k2 of {least} N/m in {}", study_file.display());
            return Err(refuse(&field, value, "a bound above the smallest k2 of each study"));
        }
        for sweep in Sweep::ALL {
            for value in plan.values(sweep) {
                bounded(&study, sweep, value, Vec::new())
                    .and_then(|study| study.search().map(drop))
                    .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
            }
        }
        if plan.dampers.iter().any(|(name, other)| *name == damper || other.name() == study.name()) {
            return Err(refuse("dampers", format!("\"{damper}\" twice"), "each name and each study once"));
        }
        for (place, design) in designs.iter().enumerate() {
            let design = known(&study, design).map_err(|(variable, value)| {
                let field = format!("dampers[{number}].designs[{place}].{variable}");
                refuse(&field, value.to_string(), "what the damper of the study has and may be")
            })?;
            plan.designs.push((number, design));
        }
        plan.dampers.push((damper, study));
    }
    Ok(plan)
}
