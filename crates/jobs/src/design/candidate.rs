//! A candidate, a damper or none, and its largest value of each quantity over the whole band.

use super::resonance::about_resonance;
use super::settled::settled;
use crate::Error;
use retune_model::{Damper, Design, Forcing, Measure, Parameter, PerMeasure, Positive, Scene, Source};
use retune_optim::{Goal, Limit, Limits, Need, Stiffnesses, Unusable};
use retune_study::{Rule, Study};
use serde::Serialize;

/// A candidate is evaluated on this many times the samples of a search.
const MORE: usize = 4;
/// A search by runs in time uses every fourth of the stiffnesses, including both ends.
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

/// The values of a damper under a shock or record with the opposite sign.
#[derive(Clone, Debug)]
pub struct OtherSign {
    /// The goal, in its unit.
    pub goal: f64,
    /// The limits that it breaks, each with the value reached.
    pub broken: Vec<(Limit, f64)>,
}

/// A candidate: its scene, and its largest values over the band.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub what: What,
    /// The study by which it is evaluated, with the candidate in its scene.
    pub study: Study,
    /// The value of the goal, in its unit.
    pub goal: f64,
    pub feasible: bool,
    /// The limits that it breaks or reaches to within 1 %, each with the value reached.
    pub binding: Vec<(Limit, f64)>,
    /// Largest values of the steady motion, each with its place; under a shock or a record, those from the time on from which they count.
    pub steady: PerMeasure<Need>,
    /// Largest values from rest on, where computed, since they take many runs: always for the recommended candidate and under a shock or a
    /// record.
    pub from_rest: Option<PerMeasure<Need>>,
}

impl Candidate {
    /// Evaluates the scene of a study, with or without a damper, once its motion has settled.
    pub fn new(what: What, study: &Study) -> Result<Self, Unusable> {
        let study = settled(study);
        let mut steady = objective_needs(&study)?;
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
        // Peaks between samples are resolved slightly better here than in a search.
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

    /// The candidate with its largest values from rest on.
    pub fn with_start(self) -> Result<Self, Unusable> {
        let from_rest = over_band(&self.study, |goal, Study { scene, solver, .. }| {
            let asked = (&self.steady, report_above(&goal.limits));
            goal.needs_from_rest(scene, &solver.settings(), asked, &|| true)
        })?;
        Ok(Self { from_rest: Some(from_rest), ..self })
    }

    /// The largest values from rest on, or those of the steady motion if the former were not computed.
    pub fn most(&self) -> &PerMeasure<Need> {
        self.from_rest.as_ref().unwrap_or(&self.steady)
    }

    /// The [goal](Self::goal) of the scene of a study alone, bit for bit as in a candidate; none where it is unbounded.
    pub fn goal_of(study: &Study) -> Option<f64> {
        let study = settled(study);
        let Need { value, .. } = objective_needs(&study).ok()?.get(study.quantity());
        (value.is_finite() && value > 0.0).then_some(value)
    }

    /// The goal, in its unit, with k1 off by each of the shares; NaN where it cannot be computed. A value above the candidate's goal
    /// replaces it.
    pub fn with_k1_off<const N: usize>(&mut self, shares: [f64; N]) -> [f64; N] {
        let quantity = self.study.quantity();
        shares.map(|share| {
            let mut study = self.study.clone();
            let k1 = Positive::new(study.scene.primary.stiffness.get() * (1.0 + share)).ok();
            if let Some(optimize) = &mut study.optimize {
                optimize.objective.k1 = k1.map(|k1| Stiffnesses::Set(vec![k1]));
            }
            let Ok(need) = objective_needs(&study).map(|needs| needs.get(quantity)) else { return f64::NAN };
            if need.value > self.goal {
                self.goal = need.value;
                self.steady.set(quantity, need);
            }
            need.value
        })
    }

    /// Whether it is under a shock or a record, so that no value has a frequency.
    pub fn is_transient(&self) -> bool {
        self.study.scene.forcing.is_transient()
    }

    /// Its values under the shock or record with the opposite sign; none under a harmonic.
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

    /// The largest value of a quantity in [`Self::steady`], in its SI unit.
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

    /// Whether it touches a wall in any run made.
    pub fn strikes(&self) -> bool {
        self.most().get(Measure::ContactForce).value > 0.0
    }
}

/// The study with a design in its scene. `value` gives each parameter of the damper in its SI unit; NaN keeps the scene's value.
///
/// # Errors
/// A value is out of range, or the scene has no damper.
pub(super) fn with_design(study: &Study, value: impl Fn(Parameter) -> f64) -> Result<Study, Error> {
    let no_damper = || Error::Rule { name: study.name().to_owned(), rule: Rule::NoDamper };
    let design = Design::new(value).map_err(|(_, source)| Error::from(source))?;
    let scene = study.scene_at(&design).ok_or_else(no_damper)?;
    Ok(Study { scene, ..study.clone() })
}

/// The goal by which a candidate is evaluated: on more samples of the band than in a search, since few samples miss a motion that exists
/// only in a part of it. With several stiffnesses, which shift the resonances, the samples suffice.
fn on_many_samples(study: &Study) -> Goal {
    let mut goal = study.goal();
    goal.objective.for_each_term(&mut |term| {
        if let (Some(band), None) = (&mut term.omega, &term.k1) {
            band.samples *= MORE;
        }
    });
    goal
}

/// The largest values over everything that the objective covers.
fn objective_needs(study: &Study) -> Result<PerMeasure<Need>, Unusable> {
    over_band(study, |goal, Study { scene, solver, .. }| goal.own_needs(scene, &solver.settings(), &|| true))
}

/// The largest values over the band, and over the part of a wide one about the resonance, whose peak may lie between its samples.
fn over_band(
    study: &Study,
    evaluate: impl Fn(&Goal, &Study) -> Result<PerMeasure<Need>, Unusable>,
) -> Result<PerMeasure<Need>, Unusable> {
    let mut all = evaluate(&on_many_samples(study), study)?;
    if let Some(narrow) = about_resonance(study) {
        let there = evaluate(&on_many_samples(&narrow), &narrow)?;
        for measure in Measure::ALL {
            if there.get(measure).value > all.get(measure).value {
                all.set(measure, there.get(measure));
            }
        }
    }
    Ok(all)
}

/// The study for searches by runs in time: with few of the values of k1.
pub(super) fn at_few_stiffnesses(study: &Study) -> Study {
    let mut study = study.clone();
    let k1 = study.optimize.as_mut().and_then(|optimize| optimize.objective.k1.as_mut());
    if let Some(Stiffnesses::Set(all)) = k1 {
        *all = all.iter().step_by(SPARSE).copied().collect();
    }
    study
}

/// Thresholds above which values from rest are reported and their peaks between samples matter: the limits; for the stroke, which is drawn,
/// any value.
fn report_above(limits: &Limits) -> PerMeasure<f64> {
    PerMeasure(Measure::OF_RUN.map(|measure| match measure {
        Measure::Stroke => f64::NEG_INFINITY,
        _ => limits.get(Limit::Of(measure)).unwrap_or(f64::INFINITY),
    }))
}
