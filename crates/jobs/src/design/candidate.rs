//! A damper that may be built, or none: what it has of each quantity over the whole band.

use super::resonance::about_resonance;
use super::settled::settled;
use crate::Error;
use retune_model::{Damper, Design, Forcing, Measure, Parameter, PerMeasure, Positive, Scene, Source};
use retune_optim::{Goal, Limit, Limits, Need, Stiffnesses, Unusable};
use retune_study::{Rule, Study};
use serde::Serialize;

/// A candidate is measured on so many times the samples of a search.
const MORE: usize = 4;
/// A search in time looks at every fourth of the stiffnesses that there may be, the ends among them.
const SPARSE: usize = 4;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum What {
    /// The structure alone.
    #[serde(rename = "no damper")]
    None,
    /// A damper that touches nothing.
    #[serde(rename = "TMD")]
    Tmd,
    /// A damper that strikes its walls.
    #[serde(rename = "SSVI NES")]
    Ssvi,
}

impl What {
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "no damper",
            Self::Tmd => "TMD",
            Self::Ssvi => "SSVI NES",
        }
    }
}

/// What a damper has under a shock or a record with the other sign.
#[derive(Clone, Debug)]
pub struct OtherSign {
    /// The goal, in its unit.
    pub goal: f64,
    /// Limits that it breaks, each with what it has.
    pub broken: Vec<(Limit, f64)>,
}

/// A candidate: its scene, and its largest values over the band.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub what: What,
    /// The study by which it is measured, with it in its scene.
    pub study: Study,
    /// The value of the goal, in its unit.
    pub goal: f64,
    pub feasible: bool,
    /// Limits that it reaches to 1 %, or breaks, with what it has.
    pub binding: Vec<(Limit, f64)>,
    /// Largest values once the motion is steady, each with its place; under a shock or a record, from the time on from which they count.
    pub steady: PerMeasure<Need>,
    /// The same from rest on, of the one to build: many runs.
    pub from_rest: Option<PerMeasure<Need>>,
}

impl Candidate {
    /// Measures the scene of a study, with its damper or without, once it has settled.
    pub fn new(what: What, study: &Study) -> Result<Self, Unusable> {
        let study = settled(study);
        let mut steady = own_needs(&study)?;
        let (goal, settings) = (on_many_samples(&study), study.solver.settings());
        let mut found = goal.evaluate(&study.scene, &settings, f64::INFINITY)?;
        if let Some(narrow) = about_resonance(&study) {
            let there = on_many_samples(&narrow).evaluate(&study.scene, &settings, f64::INFINITY)?;
            found.violation = found.violation.max(there.violation);
            for limit in Limit::ALL {
                found.reached.set(limit, found.reached.get(limit).max(there.reached.get(limit)));
            }
        }
        let limits = goal.limits;
        let binding =
            limits.active(&found.reached).into_iter().map(|limit| (limit, found.reached.get(limit)));
        for measure in Measure::ALL {
            let own = steady.get(measure);
            if own.value == f64::NEG_INFINITY {
                steady.set(measure, Need { value: 0.0, ..own });
            }
        }
        // Peaks between samples are told apart a little better here than in a search.
        let best = steady.get(study.quantity()).value;
        Ok(Self {
            what,
            goal: if best.is_finite() && best > 0.0 { best } else { found.value },
            feasible: found.violation == 0.0,
            binding: binding.collect(),
            steady,
            from_rest: None,
            study,
        })
    }

    /// The same with its largest values from rest on.
    pub fn with_start(self) -> Result<Self, Unusable> {
        let from_rest = over_band(&self.study, |goal, Study { scene, solver, .. }| {
            let asked = (&self.steady, told(&goal.limits));
            goal.needs_from_rest(scene, &solver.settings(), asked, &|| true)
        })?;
        Ok(Self { from_rest: Some(from_rest), ..self })
    }

    /// The largest values from rest on, or those of the steady motion where the others were not looked at.
    pub fn most(&self) -> &PerMeasure<Need> {
        self.from_rest.as_ref().unwrap_or(&self.steady)
    }

    /// The [goal](Self::goal) of the scene of a study, to the same bits, with which alone a search ends; none where it has no bound.
    pub fn goal_of(study: &Study) -> Option<f64> {
        let study = settled(study);
        let Need { value, .. } = own_needs(&study).ok()?.get(study.quantity());
        (value.is_finite() && value > 0.0).then_some(value)
    }

    /// The goal, in its unit, with k1 of the structure off by each of some shares of it, from the runs that the largest over all k1 is of; NaN where it has
    /// no bound. A larger one than was known becomes that largest.
    pub fn with_k1_off<const N: usize>(&mut self, shares: [f64; N]) -> [f64; N] {
        let quantity = self.study.quantity();
        shares.map(|share| {
            let mut study = self.study.clone();
            let k1 = Positive::new(study.scene.primary.stiffness.get() * (1.0 + share)).ok();
            if let Some(optimize) = &mut study.optimize {
                optimize.objective.k1 = k1.map(|k1| Stiffnesses::Set(vec![k1]));
            }
            let Ok(need) = own_needs(&study).map(|needs| needs.get(quantity)) else { return f64::NAN };
            if need.value > self.goal {
                self.goal = need.value;
                self.steady.set(quantity, need);
            }
            need.value
        })
    }

