//! The trade-off between the least E1max at the nominal stiffness and the retention range.
//!
//! For each damper the widest range is searched for (Sobol points and CMA-ES over the box of its study, if it has one, then `fminsearch`),
//! then, for ranges between that of the nominal design and the widest, the least E1max with at least this range (`fminsearch`, from the
//! best design so far). The non-dominated designs are then evaluated on the common samples, at the tolerance of the study.

use super::range::{Range, Resolution, Threshold};
use super::tuned::{OWN, STILL, Tuned, Tuning, on_samples};
use crate::Error;
use crate::columns;
use crate::searches::Searches;
use crate::tune::objective::{journaled, loose};
use retune_model::{Design, Parameter, Scene};
use retune_optim::{DesignObjective, Evaluation, Global, explore, minimize};
use retune_report::cells;
use retune_report::table::{Cell, Column, Table};
use retune_study::{Setting, Study};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// The search for the widest range.
const WIDEST: Global = Global {
    samples: 48,
    searches: 2,
    apart: 0.15,
    spread: 0.15,
    tolerance: 5e-3,
    evaluations: 100,
    seed: 1,
};
/// Number of target ranges from that of the nominal design to the widest.
const BETWEEN: u32 = 6;
/// Most evaluations of each of these searches.
const EVALUATIONS: u64 = 60;
/// Relative tolerances of these searches: for E1max at the nominal stiffness, and for values only compared with the threshold, since ends
/// of ranges are needed only to 1e-3 ([`Resolution::SEARCH`]).
const RTOL: f64 = 1e-6;
const RANGE_RTOL: f64 = 1e-4;
/// Approximate largest number of designs of a front that are evaluated on the common samples.
const MOST: usize = 32;
/// A value above every E1max, J, for designs with too small a range.
const TOO_NARROW: f64 = 1e6;

/// The columns of the ends of ranges: with the band of the study, and with a fixed one.
pub(super) const ENDS: [&str; 4] = ["from", "to", "still_from", "still_to"];

/// A design with E1max and ranges, on the common samples.
#[derive(Clone, Debug)]
pub struct Point {
    /// The index of its damper.
    pub damper: usize,
    /// How it was tuned.
    pub tuning: Tuning,
    /// The design.
    pub at: Design,
    /// E1max at the nominal stiffness, J.
    pub e1_max: f64,
    /// Its retention range with each band; none where it has none or its study lacks the band.
    pub ranges: [Option<Range>; 2],
}

impl Point {
    /// A design of a damper, on the common samples.
    pub fn new((damper, tuned): (usize, &Tuned), tuning: Tuning, at: Design) -> Self {
        let e1_max = tuned.energy(&at, tuned.nominal());
        let range = |band: usize| {
            let study = on_samples(tuned.studies.get(band)?, tuned.samples, &at)?;
            let (goal, settings) = (study.goal(), study.solver.settings());
            let evaluate = |scene: &Scene, cutoff| goal.evaluate(scene, &settings, cutoff);
            range(&study, tuned.thresholds.get(band)?, Resolution::RESULT, evaluate)
        };
        Self { damper, tuning, at, e1_max, ranges: [OWN, STILL].map(range) }
    }

    /// Its retention range with the band of the study.
    pub fn range(&self) -> Option<Range> {
        self.ranges[OWN]
    }

    /// The ends of its ranges, by the names of [`ENDS`].
    pub(super) fn ends(&self) -> [Option<f64>; 4] {
        let [own, still] = self.ranges;
        let [from, to] = [|range: Range| range.from, |range: Range| range.to];
        [own.map(from), own.map(to), still.map(from), still.map(to)]
    }

    /// The factor by which k1 may rise and fall; 1 without a range.
    pub fn factor(&self) -> f64 {
        self.range().map_or(1.0, |range| range.factor())
    }

    /// Whether it is of the same damper, no worse than `other` in E1max and range, and better in one of them.
    pub fn dominates(&self, other: &Self) -> bool {
        let (e1_max, factor) = (self.e1_max, self.factor());
        self.damper == other.damper
            && e1_max <= other.e1_max
            && factor >= other.factor()
            && (e1_max < other.e1_max || factor > other.factor())
    }
}

