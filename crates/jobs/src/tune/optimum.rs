//! The result of a search: one type, from which `optimum.json` and the last lines on screen are made.

mod answer;
pub(crate) mod flags;
pub(crate) mod notes;

use super::choice::PassedOver;
use super::global::{Basins, Explored};
use super::refine::{Descended, Refined, Run};
use super::surf::Surf;
use super::valley::Valley;
use crate::Error;
use crate::amount::Amount;
use crate::certify::Certificate;
use crate::needs::Needs;
use crate::summary::{MadeBy, Summary, TunedDamper, baseline};
use notes::{Goal, LimitNote, Met};
use retune_model::{Measure, Parameter, PerVariable, Scene};
use retune_optim::{Evaluation, Failures, Minimum, Scaling, Stop, value_of};
use retune_study::{Search, Study, design_cells, short};
use serde::{Serialize, Serializer};

/// The best design and how it was found. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Optimum {
    pub(crate) damper_type: &'static str,
    /// The best design.
    #[serde(flatten)]
    pub damper: TunedDamper,
    #[serde(flatten)]
    value: Amount,
    /// The meaning of that value, if it is not E1max in a window at the scene's omega.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) objective: Option<Goal>,
    /// The value without a damper; null if it is unbounded.
    #[serde(flatten)]
    none: Amount,
    /// The damper of the study's scene in words.
    #[serde(skip)]
    baseline: &'static str,
    /// The value with the damper of the study's scene; null if it cannot be run.
    #[serde(flatten)]
    study: Amount,
    pub(crate) on_bound: Vec<Met>,
    /// The parameters in which the best point of the grid lies at its edge, where the grid could be wider.
    pub(crate) on_edge: Vec<Parameter>,
    /// The state of the study's limits, if it has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) limits: Option<LimitNote>,
    surf: Option<GridBest>,
    /// The result of the global search, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) global: Option<Basins>,
    refine: Refinement,
    /// Number of refinements that begin at the starts.
    #[serde(skip)]
    starts: usize,
    /// The start of the winning run, if not one of the starts.
    #[serde(skip)]
    beyond: Option<&'static str>,
    pub(crate) failures: FailureNote,
    /// Designs with smaller values that were passed over for a safer or less loaded one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) passed_over: Vec<PassedOver>,
    /// The range of each parameter, the others held, within which the value is at most 0.1 % larger.
    #[serde(rename = "within_0.1_percent")]
    valleys: Vec<Valley>,
    /// `certificate.json`, here in its short form.
    #[serde(serialize_with = "in_short")]
    pub(crate) certificate: Certificate,
    /// The largest values over everything that the objective covers, each at its own worst case.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) needs: Option<Needs>,
    /// The study with the tuned damper, for texts.
    #[serde(skip)]
    of: Study,
    simulation: Summary,
    #[serde(skip)]
    made_by: MadeBy,
}

/// The stages before the refinement.
pub(super) struct Searched<'a> {
    pub surf: Option<&'a Surf>,
    pub explored: Option<&'a Explored>,
    pub basins: Option<Basins>,
    pub passed_over: Vec<PassedOver>,
    pub valleys: Vec<Valley>,
}

#[derive(Clone, Debug, Serialize)]
struct GridBest {
    points: usize,
    best: PerVariable<f64>,
    #[serde(flatten)]
    value: Amount,
}

#[derive(Clone, Debug, Serialize)]
struct Refinement {
    /// "absolute" or "scaled": what TolX measures.
    #[serde(rename = "TolX_mode")]
    tol_x_mode: &'static str,
    #[serde(rename = "TolX")]
    tol_x: f64,
    #[serde(rename = "TolFun")]
    tol_fun: f64,
    /// The number, from 1, of the start that gave the optimum.
    winner: usize,
    runs: Vec<RunNote>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct FailureNote {
    pub(crate) count: u64,
    pub(crate) example: Option<String>,
}

impl Optimum {
    /// The tuned parameters of every basin found by the global search, best first.
    pub fn places(&self) -> Vec<PerVariable<f64>> {
        self.global.iter().flat_map(Basins::places).collect()
    }