    /// Whether it stands under a shock or a record, so that no value has a frequency.
    pub fn is_transient(&self) -> bool {
        self.study.scene.forcing.is_transient()
    }

    /// What it has under what is given in time with the other sign; none under a harmonic.
    pub fn with_other_sign(&self) -> Option<OtherSign> {
        let Study { scene, solver, .. } = &self.study;
        let source = Source::History(scene.forcing.history()?.reversed()?);
        let scene = Scene { forcing: Forcing { source, ..scene.forcing }, ..*scene };
        let goal = self.study.goal();
        let found = goal.evaluate(&scene, &solver.settings(), f64::INFINITY).ok()?;
        let reached = |limit: &Limit| found.reached.get(*limit);
        let broken = goal
            .limits
            .set()
            .filter(|limit| goal.limits.get(*limit).is_some_and(|most| reached(limit) > most));
        Some(OtherSign { goal: found.value, broken: broken.map(|limit| (limit, reached(&limit))).collect() })
    }

    /// The largest steady value of a quantity, or that under a shock or a record, in its SI unit.
    pub fn value(&self, measure: Measure) -> f64 {
        self.steady.get(measure).value
    }

    pub fn damper(&self) -> Option<Damper> {
        self.study.scene.damper
    }

    /// k2, N/m; zero without a damper.
    pub fn k2(&self) -> f64 {
        self.damper().map_or(0.0, |damper| damper.stiffness.get())
    }

    /// c2, N·s/m; zero without a damper.
    pub fn c2(&self) -> f64 {
        self.damper().map_or(0.0, |damper| damper.damping.get())
    }

    /// Whether it touches a wall, as far as it was looked at.
    pub fn strikes(&self) -> bool {
        self.most().get(Measure::ContactForce).value > 0.0
    }
}

/// A study with a design in its scene: the value of each parameter of the damper in its SI unit; NaN keeps that of the scene.
///
/// # Errors
/// A value is out of range, or the scene has no damper.
pub(super) fn with_design(study: &Study, value: impl Fn(Parameter) -> f64) -> Result<Study, Error> {
    let no_damper = || Error::Rule { name: study.name().to_owned(), rule: Rule::NoDamper };
    let design = Design::new(value).map_err(|(_, source)| Error::from(source))?;
    let scene = study.scene_at(&design).ok_or_else(no_damper)?;
    Ok(Study { scene, ..study.clone() })
}

/// The goal by which a candidate is measured: on more samples of the band than a search takes, since a motion that is there in a part of it
/// alone is missed by few. Several stiffnesses, at which resonances lie elsewhere, are samples enough.
fn on_many_samples(study: &Study) -> Goal {
    let mut goal = study.goal();
    goal.objective.for_each_term(&mut |term| {
        if let (Some(band), None) = (&mut term.omega, &term.k1) {
            band.samples *= MORE;
        }
    });
    goal
}

/// The largest values over what the objective looks at.
fn own_needs(study: &Study) -> Result<PerMeasure<Need>, Unusable> {
    over_band(study, |goal, Study { scene, solver, .. }| goal.own_needs(scene, &solver.settings(), &|| true))
}

/// The largest values over the band, and over the part of a wide one about the resonance, whose peak may lie between its samples.
fn over_band(
    study: &Study,
    look: impl Fn(&Goal, &Study) -> Result<PerMeasure<Need>, Unusable>,
) -> Result<PerMeasure<Need>, Unusable> {
    let mut all = look(&on_many_samples(study), study)?;
    if let Some(narrow) = about_resonance(study) {
        let there = look(&on_many_samples(&narrow), &narrow)?;
        for measure in Measure::ALL {
            if there.get(measure).value > all.get(measure).value {
                all.set(measure, there.get(measure));
            }
        }
    }
    Ok(all)
}

/// The study by which a search in time goes: with k1 at few of the values that it may have.
pub(super) fn at_few_stiffnesses(study: &Study) -> Study {
    let mut study = study.clone();
    let k1 = study.optimize.as_mut().and_then(|optimize| optimize.objective.k1.as_mut());
    if let Some(Stiffnesses::Set(all)) = k1 {
        *all = all.iter().step_by(SPARSE).copied().collect();
    }
    study
}

/// From where on a value from rest is told, and its peaks between samples matter: above its limit; of the stroke, which is drawn, everywhere.
fn told(limits: &Limits) -> PerMeasure<f64> {
    PerMeasure(Measure::OF_RUN.map(|measure| match measure {
        Measure::Stroke => f64::NEG_INFINITY,
        _ => limits.get(Limit::Of(measure)).unwrap_or(f64::INFINITY),
    }))
}
