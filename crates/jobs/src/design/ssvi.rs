//! The best SSVI NES near known designs: good designs of this repository's studies, in dimensionless form, and the best TMD with its walls
//! within reach. A few runs each show which can compete with the TMD, and descents start from the best of these; under a shock or a record,
//! where there are no derivatives, simplex searches.
//!
//! This takes seconds and is no global search: `retune optimize` of the written study makes one.

use super::candidate::{Candidate, at_few_stiffnesses};
use super::resonance::about_resonance;
use super::settled::{settles_late, settling};
use super::tmd::simplex;
use super::words::sized;
use crate::tune::descent::descend;
use crate::tune::objective::{coarse, journaled, loose, searched};
use crate::{Error, Observer, Progress};
use rayon::prelude::*;
use retune_model::{Coupled, Measure, Scene};
use retune_optim::{Bounds, INFEASIBLE, Parameter, Point};
use retune_store::Journal;
use retune_study::{Search, Study};
use std::sync::{Mutex, PoisonError};

/// Good designs, dimensionless: k2/(m2 ω1²); c2/(2 m2 ω1) √(0.06/μ) for a mass ratio μ; D and C as shares of the stroke of the best TMD.
/// Off resonance, the nearest frequency of the band replaces ω1. From `results`: `ssvi`, `ssvi-global`, `ssvi-robust`, `ssvi-loss`,
/// `table2` and the softest of `fronts`, each for μ = 0.06.
const KNOWN: [[f64; 4]; 6] = [
    [0.246, 0.126, 0.106, 4.05],
    [0.246, 0.126, 2.81, 0.101],
    [0.246, 0.129, 0.110, 3.99],
    [0.253, 0.056, 0.060, 4.84],
    [0.094, 0.304, 0.228, 1.37],
    [0.042, 0.321, 1.46, 0.0],
];
const RATIO: f64 = 0.06;
/// Gaps of the starts at the best TMD, as shares of its stroke.
const NEAR: [f64; 3] = [0.5, 0.75, 0.95];
/// Multiples of the dashpots and gaps of known designs that are tried; [`STRONG`] is for conditions far from the known ones, such as small
/// damping.
const DASHPOTS: [f64; 3] = [0.6, 1.0, 1.7];
const STRONG: f64 = 4.0;
const GAPS: [f64; 3] = [0.4, 1.0, 2.5];
/// Designs above this multiple of the TMD's value are not evaluated further.
const WORTH: f64 = 4.0;
/// Total relative violation of the limits above which a known design is no start: a descent from there takes minutes.
const FAR: f64 = 2.0;
/// Number of descents: each from the best design of a family, for the best families, and half as many for families far from the known
/// designs.
const DESCENTS: usize = 4;
/// Most evaluations of a descent, so that the answer takes seconds and is the same on every machine; most descents need fewer than 60. Runs
/// whose contacts lose energy take several times as long.
const PATIENCE: u64 = 150;
const PATIENCE_WHERE_SLOW: u64 = 60;
/// Slow searches are coarser: their tolerance, for steps that must gain 1e-5; their samples of the band, plus peaks between them; and for
/// all searches, the most periods before the window. Results are evaluated on all samples of the study, at its tolerance, once settled.
const RTOL_WHERE_SLOW: f64 = 1e-7;
const SAMPLES_WHERE_SLOW: usize = 16;
const PASSED_IN_SEARCH: f64 = 300.0;

/// The result of a search for an SSVI NES.
pub(super) struct Ends {
    /// The designs found, each its value and `[k2, c2, D, C]`, the best first; empty if nothing tried can compete with the TMD.
    pub ends: Vec<(f64, Vec<f64>)>,
    pub tried: usize,
}

/// A start with the number of its family.
type Start = (usize, Vec<f64>);

/// The starts: known designs and the TMD, within the bounds of the search.
fn starts(study: &Study, search: &Search, (tmd, strokes): (&Candidate, &[f64])) -> Vec<Start> {
    let Scene { primary, forcing, .. } = study.scene;
    // Off resonance the damper is tuned to the frequency of the forcing.
    let driven = if forcing.is_transient() { primary.natural_frequency() } else { forcing.frequency.get() };
    let (m2, stroke_of_tmd) = (search.damper.mass.get(), tmd.value(Measure::Stroke));
    let mass_scale = (m2 / primary.mass.get() / RATIO).sqrt();
    let near = |share: &f64| (0, [tmd.k2(), tmd.c2(), share * stroke_of_tmd, share * stroke_of_tmd]);
    let mut all: Vec<(usize, [f64; 4])> = NEAR.iter().map(near).collect();
    for (number, [k2, c2, d, c]) in KNOWN.into_iter().enumerate() {
        for dashpot in DASHPOTS.into_iter().chain([STRONG]) {
            for (i, stroke) in strokes.iter().enumerate() {
                // Separate families for starts farther from the known designs.
                let beside = if i > 0 || dashpot == STRONG { KNOWN.len() } else { 0 };
                let c2 = dashpot * c2 * mass_scale * 2.0 * m2 * driven;
                let with = |gap: f64| [k2 * m2 * driven * driven, c2, gap * d * stroke, gap * c * stroke];
                all.extend(GAPS.map(|gap| (number + 1 + beside, with(gap))));
            }
        }
    }
    let within = |(family, x): (usize, [f64; 4])| {
        let bounds = search.options.bounds.iter().zip(x);
        let one = |(bound, x): (&Bounds, f64)| {
            x.clamp(bound.lower.unwrap_or(0.0), bound.upper.unwrap_or(f64::INFINITY))
        };
        (family, bounds.map(one).collect())
    };
    all.into_iter().map(within).collect()
}