    /// Collects the results of a search; `summary` is of a run of the best design at the worst frequency of `evaluation`.
    pub(super) fn new(
        study: &Study,
        search: &Search,
        Searched { surf, explored, basins, passed_over, valleys }: Searched,
        refined: &Refined,
        summary: Summary,
        evaluation: Evaluation,
        certificate: Certificate,
    ) -> Result<Self, Error> {
        let (best, quantity) = (refined.best(), study.quantity());
        let damper = refined.objective.damper(&best.minimum.x)?;
        let over = |values: &[f64]| PerVariable::of(&search.variables, values);
        let refine = study.optimize.as_ref().map(|optimize| optimize.refine).unwrap_or_default();
        Ok(Self {
            damper_type: summary.damper_type(),
            damper: TunedDamper::of(&damper, &search.variables),
            value: Amount::new(quantity, evaluation.value),
            none: Amount::of(quantity, "_none", study.energy_without_damper()),
            baseline: baseline(&study.scene),
            study: Amount::of(quantity, "_study", study.energy(&study.scene).unwrap_or(f64::NAN)),
            objective: (!study.objective().is_default()).then(|| Goal::new(study, &evaluation)),
            on_bound: notes::on_bound(search, best, &valleys),
            on_edge: surf.map(|surf| notes::on_edge(search, surf)).unwrap_or_default(),
            limits: LimitNote::new((study, search), &evaluation, surf, explored, refined),
            surf: surf.map(|surf| GridBest {
                points: surf.grid.len(),
                best: PerVariable::of(&surf.variables, &surf.point(surf.best)),
                value: Amount::new(quantity, value_of(surf.least)),
            }),
            global: basins,
            refine: Refinement {
                tol_x_mode: tol_x_mode(best.minimum.scaling),
                tol_x: refine.tol_x,
                tol_fun: refine.tol_fun,
                winner: refined.winner + 1,
                runs: refined.runs.iter().map(|run| RunNote::new(run, quantity, over)).collect(),
            },
            starts: refined.starts,
            beyond: refined.beyond(refined.winner),
            failures: FailureNote::new(&[
                surf.map(|surf| &surf.failures),
                explored.map(|explored| &explored.failures),
                Some(&refined.objective.failures()),
            ]),
            passed_over,
            valleys,
            certificate,
            needs: Needs::new(study, search, &refined.objective.scene(&best.minimum.x)?, evaluation.value),
            of: Study { scene: Scene { damper: Some(damper), ..study.scene }, ..study.clone() },
            simulation: summary,
            made_by: MadeBy::new(study),
        })
    }

    /// The value of the study's objective, in the unit of the quantity.
    pub fn value(&self) -> f64 {
        self.value.value
    }

    /// The verdict of its certificate.
    pub fn verdict(&self) -> &'static str {
        self.certificate.verdict()
    }

    /// The reason for the verdict, in words.
    pub fn reason(&self) -> &str {
        self.certificate.reason()
    }

    /// Refuses a design that breaks the limits of its study by [`Error::Infeasible`].
    pub fn check_limits(&self) -> Result<(), Error> {
        self.certificate.check_limits()
    }
}

fn in_short<S: Serializer>(certificate: &Certificate, serializer: S) -> Result<S::Ok, S::Error> {
    certificate.short().serialize(serializer)
}

/// The header of the paper's Table 2.
pub fn table2_header() -> String {
    format!(
        "{:<24}{:<10}{:<12}{:<14}{:<12}{:<12}",
        "Damper type", "m2, kg", "k2, N/m", "c2, N·s/m", "D, m", "C, m"
    )
    .trim_end()
    .to_owned()
}

/// A row of the paper's Table 2.
pub fn table2_row(name: &str, damper: &TunedDamper) -> String {
    let m2 = short(damper.mass.get());
    let [k2, c2, d, c] = design_cells(&damper.design, 6);
    format!("{name:<24}{m2:<10}{k2:<12}{c2:<14}{d:<12}{c}")
}

impl FailureNote {
    /// Collects the failures of all stages; the example is the first.
    fn new(stages: &[Option<&Failures>]) -> Self {
        let count = stages.iter().flatten().map(|failures| failures.count).sum();
        let first = stages.iter().flatten().find_map(|failures| failures.example.as_deref());
        Self { count, example: first.map(|(design, reason)| format!("{design:?}: {reason}")) }
    }
}

fn tol_x_mode(scaling: Scaling) -> &'static str {
    match scaling {
        Scaling::None => "absolute",
        Scaling::Start => "scaled",
    }
}

pub(crate) fn stop_words(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::MaxIter => "stopped at MaxIter",
        Stop::MaxFunEvals => "stopped at MaxFunEvals",
        Stop::Interrupted => "interrupted",
    }
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct RunNote {
    pub(super) start: PerVariable<f64>,
    #[serde(flatten)]
    pub(super) at_start: Amount,
    pub(super) found: PerVariable<f64>,
    #[serde(flatten)]
    pub(super) value: Amount,
    pub(super) iterations: u64,
    pub(super) func_count: u64,
    pub(super) stop: Stop,
    /// The descent by derivatives from the end of the refinement, where it found a better design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) descent: Option<DescentNote>,
}

#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct DescentNote {
    #[serde(flatten)]
    pub(super) from: Amount,
    pub(super) evaluations: u64,
}

impl RunNote {
    pub(super) fn new(run: &Run, quantity: Measure, over: impl Fn(&[f64]) -> PerVariable<f64>) -> Self {
        let Minimum { x, value, iterations, func_count, stop, .. } = &run.minimum;
        let (start, at_start) = match run.rows.first() {
            Some(row) => (over(&row.best), value_of(row.value)),
            None => (PerVariable::default(), f64::NAN),
        };
        let (iterations, func_count) = (*iterations, *func_count);
        Self {
            start,
            at_start: Amount::of(quantity, "_start", at_start),
            found: over(x),
            value: Amount::new(quantity, value_of(*value)),
            iterations,
            func_count,
            stop: *stop,
            descent: run.descent.map(|Descended { from, evaluations }| DescentNote {
                from: Amount::of(quantity, "_before", value_of(from)),
                evaluations,
            }),
        }
    }
}