/// The designs that no other of the same damper dominates, the least E1max first.
pub fn front(points: &[Point], damper: usize) -> Vec<&Point> {
    let good = |point: &&Point| point.damper == damper && point.range().is_some();
    let dominated = |point: &Point| points.iter().any(|other| other.dominates(point));
    let mut front: Vec<&Point> = points.iter().filter(good).filter(|point| !dominated(point)).collect();
    front.sort_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
    front
}

/// The range of the damper in a study's scene, by evaluations of the scene at other k1.
fn range<E>(
    study: &Study,
    threshold: &Threshold,
    resolution: Resolution,
    evaluate: impl Fn(&Scene, f64) -> Result<Evaluation, E> + Sync,
) -> Option<Range> {
    threshold.range(resolution, |k1, cutoff| {
        let scene = study.scene_with(&[Setting::new(Parameter::K1, k1)]).ok();
        let found = scene.and_then(|scene| evaluate(&scene, cutoff).ok());
        found.map_or(f64::INFINITY, |found| found.value)
    })
}

/// The designs of a damper between the nominal one and the one with the widest range.
pub fn trade(number: usize, tuned: &Tuned, searches: &Searches) -> Result<Vec<Point>, Error> {
    let (study, threshold) = (tuned.study(), &tuned.thresholds[OWN]);
    let search = study.search().map_err(Error::rule(study))?;
    let [objective, range_objective] =
        [RTOL, RANGE_RTOL].map(|rtol| loose(study, &search, &search.variables, rtol));
    let stages = ["E1max", "range"].map(|what| format!("{number} {what}"));
    let all = Mutex::default();
    let evaluated = Evaluated {
        study,
        objective: &objective,
        range_objective: &range_objective,
        threshold,
        searches,
        stages,
        all,
    };
    // The kept designs within the bounds of the search come first.
    let mut least = 0.0;
    for (tuning, at) in &tuned.kept {
        let x: Vec<f64> = search.variables.iter().map(|variable| at.get(*variable)).collect();
        if search.options.bounds.iter().zip(&x).all(|(bounds, value)| bounds.contain(*value)) {
            let (_, width) = evaluated.evaluate(&x);
            if *tuning == Tuning::Nominal {
                least = width;
            }
        }
    }
    // Without a range, a design closer to the threshold scores better.
    let score = |(e1_max, width): (f64, f64)| {
        if width > 0.0 { -width } else { e1_max / threshold.at(tuned.nominal()) }
    };
    let widest = |x: &[f64]| score(evaluated.evaluate(x));
    if let Some((_, space, _)) = &search.global {
        let found = explore(|x, _| widest(x), space, &WIDEST, || ());
        found.map_err(|source| Error::Global { source, failures: objective.failures() })?;
    }
    let options = || retune_optim::Options { max_fun_evals: Some(EVALUATIONS), ..search.options.clone() };
    let refine = |value: &dyn Fn(&[f64], f64) -> f64, from: Option<(Vec<f64>, _)>| -> Result<(), Error> {
        let Some((from, _)) = from else { return Ok(()) };
        let found = minimize(value, &from, options(), |_| ControlFlow::Continue(()));
        found.map_err(|source| Error::Search { source, failures: objective.failures() })?;
        Ok(searches.journal().check()?)
    };
    refine(&|x, _| widest(x), evaluated.best(score))?;
    let most = evaluated.best(|(_, width)| -width).map_or(0.0, |(_, (_, width))| width);
    let targets = if most > 0.0 { BETWEEN } else { 0 };
    for i in 1..=targets {
        let wanted = least + (most - least) * f64::from(i) / f64::from(BETWEEN);
        let value = |x: &[f64], _cutoff: f64| match evaluated.evaluate(x) {
            (e1_max, width) if width >= wanted => e1_max,
            (_, width) => TOO_NARROW * (1.0 + wanted - width),
        };
        let keeps = |(e1_max, width): (f64, f64)| if width >= wanted { e1_max } else { f64::INFINITY };
        refine(&value, evaluated.best(keeps))?;
    }
    let designs = evaluated.front(&search.variables)?;
    let (name, count) = (&tuned.name, designs.len());
    searches.watch.log(&format!("{name}: {count} designs between the least E1max and the widest range"))?;
    Ok(designs.into_iter().map(|at| Point::new((number, tuned), Tuning::Front, at)).collect())
}

