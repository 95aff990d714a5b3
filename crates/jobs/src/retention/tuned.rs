//! Dampers tuned for several stiffnesses of the structure.

use super::range::Threshold;
use crate::Error;
use crate::tune::objective::with_samples;
use retune_model::{Design, NonNegative, Positive, Scene};
use retune_optim::Stiffnesses;
use retune_study::Study;

pub(super) const DESIGNS: &str = "retune.csv";
pub(super) const CURVES: &str = "retention.csv";
pub(super) const RANGES: &str = "range.csv";
pub(super) const FORCES: &str = "force.csv";

/// How a design was tuned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tuning {
    /// No damper.
    None,
    /// The paper's design, kept for all k1.
    Paper,
    /// Another given design, kept for all k1.
    Study,
    /// Tuned for the k1 of its study, and kept for all k1.
    Nominal,
    /// Tuned for the worst over all k1, and kept for all k1.
    Robust,
    /// Re-tuned at each k1.
    Anew,
    /// Between the nominal design and the one with the widest range.
    Front,
}

impl Tuning {
    /// The tunings whose design is kept.
    pub const KEPT: [Self; 4] = [Self::Paper, Self::Study, Self::Nominal, Self::Robust];
    /// The tunings that no search found.
    pub const GIVEN: [Self; 2] = [Self::Paper, Self::Study];

    /// Its name in tables and figures.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Paper => "paper",
            Self::Study => "of the study",
            Self::Nominal => "nominal",
            Self::Robust => "k1-robust",
            Self::Anew => "re-tuned",
            Self::Front => "front",
        }
    }
}

/// The names of bands in tables: the study's band, and the band fixed where it is at the nominal k1.
pub(super) const BANDS: [&str; 2] = ["own", "still"];
/// Their indices.
pub(super) const OWN: usize = 0;
pub(super) const STILL: usize = 1;

/// A damper with its designs.
#[derive(Debug)]
pub struct Tuned {
    /// Its name.
    pub name: String,
    /// Its study, with the given damper in the scene; then the study with a fixed band, if the study's band moves with k1.
    pub studies: Vec<Study>,
    /// The threshold for each of the studies.
    pub thresholds: Vec<Threshold>,
    /// The samples of the band on which all designs are compared.
    pub samples: Option<usize>,
    /// The designs that are kept while k1 changes.
    pub kept: Vec<(Tuning, Design)>,
    /// The design for each stiffness k1, N/m, in their order.
    pub anew: Vec<(f64, Design)>,
}

impl Tuned {
    /// A damper without designs and thresholds.
    pub(super) fn new(name: String, study: Study, samples: Option<usize>) -> Self {
        let studies = [Some(study.clone()), still(&study)].into_iter().flatten().collect();
        Self { name, studies, thresholds: Vec::new(), samples, kept: Vec::new(), anew: Vec::new() }
    }

    /// The damper with its thresholds.
    pub(super) fn with_thresholds(self) -> Result<Self, Error> {
        Ok(Self { thresholds: self.studies.iter().map(Threshold::of).collect::<Result<_, _>>()?, ..self })
    }

    /// Its study.
    pub fn study(&self) -> &Study {
        &self.studies[OWN]
    }

    /// The stiffness of its study, N/m.
    pub fn nominal(&self) -> f64 {
        self.study().scene.primary.stiffness.get()
    }

    /// The kept design of a tuning, if there is one.
    pub fn of(&self, tuning: Tuning) -> Option<Design> {
        self.kept.iter().find(|(kept, _)| *kept == tuning).map(|(_, at)| *at)
    }

    /// E1max of a design at a stiffness (N/m), J, on the common samples; NaN where it cannot be run.
    pub fn energy(&self, at: &Design, k1: f64) -> f64 {
        energy(self.study(), self.samples, at, k1).unwrap_or(f64::NAN)
    }

    /// E1max of a design under the conditions it was tuned for, J: the worst over all `k1` (N/m), that at the k1 of a re-tuned design, else
    /// at the nominal one. None where it cannot be run.
    pub fn energy_as_tuned(&self, tuning: &str, at: &Design, k1: &[f64]) -> Option<f64> {
        let tuned_for = k1.iter().copied().find(|k1| label(*k1) == tuning).unwrap_or(self.nominal());
        let robust = (tuning == Tuning::Robust.name()).then(|| over(self.study(), k1));
        energy(robust.as_ref().unwrap_or(self.study()), self.samples, at, tuned_for)
    }
}

/// The label of a design tuned for a stiffness, N/m.
pub fn label(k1: f64) -> String {
    format!("k1 = {k1}")
}

/// The study with its band fixed at the nominal k1; none if the band does not move with k1.
fn still(study: &Study) -> Option<Study> {
    let mut study = study.clone();
    let (primary, mut moves) = (study.scene.primary, false);
    if let Some(optimize) = &mut study.optimize {
        optimize.objective.for_each_term(&mut |term| {
            if let Some(band) = term.omega.as_mut().filter(|band| band.relative) {
                let ends = band.of(&primary);
                if let (Ok(from), Ok(to)) = (Positive::new(ends.from), Positive::new(ends.to)) {
                    (band.from, band.to, band.relative, moves) = (from, to, false, true);
                }
            }
        });
    }
    moves.then_some(study)
}

/// E1max of a design by a study's objective at a stiffness (N/m), J, on `samples` frequencies, by default the study's; none where it cannot
/// be run.
pub fn energy(study: &Study, samples: Option<usize>, at: &Design, k1: f64) -> Option<f64> {
    let study = on_samples(study, samples, at)?;
    study.energy(&scene_at(&study, k1)?)
}

/// The study with the worst over some stiffnesses, N/m, as objective.
pub fn over(study: &Study, k1: &[f64]) -> Study {
    let mut study = study.clone();
    let all: Vec<Positive> = k1.iter().filter_map(|k1| Positive::new(*k1).ok()).collect();
    if let Some(optimize) = &mut study.optimize {
        optimize.objective.for_each_term(&mut |term| term.k1 = Some(Stiffnesses::Set(all.clone())));
    }
    study
}

/// E1max without a damper by the objective of a study at a stiffness (N/m), J.
pub fn bare(study: &Study, k1: f64) -> Option<f64> {
    study.energy(&Scene { damper: None, ..scene_at(study, k1)? })
}

/// The study with a design in its scene and its band on `samples` frequencies, by default its own.
pub fn on_samples(study: &Study, samples: Option<usize>, at: &Design) -> Option<Study> {
    match samples {
        Some(samples) => with_samples(study, samples, at),
        None => Some(Study { scene: study.scene_at(at)?, ..study.clone() }),
    }
}

fn scene_at(study: &Study, k1: f64) -> Option<Scene> {
    let mut scene = study.scene;
    scene.primary.stiffness = NonNegative::new(k1).ok()?;
    Some(scene)
}
