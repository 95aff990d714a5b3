//! The study behind the page: the paper's two dampers, the family of stiffnesses, and the resolution.

use crate::{Error, Observer};
use retune_model::{Contact, Damper, Design, Parameter, Scene};
use retune_optim::Failures;
use retune_solver::{Settings, Window};
use retune_study::{Kind, PaperStudy, Setting, Study, StudyError, read_paper, read_table2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The study of the whole paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PaperPlan {
    /// The JSON Schema that an editor completes and checks this file with. Retune ignores it.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// "paper". A file without it is recognised by its other fields.
    #[serde(default = "kind")]
    #[schemars(extend("const" = "paper"))]
    pub kind: Kind,
    /// The table of the two dampers, the SSVI NES first, then the TMD; a path as seen from this file.
    pub table2: PathBuf,
    /// Stiffnesses k1 of the primary structure, N/m.
    pub k1: Vec<f64>,
    /// Frequencies of Figures 3 to 5, rad/s.
    pub omega: Range,
    /// Stiffnesses of Figure 5a, N/m.
    pub k1_range: Range,
    /// Numbers of frequencies on which every worst over a band is looked at again, ascending; designs near are looked at on the middle one.
    #[serde(default = "ladder")]
    #[schemars(length(min = 1))]
    pub ladder: Vec<usize>,
    /// Frequencies on either side of the natural frequency over which motions are named, as ratios to it, and how many.
    pub motions: Range,
}

fn kind() -> Kind {
    Kind::Paper
}

fn ladder() -> Vec<usize> {
    vec![61, 121, 601, 3001, 5001]
}

/// Evenly spaced values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// How many.
    #[schemars(range(min = 2, max = 100_000))]
    pub points: usize,
}

/// Runs the search of a study and returns its design.
pub type Tuner<'a> = dyn FnMut(&Study) -> Result<Design, Error> + 'a;

/// The plan with the studies that it names.
pub struct Plan<'a> {
    pub file: PaperPlan,
    pub ssvi: Study,
    pub tmd: Study,
    /// The observer of the job.
    pub watch: &'a dyn Observer,
    /// Whether only the verdicts are needed, on fewer points.
    pub is_brief: bool,
}

/// The allowed numbers of points.
const POINTS: std::ops::RangeInclusive<usize> = 2..=100_000;

/// Most steps of a run: a hundred times those of the paper's runs, so that a run that chatters on a wall ends in seconds.
const MOST_STEPS: u64 = 1_000_000;

/// Radii of the damper's surfaces, m, for which results are repeated, since the paper does not state its radius.
pub const RADII: [f64; 5] = [0.1, 0.5, 2.0, 5.0, 10.0];

impl Range {
    pub fn values(self) -> Vec<f64> {
        retune_dynamics::parameter::evenly(self.from, self.to, self.points)
    }

    fn is_sound(self) -> bool {
        let Self { from, to, points } = self;
        from.is_finite() && to.is_finite() && 0.0 < from && from < to && POINTS.contains(&points)
    }
}

impl<'a> Plan<'a> {
    pub fn read(path: &Path, watch: &'a dyn Observer) -> Result<Self, Error> {
        let file: PaperPlan = read_paper(path)?;
        let refuse = |problem: &str| {
            Error::from(StudyError::Paper { file: path.display().to_string(), problem: problem.to_owned() })
        };
        if file.k1.is_empty() || !file.k1.iter().all(|k1| k1.is_finite() && *k1 > 0.0) {
            return Err(refuse("k1: give at least one number above 0"));
        }
        for (name, range) in [("omega", file.omega), ("k1_range", file.k1_range), ("motions", file.motions)] {
            if !range.is_sound() {
                return Err(refuse(&format!("{name}: give 0 < from < to and 2 to 100000 points")));
            }
        }
        let ladder = &file.ladder;
        if ladder.is_empty() || !ladder.is_sorted() || !ladder.iter().all(|n| POINTS.contains(n)) {
            return Err(refuse("ladder: give at least one number from 2 to 100000, ascending"));
        }
        let directory = path.parent().unwrap_or(Path::new(""));
        let rows = read_table2(&directory.join(&file.table2))?;
        let studies: Result<[PaperStudy; 2], _> = rows.try_into();
        let [ssvi, tmd] =
            studies.map_err(|_| refuse("table2: must have two rows, the SSVI NES and the TMD"))?;
        // The page has its own objectives: only the scenes, the window and the solver are taken from the studies.
        let [ssvi, tmd] = [ssvi, tmd].map(|row| Study { optimize: None, ..row.study });
        Ok(Self { file, ssvi, tmd, watch, is_brief: false })
    }

    /// The scenes without damper, with SSVI NES and with TMD at a stiffness.
    pub fn scenes(&self, k1: f64) -> Result<[Scene; 3], Error> {
        let at = |study: &Study| -> Result<Scene, Error> { Ok(Parameter::K1.at(study.scene, k1)?) };
        let (ssvi, tmd) = (at(&self.ssvi)?, at(&self.tmd)?);
        Ok([Scene { damper: None, ..ssvi }, ssvi, tmd])
    }

    /// The stiffness at which the dampers are tuned, N/m.
    pub fn tuned(&self) -> f64 {
        self.ssvi.scene.primary.stiffness.get()
    }

    /// The scene of the SSVI NES with other values of some parameters.
    pub fn ssvi_with(&self, values: &[(Parameter, f64)]) -> Result<Scene, Error> {
        let settings: Vec<Setting> =
            values.iter().map(|&(parameter, value)| Setting::new(parameter, value)).collect();
        Ok(self.ssvi.scene_with(&settings)?)
    }

    /// The radius of the SSVI NES's surfaces, m.
    pub fn radius(&self) -> f64 {
        self.ssvi.value_of(Parameter::R).unwrap_or(f64::NAN)
    }

    /// The [`RADII`] other than the plan's, m.
    pub fn other_radii(&self) -> impl Iterator<Item = f64> {
        let radius_of_plan = self.radius();
        RADII.into_iter().filter(move |radius| *radius != radius_of_plan)
    }

    pub fn window(&self) -> Window {
        self.ssvi.window.window()
    }

    /// From rest to the end of the window.
    pub fn whole_run(&self) -> Window {
        Window { from: 0.0, ..self.window() }
    }

    /// How runs are integrated.
    pub fn settings(&self) -> Settings {
        let settings = self.ssvi.solver.settings();
        Settings { max_steps: settings.max_steps.min(MOST_STEPS), ..settings }
    }

    /// The settings behind an item, in words.
    pub fn made_by(&self, more: &str) -> String {
        let contact = self.ssvi.scene.damper.and_then(|damper| damper.contact);
        let surfaces = contact.as_ref().and_then(Contact::surfaces);
        let radius = surfaces.map_or(String::new(), |surfaces| {
            format!("R = {} m, q = {}; ", surfaces.radius.get(), surfaces.coefficient.get())
        });
        format!("{radius}{}. {more}", crate::summary::MadeBy::new(&self.ssvi))
    }
}

pub fn damper(study: &Study) -> Result<Damper, Error> {
    study.scene.damper.ok_or_else(|| Error::NoStart(Failures::default()))
}

/// `2.00e4`, as the paper writes stiffnesses.
pub fn stiffness(k1: f64) -> String {
    format!("{k1:.2e}")
}