/// Reports the best design so far, with the value of the table, since runs of a search are less accurate. Descents run in parallel but are
/// reported in the order of their starts: the lines are the same for any number of threads.
struct BestSoFar<'a> {
    bar: Box<dyn Progress + 'a>,
    watch: &'a dyn Observer,
    study: &'a Study,
    /// Whether the designs answer the request; those under other limits do not.
    asked: bool,
    outcomes: Mutex<Outcomes>,
}

/// The results of the descents.
struct Outcomes {
    /// By number of the descent; none while it is running.
    all: Vec<Option<(f64, Vec<f64>)>>,
    /// Number of descents reported.
    reported: usize,
    best: f64,
}

impl BestSoFar<'_> {
    /// Records the result of a descent and reports improvements in order.
    fn done(&self, number: usize, value: f64, x: &[f64]) -> Result<(), Error> {
        let mut outcomes = self.outcomes.lock().unwrap_or_else(PoisonError::into_inner);
        let Outcomes { all, reported, best } = &mut *outcomes;
        all[number] = Some((value, x.to_vec()));
        let mut written = Ok(());
        while let Some(Some((value, x))) = all.get(*reported) {
            *reported += 1;
            if *value < *best {
                *best = *value;
                self.bar.best(&sized(*value, self.study.quantity().unit()));
                if self.asked && written.is_ok() {
                    self.bar.aside(&mut || written = self.watch.so_far(&so_far(self.study, *value, x)));
                }
            }
        }
        self.bar.inc(1);
        written
    }
}

/// The best design of a stage, in case the user stops there.
fn so_far(study: &Study, value: f64, x: &[f64]) -> String {
    format!("SSVI NES so far: {}", words(study, value, x))
}

/// A value and its design, in words.
fn words(study: &Study, value: f64, x: &[f64]) -> String {
    let quantity = study.quantity();
    let value = if value < INFEASIBLE {
        format!("{} {}", quantity.name(), sized(value, quantity.unit()))
    } else {
        "breaks a limit".to_owned()
    };
    let one = |(parameter, x): (&Parameter, &f64)| format!("{parameter} = {}", sized(*x, parameter.unit()));
    let design: Vec<String> = Parameter::PAPER.iter().zip(x).map(one).collect();
    format!("{value}, {}", design.join(", "))
}

/// Reports the SSVI NES that is compared and why, if it is not the best reported. `compared` holds it and the least goal of those that
/// strike their walls.
pub(super) fn report_compared(
    found: &Ends,
    compared: Option<(&Candidate, f64)>,
    watch: &dyn Observer,
) -> Result<(), Error> {
    let Some((of, least)) = compared.filter(|(of, _)| of.feasible) else { return Ok(()) };
    let x = Parameter::PAPER.map(|parameter| of.damper().map_or(f64::NAN, |damper| parameter.get(&damper)));
    let compared = words(&of.study, of.goal, &x);
    let reported = found.ends.first().map(|(value, end)| (words(&of.study, *value, end), end[..] == x));
    let why = match reported {
        Some((words, _)) if words == compared => return Ok(()),
        Some((_, true)) => "settled",
        _ if of.goal == least => "the best that strikes its walls",
        _ => "nearly as good, and more certain",
    };
    watch.so_far(&format!("SSVI NES compared ({why}): {compared}"))
}

/// Whether contacts lose energy: runs then take several times as long.
pub(super) fn is_lossy(Scene { primary, forcing, damper }: &Scene) -> bool {
    damper.is_some_and(|damper| Coupled::new(primary, forcing, &damper).is_lossy())
}

/// The study of the search, and whether its runs are slow: contacts lose energy, or the motion builds up for hundreds of periods.
fn searched_study(study: &Study, tmd: &Candidate) -> (Study, bool) {
    let with_tmd = &tmd.study.scene;
    let slow = is_lossy(&study.scene) || settles_late(study, with_tmd);
    // Samples of a wide band may miss the resonance, where an SSVI NES is effective.
    let narrow = about_resonance(study);
    let mut searched_study =
        at_few_stiffnesses(&settling(narrow.as_ref().unwrap_or(study), with_tmd, PASSED_IN_SEARCH));
    let band = searched_study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut());
    if let Some(band) = band.filter(|_| slow) {
        band.samples = band.samples.min(SAMPLES_WHERE_SLOW);
    }
    (searched_study, slow)
}