/// The evaluated designs of a damper: E1max at the nominal stiffness, J, and the factor of the range minus 1.
struct Evaluated<'a> {
    study: &'a Study,
    objective: &'a DesignObjective,
    range_objective: &'a DesignObjective,
    threshold: &'a Threshold,
    searches: &'a Searches<'a>,
    stages: [String; 2],
    all: Mutex<BTreeMap<Vec<u64>, (f64, f64)>>,
}

impl Evaluated<'_> {
    /// Evaluates a design; the journal keeps both numbers.
    fn evaluate(&self, x: &[f64]) -> (f64, f64) {
        let journal = self.searches.journal();
        let [first, second] = &self.stages;
        let e1_max = journaled(self.objective, journal, first, || ())(x, f64::INFINITY);
        let nominal = self.study.scene.primary.stiffness.get();
        let width = match e1_max <= self.threshold.at(nominal) {
            true => journal.value(second, x, f64::INFINITY, || self.width(x), |_| ()),
            false => 0.0,
        };
        let key = x.iter().map(|value| value.to_bits()).collect();
        self.all.lock().unwrap_or_else(PoisonError::into_inner).insert(key, (e1_max, width));
        (e1_max, width)
    }

    fn width(&self, x: &[f64]) -> f64 {
        let Ok(scene) = self.objective.scene(x) else { return 0.0 };
        let study = Study { scene, ..self.study.clone() };
        let evaluate = |scene: &Scene, cutoff| self.range_objective.evaluate(scene, cutoff);
        let range = range(&study, self.threshold, Resolution::SEARCH, evaluate);
        range.map_or(0.0, |range| range.factor() - 1.0)
    }

    /// All designs with both numbers, in an order that does not depend on the threads.
    fn all(&self) -> Vec<(Vec<f64>, (f64, f64))> {
        let all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        let design = |key: &Vec<u64>| key.iter().map(|bits| f64::from_bits(*bits)).collect();
        all.iter().map(|(key, numbers)| (design(key), *numbers)).collect()
    }

    /// The design with the least finite value.
    fn best(&self, value: impl Fn((f64, f64)) -> f64) -> Option<(Vec<f64>, (f64, f64))> {
        let finite = self.all().into_iter().filter(|(_, numbers)| value(*numbers).is_finite());
        finite.min_by(|a, b| value(a.1).total_cmp(&value(b.1)))
    }

    /// The non-dominated designs, at most about [`MOST`], evenly along the front.
    fn front(&self, varied: &[Parameter]) -> Result<Vec<Design>, Error> {
        let mut all = self.all();
        all.retain(|(_, (_, width))| *width > 0.0);
        all.sort_by(|a, b| a.1.0.total_cmp(&b.1.0).then(b.1.1.total_cmp(&a.1.1)));
        let mut widest = 0.0;
        all.retain(|(_, (_, width))| {
            let more = *width > widest;
            widest = widest.max(*width);
            more
        });
        let (step, last, mut next) = (widest / MOST as f64, all.len().saturating_sub(1), 0.0);
        let mut front = Vec::new();
        for (number, (x, (_, width))) in all.into_iter().enumerate() {
            if width >= next || number == last {
                next = width + step;
                front.push(Design::of_varied(&self.objective.damper(&x)?, varied));
            }
        }
        Ok(front)
    }
}

pub fn table<'a>(dampers: &[Tuned], points: impl Iterator<Item = &'a Point> + Clone) -> Table {
    let parameters = columns::of_designs(points.clone().map(|point| &point.at));
    let names = [&["damper", "tuning"], &*columns::symbols(&parameters), &["E1max"]].concat();
    let ends = ENDS.map(|end| Column::new(end, Parameter::K1.unit()));
    let row = |point: &Point| {
        let first = cells![dampers[point.damper].name.as_str(), point.tuning.name()];
        let design = columns::cells_of(&point.at, &parameters);
        [first, design, cells![point.e1_max], point.ends().map(Cell::from).into()].concat()
    };
    Table::new(names.into_iter().map(columns::column).chain(ends)).with(points.map(row))
}
