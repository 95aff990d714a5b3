//! The study behind `retune fronts`: dampers to tune under ever looser bounds on the spring or on the stroke.

use super::file::{StudyError, expect, parse, read_text};
use super::format::Study;
use super::kind::Kind;
use super::per_variable::PerVariable;
use super::read::read;
use super::rule::Rule;
use retune_model::Positive;
use retune_optim::Variable;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Most samples of a band on which designs that were found are looked at again.
const MOST_SAMPLES: usize = 10_000;

/// What a damper is good for: the least E1max under bounds on its spring, and on its stroke.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fronts {
    /// The JSON Schema that an editor completes and checks this file with. Retune ignores it.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// "fronts". A file without it is recognised by its other fields.
    #[serde(default = "kind")]
    #[schemars(extend("const" = "fronts"))]
    pub kind: Kind,
    /// The dampers. Each is compared with the first, and its searches start at the designs of those before it too.
    #[schemars(length(min = 1))]
    pub dampers: Vec<FrontDamper>,
    /// Largest k2 allowed, N/m; every study is tuned under each.
    #[schemars(length(min = 1))]
    pub k2: Vec<Positive>,
    /// Largest stroke (spring deflection |x2 - x1 - D|) allowed, m, as the limit of that name in a study; every study is tuned under each, with k2 as free as its bounds say.
    #[schemars(length(min = 1))]
    pub stroke: Vec<Positive>,
    /// Samples of the bands on which the designs that were found are looked at again, to be compared.
    #[serde(default = "samples")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
    /// How many designs are certified: those that are furthest below the first damper under the same bound.
    #[serde(default = "certificates")]
    pub certificates: usize,
}

/// A damper to tune.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontDamper {
    /// Its name in tables and figures.
    pub damper: String,
    /// The study that tunes it, which must tune k2; a path as seen from this file. The damper in its scene is drawn beside those
    /// that are found. A `surf` in it is left out.
    pub study: PathBuf,
}

/// What is bounded along a front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// The stiffness of the spring.
    K2,
    /// The stroke.
    Stroke,
}

/// The studies of a file, with all that it says about them.
#[derive(Clone, Debug)]
pub struct FrontsPlan {
    /// The file.
    pub said: Fronts,
    /// Each damper's name and study.
    pub dampers: Vec<(String, Study)>,
}

fn kind() -> Kind {
    Kind::Fronts
}

fn samples() -> usize {
    61
}

fn certificates() -> usize {
    3
}

impl Sweep {
    /// Both.
    pub const ALL: [Self; 2] = [Self::K2, Self::Stroke];

    /// Its name in studies and of its table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::K2 => "k2",
            Self::Stroke => "stroke",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::K2 => "N/m",
            Self::Stroke => "m",
        }
    }
}

impl FrontsPlan {
    /// The values of a bound, smallest first, each once.
    pub fn values(&self, sweep: Sweep) -> Vec<f64> {
        let given = match sweep {
            Sweep::K2 => &self.said.k2,
            Sweep::Stroke => &self.said.stroke,
        };
        let mut values: Vec<f64> = given.iter().map(|value| value.get()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }
}

/// The study of a damper under a bound, which `starts` have to keep.
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
    match sweep {
        Sweep::K2 => {
            let lower = optimize.bounds.get(Variable::K2).map_or(0.0, |(lower, _)| lower);
            *optimize.bounds.get_mut(Variable::K2) = Some((lower, Some(value)));
            if let Some(global) = &mut optimize.global {
                *global.sides.get_mut(Variable::K2) = None;
            }
        }
        Sweep::Stroke => optimize.limits.stroke = Positive::new(value).ok(),
    }
    optimize.starts.extend(starts);
    study.check()?;
    Ok(study)
}

/// Reads a file of fronts and the studies that it names, and checks that each can be tuned under each bound.
///
/// # Errors
/// [`StudyError`], of the file or of a study that it names.
pub fn read_fronts(path: &Path) -> Result<FrontsPlan, StudyError> {
    let file = path.display().to_string();
    let text = read_text(path)?;
    expect(Kind::Fronts, &text, &file)?;
    let said: Fronts = parse(&text, &file)?;
    let refuse = |field: &str, value: String, allowed| StudyError::Rule {
        file: file.clone(),
        rule: Rule::NotAllowed { field: field.to_owned(), value, allowed },
    };
    for (field, count) in
        [("dampers", said.dampers.len()), ("k2", said.k2.len()), ("stroke", said.stroke.len())]
    {
        if count == 0 {
            return Err(refuse(field, "an empty list".to_owned(), "at least one"));
        }
    }
    if !(2..=MOST_SAMPLES).contains(&said.samples) {
        return Err(refuse("samples", said.samples.to_string(), "a whole number from 2 to 10000"));
    }
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut plan = FrontsPlan { said, dampers: Vec::new() };
    for FrontDamper { damper, study } in plan.said.dampers.clone() {
        let study_file = directory.join(&study);
        let study = read(&study_file)?;
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
        plan.dampers.push((damper, study));
    }
    Ok(plan)
}