/// Searches from known designs, with gaps scaled by each of `strokes`, or from `given` starts, such as the end of a search under other
/// limits.
pub(super) fn best(
    study: &Study,
    (tmd, strokes): (&Candidate, &[f64]),
    given: &[Vec<f64>],
    (journal, stage): (&Journal, &str),
    watch: &dyn Observer,
) -> Result<Ends, Error> {
    let search = study.search().map_err(Error::rule(study))?;
    debug_assert_eq!(search.variables, Parameter::PAPER);
    let (searched_study, slow) = searched_study(study, tmd);
    let objective = if slow {
        let loose = loose(&searched_study, &search, &search.variables, RTOL_WHERE_SLOW);
        loose.within(PATIENCE_WHERE_SLOW)
    } else {
        searched(&searched_study, &search, &search.variables).within(PATIENCE)
    };
    let coarse = coarse(&searched_study, &search, &search.variables);
    // Results from given starts are for other limits and do not answer the request.
    let asked = given.is_empty();
    let given: Vec<Start> = given.iter().cloned().enumerate().collect();
    let starts = if given.is_empty() { starts(study, &search, (tmd, strokes)) } else { given };
    let most = if tmd.feasible { WORTH * tmd.goal } else { f64::INFINITY };
    let name = format!("{stage} known");
    let value = journaled(&coarse, journal, &name, || ());
    let bar = watch.progress("SSVI NES, known designs", starts.len() as u64);
    let tried = |start: &Start| {
        let value = value(&start.1, most);
        bar.inc(1);
        value
    };
    let values: Vec<f64> = starts.par_iter().map(tried).collect();
    let mut all: Vec<(f64, &Start)> = values.into_iter().zip(&starts).collect();
    bar.finish();
    journal.check()?;
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The value as in the table, for a design that breaks no limit in the search.
    let exactly = |value: f64, x: &[f64]| {
        let exact = || {
            let scene = objective.scene(x).ok()?;
            Candidate::goal_of(&Study { scene, ..study.clone() })
        };
        let of = || exact().unwrap_or(value);
        if value < INFEASIBLE {
            journal.value(&format!("{stage} exactly"), x, f64::INFINITY, of, |_| ())
        } else {
            value
        }
    };
    let mut ends: Vec<(f64, Vec<f64>)> = Vec::new();
    if let Some((_, (_, x))) = all.first().filter(|(value, _)| asked && *value < most) {
        let known = journaled(&objective, journal, &format!("{stage} best known"), || ())(x, f64::INFINITY);
        let known = exactly(known, x);
        watch.so_far(&so_far(study, known, x))?;
        ends.push((known, x.clone()));
    }
    // Descents from designs that break limits take long.
    let descents = if tmd.feasible { DESCENTS } else { DESCENTS / 2 };
    let mut chosen: Vec<&Start> = Vec::new();
    let within_reach = most.min(INFEASIBLE * (1.0 + FAR));
    for (_, start) in all.iter().filter(|(value, _)| *value < within_reach) {
        let is_far = |family: usize| family > KNOWN.len();
        let similar = chosen.iter().filter(|(family, _)| is_far(*family) == is_far(start.0)).count();
        let room = if is_far(start.0) { descents.div_ceil(2) } else { descents };
        if similar < room && chosen.iter().all(|(known, _)| *known != start.0) {
            chosen.push(start);
        }
    }
    let known = ends.first().map_or(INFEASIBLE, |(value, _)| *value);
    let bar = watch.progress("SSVI NES", chosen.len() as u64);
    if known < INFEASIBLE {
        bar.best(&sized(known, study.quantity().unit()));
    }
    let outcomes = Outcomes { all: vec![None; chosen.len()], reported: 0, best: known.min(INFEASIBLE) };
    let reported = BestSoFar { bar, watch, study, asked, outcomes: Mutex::new(outcomes) };
    let descent = |(number, (_, x)): (usize, &&Start)| {
        let stage = format!("{stage} descent");
        let Point { x, value } = if study.scene.forcing.is_transient() {
            simplex(journaled(&objective, journal, &stage, || ()), &search, x)
        } else {
            descend(&objective, &search, x, journal, &stage).end
        };
        let value = exactly(value, &x);
        reported.done(number, value, &x).map(|()| (value, x))
    };
    let found: Result<Vec<(f64, Vec<f64>)>, Error> = chosen.par_iter().enumerate().map(descent).collect();
    reported.bar.finish();
    journal.check()?;
    let known = ends.first().map(|(_, x)| x.clone());
    ends.extend(found?.into_iter().filter(|(_, x)| known.as_ref() != Some(x)));
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let tried = objective.counts().evaluations + coarse.counts().evaluations;
    Ok(Ends { ends, tried: tried as usize })
}
