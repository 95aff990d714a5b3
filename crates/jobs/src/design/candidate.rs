//! A damper that may be built, or none: what it has of each quantity over the whole band.

use retune_model::{Damper, Forcing, Measure, NonNegative, PerMeasure, Positive, Scene, Source};
use retune_optim::{Limit, Limits, Need, Unusable};
use retune_study::{Span, Study};
use serde::Serialize;
use std::f64::consts::TAU;

/// Periods of the natural frequency that are waited for at most until a motion has settled: more would take minutes.
const SETTLED: f64 = 1000.0;

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
        let study = settling(study, &study.scene);
        let settings = study.solver.settings();
        let mut steady = study.goal().own_needs(&study.scene, &settings, &|| true)?;
        let found = study.goal().evaluate(&study.scene, &settings, f64::INFINITY)?;
        let limits = study.goal().limits;
        let is_damper = study.scene.damper.is_some();
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
            feasible: is_damper && found.violation == 0.0,
            binding: binding.collect(),
            steady,
            from_rest: None,
            study,
        })
    }

    /// The same with its largest values from rest on.
    pub fn with_start(self) -> Result<Self, Unusable> {
        let Study { scene, solver, .. } = &self.study;
        let goal = self.study.goal();
        let asked = (&self.steady, told(&goal.limits));
        let from_rest = goal.needs_from_rest(scene, &solver.settings(), asked, &|| true)?;
        Ok(Self { from_rest: Some(from_rest), ..self })
    }

    /// The largest values from rest on, or those of the steady motion where the others were not looked at.
    pub fn most(&self) -> &PerMeasure<Need> {
        self.from_rest.as_ref().unwrap_or(&self.steady)
    }

    /// The [goal](Self::goal) of the scene of a study, to the same bits, with which alone a search ends; none where it has no bound.
    pub fn goal_of(study: &Study) -> Option<f64> {
        let study = settling(study, &study.scene);
        let needs = study.goal().own_needs(&study.scene, &study.solver.settings(), &|| true).ok()?;
        let Need { value, .. } = needs.get(study.quantity());
        (value.is_finite() && value > 0.0).then_some(value)
    }

    /// Whether it stands under a shock or a record, so that no value has a frequency.
    pub fn is_transient(&self) -> bool {
        self.study.scene.forcing.is_transient()
    }

    /// Its goal under what is given in time with the other sign; none under a harmonic.
    pub fn with_other_sign(&self) -> Option<f64> {
        let Study { scene, .. } = &self.study;
        let source = Source::History(scene.forcing.history()?.reversed()?);
        self.study.energy(&Scene { forcing: Forcing { source, ..scene.forcing }, ..*scene })
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

/// The study with its window, as long as it is, from when the slowest transient of a scene with its walls open has decayed, if that matters at its
/// own t0. With a damper whose stroke or mass is kept small the motion builds up from rest for hundreds of periods, and would be measured too early.
pub(super) fn settling(study: &Study, scene: &Scene) -> Study {
    let mut study = study.clone();
    if (Study { scene: *scene, ..study.clone() }).unsettled().is_none() {
        return study;
    }
    let length = study.window.end.get() - study.window.t0.get();
    let period = TAU / scene.forcing.frequency.get();
    let settled = Span::settled(scene).map_or(f64::INFINITY, |span| span.t0.get());
    let t0 = settled.min(SETTLED * period);
    if let (Ok(t0), Ok(end)) = (NonNegative::new(t0), Positive::new(t0 + length)) {
        study.window = Span { t0, end };
        if let Some(from) = study.optimize.as_mut().and_then(|optimize| optimize.limits.from.as_mut()) {
            *from = t0; // of the same motion as the objective
        }
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
